// SPDX-License-Identifier: MIT
//
// Reductions to streams, sums of every kind, folded outputs and scans: the calls of reductions.cpp.
import { stride } from 'streamkernel';
import { folds as k, folds_Sums as Sums } from './reductions.sk.js';

/** The cases, given what calls.mjs has to make and compare streams. */
export function reductionCases({ random24, floats, integers, filled, random, size, from, same, refused, expect }) {
  // Floats of all magnitudes: sums of them cancel, and depend on the order wherever they are rounded.
  const wild = (count, seed) => floats(count, seed).map((value, i) => value * 2 ** ((random24(i, seed + 100) % 200) - 110));
  const bits = (values) => {
    const list = Float32Array.from(values);
    const words = new Uint32Array(list.buffer);
    return Array.from(list, (value, i) => (Number.isNaN(value) ? -1 : words[i]));
  };
  const exactly = { accumulate: 'exact' };
  const extended = { accumulate: 'extended' };
  const listOf = ({ moment, mass, farthest }, count) =>
    Array.from({ length: count }, (_, i) => [moment[2 * i], moment[2 * i + 1], mass[i], farthest[i]]).flat();

  return {
    async exactSums(device) {
      for (const n of [1, 7, 1000, 20011]) {
        const [x, y, z] = [filled(device, 'float', [n], wild(n, 40)), filled(device, 'float', [n], wild(n, 41)), random(device, [n], 42)];
        same(`exact ${n}`, bits([await k.sum.with(exactly)(x), await k.precisely(y)]));
        same(`exact dot ${n}`, bits([await k.dot.with(exactly)(z, y)]));
        // Native code sums in doubles, and pairs of floats have 47 bits: both round once, to one of two neighbours.
        same(`extended ${n}`, [await k.sum.with(extended)(z), await k.dot.with(extended)(z, z)], 1, n);
        const { moment, mass, farthest } = await k.gathered.with(exactly)(x, z);
        same(`exact struct ${n}`, bits([...moment, mass, farthest]));
      }
      const shape = [48, 36];
      const [x, z] = [filled(device, 'float', shape, wild(size(shape), 43)), random(device, shape, 44)];
      for (const result of [[48, 1], [1, 36], [12, 6], [1, 1]]) {
        const r = device.stream('float', result);
        k.sum.with(exactly)(x, r);
        same(`exact to ${result}`, bits(await r.read()));
        k.dot.with(exactly)(x, z, r);
        same(`exact dot to ${result}`, bits(await r.read()));
        k.sum.with(extended)(z, r);
        same(`extended to ${result}`, await r.read(), 1, 32);
        k.sum(z, r);
        same(`sum to ${result}`, await r.read(), 1, 32); // compensated: within one rounding of sums below 32
      }
      const ends = [[1, Infinity, 2], [Infinity, -Infinity], [-0, -0], [3e38, 3e38, -3e38], [1e-45, 1e-45, 2e-38], [3e38, 3e38, 3e38], [NaN, 1]];
      const found = [];
      for (const values of ends) found.push(await k.sum.with(exactly)(filled(device, 'float', [values.length], Float32Array.from(values))));
      same('exact ends', bits(found));
    },

    // Results in views are those in streams, and what lies around them stays.
    async viewedResults(device) {
      const equal = (what, found, wanted) => expect(what, String(found) === String(wanted), String(found));
      const x = filled(device, 'int', [12, 8], integers(Int32Array, 96, 60, 2001));
      const [rows, sums] = [device.stream('int', [12, 1]), device.stream('int', [14, 5])];
      k.count(x, rows);
      sums.fill(-1);
      k.count(x, sums.domain([1, 2], [13, 3]));
      const column = await rows.read();
      equal('a column of a stream', await sums.read(), from(Int32Array, 70, (i) => (i % 5 === 2 && i > 5 && i < 65 ? column[Math.floor(i / 5) - 1] : -1)));
      const [whole, wide] = [device.stream('int', [12, 8]), device.stream('int', [12, 16])];
      k.prefix(x, whole);
      k.prefix(x, stride(wide, [1, 2]));
      equal('a scan to every second column', await wide.read(), [...(await whole.read())].flatMap((n) => [n, 0]));
      const [next, part] = [device.stream('int', [12, 8]), device.stream('int', [20, 20])];
      const folded = await k.advance(x, next);
      equal('the fold beside a view', await k.advance(x, part.domain([3, 4], [15, 12])), folded);
      equal('an output in a view', await part.domain([3, 4], [15, 12]).read(), await next.read());
      equal('the rest', await k.count(part), await k.count(next));
      await refused('misuse', "'alive' and 'most' overlap: both write elements of one stream", () => k.advance(x, next, rows.domain([0, 0], [6, 1]), rows.domain([5, 0], [11, 1])));
      await refused('shape', 'give the output as many dimensions, or fewer', () => k.count(x, sums.domain([0, 0], [5, 1])));
    },

    async blocks(device) {
      const cases = [
        [[60, 48], [[60, 1], [1, 48], [48], [30, 24], [6, 8], [1, 1], [1], [60, 48]]],
        [[4, 5000], [[4, 1], [2, 1], [1, 50]]],
        [[7, 33], [[7], [1, 11]]],
        [[9000], [[10], [3000], [1]]],
        [[6, 8, 10], [[3, 4, 5], [6, 1, 1], [8, 10], [1, 1, 10]]],
        [[2, 3, 4, 50], [[2, 3, 4, 1], [1, 3, 1, 25], [2, 1, 4, 1]]],
      ];
      for (const [shape, results] of cases) {
        const x = filled(device, 'int', shape, integers(Int32Array, size(shape), 45, 2001));
        for (const result of results) {
          const name = `${shape} to ${result}`;
          const [r, s] = [device.stream('int', result), device.stream('int', result)];
          k.count(x, r);
          same(`count ${name}`, await r.read());
          k.last(x, r);
          same(`last ${name}`, await r.read());
          k.weighted(x, r, s);
          same(`weighted ${name}`, await r.read());
          same(`most ${name}`, await s.read());
        }
      }
      const x = filled(device, 'int', [24, 40], integers(Int32Array, 960, 46, 100));
      const table = filled(device, 'int', [16], integers(Int32Array, 16, 47, 100));
      const n = device.stream('int', [24, 1]);
      k.looked(3, true, table, x, n);
      same('looked', await n.read());
      const [a, b] = [random(device, [24, 40], 48), random(device, [24, 40], 49)];
      const s = device.stream(Sums, [6, 10]);
      k.gathered(a, b, s);
      same('gathered', listOf(await s.read(), 60), 1, 16);
      k.largest(x, x);
      same('same', await x.read());
      const zeros = filled(device, 'int', [1, 8], integers(Int32Array, 8, 50, 9));
      k.count(device.stream('int', [0, 8]), zeros);
      same('none', await zeros.read());

      const wide = device.stream('int', [8, 8]);
      const [r, other] = [device.stream('int', [8]), device.stream('int', [4])];
      await refused('shape', "'x' has shape [8, 8], and the output 'n' has [8], which could mean [8, 1] or [1, 8]", () => k.count(wide, r));
      await refused('shape', 'each extent a divisor', () => k.count(wide, device.stream('int', [3, 8])));
      await refused('shape', "the outputs 'all' and 'most' have shapes [8] and [4]", () => k.weighted(wide, r, other));
      await refused('misuse', "the outputs 'all' and 'most' are one stream", () => k.weighted(wide, r, r));
      await refused('type', "'n' is declared as int, but its stream holds float", () => k.count(wide, device.stream('float', [8, 1])));
      await refused('misuse', "'n' is null; give a stream, or leave all results out", () => k.count(wide, null));
      await refused('misuse', '2 arguments are given, but 1 are taken, or 3 with streams for the results', () => k.weighted(wide, r));
      await refused('shape', "'r' declares no identity", () => k.last(device.stream('int', [0, 8]), device.stream('int', [1, 8])));
      await refused('shape', "'r' declares no identity", () => k.last(device.stream('int', [0])));
      await refused('misuse', "it has no sum of floats to add exactly; call it without 'exact'", () => k.count.with(exactly)(wide));
      await refused('misuse', "'exakt' is no way to accumulate", () => k.sum.with({ accumulate: 'exakt' })(a));
      await refused('misuse', "it is not a scan; call it without 'scan'", () => k.sum.with({ scan: 'exclusive' })(a));
    },

    async folded(device) {
      for (const w of [64, 61]) {
        const shape = [48, w];
        const [p, q, x, r] = [51, 52, 53, 54].map((seed) => random(device, shape, seed));
        const [rr, rows] = [device.stream('float', [1]), device.stream('float', [48, 1])];
        if (w === 64) {
          const value = await k.descend(0.5, p, q, x, r, x, r);
          same(`descend ${w}`, [value], 4, 2048); // squares whose terms the driver may contract
        } else {
          k.descend(0.5, p, q, x, r, x, r, rr);
          same(`descend ${w}`, await rr.read(), 4, 2048);
        }
        k.descend(0.25, p, q, x, r, x, r, rows);
        same(`descend rows ${w}`, await rows.read(), 4, 64);
        same(`descend x ${w}`, await x.read(), 4);
        same(`descend r ${w}`, await r.read(), 4);
        const cells = filled(device, 'int', shape, integers(Int32Array, 48 * w, 55, 7));
        same(`advance ${w}`, await k.advance(cells, cells));
        const [alive, most] = [device.stream('int', [48, 1]), device.stream('int', [48, 1])];
        k.advance(cells, cells, alive, most);
        same(`advance rows ${w}`, await alive.read());
        same(`advance most ${w}`, await most.read());
        same(`advance cells ${w}`, await cells.read());
      }
      const r = device.stream('int', [10, 12]);
      const total = await k.ramped({ begin: 0, end: 120 }, r);
      same('ramped', [total, (await r.read())[119]]);
      const cells = device.stream('int', [4, 4]);
      await refused('misuse', "the outputs 'next' and 'alive' are one stream", () => k.advance(cells, cells, cells, device.stream('int', [4, 4])));
      await refused('shape', "'next' has shape [4, 4], and the output 'alive' has [3, 1]", () =>
        k.advance(cells, cells, device.stream('int', [3, 1]), device.stream('int', [3, 1])));
    },

    async scans(device) {
      for (const shape of [[1], [7], [1000], [20011], [37, 29], [64, 48], [5, 7, 36], [3, 2, 4, 20]]) {
        const x = filled(device, 'int', shape, integers(Int32Array, size(shape), 56, 201));
        const s = device.stream('int', shape);
        for (let along = -1; along < shape.length; ++along) {
          const name = `${shape} along ${along}`;
          const dimension = along < 0 ? {} : { along };
          k.prefix.with(dimension)(x, s);
          same(`prefix ${name}`, await s.read());
          k.prefix.with(dimension).with({ scan: 'exclusive' })(x, s);
          same(`before ${name}`, await s.read());
          k.highest.with(dimension)(x, s);
          same(`highest ${name}`, await s.read());
          k.located.with(dimension)(x, s);
          same(`located ${name}`, await s.read());
        }
      }
      const [x, r] = [filled(device, 'float', [3000], wild(3000, 57)), device.stream('float', [3000])];
      const [z, t] = [random(device, [50, 60], 58), device.stream('float', [50, 60])];
      k.running.with(exactly)(x, r);
      same('running exact', bits(await r.read()));
      k.running.with({ ...exactly, along: 1, scan: 'exclusive' })(z, t);
      same('running exact along', bits(await t.read()));
      k.running(z, t);
      same('running', await t.read(), 1, 64); // compensated: within one rounding of sums below 64
      k.running.with(extended)(z, z);
      same('running extended', await z.read(), 1, 64);
      k.prefix(device.stream('int', [0, 4]), device.stream('int', [0, 4]));

      const wide = device.stream('int', [4, 8]);
      await refused('shape', 'a scan has one result for each element, so give them the same shape', () => k.prefix(wide, device.stream('int', [4, 1])));
      await refused('shape', 'which has no dimension 2; along is 0 to 1', () => k.prefix.with({ along: 2 })(wide, wide));
      await refused('misuse', "an exclusive scan starts with the identity, and 's' declares none", () => k.latest.with({ scan: 'exclusive' })(wide, wide));
      await refused('misuse', "'backward' is no kind of scan", () => k.prefix.with({ scan: 'backward' })(wide, wide));
      await refused('misuse', '1 arguments are given, but 2 are taken', () => k.prefix(wide));
    },

    async compiledReductions(device) {
      await device.compile([k.sum.with(exactly), k.advance, k.prefix]);
    },
  };
}
