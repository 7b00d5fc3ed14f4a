// SPDX-License-Identifier: MIT
//
// Water by implicit steps, with the vectors, the banded matrix and the operators of examples/classics/banded: conjugate gradients whose scalars stay
// on the device.
import { fillMatrix, step, vectorsOf } from '../banded_solver.js';
import { InHalves, stroke } from '../field.js';
import { openPage } from '../page.js';
import { banded } from '../sk/classics/banded.sk.js';
import { compareSteps } from '../steps.js';

const sun = [-0.3, 0.87, 0.39];
const stepsOfADrop = 15;
/** With c dt in distances of points: an explicit step may be `longest`. The matrix is I - alpha L. */
const longest = Math.SQRT1_2;
const alphaOf = (times) => (times * longest) ** 2 / 2;

/** Where the water is, in lengths of its square, that a place in the picture shows; see shade() in banded.sk. Null in the sky. */
function waterAt(x, y, aspect) {
  const [eye, tilt, field] = [[0.62, -0.25, 0.45], 0.45, 1.2];
  const [right, down] = [field * (x - 0.5), field * aspect * (y - 0.5)];
  const fall = Math.sin(tilt) + down * Math.cos(tilt);
  if (fall < 0.03) return null;
  const far = eye[2] / fall;
  return [eye[0] + far * right, eye[1] + far * (Math.cos(tilt) - down * Math.sin(tilt))].map((place) => place - Math.floor(place));
}

function create({ device, canvas, controls, tell }) {
  const w = Math.max(32, Math.round(0.32 * canvas.width));
  const v = vectorsOf(device, w);
  const colour = device.stream('float3', [canvas.height, canvas.width]);
  const changed = () => fillMatrix(v, alphaOf(controls.get('times')));
  changed();
  let [steps, frames] = [0, 0];
  return {
    elements: v.now.size,
    w,
    changed,
    step() {
      if (controls.get('rain') && steps % stepsOfADrop === 0) banded.drop(steps / stepsOfADrop, v.now, v.last, v.now, v.last);
      ++steps;
      step(v, controls.get('iterations'));
    },
    draw() {
      banded.shade({ height: v.now, scale: w, sun }, colour);
      device.draw(colour, canvas);
      if (frames++ % 20 > 0) return;
      Promise.all([v.rho.read(), banded.clVecReduce(v.b, v.b)])
        .then(([[rho], bb]) => tell(`What the last step leaves of its right-hand side: ${Math.sqrt(rho / (bb || 1)).toExponential(1)}`), () => {});
    },
    /** A dent, which is at rest. */
    point({ kind, x, y, isErasing }) {
      const at = kind === 'up' ? null : waterAt(x, y, canvas.height / canvas.width);
      if (at === null) return;
      const place = { x: at[0], y: 1 - at[1], lastX: at[0], lastY: 1 - at[1] };
      for (const field of [v.now, v.last]) stroke(place, w / 25, [field, isErasing ? 0.03 : -0.03, 0.8]);
    },
  };
}

/** A step in doubles, on a ring of numbers, by Jacobi's iteration to the last bits. */
function referenceStep({ now, last }, w, alpha) {
  const n = w * w;
  const around = (u, i) => u[(i + 1) % n] + u[(i + n - 1) % n] + u[(i + w) % n] + u[(i + n - w) % n];
  const right = now.map((here, i) => 3 * here - ((1 + 4 * alpha) * here - alpha * around(now, i)) - last[i]);
  let x = right;
  for (let i = 0; i < 60; ++i) x = right.map((b, k) => (b + alpha * around(x, k)) / (1 + 4 * alpha));
  return { now: x, last: now };
}

async function* measure(tools) {
  const { device, simulation } = tools;
  const [w, steps, alpha] = [16, 8, 0.25];
  const first = Float32Array.from({ length: w * w }, (_, i) => ((i % w) - 5 < 4 && i % w >= 5 && Math.floor(i / w) % 8 < 3 ? -0.0625 : 0));
  let exact = { now: Float64Array.from(first), last: Float64Array.from(first) };
  for (let i = 0; i < steps; ++i) exact = referenceStep(exact, w, alpha);
  const iterate = (iterations) => (v) => () => step(v, iterations);
  const streams = (size) => {
    const v = vectorsOf(device, size);
    fillMatrix(v, alpha);
    return v;
  };
  yield* compareSteps(tools, {
    ways: [
      ['16 iterations', iterate(16)],
      ['8 iterations', iterate(8)],
      ['4 iterations', iterate(4)],
      ['16 iterations, halves between steps', (v) => {
        const halves = new InHalves(device, [v.now, v.last]);
        return () => halves.step(iterate(16)(v));
      }],
    ],
    steps,
    note: `${steps} steps of ${w} × ${w} points`,
    small() {
      const v = streams(w);
      for (const field of [v.now, v.last]) field.write(first);
      return v;
    },
    large: () => streams(simulation.w),
    result: ({ now }) => now.read(),
    exact: exact.now,
  });
}

openPage({
  width: 800,
  aspect: 0.5625,
  steps: 3,
  help: 'Press on the water, or drag over it; with Shift or the second button, lift it. Keys: arrows move, Space presses, P pauses.',
  controls: [
    { name: 'iterations', label: 'Iterations of a step', range: [1, 40, 1], value: 10 },
    { name: 'times', label: 'Step, times the longest explicit one', range: [0.25, 6, 0.25], value: 1, show: (x) => x.toFixed(2) },
    { name: 'rain', label: 'Drops fall', isOn: true },
  ],
  sources: ['sk/classics/banded.sk', 'sk/gallery/scalars.sk', 'sk/gallery/brush.sk'],
  create,
  accuracy: {
    note: 'The same steps, as long as explicit ones may be, with fewer iterations and with halves in between, against doubles in JavaScript that solve each step to the last ' +
      'bits. Times are those of a step of the picture.',
    measure,
  },
});
