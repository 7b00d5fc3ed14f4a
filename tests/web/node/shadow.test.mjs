// SPDX-License-Identifier: MIT
//
// What a shadow concludes from numbers: errors, whose they are, verdicts, and the report of them.
import assert from 'node:assert/strict';
import { test } from 'node:test';

const load = (name) => import(`${process.env.SK_WEB}/streamkernel/shadow/${name}.js`);
const [{ compare, isJump }, { Records }, { Series, Spread }, { Shares, writtenByHost }, { verdictsOf }, { hexOf, reportOf }, { tableOf }, { checkedOptions, matchesAny }, { CallRecorder, haveOtherSigns }, { sampleOf }] =
  await Promise.all(['errors', 'records', 'series', 'shares', 'verdicts', 'report', 'table', 'shadow', 'record_call', 'columns'].map(load));

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

test('no digit is right of numbers that are lost, whoever has lost them', () => {
  const own = compare([true], columns([1, Infinity, NaN]), columns([1, 2, NaN]), columns([1, 2, 3]));
  assert.deepEqual([own.lost, own.relativeTotal(), own.reportedTotal(), own.reportedOwn(), own.ownShare()], [2, 0, Infinity, Infinity, 1]);
  const inherited = compare([true], columns([1.5, NaN]), columns([1, NaN]), columns([1, 2]));
  assert.deepEqual([inherited.lost, inherited.reportedTotal(), inherited.reportedOwn(), inherited.ownShare()], [1, Infinity, 0.5, 1]);
  const meant = compare([true], columns([1, -Infinity]), columns([1, -Infinity]), columns([1, -Infinity]));
  assert.deepEqual([meant.lost, meant.reportedTotal(), meant.reportedOwn(), meant.ownShare()], [0, 0, 0, 0]);
  const all = compare([true], columns([Infinity, Infinity]), columns([2, 3]), columns([2, 3]));
  assert.deepEqual([all.reals, all.absoluteTotal(), all.reportedTotal()], [0, 0, Infinity]);
});

test('errors of numbers below the smallest normal float are relative to that', () => {
  const least = 2 ** -126;
  close(compare([true], columns([0, 0]), null, columns([least / 8, least / 8])).relativeTotal(), 1 / 8);
  close(compare([true], columns([0, 0]), null, columns([8 * least, 8 * least])).relativeTotal(), 1);
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
  for (let call = 1; call <= 5000; ++call) series.add({ call, own: call === 3210 ? 9 : 1, inherited: 0, total: 1, absolute: 1, isTurned: call === 1234 });
  assert.ok(series.points.length <= 1024 && series.points.length >= 512);
  assert.equal(Math.max(...series.points.map(({ own }) => own)), 9);
  assert.equal(series.points[series.points.length - 1].call, 5000);
  assert.equal(series.points.filter(({ isTurned }) => isTurned).length, 1);
  const spread = new Spread();
  for (const error of [0, 1e-8, 1e-4, Infinity]) spread.add(error);
  close(spread.typical, 1e-6);
});

test('signs that have mostly changed are seen by some of many elements', () => {
  const body = { name: 'Body', fields: [{ scalar: 'int', width: 1 }, { scalar: 'float', width: 2 }] };
  const wave = (sign) => sampleOf(body, columns([], Array.from({ length: 1000 }, (_, i) => sign * Math.cos(i)), []));
  assert.deepEqual([wave(1).length, wave(1)[2]], [334, Math.cos(6)]);
  assert.deepEqual([haveOtherSigns(wave(1), wave(-2)), haveOtherSigns(wave(1), wave(2)), haveOtherSigns(wave(1), wave(0))], [true, false, false]);
  assert.equal(sampleOf({ name: 'int', fields: [{ scalar: 'int', width: 1 }] }, columns([1, 2])).length, 0);
});

