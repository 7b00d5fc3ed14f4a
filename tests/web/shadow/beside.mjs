// SPDX-License-Identifier: MIT
//
// device.shadow(): pages whose faults are known, and what the shadow says of them. Programs are replayed in JavaScript's doubles.
import { Device, SkError, stretch } from 'streamkernel';
import * as k from './beside.sk.js';
import * as plain from './without.sk.js';

const report = { mistakes: [], checks: 0, reports: {} };
function expect(what, holds, found = '') {
  ++report.checks;
  if (!holds) report.mistakes.push(`${what}: ${found}`);
}
const isClose = (a, b, bound) => Math.abs(a - b) <= bound * Math.abs(b);
const sum2 = (array) => array.reduce((sum, x) => sum + x * x, 0);
const less = (a, b) => a.map((x, i) => x - b[i]);

function filled(device, shape, of) {
  const stream = device.stream('float', shape);
  stream.write(Float32Array.from({ length: stream.size }, (_, i) => of(i)));
  return stream;
}

/** What a page does under a shadow. */
async function followed(name, device, run, options = {}) {
  const shadow = await device.shadow(options);
  try {
    const value = await run(shadow);
    const found = await shadow.report();
    report.reports[name] = found;
    return { found, shadow, value, kernel: (kernel) => found.kernels.find((each) => each.name === kernel) };
  } finally {
    shadow.stop();
  }
}

// ---- blame ----------------------------------------------------------------------------------------

const side = 32;
const size = side * side;
const start = Float32Array.from({ length: size }, (_, i) => 1e4 * (1 + Math.sin(i) ** 2));

/** Results that do not depend on the shadow, and the elements that the bad kernel reads. */
async function cancels(device, shadow, readsWithin) {
  const [u, v, w] = [1, 2, 3].map(() => device.stream('float', [side, side]));
  shadow?.name(w, 'w');
  u.write(start);
  for (let i = 0; i < 5; ++i) k.field.diffuse(0.2, u, u);
  const within = readsWithin ? await u.read() : null;
  k.field.cancel(u, v);
  const cancelled = readsWithin ? await v.read() : null;
  k.field.damp(0.5, v, w);
  const sum = await k.total(w);
  const result = await w.read();
  for (const stream of [u, v, w]) stream.dispose();
  return { within, cancelled, sum, result };
}

function diffusedInDoubles() {
  let u = Float64Array.from(start);
  const c = Math.fround(0.2);
  for (let step = 0; step < 5; ++step) {
    const at = (x, y) => u[((y + side) % side) * side + ((x + side) % side)];
    u = u.map((here, i) => {
      const [x, y] = [i % side, Math.floor(i / side)];
      return here + c * (at(x + 1, y) + at(x - 1, y) + at(x, y + 1) + at(x, y - 1) - 4 * here);
    });
  }
  return u;
}

const cancelInDoubles = (x) => Math.sqrt(1 + x) - Math.sqrt(x);

