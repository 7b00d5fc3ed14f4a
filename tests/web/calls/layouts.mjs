// SPDX-License-Identifier: MIT
//
// Views, inputs that repeat or are fitted, values that streams hold, dials: the calls of layouts.cpp.
import { Device, stretch, stride } from 'streamkernel';
import * as k from './layouts.sk.js';

/** `tools`: what calls.mjs compares and fails with. */
export function layoutCases({ same, refused, filled, floats, integers, from, size, mistakes }) {
  const random = (device, shape, seed) => filled(device, 'float', shape, floats(size(shape), seed));
  const numbers = (device, shape, seed) => filled(device, 'int', shape, integers(Int32Array, size(shape), seed, 1000));
  const flat = (shape, value) => shape.map(() => value);
  const points = ({ at, kind }) => from(Array, kind.length, (i) => [at[2 * i], at[2 * i + 1], kind[i]]).flat();

  return {
    async views(device) {
      for (const shape of [[24, 32], [600], [6, 4, 10], [4, 6, 6, 8]]) {
        const rank = shape.length;
        const [x, y, r] = [random(device, shape, 1), random(device, shape, 2), random(device, shape, 3)];
        const [begin, other, steps] = [flat(shape, 1), flat(shape, 2), flat(shape, 2)];
        const [end, last] = [shape.map((n) => n - 1), shape];
        k.mixed(2.5, x.domain(begin, end), y.domain(other, last), r.domain(begin, end));
        same(`box ${rank}`, await r.read(), 2, 4); // two roundings of numbers below 4, or one
        same(`box read ${rank}`, await r.domain(begin, end).read(), 2, 4);
        k.mixed(0.5, stride(x, steps), stride(y, steps, begin), stride(r, steps));
        same(`strides ${rank}`, await r.read(), 4, 4);
        k.mixed(3, r.domain(begin, end), y.domain(other, last), r.domain(begin, end));
        same(`in place ${rank}`, await r.read(), 8, 16);
        const part = stride(r.domain(begin, end), steps);
        part.write(floats(part.size, 4));
        same(`written ${rank}`, await r.read(), 8, 16);
        same(`strides read ${rank}`, await part.read());
        same(`sums of views ${rank}`, [await k.squares(x.domain(begin, end)), await k.squares(stride(x, steps))], 2, 1024);
      }
    },

    async fills(device) {
      const expectSame = (what, found, wanted) => {
        const list = Array.from(found, Number);
        if (list.length !== wanted.length || list.some((x, i) => x !== wanted[i])) mistakes.push(`${what}: ${list.slice(0, 40)}, not ${wanted.slice(0, 40)}`);
      };
      for (const shape of [[24, 32], [600], [7, 9], [5, 7, 3], [2, 3, 4, 8]]) {
        const [u, v] = [random(device, shape, 20), device.stream('float', shape)];
        const host = await u.read();
        u.copyTo(v);
        expectSame(`copy of ${shape}`, await v.read(), host);
        v.fill(2.5);
        expectSame(`filled ${shape}`, await v.read(), host.map(() => 2.5));
        const inner = [flat(shape, 1), shape.map((n) => n - 1)];
        const parts = [(s) => s.domain(...inner), (s) => stride(s, flat(shape, 2)), (s) => stride(s.domain(...inner), flat(shape, 2))];
        for (const [i, part] of parts.entries()) {
          const marks = device.stream('float', shape);
          part(marks).write(new Float32Array(part(marks).size).fill(1)); // where the part is
          const isIn = await marks.read();
          u.write(host);
          part(u).fill(-3);
          expectSame(`part ${i} of ${shape}`, await u.read(), host.map((x, n) => (isIn[n] ? -3 : x)));
          v.fill(7);
          u.write(host);
          part(u).copyTo(part(v));
          expectSame(`copied part ${i} of ${shape}`, await v.read(), host.map((x, n) => (isIn[n] ? x : 7)));
        }
      }
      const lines = numbers(device, [6, 5], 21);
      const before = await lines.read();
      lines.domain([0, 0], [4, 5]).copyTo(lines.domain([2, 0], [6, 5])); // they overlap
      expectSame('overlapping copies', await lines.read(), [...before.slice(0, 10), ...before.slice(0, 20)]);
      lines.copyTo(lines);
      const values = { int3: [1, -2, 3], bool: true, double: 1 / 3, double3: [1 / 3, 2, 1e-9], half: 0.25, unorm8: 200, short2: [-5, 300], float2x2: [1, 2, 3, 4] };
      for (const [type, value] of Object.entries(values)) {
        const s = device.stream(type, [3, 5]);
        s.fill(value);
        expectSame(`filled ${type}`, (await s.read()), from(Array, 15, () => value).flat().map(Number));
        const part = s.domain([1, 1], [2, 3]);
        part.copyTo(s.domain([0, 0], [1, 2]));
        expectSame(`copied ${type}`, (await part.read()), from(Array, 2, () => value).flat().map(Number));
      }
      const p = device.stream(k.Point, [4]);
      p.fill({ at: [1, 2], kind: 3 });
      expectSame('filled structs', points(await p.read()), from(Array, 4, () => [1, 2, 3]).flat());
      const empty = device.stream('float', [0, 4]);
      empty.fill(1);
      empty.copyTo(device.stream('float', [0, 4]));

      const [u, n] = [device.stream('float', [4, 4]), device.stream('int', [4, 4])];
      await refused('type', 'fill: a value of float has 1 number(s), but 2 are given', () => u.fill([1, 2]));
      await refused('type', 'fill: a value of Point has 3 number(s), but 2 are given', () => p.fill({ at: [1, 2] }));
      await refused('type', 'fill: NaN is no whole number, as int holds', () => n.fill(NaN));
      await refused('shape', 'copyTo: the source has shape [4, 4], the target [4, 5]', () => u.copyTo(device.stream('float', [4, 5])));
      await refused('type', 'copyTo: the source holds float, the target int', () => u.copyTo(n));
      await refused('type', 'the target is no stream', () => u.copyTo(new Float32Array(16)));
      const other = await Device.create();
      await refused('device', 'copyTo: the streams are of two devices', () => u.copyTo(other.stream('float', [4, 4])));
      other.dispose();
      u.dispose();
      await refused('lost', 'fill: the stream has been disposed of', () => u.fill(0));
    },

    async fits(device) {
      const [x, row, column, one] = [random(device, [24, 32], 5), random(device, [1, 32], 6), random(device, [24, 1], 7), random(device, [1, 1], 8)];
      const r = device.stream('float', [24, 32]);
      k.mixed(2, row, column, r);
      same('row and column', await r.read(), 2, 4);
      k.mixed(2, one, x, r);
      same('one', await r.read(), 2, 4);
      const [small, large, both] = [random(device, [6, 16], 9), random(device, [48, 96], 10), random(device, [12, 64], 11)];
      k.mixed(2, stretch(small), x, r);
      same('stretched', await r.read(), 2, 4);
      k.mixed(2, stride(large), x, r);
      same('strided', await r.read(), 2, 4);
      k.mixed(2, stretch(stride(both)), row, r.domain([0, 0], [24, 32]));
      same('both', await r.read(), 2, 4);
      const out = device.stream('float', [3, 5, 8]);
      k.mixed(2, random(device, [3, 1, 8], 12), stretch(random(device, [1, 5, 4], 13)), out);
      same('deep', await out.read(), 2, 4);
    },

    async gathers(device) {
      const [u, b, v] = [random(device, [20, 24], 14), random(device, [9], 15), random(device, [30, 40], 16)];
      k.smooth(u, b, v); // smaller than the domain
      same('small gathers', await v.read(), 8, 32);
      k.smooth(u.domain([2, 3], [18, 21]), stride(b, [2]), v.domain([1, 1], [17, 19]));
      same('views of gathers', await v.read(), 8, 32);
      k.smooth(random(device, [1, 3], 17), b, v);
      same('tiny gathers', await v.read(), 8, 32);
      const m = random(device, [80], 19);
      k.line(stride(random(device, [50], 18), [3], [1]), m);
      same('line', await m.read(), 8, 8);
      const t = random(device, [4, 4, 4], 21);
      k.space(random(device, [6, 5, 8], 20).domain([1, 0, 2], [5, 4, 7]), random(device, [4, 1, 4], 22), t);
      same('space', await t.read(), 8, 8);
    },

    async indices(device) {
      const [x, a] = [numbers(device, [12, 16], 23), numbers(device, [16, 12], 24)];
      const [r, s] = [device.stream('int4', [12, 16]), device.stream('float', [12, 16])];
      const ramp = { begin: [0, 0], end: [16, 3] };
      k.places(x.domain([2, 3], [8, 11]), a.domain([0, 2], [12, 12]), { begin: 0, end: 96 }, { begin: [0, 0], end: [16, 3] }, r.domain([1, 4], [7, 12]), s.domain([1, 4], [7, 12]));
      same('places r', await r.read());
      same('places s', await s.read(), 4, 2048);
      k.places(stretch(numbers(device, [3, 4], 25)), a, { begin: 0, end: 192 }, ramp, r, s);
      same('stretched places', await r.read());
      k.places(numbers(device, [1, 16], 26), a, { begin: 0, end: 192 }, ramp, r, s);
      same('repeated places', await r.read());
      const steps = device.stream('int', [12, 16]);
      k.loops(stride(x, [2, 2]), stride(steps, [2, 2], [1, 0]));
      same('loops', await steps.read());
      const [f, g, h] = [random(device, [7], 27), random(device, [9], 28), random(device, [9], 29)];
      k.chosen(true, f.domain([1], [6]), g.domain([4], [9]), h.domain([2], [7]));
      k.chosen(false, f.domain([0], [2]), null, h.domain([7], [9]));
      same('chosen', await h.read(), 4, 4);
    },

    async records_of_views(device) {
      const f = floats(360, 30);
      const [b, r, s] = [device.stream(k.Point, [10, 12]), device.stream(k.Point, [10, 12]), device.stream('float2', [10, 12])];
      b.write({ at: from(Float32Array, 240, (i) => f[(i >> 1) + (i & 1)]), kind: from(Int32Array, 120, (i) => i) });
      k.moved([1, 2], b.domain([1, 1], [5, 7]), r.domain([2, 0], [6, 6]), s.domain([2, 0], [6, 6]));
      same('moved r', points(await r.read()), 2, 4);
      same('moved s', await s.read());
      k.moved([1, 2], b.domain([1, 1], [5, 7]), b.domain([2, 0], [6, 6]), s.domain([0, 5], [4, 11]));
      same('moved in place', points(await b.read()), 2, 4);
      same('moved aside', await s.read());
      const [x, a, d] = [31, 33, 34].map((seed) => random(device, [10, 12], seed));
      const c = filled(device, 'float3', [10, 12], from(Float32Array, 360, (i) => f[Math.floor(i / 3) * ((i % 3) + 1)]));
      const [two, e] = [device.stream('float2', [10, 12]), device.stream('int', [10, 12])];
      k.passes(
        0.5, x.domain([2, 0], [8, 12]), c.domain([0, 0], [5, 6]), a.domain([1, 1], [6, 7]), two.domain([0, 0], [5, 6]),
        c.domain([5, 6], [10, 12]), d.domain([1, 1], [6, 7]), e.domain([1, 1], [6, 7]),
      );
      same('passes a', await a.read(), 16, 4); // five products of two roundings each
      same('passes b', await two.read(), 16, 4);
      same('passes c', await c.read(), 16, 4);
      same('passes d', await d.read(), 32, 8);
      same('passes e', await e.read(), 2 ** 23, 1); // a sum on either side of an integer
    },

    async stacks(device) {
      const shape = [16, 20];
      const f = from(Array, 18, (i) => random(device, shape, 40 + i));
      const [i, j, s, r] = [numbers(device, shape, 60), numbers(device, shape, 61), device.stream('int', shape), device.stream('float', shape)];
      const [l, m] = [floats(640, 62), floats(640, 62)].map((values) => filled(device, 'float2', shape, values));
      k.many(0.5, ...f.slice(0, 8), i, j, l, m, ...f.slice(8, 15), r, s);
      same('many r', await r.read(), 40, 128); // 19 products and sums below 128
      same('many s', await s.read());
      const [p, q] = [(stream) => stream.domain([1, 2], [9, 13]), (stream) => stream.domain([0, 0], [8, 11])];
      k.many(
        0.5, p(f[0]), q(f[1]), p(f[2]), q(f[3]), p(f[4]), q(f[5]), p(f[6]), p(f[7]), p(i), q(j), p(l), q(m), p(f[8]), p(f[9]), p(f[10]),
        p(f[11]), p(f[12]), random(device, [1, 11], 63), p(f[14]), p(r), p(s),
      );
      same('many views r', await r.read(), 40, 128);
      same('many views s', await s.read());
    },

    async values(device) {
      const [x, r] = [random(device, [5, 8], 64), device.stream('float2', [5, 8])];
      const [a, row] = [random(device, [1], 65), random(device, [8], 66)];
      const b = filled(device, 'float2', [1, 1], new Float32Array([3, 4]));
      const c = device.stream(k.Point, [2, 2]);
      c.write({ at: new Float32Array([1, 2, 4, 5, 7, 8, 10, 11]), kind: new Int32Array([3, 6, 9, 12]) });
      const n = numbers(device, [3], 67);
      const flips = filled(device, 'bool', [1], new Uint8Array([1]));
      const m = filled(device, 'float2x2', [1], new Float32Array([1, 2, 3, 4]));
      k.held(a, b, c.domain([1, 0], [2, 1]), n.domain([2], [3]), flips, m, x, r);
      same('held by streams', await r.read(), 8, 1024);
      k.held(row.domain([5], [6]), [1, 2], { at: [1, 2], kind: 3 }, n.domain([0], [1]), false, [1, 2, 3, 4], x, r);
      same('held by some', await r.read(), 8, 1024);
      const v = random(device, [5, 8], 68);
      k.mixed(row.domain([3], [4]), x.domain([0, 1], [5, 2]), x, v);
      same('held beside views', await v.read(), 2, 4);
      await refused('shape', "'a' is one value for all elements, but its stream has shape [8]", () => k.mixed(row, x, x, v));
      await refused('type', "'a' is declared as float, but its stream holds int", () => k.mixed(n.domain([0], [1]), x, x, v));
      await refused('type', 'streams do not stand for values of reduces', () => k.scaled(a, x));
    },

    async dials(device) {
      const [x, r] = [random(device, [64], 69), device.stream('float', [64])];
      const by = [1.5, 0.25];
      k.curve(0.75, by, x, r);
      same('single', await r.read(), 16, 4); // an exponential within 3 ulp
      k.curve.with({ precision: 'half' })(0.75, by, x, r);
      same('half', await r.read(), 2 ** 14, 4); // two halves' units
      k.steady.with({ precision: 'extended' })(0.75, by, x, r);
      same('extended', await r.read(), 0.51, 4); // rounded once, when it is stored
      k.curve.with({ intrinsics: 'fast' })(0.75, by, x, r);
      same('single', await r.read(), 64, 4);
      k.curve.with({ intrinsics: 'fast' }).with({ precision: 'half' })(0.75, by, x, r);
      same('half', await r.read(), 2 ** 14, 4);
      k.thirds(x, r);
      same('thirds', await r.read());
      const [i, j] = [numbers(device, [9], 70), device.stream('int', [9])];
      k.integers.with({ precision: 'half' })(i, j);
      same('integers', await j.read());
      await refused('compile', "layouts.sk.js has no programs for extended; write [[variants(extended)]] before 'thirds' in layouts.sk", () => k.thirds.with({ precision: 'extended' })(x, r));
      await refused('misuse', "there is no precision 'quad'; there are half, single, extended", () => k.curve.with({ precision: 'quad' })(1, by, x, r));
    },

    async layout_errors(device) {
      const [u, v] = [device.stream('float', [8, 8]), device.stream('float', [8, 12])];
      const box = u.domain([0, 0], [4, 4]);
      const declare = "write [[variants(views)]] before 'plain' in layouts.sk";
      await refused('compile', `where 'u' is a view; ${declare}`, () => k.plain(box, box, device.stream('float', [4, 4])));
      await refused('compile', `where 'x' repeats; ${declare}`, () => k.plain(u, device.stream('float', [1, 8]), u));
      await refused('compile', `where 'x' is fitted to the output; ${declare}`, () => k.plain(u, stretch(device.stream('float', [4, 8])), u));
      await refused('compile', `where a gather is smaller than the output, or nearly; ${declare}`, () => k.plain(device.stream('float', [4, 8]), u, u));
      await refused('shape', 'is no box inside shape [8, 8]', () => u.domain([0, 0], [9, 8]));
      await refused('shape', 'is no box inside shape [8, 8]', () => u.domain([0], [8]));
      await refused('shape', 'is no box inside shape [4, 4]', () => box.domain([0, NaN], [4, 4]));
      await refused('shape', 'do not go through shape [8, 8]', () => stride(u, [0, 1]));
      await refused('shape', 'do not go through shape [8, 8]', () => stride(u, [1, 1], [0, 9]));
      await refused('shape', "to stretch it, each of its extents must divide the domain's", () => k.mixed(1, stretch(device.stream('float', [3, 8])), u, u));
      await refused('shape', "each of its extents must be a multiple of the domain's", () => k.mixed(1, stride(v), u, u));
      await refused('shape', "or extent 1 where 'x' repeats", () => k.mixed(1, v, u, u));
      await refused('shape', 'give them the same shape, or extent 1', () => k.mixed(1, device.stream('float', [8]), u, u));
      await refused('shape', 'element(s) of float are 16 number(s), but the array has 15', () => box.write(new Float32Array(15)));
      await refused('type', "'u' is no input 'T x<>'", () => k.plain(stretch(u), u, u));
      await refused('type', "'x' is fitted, but only outputs say to what", () => k.squares(stretch(u)));
      const p = device.stream(k.Point, [4, 4]);
      const q = device.stream('float2', [4, 4]);
      k.moved([0, 0], p.domain([0, 0], [0, 4]), p.domain([0, 0], [0, 4]), q.domain([0, 0], [0, 4]));
      const halves = device.stream('float', [10, 12]);
      const five = (x) => [x.domain([0, 0], [5, 6]), x.domain([1, 5], [6, 11])];
      const [a, d] = five(halves);
      const [two, c, e] = ['float2', 'float3', 'int'].map((type) => device.stream(type, [5, 6]));
      await refused('misuse', "the outputs 'a' and 'd' overlap", () => k.passes(1, u, c, a, two, c, d, e));
      u.dispose();
      await refused('lost', 'has been disposed of', () => box.read());
      await refused('lost', 'has been disposed of', () => k.mixed(1, box, box, device.stream('float', [4, 4])));
      const other = await Device.create();
      await refused('device', 'streams of two devices', () => k.mixed(other.stream('float', [1]), v, v, v));
      other.dispose();
    },
  };
}
