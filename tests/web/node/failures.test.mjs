// SPDX-License-Identifier: MIT
//
// What a device does where its context fails: a context that is no more than a list of what it was asked to do stands in for the
// browser's.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

const { Device, SkError } = await import(`${process.env.SK_WEB}/streamkernel/index.js`);

/** Every name in capitals is a number of its own, every other name a function that does nothing unless `own` has another. */
function fakeContext(own = {}) {
  const numbers = new Map();
  const canvas = new EventTarget();
  const state = { errors: [], isLost: false, disabled: new Set(), pixelStore: new Map(), bound: new Map() };
  const functions = {
    getExtension: () => ({}),
    getParameter: () => 4096,
    getError: () => state.errors.shift() ?? 0,
    isContextLost: () => state.isLost,
    createTexture: () => ({}),
    createBuffer: () => ({}),
    createFramebuffer: () => ({}),
    checkFramebufferStatus: () => gl.FRAMEBUFFER_COMPLETE,
    fenceSync: () => ({}),
    clientWaitSync: () => (state.isLost ? gl.WAIT_FAILED : gl.ALREADY_SIGNALED),
    disable: (name) => void state.disabled.add(name),
    pixelStorei: (name, value) => void state.pixelStore.set(name, value),
    ...own,
  };
  const gl = new Proxy({ canvas, state }, {
    get(target, name) {
      if (name in target) return target[name];
      if (name in functions) return functions[name];
      if (!/^[A-Z0-9_]+$/.test(String(name))) return () => undefined;
      if (name === 'NO_ERROR') return 0;
      if (!numbers.has(name)) numbers.set(name, 1000 + numbers.size);
      return numbers.get(name);
    },
  });
  return gl;
}

const isOfKind = (kind) => (error) => error instanceof SkError && error.kind === kind;

test('a texture that has no memory is an error, and no empty stream', async () => {
  let isFull = false;
  const gl = fakeContext({ texStorage2D: () => isFull && gl.state.errors.push(gl.OUT_OF_MEMORY) });
  const device = await Device.create({ context: gl });
  const make = () => device.stream('float', [3, 4]).write(new Float32Array(12));
  make();
  isFull = true;
  assert.throws(() => device.stream('float', [5, 4]).write(new Float32Array(20)), isOfKind('memory'));
  assert.throws(() => device.stream('float', [5, 4]).write(new Float32Array(20)), /no memory/);
  isFull = false;
  device.stream('float', [5, 4]).write(new Float32Array(20));
});

test("the application's errors are not the device's", async () => {
  const gl = fakeContext();
  const device = await Device.create({ context: gl });
  gl.state.errors.push(gl.INVALID_OPERATION, gl.OUT_OF_MEMORY);
  device.stream('float', [3, 4]).write(new Float32Array(12));
});

test('a read that fails fails alone', async () => {
  let calls = 0;
  const gl = fakeContext({
    getBufferSubData: (target, offset, into) => {
      if (++calls === 1) throw new RangeError('too large');
      into.fill(7);
    },
  });
  const device = await Device.create({ context: gl });
  const stream = device.stream('float', [4]);
  stream.write(new Float32Array(4));
  const reads = await Promise.allSettled([stream.read(), stream.read(), stream.read()]);
  assert.deepEqual(reads.map(({ status }) => status), ['rejected', 'fulfilled', 'fulfilled']);
  assert.deepEqual([...reads[2].value], [7, 7, 7, 7]);
  assert.deepEqual([...(await stream.read())], [7, 7, 7, 7]);
});

test('a read that the page has no memory for is an error of that kind', async () => {
  const gl = fakeContext({ bufferData: () => gl.state.errors.push(gl.OUT_OF_MEMORY) });
  const device = await Device.create({ context: gl });
  const stream = device.stream('float', [1024, 1024]);
  stream.write(new Float32Array(1024 * 1024));
  await assert.rejects(stream.read(), isOfKind('memory'));
});

for (const isKnown of [true, false]) {
  test(`a lost context rejects all that is pending, ${isKnown ? 'at its event' : 'before its event'}`, async () => {
    const gl = fakeContext({ clientWaitSync: () => (gl.state.isLost ? gl.WAIT_FAILED : gl.TIMEOUT_EXPIRED) });
    const device = await Device.create({ context: gl });
    const stream = device.stream('float', [4]);
    stream.write(new Float32Array(4));
    const pending = [stream.read(), stream.read()].map((read) => read.then(() => null, (error) => error));
    gl.state.isLost = true;
    if (isKnown) gl.canvas.dispatchEvent(new Event('webglcontextlost'));
    for (const error of await Promise.all(pending)) assert.ok(isOfKind('lost')(error), String(error));
    gl.canvas.dispatchEvent(new Event('webglcontextlost'));
    assert.throws(() => device.stream('float', [4]), isOfKind('lost'));
    await assert.rejects(stream.read(), isOfKind('lost'));
  });
}

test('elements that are read after the context was lost are not taken for results', async () => {
  const gl = fakeContext({ clientWaitSync: () => gl.ALREADY_SIGNALED });
  const device = await Device.create({ context: gl });
  const stream = device.stream('float', [4]);
  stream.write(new Float32Array(4));
  const read = stream.read();
  gl.state.isLost = true; // its fence has passed
  await assert.rejects(read, isOfKind('lost'));
});

test("each call in an application's context sets what C++ sets, as far as browsers have it", async () => {
  const gl = fakeContext();
  const device = await Device.create({ context: gl });
  gl.state.disabled.clear();
  gl.state.pixelStore.clear();
  device.begin();
  const table = readFileSync(`${process.env.SK_SOURCE}/runtime/src/gl/pass_state.def`, 'utf8');
  const rows = [...table.matchAll(/^SK_(TOGGLE|PIXEL_STORE)\(GL_(\w+), (?:(\d+), )?Nothing\)/gm)];
  assert.ok(rows.length > 10);
  for (const [, kind, name, value] of rows) {
    if (kind === 'TOGGLE') assert.ok(gl.state.disabled.has(gl[name]), name);
    else assert.equal(gl.state.pixelStore.get(gl[name]), Number(value), name);
  }
  for (const name of ['SCISSOR_TEST', 'BLEND']) assert.ok(gl.state.disabled.has(gl[name]), name);
});

test('renderers that run on the processor are those that C++ knows', async () => {
  const { softwareRenderers } = await import(`${process.env.SK_WEB}/streamkernel/abilities.js`);
  const table = readFileSync(`${process.env.SK_SOURCE}/runtime/src/gl/known_devices.def`, 'utf8');
  const parts = [...table.matchAll(/^SK_RENDERER\(Software, "(.*)"\)/gm)].map(([, part]) => part);
  assert.ok(parts.length > 5);
  assert.deepEqual(softwareRenderers.source.split('|').sort(), parts.sort());
});