async function blame(device) {
  const without = await cancels(device, null, true);
  const { found, kernel, value, shadow } = await followed('blame', device, (shadow) => cancels(device, shadow, false));
  const bits = (array) => new Uint32Array(array.buffer).join();
  expect('results have the same bits', bits(value.result) === bits(without.result) && value.sum === without.sum, `${value.sum} ${without.sum}`);
  expect('the first verdict names the bad kernel', found.verdicts[0]?.kernel === 'field::cancel' && found.verdicts[0].kind === 'error', JSON.stringify(found.verdicts));
  const reference = diffusedInDoubles().map(cancelInDoubles);
  const own = Float64Array.from(without.within).map(cancelInDoubles);
  const replayed = Math.sqrt(sum2(less(Float64Array.from(without.cancelled), own)) / sum2(reference));
  const inherited = Math.sqrt(sum2(less(own, reference)) / sum2(reference));
  expect('the own error is that of a replay', isClose(kernel('field::cancel').own.largest, replayed, 1e-6), `${kernel('field::cancel').own.largest}, not ${replayed}`);
  expect('so is what it inherited', isClose(kernel('field::cancel').inherited.largest, inherited, 1e-2), `${kernel('field::cancel').inherited.largest}, not ${inherited}`);
  expect('the bad kernel has nearly all of the share', kernel('field::cancel').share > 0.99 && kernel('field::diffuse').share < 0.01, String(kernel('field::cancel').share));
  expect('a kernel that doubles would not make better adds nothing', kernel('field::damp').own.largest < 1e-7 && kernel('field::damp').inherited.largest > 1e-4);
  expect('amplification is that of the formula', Math.abs(kernel('field::cancel').amplification.largest - 0.5) < 0.05, JSON.stringify(kernel('field::cancel').amplification));
  const { worst } = kernel('field::cancel');
  const input = Float64Array.of(without.within[worst.element[0] * side + worst.element[1]])[0];
  expect('the worst element has its input', worst.inputs[0].parameter === 'x' && worst.inputs[0].value === input, JSON.stringify(worst));
  expect('and its values', worst.device.value === without.cancelled[worst.element[0] * side + worst.element[1]] && isClose(worst.reference.value, cancelInDoubles(input), 1e-8), JSON.stringify(worst));
  const total = Math.sqrt(sum2(less(Float64Array.from(without.result), reference.map((x) => 0.5 * x))) / sum2(reference.map((x) => 0.5 * x)));
  const result = found.results.find(({ name }) => name === 'w');
  expect('a result has the error of a replay', isClose(result?.error.largest ?? 0, total, 1e-6), JSON.stringify(result));
  expect('a value, too', found.results.some(({ name, kind, error }) => name === 'total' && kind === 'value' && error.largest > 1e-6));
  expect('all calls are followed', found.calls === 8 && found.followed === 8 && found.notes.length === 0, JSON.stringify(found.notes));
  const table = await shadow.table();
  expect('the table begins with the verdict', table.startsWith(found.verdicts[0].text) && /field::cancel +1 /.test(table), table);
  const html = await shadow.html();
  report.html = html;
  expect('the page has the report', html.startsWith('<!DOCTYPE html>') && html.includes('"field::cancel"') && !html.includes('/*REPORT*/null;'));
  expect('the page is not followed after stop()', (await cancels(device, null, false)).sum === without.sum && (await shadow.report()).calls === 8);
}

// ---- kinds of calls -------------------------------------------------------------------------------

async function folds(device) {
  const x = filled(device, [8, 12], (i) => 1 + i / 7);
  const [y, rows, one] = [device.stream('float', [8, 12]), device.stream('float', [8, 1]), device.stream('float', [1])];
  const { found, kernel, value } = await followed('folds', device, async () => {
    const scale = filled(device, [1], () => 1 / 3);
    k.field.damp(scale, x, y);
    const squares = await k.energy(1 / 3, x, y);
    k.energy(1 / 3, x, y, one);
    k.total(y, rows);
    return { squares, y: await y.read(), rows: await rows.read(), one: await one.read() };
  });
  const third = Math.fround(1 / 3);
  const exact = Float64Array.from({ length: 96 }, (_, i) => third * Math.fround(1 + i / 7));
  const own = Math.abs(value.squares - sum2(exact)) / sum2(exact);
  expect('a folded output is compared', Math.abs(kernel('energy').outputs.find(({ name }) => name === 'squares').points[0][1] - own) < 1e-12, `${JSON.stringify(kernel('energy').outputs)}, not ${own}`);
  const ofMap = Math.sqrt(sum2(less(Float64Array.from(value.y), exact)) / sum2(exact));
  expect('the other output of a fold, too', isClose(kernel('energy').outputs.find(({ name }) => name === 'y').points[0][1], ofMap, 1e-6), String(ofMap));
  expect('a reduce to a stream is', kernel('total').followed === 1 && kernel('total').total.largest < 1e-7 && value.rows.length === 8, JSON.stringify(kernel('total')));
  expect('a stream for a value is named', found.notes.length === 1 && found.notes[0].startsWith("'a' of field::damp is a value in a stream"), JSON.stringify(found.notes));
  expect('so is what a page is promised', found.results.some(({ name, kind }) => name === 'energy' && kind === 'value'), JSON.stringify(found.results));
  expect('everything is right', found.verdicts[0].kind === 'fine' && found.followed === 4, JSON.stringify(found.verdicts));
}

