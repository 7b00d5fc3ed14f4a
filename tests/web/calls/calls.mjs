// SPDX-License-Identifier: MIT
//
// Makes the calls of reference.cpp in a browser and compares the results. Posts what differs.
import { Device, SkError } from 'streamkernel';
import * as k from './calls.sk.js';
import { appendCases } from './append.mjs';
import { deviceCases } from './devices.mjs';
import { mistakeCases } from './mistakes.mjs';
import { repeatCases } from './repeats.mjs';
import { reductionCases } from './reductions.mjs';
import { layoutCases } from './layouts.mjs';

const expected = await (await fetch('expected.json')).json();
const mistakes = [];
let checks = 0;

function random24(i, seed) {
  let x = (Math.imul(i, 747796405) + Math.imul(seed, 2891336453) + 1) >>> 0;
  x = Math.imul(((x >>> ((x >>> 28) + 4)) ^ x) >>> 0, 277803737) >>> 0;
  return (((x >>> 22) ^ x) >>> 0) >>> 8;
}
const from = (type, count, value) => type.from({ length: count }, (_, i) => value(i));
const floats = (count, seed) => from(Float32Array, count, (i) => random24(i, seed) / 8388608 - 1);
const integers = (type, count, seed, below) => from(type, count, (i) => random24(i, seed) % below);

/**
 * Compares with native code. `ulps` is the bound, in units in the last place of the largest magnitude that a rounding may
 * have: of 1 for most cases, whose inputs are below 1. 0: the same numbers.
 */
function same(name, values, ulps = 0, magnitude = 1) {
  ++checks;
  const wanted = expected[name];
  const list = Array.from(values, Number);
  if (wanted === undefined) return mistakes.push(`${name}: the reference has no such case`);
  if (wanted.length !== list.length) return mistakes.push(`${name}: ${list.length} numbers, not ${wanted.length}`);
  const bound = ulps * 2 ** -23 * magnitude;
  const bad = list.findIndex((value, i) => !(Math.abs(value - wanted[i]) <= bound));
  if (bad >= 0) mistakes.push(`${name}: number ${bad} is ${list[bad]}, not ${wanted[bad]} (bound ${bound})`);
}

/** The call must fail with this kind of error and message. */
async function refused(kind, message, call) {
  ++checks;
  try {
    await call();
  } catch (error) {
    const isRight = error instanceof SkError && error.kind === kind && error.message.includes(message);
    if (!isRight) mistakes.push(`refused, but as ${error.kind ?? error.name}: ${error.message}; not ${kind}: ${message}`);
    return;
  }
  mistakes.push(`not refused: ${message}`);
}

/** This must hold. */
function expect(what, holds, found = '') {
  ++checks;
  if (!holds) mistakes.push(`not true: ${what}: ${found.slice(0, 200)}`);
}

function filled(device, type, shape, values) {
  const stream = device.stream(type, shape);
  stream.write(values);
  return stream;
}
const size = (shape) => shape.reduce((a, b) => a * b, 1);
const random = (device, shape, seed) => filled(device, 'float', shape, floats(size(shape), seed));

