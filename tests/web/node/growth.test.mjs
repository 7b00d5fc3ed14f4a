// SPDX-License-Identifier: MIT
//
// What a shadow concludes from errors that grow is what the C++ runtime concludes (runtime/src/shadow/report_test.cpp): both read
// tests/shadow/growth.json.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

const load = (name) => import(`${process.env.SK_WEB}/streamkernel/shadow/${name}.js`);
const [{ Records }, { verdictsOf }] = await Promise.all(['records', 'verdicts'].map(load));
const { cases } = JSON.parse(readFileSync(`${process.env.SK_SOURCE}/tests/shadow/growth.json`));

function recordsOf({ calls, stride = 1, absolute, relative, turned = 0, steady = 0, watched = false, decision = 0, result, exceptions }) {
  const all = new Records();
  all.calls = calls * stride;
  all.followed = calls;
  const step = all.kernels[all.kernel('step')];
  step.calls = calls;
  const after = ([a, f, p], n) => a * f ** n * n ** p;
  for (let n = 1; n <= calls; ++n) {
    step.amplification.add(1);
    const errors = { call: n * stride, own: 0, inherited: 0 };
    step.output('v', 'float').points.add({ ...errors, total: after(relative, n), absolute: after(absolute, n), isTurned: n <= turned });
    for (let i = 0; i < steady; ++i) step.output(`w${i}`, 'float').points.add({ ...errors, total: 1e-7, absolute: 1e-7, isTurned: false });
  }
  if (watched) {
    step.readFrom.add(0);
    const look = all.kernels[all.kernel('look')];
    look.calls = calls;
    look.readFrom.add(0);
    for (const point of step.output('v', 'float').points.points) {
      look.amplification.add(1);
      look.output('w', 'float').points.add({ ...point, absolute: point.absolute ** 2 });
    }
  }
  const read = all.result('v', false);
  read.largest = read.last = result === 'inf' ? Infinity : result;
  read.shares.add(0, 1 - decision);
  read.shares.add(1, decision);
  if (decision > 0) {
    const value = { value: 0, isReal: true };
    const first = { call: calls, output: 'depth', index: [0], device: value, reference: value, inputs: [] };
    all.decisions.push({ kernel: all.kernel('draw'), elements: 1, isInherited: false, first });
  }
  for (const [kind, call, isInReference] of exceptions) {
    const value = { value: 0, isReal: true };
    all.exceptions.push({ kind, kernel: 0, elements: 1, isInReference, first: { call, output: 'v', index: [0], device: value, reference: value, inputs: [] }, path: [] });
  }
  return all;
}

test('errors that grow are what they are in C++', () => {
  for (const each of cases) {
    const verdicts = verdictsOf(recordsOf(each));
    assert.deepEqual(verdicts.map(({ kind }) => kind), each.verdicts, each.name);
    const growth = verdicts.find(({ kind }) => kind === 'unstable' || kind === 'growth');
    assert.equal(growth?.text ?? null, each.text, each.name);
  }
});