/** A sum with a small part that is wrong by far, and a large one that is right to its last digit: the large one's error counts. */
async function influences(device) {
  const x = filled(device, [size], (i) => start[i]);
  const [large, small, r] = [1, 2, 3].map(() => device.stream('float', [size]));
  const sharesOf = async (name, calls) => {
    const { found } = await followed(name, device, async () => {
      for (let i = 0; i < calls; ++i) {
        k.field.damp(1 / 3, x, large);
        k.field.cancel(x, small);
        k.add(large, small, r);
      }
      await r.read();
    });
    expect(`${name}: everything is followed`, found.followed === 3 * calls && found.notes.length === 0, JSON.stringify(found.notes));
    return (kernel) => found.results[0].shares.find((each) => each.kernel === kernel)?.share ?? 0;
  };
  for (const calls of [1, 3]) {
    const share = await sharesOf(`influences, ${calls}`, calls);
    expect('inherited errors are divided by what each input does', share('field::damp') > 0.2 && share('field::cancel') < 0.1, JSON.stringify([share('field::damp'), share('field::cancel')]));
  }
}

/** The shares of a result are those of its worst read. */
async function worst(device) {
  const x = filled(device, [size], (i) => start[i]);
  const r = device.stream('float', [size]);
  const { found } = await followed('worst', device, async () => {
    for (const run of [() => k.field.damp(1 / 3, x, r), () => k.field.cancel(x, r), () => k.field.damp(1 / 3, x, r)]) {
      run();
      await r.read();
    }
    k.field.cancel(x, r);
    await k.total(r);
    k.field.damp(1 / 3, x, r);
    await k.total(r);
  });
  const [read, sum] = found.results;
  expect('shares are those of the worst read', read.reads === 3 && read.error.last < read.error.largest && read.shares[0].kernel === 'field::cancel', JSON.stringify(read));
  expect('and of the worst value', sum.reads === 2 && sum.error.largest > 0, JSON.stringify(sum));
}

async function views(device) {
  const [x, y] = [filled(device, [8, 8], (i) => i / 3), filled(device, [1, 8], (i) => 1000 + i)];
  const [r, s] = [filled(device, [8, 8], () => 7), device.stream('float', [8, 8])];
  const small = filled(device, [4, 4], (i) => i / 3);
  const { found, value } = await followed('views', device, async () => {
    k.add(x.domain([2, 2], [6, 6]), x.domain([0, 0], [4, 4]), r.domain([4, 4], [8, 8]));
    k.add(x, y, s);
    k.add(stretch(small), s, s);
    r.copyTo(x);
    r.domain([0, 0], [1, 8]).fill(3);
    r.domain([1, 0], [2, 8]).write(new Float32Array(8).fill(4));
    k.field.damp(1 / 3, r, r);
    r.domain([0, 0], [2, 8]).copyTo(x.domain([6, 0], [8, 8]));
    const last = await x.domain([4, 0], [8, 8]).read();
    return { s: await s.read(), r: await r.read(), last };
  });
  const third = Math.fround(1 / 3);
  expect('views hold what they should', Math.abs(value.r[0] - 3 * third) < 1e-6 && Math.abs(value.r[8] - 4 * third) < 1e-6 && Math.abs(value.last[16] - 3 * third) < 1e-6, String(value.r));
  expect('views are followed', found.followed === 4 && found.notes.length === 0 && found.results.length === 3, JSON.stringify([found.notes, found.results]));
  const isRound = found.results.every(({ error }) => error.largest > 0 && error.largest < 1e-7);
  expect('their errors are those of rounding', isRound && found.streams.every(({ resyncs }) => resyncs === 0), JSON.stringify(found.results));
}

async function structs(device) {
  const bodies = device.stream(k.Body, [5]);
  const at = Float32Array.from({ length: 15 }, (_, i) => 0.1 * i);
  bodies.write({ at, mass: Float32Array.from([1, 2, 3, 4, 5]), id: Int32Array.from([1, 2, 3, 4, 5]) });
  const { kernel, value } = await followed('structs', device, async () => {
    k.move([0.1, 0.2, 0.3], bodies, bodies);
    return bodies.read();
  });
  const by = [0.1, 0.2, 0.3].map(Math.fround);
  const exact = Float64Array.from(at, (x, i) => x + by[i % 3] / (2 + Math.floor(i / 3)));
  const errors = sum2(less(Float64Array.from(value.at), exact));
  const scale = sum2(exact) + sum2([1, 2, 3, 4, 5]);
  expect('structs are compared', isClose(kernel('move')?.own.largest ?? 0, Math.sqrt(errors / scale), 1e-6), JSON.stringify(kernel('move')?.own));
  expect('their members have names', /^r\.at\.[xyz]$/.test(kernel('move').worst.output) && kernel('move').worst.inputs.some(({ parameter }) => parameter === 'b.id'), JSON.stringify(kernel('move').worst));
}