const cases = {
  async heat(device) {
    const start = new Float32Array(256 * 256);
    start[128 * 256 + 128] = 1000;
    const u = filled(device, 'float', [256, 256], start);
    for (let step = 0; step < 100; ++step) k.diffuse(0.2, u, u);
    // The same bits, but where values are denormal, and those that come of them.
    same('heat', await u.read(), 2 ** -90);
    // Heat is conserved but for the steps' roundings, and a tree of 2^16 numbers rounds 16 times.
    const values = [await k.sum(u), await k.sum.with({ accumulate: 'tree' })(u)];
    same('heat sum', values, 8, 1000);
    u.dispose();
    await refused('lost', 'disposed', () => u.read());
  },

  async elements(device) {
    for (const n of [1, 7, 256, 1000, 100003]) {
      const [x, y, r] = [random(device, [n], 1), random(device, [n], 2), device.stream('float', [n])];
      k.saxpy(2.5, x, y, r);
      same(`saxpy ${n}`, await r.read());
      same(`sums ${n}`, [await k.sum(r), await k.last(r), await k.dot(x, y)], 8, Math.max(4, Math.sqrt(n)));
    }
  },

  // Operations are those of the text, in its order.
  async arithmetic(device) {
    const n = 4096;
    const [x, y, r] = [random(device, [n], 14), random(device, [n], 15), device.stream('float', [n])];
    const [p, q, s] = [1, 2, 3].map(() => device.stream('float4', [n]));
    k.written(x, y, p, q, s);
    same('written p', await p.read());
    same('written q', await q.read());
    same('written r', await s.read());
    k.divided(x, p, q);
    same('divided p', await p.read());
    same('divided q', await q.read());
    k.loose(x, r);
    same('loose', await r.read(), 2, 1);
  },

  async boundaries(device) {
    for (const [h, w] of [[29, 37], [48, 64], [1, 8], [3, 3]]) {
      const [a, b, c] = [3, 4, 5].map((seed) => random(device, [h, w], seed));
      const d = random(device, [w], 6);
      const r = device.stream('float', [h, w]);
      if (w >= 8) {
        if (h > 1) {
          k.edges(a, b, c, d, r);
          same(`edges ${w}`, await r.read(), 8, 32); // five terms below 32
        } else {
          await refused('compile', "where a gather is smaller than the output, or nearly; write [[variants(views)]] before 'edges'", () => k.edges(a, b, c, d, r));
        }
      }
      same(`far ${w}`, [await k.farthest(a)], 1, 512);
    }
    for (const n of [6, 8]) {
      const [a, r] = [random(device, [5, 7, n], 7), device.stream('float', [5, 7, n])];
      k.blur3(a, r);
      same(`space ${n}`, await r.read(), 8);
      same(`space sum ${n}`, [await k.sum(r), await k.farthest(r)], 64, 16);
    }
  },

  async exact(device) {
    for (const w of [64, 61]) {
      const count = 64 * w;
      const cells = filled(device, 'int', [64, w], integers(Int32Array, count, 8, 2));
      for (let step = 0; step < 10; ++step) k.life(cells, cells);
      same(`life ${w}`, await cells.read());
      same(`alive ${w}`, [await k.count(cells), await k.largest(cells)]);
      const x = filled(device, 'uint', [64, w], integers(Uint32Array, count, 9, 2 ** 24));
      const [r, s, steps] = [device.stream('uint', [64, w]), device.stream('int', [64, w]), device.stream('int', [64, w])];
      k.mix_bits(0xdeadbeef, x, r, s);
      same(`bits ${w}`, await r.read());
      same(`quotients ${w}`, await s.read());
      same(`totals ${w}`, [await k.count(s), await k.largest(s)]);
      k.collatz(300, cells, steps);
      k.collatz(300, steps, steps);
      same(`collatz ${w}`, await steps.read());
    }
    same('bounds', await k.bounds(random(device, [300, 300], 10)));
  },

  async records(device) {
    const count = 40 * 31;
    const f = floats(4 * count, 11);
    const v = filled(device, 'float4', [40, 31], f);
    const [r, s] = [device.stream('float3', [40, 31]), device.stream('float2', [40, 31])];
    k.turn([1, 2, 3], true, v, r, s);
    same('turn r', await r.read(), 4, 8);
    same('turn s', await s.read(), 1, 2);
    const b = device.stream(k.Body, [40, 31]);
    b.write({
      spot: { at: from(Float32Array, 2 * count, (i) => f[(i >> 1) + (i & 1)]), heat: from(Float32Array, count, (i) => f[i + 2]) },
      kind: from(Int32Array, count, (i) => i),
      color: from(Float32Array, 3 * count, (i) => f[Math.floor(i / 3) + 3 + (i % 3)]),
    });
    k.move({ at: [1, 2], heat: 3 }, b, b);
    const { spot, kind, color } = await b.read();
    const members = from(Array, count, (i) => [spot.at[2 * i], spot.at[2 * i + 1], spot.heat[i], kind[i], color[3 * i], color[3 * i + 1], color[3 * i + 2]]);
    same('move', members.flat(), 2, 4);
    const most = await k.heaviest(b);
    same('heaviest', [...most.at, most.heat], 2, 4);
    const q = filled(device, 'float2', [40, 31], f.slice(0, 2 * count));
    k.field.scale([2, 3], q, q);
    same('scale2', await q.read());
  },

  async choices(device) {
    for (const n of [100, 300, 1024]) {
      const [x, w, r] = [random(device, [n], 12), random(device, [n], 13), device.stream('float', [n])];
      k.choose(2, true, x, w, r);
      same(`choose 2 ${n}`, await r.read(), 8, 8);
      k.choose(5, false, x, null, r);
      same(`choose 5 ${n}`, await r.read(), 16, 16);
      await refused('misuse', "'w' is null, but the kernel needs it", () => k.choose(5, true, x, null, r));
    }
    const r = device.stream('float', [6, 8]);
    k.ramp({ begin: [0, 0], end: [8, 3] }, { begin: 0, end: 96 }, r);
    same('ramp', await r.read(), 4, 1024);
    await refused('shape', 'in 48 steps, which are not whole', () => k.ramp({ begin: [0, 0], end: [8, 3] }, { begin: 0, end: 97 }, r));
  },

  async bundles(device) {
    const i = filled(device, 'int', [6, 8], from(Int32Array, 48, (k) => (k * 5) % 16));
    const [color, height, r, line] = [random(device, [16], 31), random(device, [6, 8], 32), device.stream('float', [6, 8]), device.stream('float', [16])];
    const ground = { height, level: 0.25 };
    const scene = { color, ground, doubled: true, weights: [[0, 0], [0.5, 0]] };
    k.shaded(i, scene, r);
    same('bundle', await r.read(), 2, 4);
    k.shaded(i, scene, r); // a repeated call
    same('bundle', await r.read(), 2, 4);
    same('bundle total', [await k.lifted(height, ground)], 64, 64);
    const total = device.stream('float', [1, 1]);
    k.lifted(height, total, ground);
    same('bundle total', await total.read(), 64, 64);
    k.around(height, r);
    same('around 2', await r.read(), 4, 4);
    k.around(color, line);
    same('around 1', await line.read(), 4, 4);
    await refused('misuse', "'scene.color' is null, but the kernel needs it", () => k.shaded(i, { ...scene, color: undefined }, r));
    await refused('type', "'scene.ground.level' is declared as float", () => k.shaded(i, { ...scene, ground: { height } }, r));
    await refused('misuse', "the bundle 'scene' has no member 'colour'; it has color, ground, doubled, weights, unread", () => k.shaded(i, { ...scene, colour: color }, r));
    await refused('misuse', "the bundle 'scene.ground' has no member 'depth'", () => k.shaded(i, { ...scene, ground: { ...ground, depth: 1 } }, r));
    await refused('type', "'scene' is a bundle, but 3 is given", () => k.shaded(i, 3, r));
    await refused('misuse', '2 arguments are given, but 3 are declared', () => k.shaded(i, scene));
  },

  async passes(device) {
    const shape = [24, 36];
    const y = filled(device, 'float3', shape, from(Float32Array, 3 * 24 * 36, (i) => random24(i, 22) / 16777216));
    const x = random(device, shape, 23);
    const [b, d, e, f] = ['float2', 'float', 'int', k.Spot].map((type) => device.stream(type, shape));
    k.spread(true, 0.5, x, y, x, b, y, d, e, f);
    // Seven products of sines and cosines, each within 3 ulp.
    same('spread a', await x.read(), 32, 4);
    same('spread b', await b.read(), 32, 4);
    same('spread c', await y.read(), 32, 4);
    same('spread d', await d.read(), 64, 16);
    const { at, heat } = await f.read();
    same('spread f', from(Array, 24 * 36, (i) => [at[2 * i], at[2 * i + 1], heat[i]]).flat(), 32, 4);
  },

  async types(device) {
    const n = 60;
    const a = filled(device, 'uchar', [n], integers(Uint8Array, n, 14, 256));
    const b = filled(device, 'short', [n], integers(Int16Array, n, 15, 1000));
    const c = filled(device, 'unorm8', [n], integers(Uint8Array, n, 16, 256));
    const d = filled(device, 'snorm16', [n], integers(Int16Array, n, 17, 32768));
    const e = filled(device, 'half', [n], from(Float32Array, n, (i) => (random24(i, 18) % 1024) / 64));
    const f = filled(device, 'bool', [n], integers(Uint8Array, n, 19, 2));
    const [g, h] = [device.stream('ushort', [n]), device.stream('float', [n])];
    k.narrow(a, b, c, d, e, f, g, h);
    same('narrow g', await g.read());
    same('narrow h', await h.read(), 4, 16);
    for (const stream of [a, b, c, d, e, f]) await stream.read();
    const x = filled(device, 'double', [n], from(Float64Array, n, (i) => random24(i, 20) / 16777216 + random24(i, 21) * 2 ** -44));
    k.doubles(1 / 3, x, x);
    same('doubles', await x.read(), 2 ** -20, 2); // pairs of floats: 2^-44 of numbers below 2
  },

  async longs(device) {
    const n = 60;
    const a = -1234567890123456789n;
    const x = from(BigInt64Array, 3 * n, (i) => BigInt.asIntN(64, BigInt(random24(i, 22)) ** 3n));
    const y = from(BigUint64Array, n, (i) => BigInt.asUintN(64, BigInt(random24(i, 23)) ** 3n));
    const [r, s] = [device.stream('long3', [n]), device.stream('ulong', [n])];
    k.longs(a, filled(device, 'long3', [n], x), filled(device, 'ulong', [n], y), r, s);
    const wanted = from(BigInt64Array, 3 * n, (i) => BigInt.asIntN(64, a * x[i] + x[i - (i % 3) + [2, 0, 1][i % 3]] / 3n));
    expect('products and quotients of longs', String(await r.read()) === String(wanted), String(await r.read()));
    const products = from(BigUint64Array, n, (i) => BigInt.asUintN(64, (y[i] >> 7n) * BigInt.asUintN(64, a)));
    expect('products of ulongs', String(await s.read()) === String(products), String(await s.read()));
    const total = await k.longSum(filled(device, 'long', [3 * n], x));
    expect('a sum of longs', total === BigInt.asIntN(64, x.reduce((sum, value) => sum + value, 0n)), String(total));
    const line = device.stream('long', [4]);
    line.fill(-5);
    line.domain([1], [2]).fill(1n << 62n);
    expect('filled longs', String(await line.read()) === `-5,${1n << 62n},-5,-5`, String(await line.read()));
    await refused('type', "'a' is declared as long, but number 0.5 is no such integer", () => k.longs(0.5, device.stream('long3', [n]), s, r, s));
    await refused('type', "'a' is declared as long, but bigint 9223372036854775808 is no such integer", () => k.longs(1n << 63n, device.stream('long3', [n]), s, r, s));
    await refused('type', "'a' is declared as float, but bigint 1 is no number", () => k.saxpy(1n, device.stream('float', [n]), device.stream('float', [n]), device.stream('float', [n])));
    await refused('type', 'written from a BigInt64Array, but a Float64Array is given', () => line.write(new Float64Array(4)));
  },

  async errors(device) {
    const [u, v] = [device.stream('float', [8, 8]), device.stream('float', [8, 12])];
    await refused('shape', "'u' is declared with 2 dimension(s)", () => k.diffuse(0.2, device.stream('float', [64]), u));
    await refused('shape', 'give them the same shape', () => k.saxpy(1, v, v, u));
    await refused('type', 'its stream holds int', () => k.saxpy(1, device.stream('int', [8, 8]), u, u));
    await refused('type', "'a' is declared as float", () => k.saxpy('1', u, u, u));
    await refused('misuse', '3 arguments are given, but 4 are declared', () => k.saxpy(1, u, u));
    await refused('type', "'x' is a stream, but a Float32Array is given", () => k.saxpy(1, new Float32Array(64), u, u));
    await refused('shape', '64 element(s) of float are 64 number(s), but the array has 63', () => u.write(new Float32Array(63)));
    await refused('type', 'written from a Float32Array, but an Array is given', () => u.write([1, 2]));
    await refused('shape', 'is no shape', () => device.stream('float', [2.5]));
    await refused('shape', 'is no shape', () => device.stream('float', []));
    await refused('shape', 'divide it into several streams', () => device.stream('float2', [100000, 100000]));
    await refused('type', "'flaot' is no type of elements", () => device.stream('flaot', [4]));
    await refused('misuse', 'it has no sum of floats to compensate', () => k.count.with({ accumulate: 'compensated' })(device.stream('int', [4])));
    const other = await Device.create();
    await refused('device', 'streams of two devices', () => k.saxpy(1, u, other.stream('float', [8, 8]), u));
    other.dispose();
    await refused('lost', 'has been disposed of; make a new one', () => other.stream('float', [8, 8]));
    await refused('device', 'no WebGL2 context', () => {
      const canvas = document.createElement('canvas');
      canvas.getContext('2d');
      return Device.create({ canvas });
    });
    const empty = device.stream('float', [0, 8]);
    k.saxpy(1, empty, empty, empty);
    if ((await k.sum(empty)) !== 0) mistakes.push('the sum of nothing is not 0');
  },

  async pictures(device) {
    const picture = document.getElementById('picture');
    const shades = filled(device, 'float', [48, 64], from(Float32Array, 48 * 64, (i) => (i < 64 * 24 ? 0 : i % 64 < 32 ? 0.5 : 1)));
    device.draw(shades, picture, { map: 'gray' });
    const pixels = picture.getContext('2d').getImageData(0, 0, 64, 48).data;
    const at = (x, y) => pixels[4 * (y * 64 + x)];
    ++checks;
    const found = [at(5, 5), at(5, 40), at(60, 40)];
    if (Math.abs(found[0]) > 1 || Math.abs(found[1] - 128) > 1 || Math.abs(found[2] - 255) > 1) mistakes.push(`a picture has ${found}, not 0, 128, 255`);
    // Right is red, half of the length half as bright; left has no red.
    const field = filled(device, 'float2', [1, 4], from(Float32Array, 8, (i) => [2, 0, 1, 0, -2, 0, 0, 0][i]));
    [picture.width, picture.height] = [4, 1];
    device.draw(field, picture, { vectors: 'direction', range: [0, 2] });
    const hues = [...picture.getContext('2d').getImageData(0, 0, 4, 1).data];
    const wanted = [255, 64, 64, 255, 128, 32, 32, 255, 0, 191, 191, 255, 0, 0, 0, 255];
    expect('directions are hues', hues.every((value, i) => Math.abs(value - wanted[i]) <= 2), `${hues}`);
    [picture.width, picture.height] = [64, 48];
    await refused('type', 'float has no direction', () => device.draw(shades, picture, { vectors: 'direction' }));
    await refused('misuse', "not by 'arrows'", () => device.draw(field, picture, { vectors: 'arrows' }));
    await refused('misuse', "there is no colour map 'jet'", () => device.draw(shades, picture, { map: 'jet' }));
    await refused('shape', 'is no picture', () => device.draw(device.stream('float', [2, 2, 2]), picture));
  },

  // The device's own filter weighs by 8 bits; without it, the program interpolates.
  async filters(device) {
    const shape = [20, 28];
    for (const boundary of ['clamp', 'wrap']) {
      const [a, r] = [random(device, shape, 24), device.stream('float', shape)];
      k[`zoom_${boundary}`](0.37, a, r);
      same(`zoom ${boundary}`, await r.read(), 2 ** 16);
    }
  },

  // A device on the application's own context, whose state is what it may be.
  async adopted() {
    const context = document.createElement('canvas').getContext('webgl2');
    const device = await Device.create({ context });
    await refused('misuse', 'the canvas that it was made with', () => device.draw(device.stream('float', [2, 2]), document.getElementById('picture')));
    const toggles = ['BLEND', 'SCISSOR_TEST', 'DEPTH_TEST', 'STENCIL_TEST', 'CULL_FACE', 'DITHER', 'SAMPLE_ALPHA_TO_COVERAGE', 'SAMPLE_COVERAGE'];
    for (const name of toggles) context.enable(context[name]);
    context.sampleCoverage(0, false);
    context.colorMask(true, false, false, false);
    const pixelParameters = {
      UNPACK_ALIGNMENT: 8, UNPACK_ROW_LENGTH: 101, UNPACK_IMAGE_HEIGHT: 103, UNPACK_SKIP_PIXELS: 3, UNPACK_SKIP_ROWS: 2, UNPACK_SKIP_IMAGES: 1,
      UNPACK_FLIP_Y_WEBGL: true, UNPACK_PREMULTIPLY_ALPHA_WEBGL: true, PACK_ALIGNMENT: 8, PACK_ROW_LENGTH: 107, PACK_SKIP_PIXELS: 3, PACK_SKIP_ROWS: 2,
    };
    for (const [name, value] of Object.entries(pixelParameters)) context.pixelStorei(context[name], value);
    context.bindFramebuffer(context.FRAMEBUFFER, null);
    await cases.records(device);
    context.useProgram(null);
    context.viewport(0, 0, 1, 1);
    await cases.exact(device);
  },
};
const checked = { same, refused, filled, random, random24, floats, integers, from, size, expect };
Object.assign(cases, appendCases(checked), deviceCases(checked), mistakeCases(checked), repeatCases(checked), reductionCases(checked));

Object.assign(cases, layoutCases({ same, refused, filled, floats, integers, from, size, mistakes }));

const report = { mistakes, checks, seconds: {} };
try {
  const device = await Device.create();
  let last = -1;
  await device.compile([k.diffuse, k.sum], (done) => (last = done));
  if (last !== 1) mistakes.push('compile() does not report progress');
  report.info = device.info();
  expect('sums are exact', report.info.arithmetic.exactSums, JSON.stringify(report.info.arithmetic));
  const wanted = new URLSearchParams(location.search).get('only');
  for (const [name, run] of Object.entries(cases)) {
    if (wanted && !wanted.split(',').includes(name)) continue;
    const start = performance.now();
    try {
      await run(device);
      const error = device.context.getError();
      if (error !== 0) mistakes.push(`${name}: GL error ${error}`);
    } catch (error) {
      mistakes.push(`${name}: ${error.stack}`);
    }
    report.seconds[name] = (performance.now() - start) / 1000;
  }
} catch (error) {
  mistakes.push(`no device: ${error.stack}`);
}
report.checks = checks;
await fetch('/', { method: 'POST', body: JSON.stringify(report) });
