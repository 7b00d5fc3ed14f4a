// SPDX-License-Identifier: MIT
//
// What a shadow concludes from numbers: errors, whose they are, verdicts, and the report of them.
import assert from 'node:assert/strict';
import { test } from 'node:test';

const load = (name) => import(`${process.env.SK_WEB}/streamkernel/shadow/${name}.js`);
const [{ compare, isJump }, { Records }, { Series, Spread }, { Shares, writtenByHost }, { growthOf, verdictsOf }, { hexOf, reportOf }, { tableOf }, { checkedOptions, matchesAny }] =
  await Promise.all(['errors', 'records', 'series', 'shares', 'verdicts', 'report', 'table', 'shadow'].map(load));

const columns = (...all) => all.map((one) => Float64Array.from(one));
const close = (a, b) => assert.ok(Math.abs(a - b) <= 1e-12 * Math.abs(b), `${a}, not ${b}`);

test('own, inherited and total errors are relative to the reference', () => {
  const errors = compare([true, true], columns([1.5, 2], [3, 4]), columns([1, 2], [3, 4.5]), columns([1, 1], [2, 4]));
  const scale = Math.sqrt(1 + 1 + 4 + 16);
  close(errors.relativeOwn(), Math.sqrt(0.25 + 0.25) / scale);
  close(errors.relativeInherited(), Math.sqrt(1 + 1 + 0.25) / scale);
  close(errors.relativeTotal(), Math.sqrt(0.25 + 1 + 1) / scale);
  close(errors.ownShare(), (0.5 * 0.5 - 0.5 * 0) / 2.25);
  assert.deepEqual({ ...errors.own }, { error: 0.5, element: 0, component: 0 });
  assert.equal(compare([true], columns([1]), null, columns([0])).relativeTotal(), 1, 'where the reference is 0, nothing is right');
  assert.equal(compare([true], columns([1]), null, columns([1])).relativeTotal(), 0);
});

test('values that are not finite are counted, and not summed', () => {
  const errors = compare([true], columns([NaN, Infinity, 1, NaN]), columns([1, 1, NaN, NaN]), columns([1, 1, 1, 1]));
  assert.deepEqual([errors.nans.count, errors.newNans.count, errors.newNans.first, errors.infinities.count, errors.newInfinities.first, errors.reals], [2, 1, 0, 1, 1, 0]);
});

test('integers that differ are decisions', () => {
  const errors = compare([false], columns([1, 2, 3, 5]), columns([1, 2, 4, 5]), columns([1, 0, 4, 5]));
  assert.deepEqual([errors.ownDecisions.count, errors.ownDecisions.first, errors.decisions.count, errors.decisions.first], [1, 2, 2, 1]);
  close(errors.relativeIntegers(), Math.sqrt((4 + 1) / (1 + 16 + 25)));
});

test('one element that is far off in an output that is right elsewhere is a jump', () => {
  const o = Array.from({ length: 100 }, (_, i) => 1 + i / 100);
  const errors = (at, by) => compare([true], columns(o.map((x, i) => (i === at ? x + by : x * (1 + 1e-8)))), columns(o), columns(o));
  assert.ok(isJump(errors(7, 0.5), o[7]));
  assert.ok(!isJump(errors(7, 1e-5), o[7]));
});

test('shares add up to 1 without those that are next to nothing', () => {
  const shares = new Shares();
  const others = new Shares();
  others.add(0, 1);
  others.add(writtenByHost, 3);
  shares.add(1, 2);
  shares.add(2, 1e-12);
  shares.add(3, -1);
  shares.addAll(others, 0.5);
  shares.normalize();
  assert.deepEqual(shares.entries().map(([kernel, share]) => [kernel, Number(share.toFixed(9))]), [[1, 0.5], [0, 0.125], [-1, 0.375]]);
});

test('points of a series are thinned out, and keep the largest errors', () => {
  const series = new Series();
  for (let call = 1; call <= 5000; ++call) series.add({ call, own: call === 3210 ? 9 : 1, inherited: 0, total: 1, absolute: 1 });
  assert.ok(series.points.length <= 1024 && series.points.length >= 512);
  assert.equal(Math.max(...series.points.map(({ own }) => own)), 9);
  assert.equal(series.points[series.points.length - 1].call, 5000);
  const spread = new Spread();
  for (const error of [0, 1e-8, 1e-4, Infinity]) spread.add(error);
  close(spread.typical, 1e-6);
});