async function decisions(device) {
  const x = filled(device, [100], (i) => i * 0.1);
  const [cell, more] = [device.stream('int', [100]), device.stream('int', [100])];
  const { found } = await followed('decisions', device, async () => {
    k.cells(0.1, x, cell);
    k.count(cell, more);
    await more.read();
  });
  const width = Math.fround(0.1);
  const differ = Array.from(await cell.read()).filter((n, i) => n !== Math.floor(Math.fround(i * 0.1) / width)).length;
  const [first, second] = found.decisions;
  expect('decisions that differ are found', differ > 0 && first?.kernel === 'cells' && first.elements === differ && !first.isInherited, JSON.stringify([differ, first]));
  expect('those that follow are inherited', second?.kernel === 'count' && second.isInherited && second.elements === differ, JSON.stringify(second));
  expect('the first verdict names the kernel that decides', found.verdicts[0].kind === 'decision' && found.verdicts[0].kernel === 'cells', JSON.stringify(found.verdicts));
}

async function exceptions(device) {
  const x = filled(device, [40], (i) => (i - 3) / 3);
  const [r, s] = [device.stream('float', [40]), device.stream('float', [40])];
  const { found } = await followed('exceptions', device, async () => {
    k.root(x, r);
    k.field.damp(2, r, s);
    await s.read();
  });
  const [first] = found.exceptions;
  expect('a NaN is found', first?.kind === 'nan' && first.kernel === 'root' && first.elements === 3 && first.element[0] === 0 && first.isInReference, JSON.stringify(first));
  expect('with where it went', first?.path.some(({ kernel }) => kernel === 'field::damp'), JSON.stringify(first?.path));
  expect('the first verdict names it', found.verdicts[0].kind === 'nan' && found.verdicts[0].kernel === 'root', JSON.stringify(found.verdicts));
}

async function unstable(device) {
  const x = filled(device, [64], (i) => (i + 1) / 66);
  const { found } = await followed('unstable', device, async () => {
    for (let i = 0; i < 40; ++i) k.logistic(x, x);
    await x.read();
  });
  expect('an error that grows with each call is found', found.verdicts.some(({ kind, kernel }) => kind === 'unstable' && kernel === 'logistic'), JSON.stringify(found.verdicts));
}

/** Steps of the heat equation that are too long: each multiplies the shortest wave by 1 - 4k, -2.6. */
async function overshoots(device) {
  const hill = (i) => (i % 7 === 3 ? 2 : 0.5);
  const heat = async (name, calls, isInPlace, options) => {
    const u = filled(device, [100], hill);
    const v = isInPlace ? u : device.stream('float', [100]);
    const { found } = await followed(name, device, async () => {
      for (let i = 0; i < calls; i += 2) {
        k.step(0.9, u, v);
        k.step(0.9, v, u);
      }
      await u.read();
    }, options);
    return found;
  };
  const isUnstable = (verdict) => verdict?.kind === 'unstable' && verdict.kernel === 'step' && /factor of 2\.[4-6]\d* with each call/.test(verdict.text);
  const steps = await heat('overshoots', 40, false);
  expect('a step that is too long is unstable, though its solution grows as well', steps.verdicts.some(isUnstable), JSON.stringify(steps.verdicts));
  const second = await heat('overshoots, every second', 40, true, { every: 2 });
  expect('every second call shows that', second.kernels[0].followed === 20 && second.verdicts.some(isUnstable), JSON.stringify(second.verdicts));
  const over = await heat('overflows', 120, false);
  expect('an overflow that it leads to comes after it', isUnstable(over.verdicts[0]) && over.exceptions[0]?.kind === 'infinity', JSON.stringify([over.verdicts, over.exceptions[0]]));
}

async function grows(device) {
  const x = filled(device, [64], (i) => 100 + i / 3);
  const { found } = await followed('grows', device, async () => {
    for (let i = 0; i < 200; ++i) k.accrue(0.05, x, x);
    await x.read();
  });
  const growth = found.verdicts.at(-1);
  expect('compound interest grows as it should', growth.kind === 'growth' && growth.kernel === 'accrue' && /factor of 1\.0[4-6]\d* /.test(growth.text), JSON.stringify(found.verdicts));
  expect('which is not the first thing to say of results that are right', found.verdicts.length === 2 && found.results[0].digits > 5, JSON.stringify([found.verdicts, found.results]));
}