/** What is recorded of the value of a reduce: each call's device, own and reference. */
async function values(...calls) {
  const all = new Records();
  all.calls = calls.length;
  const kernel = all.kernel('sum');
  const element = { name: 'float', fields: [{ scalar: 'float', width: 1 }] };
  for (const [number, call] of calls.entries()) {
    const arrays = Promise.resolve(call.map((x) => columns([x])));
    await new CallRecorder(all, number + 1, kernel, [], [], 1).record([{ index: 0, parameter: { name: 's' }, element, of: null, counterpart: null, arrays, changed: Promise.resolve([]) }]);
  }
  return all;
}

test('inherited errors are divided by what each input does, where calls have shown it', async () => {
  const all = new Records();
  const element = { name: 'float', size: 4, fields: [{ scalar: 'float', width: 1, offset: 0 }] };
  const [left, right, add] = ['left', 'right', 'add'].map((name) => all.kernel(name));
  const readOf = (index, kernel, relative) => {
    const shares = new Shares();
    shares.add(kernel, 1);
    return { index, name: `x${index}`, counterpart: { errors: { relative, shares, hasNan: false, hasInfinity: false, exception: -1 } }, device: null, sample: null };
  };
  const sharesAfter = async (changed) => {
    const arrays = Promise.resolve([columns([103]), columns([103]), columns([100])]);
    const written = { index: 2, parameter: { name: 's' }, element, of: null, counterpart: null, arrays, changed: Promise.resolve(changed) };
    await new CallRecorder(all, 1, add, [readOf(0, left, 0.5), readOf(1, right, 0.01)], [], 1).record([written]);
    return new Map(all.results[0].shares.entries());
  };
  close((await sharesAfter([])).get(left), 0.5 / 0.51); // by the errors of the inputs
  // The left one is small, and its error changes the sum by 1; that of the right one changes it by 2.
  const shown = [[0, columns([102])], [1, columns([101])]];
  for (const changed of [shown, []]) close((await sharesAfter(changed)).get(left), (1 / 103) / (1 / 103 + 2 / 103));
});

test('shares are those of the worst read', () => {
  const all = new Records();
  const result = all.result('r', false);
  for (const [kernel, error] of [[0, 0.1], [1, 0.5], [2, 0.2]]) {
    const shares = new Shares();
    shares.add(kernel, 1);
    result.last = error;
    all.addError(result, shares);
  }
  assert.deepEqual([result.largest, result.shares.entries()], [0.5, [[1, 1]]]);
});

test('a value is compared with the largest that the reduce has given', async () => {
  const { results: [result] } = await values([1000, 1000, 1000], [0.5, 0.5, 0.25]);
  assert.deepEqual([result.reads, result.numbers, result.scale, result.exception], [2, 1, 1000, -1]);
  close(result.largest, 2.5e-4);
  close((await values([0.5, 0.5, 0.25])).results[0].largest, 1);
});

test('a value that is lost has no digit, and says where it comes from', async () => {
  const all = await values([2, 2, 2], [Infinity, 3, 3]);
  const { results: [result], kernels: [kernel] } = all;
  assert.deepEqual([result.last, result.largest, result.notFinite, result.withoutValue, result.exception], [Infinity, Infinity, 1, 1, 0]);
  assert.deepEqual([kernel.own.largest, kernel.total.largest, kernel.infinities], [Infinity, Infinity, 1]);
  assert.deepEqual(kernel.output('s', 'float').points.points.map(({ total }) => total), [0, 1]);
  const report = reportOf(all, { program: 'page', device: 'd', hasEnded: true, every: 1, kernels: ['*'], seconds: 1 });
  const { error, digits, numbers, notFinite, withoutValue, exception } = report.results[0];
  assert.deepEqual([error, digits, numbers, notFinite, withoutValue, exception], [{ largest: 'inf', last: 'inf' }, 0, 1, 1, 1, 0]);
  assert.deepEqual(report.verdicts.map(({ kind }) => kind), ['infinity', 'error']);
  assert.equal((await values([2, 2, 2])).results[0].exception, -1);
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
