// SPDX-License-Identifier: MIT
//
// Devices that end, that come back, and that are less able than most.
import { Device } from 'streamkernel';
import * as k from './calls.sk.js';

/** Resolves when `holds()` does; the test fails if it never does. */
async function until(holds, what) {
  for (let i = 0; i < 500; ++i) {
    if (holds()) return;
    await new Promise((resolve) => setTimeout(resolve, 10));
  }
  throw new Error(`never: ${what}`);
}

/** A context of a canvas of its own, some of whose functions are others. */
function contextWith(changes) {
  const context = document.createElement('canvas').getContext('webgl2');
  for (const [name, change] of Object.entries(changes)) context[name] = change(context[name].bind(context));
  return context;
}
const without = (...names) => ({ getExtension: (get) => (name) => (names.includes(name) ? null : get(name)) });

export const deviceCases = ({ same, refused, filled, random, floats, integers, expect }) => ({
  // A device in a context of the page's keeps few textures that nothing uses, and leaves nothing behind.
  async ends() {
    const living = { Texture: new Set(), Framebuffer: new Set(), Program: new Set(), Shader: new Set(), Buffer: new Set(), Sampler: new Set() };
    const made = (objects) => (make) => (...given) => {
      const object = make(...given);
      objects.add(object);
      return object;
    };
    const freed = (objects) => (free) => (object) => {
      objects.delete(object);
      free(object);
    };
    const changes = Object.entries(living).flatMap(([kind, objects]) => [[`create${kind}`, made(objects)], [`delete${kind}`, freed(objects)]]);
    const context = contextWith(Object.fromEntries(changes));
    const device = await Device.create({ context });
    device.info();
    const kept = random(device, [24, 40], 33);
    const before = await kept.read();
    for (let i = 0; i < 1500; ++i) {
      const passing = device.stream('float', [1 + (i % 50), 1 + Math.floor(i / 50)]);
      k.saxpy(1, passing, passing, passing);
      passing.dispose();
    }
    expect('idle textures have a limit', living.Texture.size > 256 && living.Texture.size < 1200, `${living.Texture.size}`);
    const copy = device.stream('float', [24, 40]);
    k.saxpy(0, kept, kept, copy);
    copy.dispose();
    expect('streams keep their elements', String(await kept.read()) === String(before));
    device.trim();
    expect('trim() deletes what is idle', living.Texture.size < 8, `${living.Texture.size}`);
    const passing = random(device, [30, 40], 34);
    k.zoom_clamp(0.5, passing, passing);
    const pending = passing.read();
    device.dispose();
    await refused('lost', 'has been disposed of', () => pending);
    await refused('lost', 'has been disposed of', () => passing.read());
    passing.dispose();
    for (const [kind, objects] of Object.entries(living)) expect(`no ${kind} is left`, objects.size === 0, `${objects.size}`);
    expect('the context has no error', context.getError() === 0);
  },

  async losses() {
    const device = await Device.create();
    const told = [];
    device.onlost = (error) => told.push(error.kind);
    device.onrestored = () => told.push('restored');
    const shape = [24, 40];
    const [kept, written, gone, target] = [random(device, shape, 30), random(device, shape, 31), random(device, shape, 32), device.stream('float', shape)];
    const body = device.stream(k.Body, [3]);
    body.write({ spot: { at: new Float32Array(6).fill(2), heat: new Float32Array(3) }, kind: new Int32Array(3).fill(7), color: new Float32Array(9) });
    k.saxpy(2, kept, kept, kept);
    await Promise.all([kept.keep(), body.keep()]);
    const wanted = await kept.read();
    k.saxpy(2, kept, kept, kept); // lost, as it is not kept
    const loss = device.context.getExtension('WEBGL_lose_context');

    // The context goes while transfers are under way.
    const pending = [kept.read(), gone.keep(), k.sum(written)];
    loss.loseContext();
    for (const promise of pending) await refused('lost', 'taken the context away', () => promise);
    await until(() => device.lost, 'lost');
    await refused('lost', 'wait for device.onrestored', () => k.saxpy(1, kept, kept, kept));
    await refused('lost', 'wait for device.onrestored', () => k.sum(kept));
    await refused('lost', 'wait for device.onrestored', () => kept.read());
    await refused('lost', 'wait for device.onrestored', () => device.draw(kept));
    await refused('lost', 'wait for device.onrestored', () => kept.write(wanted));

    loss.restoreContext();
    await until(() => !device.lost, 'restored');
    expect('loss and return are told', String(told) === 'lost,restored', String(told));
    expect('a kept stream is restored', String(await kept.read()) === String(wanted));
    const bodies = await body.read();
    expect('a kept struct is restored', bodies.spot.at[5] === 2 && bodies.kind[2] === 7);
    await refused('lost', "the stream of 'x' has lost its elements", () => k.saxpy(1, gone, kept, target));
    await refused('lost', 'the stream has lost its elements', () => gone.read());
    await refused('lost', 'has lost its elements', () => k.sum(gone));
    await refused('lost', 'has lost its elements', () => gone.keep());
    k.saxpy(0, kept, kept, target); // an output needs no elements
    expect('programs run again', String(await target.read()) === String(wanted));
    written.write(floats(24 * 40, 31));
    const sums = [await k.sum(written), floats(24 * 40, 31).reduce((a, b) => a + b, 0)];
    expect('what is written again is there', Math.abs(sums[0] - sums[1]) < 1e-3, String(sums));
    gone.dispose();

    // Once more, now with a stream that has been restored before.
    loss.loseContext();
    await until(() => device.lost, 'lost again');
    loss.restoreContext();
    await until(() => !device.lost, 'restored again');
    expect('a stream is restored twice', String(await kept.read()) === String(wanted));
    expect('there is no GL error', device.context.getError() === 0);
    device.dispose();
    await refused('lost', 'disposed of', () => kept.read());
    await new Promise((resolve) => setTimeout(resolve, 50));
    expect('who disposes of a device is not told of a loss', String(told) === 'lost,restored,lost,restored', String(told));
  },

  async copies() {
    const device = await Device.create({ keepCopies: true });
    const start = floats(1000, 33);
    const u = filled(device, 'float', [1000], start.slice());
    k.saxpy(1, u, u, u);
    const loss = device.context.getExtension('WEBGL_lose_context');
    loss.loseContext();
    await until(() => device.lost, 'lost');
    loss.restoreContext();
    await until(() => !device.lost, 'restored');
    expect('what was written last is restored', String(await u.read()) === String(start));
    device.dispose();
  },

  // Without 32-bit floats to draw to: by the extension, and by framebuffers that are not complete all the same.
  async halves() {
    const incomplete = {
      texStorage2D: (call) => (target, levels, internal, ...size) => call(target, levels, (last = internal), ...size),
      checkFramebufferStatus: (call) => (target) => ([0x822e, 0x8230, 0x8814].includes(last) ? 0x8cd6 : call(target)),
    };
    let last = 0;
    for (const changes of [without('EXT_color_buffer_float'), incomplete]) {
      const device = await Device.create({ context: contextWith(changes) });
      expect('halves are told', device.info().floats === 'half' && !device.info().combinesScattered, JSON.stringify(device.info()));
      const n = 1000;
      const [x, y, r] = [random(device, [n], 1), random(device, [n], 2), device.stream('float', [n])];
      k.saxpy(2.5, x, y, r);
      // Both inputs are rounded to 11 bits, and the result, which is below 4: 2.5 + 1 + 4 half units.
      same(`saxpy ${n}`, await r.read(), 2 ** 13 * 7.5);
      same(`sums ${n}`, [await k.sum(r), await k.last(r), await k.dot(x, y)], 2 ** 13, 128);
      const cells = filled(device, 'int', [64, 61], integers(Int32Array, 64 * 61, 8, 2));
      for (let step = 0; step < 10; ++step) k.life(cells, cells);
      same('life 61', await cells.read()); // integers stay exact
      const [a, z] = [random(device, [20, 28], 24), device.stream('float', [20, 28])];
      k.zoom_wrap(0.37, a, z);
      same('zoom wrap', await z.read(), 2 ** 16);
      const huge = filled(device, 'float', [4], new Float32Array([70000, -70000, 65504, 2 ** -14]));
      const [above, below, ...rest] = await huge.read();
      expect('65504 is the largest number', !Number.isFinite(above) && !Number.isFinite(below) && String(rest) === `65504,${2 ** -14}`, `${above},${below},${rest}`);
      expect('there is no GL error', device.context.getError() === 0);
    }
    await refused('device', 'leave out requireFloats', () => Device.create({ context: contextWith(without('EXT_color_buffer_float')), requireFloats: true }));
    const neither = without('EXT_color_buffer_float', 'EXT_color_buffer_half_float');
    await refused('device', 'nor to halves', () => Device.create({ context: contextWith(neither) }));
    // SwiftShader is software.
    await refused('device', 'refuseSoftware', () => Device.create({ refuseSoftware: true }));
    await refused('device', 'computes on the processor', () => Device.create({ context: contextWith({}), refuseSoftware: true }));
    const none = Object.assign(document.createElement('canvas'), { getContext: () => null });
    await refused('device', 'this browser gives no WebGL2 context', () => Device.create({ canvas: none }));
    await refused('lost', 'the context is lost', () => {
      const context = contextWith({});
      context.getExtension('WEBGL_lose_context').loseContext();
      return Device.create({ context });
    });
  },
});
