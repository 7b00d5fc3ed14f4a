// SPDX-License-Identifier: MIT
//
// What the types of calls.sk.d.ts allow, and what they reject: tsc reads this, and nothing runs it.
import { Device, stretch, stride, type View } from 'streamkernel';
import { Body, around, count, diffuse, field, heaviest, longSum, move, positive, quarters, shaded, sum, wedge, type Scene } from './calls.sk.js';
import { folds } from './reductions.sk.js';
import { curve, held, mixed, Point, smooth, squares } from './layouts.sk.js';

export async function allowed(device: Device): Promise<number> {
  const u = device.stream('float', [512, 512]);
  u.write(new Float32Array(512 * 512));
  diffuse(0.2, u, u);
  const host: Float32Array = await u.read();
  const bodies = device.stream(Body, [100]);
  const { spot, kind } = await bodies.read();
  const heats: Float32Array = spot.heat;
  const kinds: Int32Array = kind;
  move({ at: [1, 2], heat: 3 }, bodies, bodies);
  const hottest: number = (await heaviest(bodies)).heat;
  const pushed = device.stream('float', [0]);
  const counted: Promise<void> = positive(u, pushed);
  await counted;
  const many: number = pushed.shape[0];
  field.scale([1, 2], device.stream('float2', [4]), device.stream('float2', [4]));
  const scene: Scene = { color: device.stream('float', [4]), doubled: true, weights: [[0, 1], [2, 3]] };
  shaded(device.stream('int', [512, 512]), { ...scene, ground: { height: u, level: device.stream('float', [1]) } }, u);
  around(u, u);
  around(device.stream('float', [4]), device.stream('float', [4]));
  const rows = device.stream('float', [512, 1]);
  sum(u, rows);
  sum.with({ accumulate: 'exact' })(u, rows);
  const cells = device.stream('int', [8, 8]);
  const [alive, most]: readonly [number, number] = await folds.advance(cells, cells);
  folds.advance(cells, cells, device.stream('int', [8, 1]), device.stream('int', [8, 1]));
  const [total]: readonly number[] = await folds.weighted(cells);
  folds.prefix.with({ scan: 'exclusive', along: 0 })(cells, cells);
  void [alive, most, total];
  const longs = device.stream('long', [4]);
  longs.fill(5n);
  const words: BigInt64Array = await longs.read();
  const sumOfLongs: bigint = await longSum(longs);
  void [words, sumOfLongs];
  const wedged: Promise<void> = wedge.over([4, 4])(device.stream('int2', [0]));
  await wedged;
  const area: number = await quarters.over(device, [100]).with({ accumulate: 'exact' })(100);
  quarters.with({ accumulate: 'tree' }).over([100])(100, device.stream('float', [1]));
  void area;
  u.fill(1);
  bodies.domain([0], [5]).fill({ spot: { at: [1, 2], heat: 3 }, kind: 4, color: [0, 0, 1] });
  u.domain([0, 0], [1, 512]).copyTo(u.domain([1, 0], [2, 512]));
  return (await sum.with({ accumulate: 'tree' })(u)) + host[0]! + heats[0]! + kinds[0]! + many + hottest;
}

export async function rejected(device: Device): Promise<void> {
  const u = device.stream('float', [512, 512]);
  const line = device.stream('float', [512]);
  const ints = device.stream('int', [512, 512]);
  // @ts-expect-error: a vector for a number
  u.fill([1, 2]);
  // @ts-expect-error: numbers are no integers of 64 bits
  device.stream('long', [4]).fill(0.5);
  // @ts-expect-error: another type of elements
  u.copyTo(ints);
  // @ts-expect-error: another rank
  u.copyTo(line);
  // @ts-expect-error: a shape is an array
  wedge.over(4);
  // @ts-expect-error: of at most four dimensions
  wedge.over([1, 2, 3, 4, 5]);
  // @ts-expect-error: the gather has two dimensions
  diffuse(0.2, line, u);
  // @ts-expect-error: of floats
  diffuse(0.2, ints, u);
  // @ts-expect-error: k is a number
  diffuse('0.2', u, u);
  // @ts-expect-error: v is missing
  diffuse(0.2, u);
  // @ts-expect-error: a stream of floats takes no ints
  u.write(new Int32Array(1));
  // @ts-expect-error: the total is a number
  const text: string = await count(ints);
  // @ts-expect-error: pushed elements have one dimension
  await positive(u, u);
  // @ts-expect-error: totals are floats
  sum(u, ints);
  // @ts-expect-error: two accumulators need two streams
  folds.weighted(ints, ints);
  // @ts-expect-error: there is no such sum
  sum.with({ accumulate: 'exakt' });
  // @ts-expect-error: a reduce is no scan
  sum.with({ along: 0 });
  // @ts-expect-error: a scan needs a stream for its results
  folds.prefix(ints);
  // @ts-expect-error: there is no such type
  device.stream('flaot', [1]);
  void text;
}

export async function layouts(device: Device): Promise<number> {
  const u = device.stream('float', [8, 8]);
  const box: View<'float', 2> = u.domain([0, 0], [4, 4]);
  const odd: View<'float', 2> = stride(box, [2, 2], [1, 1]);
  const host: Float32Array = await odd.read();
  mixed(1, stretch(u), stride(stretch(box)), u.domain([1, 1], [2, 2]));
  mixed(device.stream('float', [1]), u, box, odd);
  const point = device.stream(Point, [1]);
  held(1, [1, 2], point, 3, device.stream('bool', [1]), [1, 2, 3, 4], u, device.stream('float2', [8, 8]));
  curve.with({ precision: 'half', intrinsics: 'fast' })(1, [1, 2], u, u);
  // @ts-expect-error: a position for each dimension
  u.domain([0], [4]);
  // @ts-expect-error: a view of floats takes no ints
  box.write(new Int32Array(16));
  // @ts-expect-error: the gather has two dimensions
  smooth(device.stream('float', [8]).domain([0], [4]), device.stream('float', [8]), u);
  // @ts-expect-error: only inputs are fitted
  smooth(stretch(u), device.stream('float', [8]), u);
  // @ts-expect-error: an output is not fitted
  mixed(1, u, u, stretch(u));
  // @ts-expect-error: k is a float, not an int
  mixed(device.stream('int', [1]), u, u, u);
  // @ts-expect-error: there is no such precision
  curve.with({ precision: 'quad' });
  // @ts-expect-error: kernels accumulate nothing
  curve.with({ accumulate: 'tree' });
  return (await squares(odd)) + host[0]!;
}