async function vanishes(device) {
  const x = filled(device, [40], () => 1e-9);
  const [r, s, t] = [1, 2, 3].map(() => device.stream('float', [40]));
  const { found, kernel } = await followed('vanishes', device, async () => {
    k.vanish(x, r);
    k.field.damp(2, r, s);
    k.step(0.25, r, t);
    await s.read();
    await t.read();
  });
  const [result, difference] = found.results;
  expect('a result that is infinite has no digit', result.error.largest === 'inf' && result.error.last === 'inf' && result.digits === 0, JSON.stringify(result));
  expect('its numbers are counted', result.numbers === 40 && result.notFinite === 40 && result.withoutValue === 40, JSON.stringify(result));
  expect('it says where they come from', found.exceptions[result.exception]?.kernel === 'vanish' && result.shares[0]?.kernel === 'vanish', JSON.stringify([result, found.exceptions]));
  expect('a NaN comes from where the infinities do whose difference it is', difference.exception === result.exception && found.exceptions.length === 2 && found.exceptions[1].kind === 'nan', JSON.stringify([difference, found.exceptions]));
  expect('the kernel has no digit either', kernel('vanish').own.largest === 'inf' && kernel('vanish').digits === 0 && kernel('field::damp').own.largest === 0 && kernel('field::damp').total.largest === 'inf', JSON.stringify(found.kernels));
  expect('the first verdict is of the infinity', found.verdicts[0].kind === 'infinity' && found.verdicts[0].kernel === 'vanish' && found.verdicts.some(({ kind }) => kind === 'error'), JSON.stringify(found.verdicts));
}

// ---- what is not followed -------------------------------------------------------------------------

async function named(device) {
  const x = filled(device, [64], (i) => i / 7);
  const [r, s] = [device.stream('float', [0]), device.stream('float', [64])];
  const { found } = await followed('named', device, async () => {
    k.field.damp(1 / 3, x, x);
    await k.select(0.5, x, r);
    const large = device.stream('float', [r.size]);
    k.field.damp(2, r, large);
    plain.field.damp(2, x, s);
    plain.field.damp(2, x, s);
    k.root(s, s);
    await Promise.all([large.read(), s.read()]);
  });
  const notes = found.notes.join('\n');
  expect('pushes are named once', notes.match(/select is not followed: it pushes or scatters/g)?.length === 1, notes);
  expect('so are modules without programs', notes.match(/without.sk.js has no programs for it; give skc the option --shadow/g)?.length === 1, notes);
  expect('the reference takes over what they write', found.streams.filter(({ resyncs }) => resyncs === 1).length === 2, JSON.stringify(found.streams));
  expect('what follows is compared', found.results.length === 2 && found.results.every(({ error }) => error.largest < 1e-6), JSON.stringify(found.results));
}

async function choices(device) {
  const x = filled(device, [16], (i) => i / 7);
  const run = async () => {
    for (let i = 0; i < 6; ++i) k.field.damp(1 / 3, x, x);
    k.root(x, x);
    await x.read();
  };
  const some = await followed('every', device, run, { every: 3, kernels: ['field::*'] });
  expect('every third call is compared', some.kernel('field::damp').followed === 2 && some.kernel('root').followed === 0, JSON.stringify(some.found.kernels));
  expect('the reference runs all of them', some.found.results[0].error.largest > 1e-9 && some.found.results[0].error.largest < 1e-6, JSON.stringify(some.found.results));
  const other = await followed('other kernels', device, async () => {
    k.field.damp(1 / 3, x, x);
    await x.read();
  }, { kernels: ['root'] });
  const [result] = other.found.results;
  expect('nobody knows whose an error is that has passed through a kernel of which no call is compared',
    result.error.last > 1e-9 && result.shares.length === 1 && result.shares[0].kernel === '(calls that were not compared)', JSON.stringify(result));
  const refused = [[{ every: 0 }, 'every: 0'], [{ every: 1.5 }, 'every: 1.5'], [{ kernels: 'heat' }, 'kernels: give an array'], [{ kernels: [] }, 'kernels'], [{ decisions: 'own' }, "no option 'decisions'"], [null, 'no object']];
  for (const [options, text] of refused) {
    const error = await device.shadow(options).then(() => null, (error) => error);
    expect(`${JSON.stringify(options)} is refused`, error instanceof SkError && error.kind === 'misuse' && error.message.includes(text), String(error));
  }
  const first = await device.shadow();
  const error = await device.shadow().then(() => null, (error) => error);
  expect('a second shadow is refused', error instanceof SkError && error.message.includes('stop() that first'), String(error));
  const mistake = await (async () => k.field.damp(1, x, device.stream('float', [3])))().then(() => null, (error) => error);
  expect('mistakes of the page stay its own', mistake instanceof SkError && mistake.kind === 'shape', String(mistake));
  const gone = filled(device, [16], (i) => i);
  gone.dispose();
  const lost = await (async () => k.field.damp(1, gone, x))().then(() => null, (error) => error);
  const rejected = await k.total(gone).then(() => null, (error) => error);
  k.field.damp(1 / 3, x, x);
  await k.total(x);
  const after = await first.report();
  expect('and are not those of the kernel', lost?.kind === 'lost' && rejected?.kind === 'lost' && after.followed === 2 && after.notes.length === 0, JSON.stringify([String(lost), after.notes]));
  first.stop();
}

