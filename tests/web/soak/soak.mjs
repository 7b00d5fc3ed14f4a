// SPDX-License-Identifier: MIT
//
// Makes calls of all kinds in random order, as a page that is open for days does. Posts what lives at every tenth of them, and which
// results have other bits at the end.
import { Device, SkError } from 'streamkernel';
import * as k from './calls.sk.js';
import * as own from './soak.sk.js';

const wanted = new URLSearchParams(location.search);
const calls = Number(wanted.get('calls') ?? 10000);
let seed = Number(wanted.get('seed') ?? 1);

/** Mulberry32. */
function random() {
  seed = (seed + 0x6d2b79f5) | 0;
  let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
}
const below = (n) => Math.floor(random() * n);

// What lives of the context's objects: what is neither deleted nor collected.
const kinds = ['Texture', 'Buffer', 'Framebuffer', 'Program', 'Shader', 'Sampler', 'Query', 'TransformFeedback', 'VertexArray', 'Sync'];
let living = 0;
const collected = new FinalizationRegistry(() => --living);
for (const kind of kinds) {
  const prototype = WebGL2RenderingContext.prototype;
  const make = kind === 'Sync' ? 'fenceSync' : `create${kind}`;
  const [created, deleted] = [prototype[make], prototype[`delete${kind}`]];
  const known = new WeakSet();
  prototype[make] = function (...given) {
    const object = created.apply(this, given);
    if (object) known.add(object), collected.register(object, null, object), ++living;
    return object;
  };
  prototype[`delete${kind}`] = function (object) {
    if (object && known.delete(object)) collected.unregister(object), --living;
    return deleted.call(this, object);
  };
}

const filled = (device, type, shape, value) => {
  const stream = device.stream(type, shape);
  const count = shape.reduce((a, b) => a * b, 1);
  const kind = { int: Int32Array, uint: Uint32Array }[type] ?? Float32Array;
  const parts = type === 'float2' ? 2 : type === 'float4' ? 4 : 1;
  stream.write(kind.from({ length: count * parts }, (_, i) => value(i)));
  return stream;
};

/** The streams that all calls share; their values are set anew before each call. */
class Scene {
  constructor(device) {
    this.device = device;
    const wave = (i) => ((i * 37) % 101) / 64 - 0.75;
    const shape = [16, 24];
    this.x = filled(device, 'float', shape, wave);
    this.y = filled(device, 'float', shape, (i) => wave(i + 5));
    this.r = device.stream('float', shape);
    this.cells = filled(device, 'int', shape, (i) => (i * 7) % 3 & 1);
    this.next = device.stream('int', shape);
    this.bits = filled(device, 'uint', shape, (i) => i * 2654435761);
    this.mixed = device.stream('uint', shape);
    this.line = filled(device, 'float', [300], wave);
    this.pushed = device.stream('float', [4]);
    this.to = filled(device, 'int', [300], (i) => (i * 7) % 300);
    this.vectors = filled(device, 'float4', shape, wave);
    this.crossed = device.stream('float3', shape);
    this.halves = device.stream('float2', shape);
    this.volume = filled(device, 'float', [5, 7, 6], wave);
    this.blurred = device.stream('float', [5, 7, 6]);
    this.turned = device.stream('float', [300]);
  }
}