test('an error that grows exponentially is told from one that adds up', () => {
  const series = (of) => {
    const all = new Series();
    for (let call = 1; call <= 60; ++call) all.add({ call, own: 0, inherited: 0, total: 1e-9, absolute: of(call) });
    return all;
  };
  close(growthOf(series((n) => 1e-8 * 1.5 ** n)), 1.5);
  assert.equal(growthOf(series((n) => 1e-8 * n)), 1);
  assert.equal(growthOf(series(() => 1e-8)), 1);
});

/** Records of a page with two kernels and a result whose error is mostly the second one's. */
function records(error = 1e-3) {
  const all = new Records();
  all.calls = all.followed = 4;
  for (const name of ['right', 'wrong']) all.kernel(name);
  const result = all.result('u', false);
  Object.assign(result, { reads: 1, elements: 8, largest: error, last: error });
  result.shares.add(0, 0.25);
  result.shares.add(1, 0.75);
  return all;
}
const element = (device, reference) => ({ call: 3, output: 'r', index: [2, 5], device: { value: device, isReal: true }, reference: { value: reference, isReal: true }, inputs: [] });
const kinds = (all) => verdictsOf(all).map(({ kind, kernel }) => `${kind} ${kernel}`.trim());

test('verdicts name the kernel to blame, the gravest first', () => {
  assert.deepEqual(kinds(records()), ['error wrong']);
  assert.equal(verdictsOf(records())[0].text, "wrong adds 75 % of the error of what the page reads: 3.0 digits of 'u' survive");
  assert.deepEqual(kinds(records(1e-7)), ['fine']);
  const all = records();
  all.decisions.push({ kernel: 0, elements: 1, isInherited: false, first: element(1, 2) }, { kernel: 1, elements: 1, isInherited: true, first: element(1, 2) });
  all.exceptions.push({ kind: 'nan', kernel: 1, elements: 2, isInReference: false, first: element(NaN, 0.5), path: [] });
  assert.deepEqual(kinds(all), ['nan wrong', 'decision right', 'error wrong']);
  assert.equal(verdictsOf(all)[0].text, 'wrong computes the first NaN in call 3, at r[2][5], where pairs of floats give 0.5');
  all.results[0].largest = 5e-5; // no worse than rounding may make it: a decision is no more than a remark
  assert.deepEqual(kinds(all), ['nan wrong', 'error wrong', 'decision right']);
});

test('a page without calls, comparisons or results is told so', () => {
  const all = new Records();
  assert.match(verdictsOf(all)[0].text, /called no kernel/);
  all.calls = 1;
  assert.match(verdictsOf(all)[0].text, /no call was compared/);
  all.followed = 1;
  assert.match(verdictsOf(all)[0].text, /read no result/);
});

test('a report has no number that JSON has not', () => {
  const all = records(Infinity);
  all.kernels[1].worst = element(NaN, -Infinity);
  all.note('so');
  all.note('so');
  const report = reportOf(all, { program: 'page', device: 'd', hasEnded: false, every: 2, kernels: ['*'], seconds: 1 });
  assert.deepEqual(JSON.parse(JSON.stringify(report)), report);
  assert.deepEqual(report.kernels[1].worst.device, { value: 'nan', hex: 'nan' });
  assert.deepEqual(report.results[0].error, { largest: 'inf', last: 'inf' });
  assert.equal(report.ended, 'early: the page had not ended after 4 calls');
  assert.deepEqual(report.notes, ['so']);
  assert.deepEqual([-1.5, 0.1, 2 ** -1074, -0, 1e300].map(hexOf), ['-0x1.8p+0', '0x1.999999999999ap-4', '0x0.0000000000001p-1022', '-0x0p+0', '0x1.7e43c8800759cp+996']);
  const table = tableOf(report).split('\n');
  assert.match(table[2], /^kernel +calls +own/);
  assert.match(table[3], /^wrong +0 .* 75 %$/);
});

test('options are checked, and patterns match', () => {
  assert.deepEqual(checkedOptions({}), { every: 1, kernels: ['*'] });
  assert.throws(() => checkedOptions({ every: -1 }), { name: 'SkError', kind: 'misuse', message: /^shadow: every: -1 is no number of calls/ });
  assert.throws(() => checkedOptions({ evry: 1 }), /there is no option 'evry'; there are 'every' and 'kernels'/);
  assert.ok(matchesAny(['x', 'heat::*'], 'heat::diffuse') && matchesAny(['*'], 'a') && matchesAny(['a.c'], 'a.c'));
  assert.ok(!matchesAny(['heat'], 'heat::diffuse') && !matchesAny(['a.c'], 'abc'));
});