/** Calls that are not compared: what they add is not what others do. */
async function unseen(device) {
  const [tame, wild] = [filled(device, [64], (i) => 0.25 + i / 640), filled(device, [64], (i) => 1e6 + i)];
  const [r, s] = [1, 2].map(() => device.stream('float', [64]));
  const run = async () => {
    k.field.cancel(tame, r);
    k.field.cancel(wild, r);
    k.step(0.25, r, s);
    await s.read();
  };
  const second = await followed('unseen', device, run, { every: 2 });
  expect('a call that is not compared is named', second.found.verdicts[0].kernel === 'field::cancel' && second.found.results[0].shares.find(({ kernel }) => kernel === 'field::cancel').share > 0.99, JSON.stringify([second.found.verdicts, second.found.results]));
  const amplification = second.kernel('step').amplification.largest;
  expect('what is made of its error is measured', amplification > 0.2 && amplification < 2, String(amplification));
  const none = await followed('unseen by several', device, async () => {
    k.field.damp(1 / 3, wild, r);
    await run();
    k.field.damp(1 / 3, s, r);
    await r.read();
  }, { kernels: ['total'] });
  const [, last] = none.found.results;
  expect('so are several', last.shares[0].kernel === '(calls that were not compared)' && none.found.verdicts[0].text.includes('arises in, or is magnified by, field::damp or step or field::cancel, which are not compared'), JSON.stringify([last, none.found.verdicts]));
}

/** A kernel that looks at an unstable step. */
async function watched(device) {
  const x = filled(device, [100], (i) => (i % 7 === 3 ? 2 : 0.5));
  const [y, looked] = [1, 2].map(() => device.stream('float', [100]));
  const { found } = await followed('watched', device, async () => {
    for (let i = 0; i < 20; ++i) {
      k.step(0.9, x, y);
      k.step(0.9, y, x);
      k.energy(1, x, looked);
      k.field.damp(2, looked, looked);
    }
    await x.read();
  });
  expect('an unstable step is named, not what looks at it', found.verdicts.some(({ kind, kernel }) => kind === 'unstable' && kernel === 'step'), JSON.stringify(found.verdicts));
}

async function ends() {
  const device = await Device.create();
  const shadow = await device.shadow();
  const x = filled(device, [16], (i) => i);
  k.field.damp(1 / 3, x, x);
  device.dispose();
  expect('a report outlives its device', (await shadow.report()).calls === 1);
  shadow.stop();
}

const unhandled = [];
addEventListener('unhandledrejection', ({ reason }) => unhandled.push(String(reason)));
try {
  const device = await Device.create();
  for (const run of [blame, influences, worst, folds, views, structs, decisions, exceptions, unstable, overshoots, grows, vanishes, named, choices, unseen, watched, ends]) {
    try {
      await run(device);
      const error = device.context.getError();
      if (error !== 0) report.mistakes.push(`${run.name}: GL error ${error}`);
    } catch (error) {
      report.mistakes.push(`${run.name}: ${error.stack}`);
    }
  }
} catch (error) {
  report.mistakes.push(`no device: ${error.stack}`);
}
await new Promise((done) => setTimeout(done, 50));
expect('no promise is rejected unseen', unhandled.length === 0, unhandled.join());
await fetch('/', { method: 'POST', body: JSON.stringify(report) });