/** A call of each kind; returns what it computes, an array of numbers. */
const scenarios = {
  diffuse: (s) => (k.diffuse(0.2, s.x, s.r), s.r.read()),
  inPlace: (s) => (k.saxpy(1, s.x, s.y, s.r), k.diffuse(0.1, s.r, s.r), s.r.read()),
  saxpy: (s) => (k.saxpy(2.5, s.x, s.y, s.r), s.r.read()),
  unread: (s) => (k.saxpy(0.5, s.x, s.y, s.r), []),
  sum: async (s) => [await k.sum(s.x), await k.sum.with({ accumulate: 'tree' })(s.x)],
  exact: async (s) => [await k.sum.with({ accumulate: 'exact' })(s.x)],
  folds: async (s) => [await k.dot(s.x, s.y), await k.last(s.x), await k.farthest(s.x), await k.count(s.cells), ...(await k.bounds(s.x))],
  life: (s) => (k.life(s.cells, s.next), s.next.read()),
  bits: (s) => (k.mix_bits(99, s.bits, s.mixed, s.next), s.mixed.read()),
  blur: (s) => (k.blur3(s.volume, s.blurred), s.blurred.read()),
  vectors: (s) => (k.turn([1, 2, 3], true, s.vectors, s.crossed, s.halves), s.crossed.read()),
  choose: (s) => (k.choose(2, true, s.line, s.line, s.turned), s.turned.read()),
  push: async (s) => (await k.positive(s.line, s.pushed), s.pushed.read()),
  permute: async (s) => (await k.permute(s.to, s.line, s.turned), s.turned.read()),
  view: (s) => (own.offset(2, s.x.domain([2, 3], [10, 9]), s.y, s.r.domain([4, 4], [12, 10])), s.r.domain([4, 4], [12, 10]).read()),
  scan: async (s) => (await own.running(s.line, s.turned), s.turned.read()),
  ramp: (s) => (k.ramp({ begin: [0, 0], end: [24, 16] }, { begin: 0, end: 384 }, s.r), s.r.read()),
  draw: (s) => (s.device.draw(s.x, s.device.canvas, { map: 'gray' }), []),
  /** Streams of a shape of their own, some of which are left to the collector. */
  async passing(s) {
    const shape = [1 + below(40), 1 + below(40)];
    const a = s.device.stream('float', shape);
    const b = s.device.stream('float', shape);
    k.saxpy(2, a, a, b);
    if (random() < 0.5) await b.read();
    if (random() < 0.9) a.dispose(), b.dispose();
    return [];
  },
  half: (s) => (own.precise.with({ precision: 'half' })(2.5, s.x, s.r), s.r.read()),
  extended: (s) => (own.precise.with({ precision: 'extended' })(2.5, s.x, s.r), s.r.read()),
  /** What fails leaves nothing behind. */
  async mistake(s) {
    try {
      k.saxpy(1, s.line, s.x, s.r);
    } catch (error) {
      if (error instanceof SkError) return [];
      throw error;
    }
    throw new Error('a wrong shape was not refused');
  },
};

async function results(scene) {
  const all = {};
  for (const [name, run] of Object.entries(scenarios)) {
    if (name !== 'passing') all[name] = Array.from(await run(scene), Number);
  }
  return all;
}

const post = (path, value) => fetch(path, { method: 'POST', body: JSON.stringify(value) });
const report = { mistakes: [], samples: [] };

function sample(done) {
  globalThis.gc?.();
  report.samples.push({ done, objects: living, heap: performance.memory?.usedJSHeapSize ?? 0 });
}

try {
  const context = document.createElement('canvas').getContext('webgl2'); // which stays when the device goes
  const device = await Device.create({ context });
  const scene = new Scene(device);
  const before = await results(scene);
  const list = Object.values(scenarios);
  for (let i = 1; i <= calls; ++i) {
    await list[below(list.length)](scene);
    if (i % 64 === 0) await new Promise((resume) => setTimeout(resume)); // lets the collector and finalizers run
    if (i % Math.ceil(calls / 100) === 0) await post('/progress', i);
    if (i % Math.ceil(calls / 10) === 0) sample(i);
  }
  const after = await results(scene);
  for (const [name, values] of Object.entries(before)) {
    if (JSON.stringify(values) !== JSON.stringify(after[name])) report.mistakes.push(`${name}: has other bits at the end`);
  }
  const error = device.context.getError();
  if (error !== 0) report.mistakes.push(`GL error ${error}`);
  device.dispose();
  globalThis.gc?.();
  await new Promise((resume) => setTimeout(resume, 100));
  report.left = living;
} catch (error) {
  report.mistakes.push(`${error.stack}`);
}
await post('/report', report);
