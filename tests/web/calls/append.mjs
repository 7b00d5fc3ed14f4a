// SPDX-License-Identifier: MIT
//
// Kernels that push and that scatter.
import { Device } from 'streamkernel';
import * as k from './calls.sk.js';

export const appendCases = ({ same, refused, filled, random, random24, floats, integers, from, expect }) => ({
  async pushes(device) {
    for (const n of [1, 7, 256, 1000, 100003]) {
      const [x, r] = [random(device, [n], 40), device.stream('float', [3])];
      await k.positive(x, r);
      same(`positive ${n}`, await r.read());
      expect('the shape is the number of elements', r.shape.length === 1 && r.shape[0] === r.size && (await r.read()).length === r.size);
    }
    for (const [shape, most] of [[[500], 9], [[20, 25], 3], [[5, 10, 10], 0]]) {
      const x = filled(device, 'int', shape, integers(Int32Array, 500, 41, 6));
      const [twice, odd, even] = [device.stream('int', shape), device.stream('int', [0]), device.stream(k.Spot, [10000])];
      await k.sieve(most, x, twice, odd, even);
      same(`sieve twice ${most}`, await twice.read());
      same(`sieve odd ${most}`, await odd.read());
      const { at, heat } = await even.read();
      same(`sieve even ${most}`, from(Array, even.size, (i) => [at[2 * i], at[2 * i + 1], heat[i]]).flat());
    }
    const [a, at] = [random(device, [37, 52], 42), device.stream('int3', [1])];
    await k.corners(a, a, { begin: 0, end: 37 * 52 * 2 }, at);
    same('corners', await at.read());
  },

  // Results feed later calls, and streams change while the device counts.
  async orders(device) {
    const x = random(device, [1000], 43);
    await k.positive(x, x);
    same('positive of itself', await x.read());
    const r = device.stream('float', [x.size]);
    k.saxpy(1, x, x, r);
    same('twice what is pushed', await r.read());
    same('sum of what is pushed', [await k.sum(x)], 8, 500);

    const [u, v, w] = [random(device, [1000], 43), device.stream('float', [0]), device.stream('float', [0])];
    const [first, second] = [k.positive(u, v), k.positive(u, w)];
    await refused('misuse', 'await the promise of that call first', () => v.read());
    await refused('misuse', 'await the promise of that call first', () => k.saxpy(1, v, v, v));
    await refused('misuse', 'await the promise of that call first', () => k.positive(u, v));
    k.saxpy(-1, u, u, u); // 0
    u.write(new Float32Array(1000).fill(-1));
    k.permute(filled(device, 'int', [1], new Int32Array([3])), filled(device, 'float', [1], new Float32Array([5])), u);
    await Promise.all([first, second]);
    same('positive of itself', await v.read());
    same('positive of itself', await w.read());
    const changed = await u.read();
    expect('a stream that a call holds takes other elements', changed[3] === 5 && changed[2] === -1 && changed[999] === -1, String(changed));

    // A scatter to a stream that another call is yet to read keeps the other elements.
    const third = k.positive(u, v);
    k.permute(filled(device, 'int', [1], new Int32Array([4])), filled(device, 'float', [1], new Float32Array([6])), u);
    await third;
    expect('one was positive', String(await v.read()) === '5', String(await v.read()));
    await k.positive(u, v);
    expect('two are positive', String(await v.read()) === '5,6', String(await v.read()));
    const gone = k.positive(u, w);
    w.dispose();
    await gone;
    for (let i = 0; i < 40; ++i) await k.positive(filled(device, 'float', [i], new Float32Array(i).fill(1)), v);
    expect('the last of many', v.size === 39, String(v.size));
  },

  async scatters(device) {
    const n = 3000;
    const to = filled(device, 'int', [n], integers(Int32Array, n, 44, 2000));
    const r = filled(device, 'float', [1500], floats(1500, 45));
    k.permute(to, random(device, [n], 46), r); // some targets are out of bounds, and some are hit several times
    same('permute', await r.read());
    const spots = device.stream(k.Spot, [40]);
    spots.write({ at: floats(80, 47), heat: floats(40, 48) });
    const places = device.stream(k.Spot, [6, 7]);
    k.place(filled(device, 'int', [40], integers(Int32Array, 40, 49, 45)), spots, places);
    const { at, heat } = await places.read();
    same('place', from(Array, 42, (i) => [at[2 * i], at[2 * i + 1], heat[i]]).flat());

    const many = 100000; // more than one draw of sums
    const x = filled(device, 'int', [100, 1000], integers(Int32Array, many, 50, 1000));
    const w = random(device, [100, 1000], 51);
    const counts = filled(device, 'int', [16], new Int32Array(16).fill(-7));
    const total = device.stream('float', [16]);
    const [most, least] = [filled(device, 'uint', [12], new Uint32Array(12).fill(3999999999)), filled(device, 'int2', [16], new Int32Array(32).fill(5))];
    k.histogram(x, w, counts, total, most, least);
    same('histogram n', await counts.read());
    same('histogram total', await total.read(), 64, 100);
    same('histogram most', await most.read());
    same('histogram least', await least.read());
  },

  async splats(device) {
    const points = filled(device, 'float2', [300], from(Float32Array, 600, (i) => random24(i, 52) % 30));
    const image = random(device, [30, 30], 53);
    for (const radius of [1, 2]) {
      const [sum, peak] = [filled(device, 'float', [30, 30], floats(900, 54)), device.stream('float', [2, 25, 25])];
      await k.splat(radius, points, image, sum, peak);
      same(`splat sum ${radius}`, await sum.read(), 64, 8);
      same(`splat peak ${radius}`, await peak.read());
    }
    const both = random(device, [30, 30], 53);
    await k.splat(1, points, both, both, device.stream('float', [2, 25, 25]));
    same('splat of itself', await both.read(), 64, 8);
  },

  async emptiness(device) {
    const [nothing, r] = [device.stream('float', [0]), device.stream('float', [5])];
    await k.positive(nothing, r);
    expect('nothing is pushed of nothing', r.size === 0 && (await r.read()).length === 0);
    await k.positive(filled(device, 'float', [100], new Float32Array(100).fill(-1)), r);
    expect('nothing is pushed', r.size === 0 && r.shape[0] === 0);
    const target = filled(device, 'float', [4], new Float32Array(4).fill(2));
    k.permute(device.stream('int', [0]), nothing, target);
    k.permute(filled(device, 'int', [3], new Int32Array([-1, 4, 2147483647])), random(device, [3], 1), target);
    expect('nothing is scattered', String(await target.read()) === '2,2,2,2');
    k.permute(filled(device, 'int', [2], new Int32Array(2)), random(device, [2], 1), nothing);

    const [u, v] = [random(device, [8, 8], 1), device.stream('float', [8, 8])];
    await refused('shape', "'r' is a variable output, but its stream has shape [8, 8]; give it one of one dimension", () => k.positive(u, v));
    await refused('shape', "'r' is declared with 1 dimension(s)", () => k.permute(device.stream('int', [8, 8]), u, v));
    await refused('shape', "'x' has shape [8, 8], but 'to' has [64]", () => k.permute(device.stream('int', [64]), u, device.stream('float', [3])));
    const ints = device.stream('int', [4]);
    await refused('misuse', "the outputs 'twice' and 'odd' are one stream", () => k.sieve(1, device.stream('int', [4]), ints, ints, device.stream(k.Spot, [4])));
  },

  // Domains that no stream has, of kernels and of reduces.
  async domains(device) {
    const near = (x) => Math.abs(x - Math.PI) < 1e-6; // terms within 2 ulp of 4, whose sum is compensated
    expect('to a value', near(await k.quarters.over(device, [10000])(10000)));
    const exact = k.quarters.with({ accumulate: 'exact' });
    expect('options before and after', (await exact.over(device, [10000])(10000)) === (await k.quarters.over(device, [10000]).with({ accumulate: 'exact' })(10000)));
    const area = device.stream('float', [1]);
    k.quarters.over([10000])(10000, area);
    expect('to a stream', near((await area.read())[0]));
    for (const [shape, most] of [[[7], [706, 100, 100, 100]], [[60, 50], [5049, 6059, 100, 100]], [[3, 4, 5], [504, 403, 302, 100]]]) {
      expect(`places of ${shape}`, String(await k.farthest.over(device, shape)()) === String(most));
    }
    const rows = device.stream('int4', [60, 1]);
    k.farthest.over([60, 50])(rows);
    expect('of each row', (await rows.read())[4 * 7 + 1] === 6007);
    expect('of an iterator', (await k.rampOver.over(device, [10, 10])({ begin: 0, end: 100 })) === 4950);
    const s = device.stream('int', [20, 30]);
    k.triangles.over([20, 30])(s);
    expect('of a scan', (await s.read())[599] === 20 * 465);

    const p = device.stream('int2', [0]);
    await k.wedge.over([2, 3])(p);
    expect('pushed', String(await p.read()) === '1,0,2,0,2,0,1,1,2,1,2,1');
    const bins = filled(device, 'int', [8], new Int32Array(8).fill(9));
    k.dealt.over([2, 3])(bins);
    expect('scattered', String(await bins.read()) === '0,0,0,1,1,1,9,9');
    await k.filledUp(filled(device, 'int', [2], new Int32Array([1, 2])), bins);
    expect('as often as the output is long', String(await bins.read()) === '3,3,3,4,4,4,12,12');
    const r = device.stream('int', [3]);
    k.numbered.over([3])(r);
    k.numbered.over([3])(r);
    expect('the same as an output', String(await r.read()) === '0,1,2');
    await k.wedge.over([0, 4])(p);
    expect('an empty domain', p.size === 0 && (await k.quarters.over(device, [0])(1)) === 0);

    const other = await Device.create();
    const table = [
      ['shape', 'call it over a shape, dealt.over([...])(...)', () => k.dealt(bins)],
      ['shape', 'call it over a shape, quarters.over([...])(...)', () => k.quarters(4, area)],
      ['misuse', 'quarters.over(device, [...])(...)', () => k.quarters.over([4])(4)],
      ['shape', "over() gives the domain the shape [4], but 'r' has [3]", () => k.numbered.over([4])(r)],
      ['shape', 'over() gives the domain the shape [2]', () => k.triangles.over([2])(s)],
      ['device', 'give both one device', () => k.dealt.over(other, [4])(bins)],
      ['shape', 'divide it into several streams', () => k.quarters.over(device, [100000, 100000])(4)],
      ...[[], [1, 2, 3, 4, 5], [-1], [1.5], [NaN], ['4']].map((shape) => ['shape', 'is no shape', () => k.dealt.over(shape)]),
      ...[[], [4], [null], [device], [[4], [4]], [device, 4]].map((given) => ['type', 'over() takes a shape', () => k.dealt.over(...given)]),
    ];
    for (const [kind, text, call] of table) await refused(kind, text, call);
    other.dispose();
    await refused('lost', '', () => k.quarters.over(other, [4])(4));
  },

  // Without blending of floats, plain stores are left.
  async unblended() {
    const context = document.createElement('canvas').getContext('webgl2');
    const get = context.getExtension.bind(context);
    context.getExtension = (name) => (name === 'EXT_float_blend' ? null : get(name));
    const device = await Device.create({ context });
    expect('it says so', !device.info().combinesScattered);
    const r = filled(device, 'float', [1500], floats(1500, 45));
    k.permute(filled(device, 'int', [3000], integers(Int32Array, 3000, 44, 2000)), random(device, [3000], 46), r);
    same('permute', await r.read());
    const [x, w] = [device.stream('int', [4]), device.stream('float', [4])];
    const outputs = ['int', 'float', 'uint', 'int2'].map((type) => device.stream(type, [16]));
    await refused('device', 'does not blend 32-bit floats (EXT_float_blend)', () => k.histogram(x, w, ...outputs));
  },
});
