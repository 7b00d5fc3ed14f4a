// SPDX-License-Identifier: MIT
//
// Warm air that rises and cold air that sinks, by the kernels of examples/classics/multigrid: V-cycles solve for the pressure in each step.
import { relativeError } from '../accuracy.js';
import { downwards, stroke } from '../field.js';
import { openPage } from '../page.js';
import { multigrid } from '../sk/classics/multigrid.sk.js';

const dt = 0.02;
const sweeps = { before: 2, after: 2, omega: 0.8 };
const atCoarsest = 10;
const times = (count, work) => {
  for (let i = 0; i < count; ++i) work();
};

/** A grid of n = 3, 6, 12, 24 ... cells along a side, which have n - 1 elements between, and all coarser ones. The coarsest has 2 x 2 elements: in
 *  browsers, a gather is larger than the distance of the neighbors that a kernel reads. */
function gridsOf(device, n) {
  const grids = [];
  for (; n >= 3; n /= 2) grids.push(Object.fromEntries(['u', 'f', 'r'].map((name) => [name, device.stream('float', [n - 1, n - 1])])));
  return grids;
}

function vcycle([{ u, f, r }, ...coarser]) {
  const smooth = () => multigrid.smooth(sweeps.omega, f, u, u);
  if (coarser.length === 0) return times(atCoarsest, smooth);
  times(sweeps.before, smooth);
  multigrid.residual(f, u, r);
  multigrid.restrict(r, coarser[0].f);
  coarser[0].u.fill(0);
  vcycle(coarser);
  multigrid.correct(coarser[0].u, u, u);
  times(sweeps.after, smooth);
}

function create({ device, canvas, controls, tell }) {
  const n = 3 * 2 ** Math.max(2, Math.round(Math.log2(canvas.width / 3)));
  const grids = gridsOf(device, n);
  const [{ u, f, r }] = grids;
  let [heat, next] = [0, 1].map(() => device.stream('float', [n, n]));
  const w = device.stream('float2', [n, n]);
  const pressure = device.stream('float', [n, n]); // u, and the end of the square, where it is 0: a gather as large as w
  let [frames, mostPressure] = [0, 1e-3];
  const report = async () => {
    multigrid.residual(f, u, r);
    const [left, right, most] = await Promise.all([r, f, u].map((field) => multigrid.largest(field)));
    mostPressure = Math.max(most, 1e-6);
    tell(`${controls.get('cycles')} cycles on ${grids.length} grids leave ${(left / (right || 1)).toExponential(1)} of the divergence`);
  };
  return {
    elements: heat.size,
    n,
    step() {
      multigrid.advect(dt, w, heat, w, next);
      [heat, next] = [next, heat];
      multigrid.diverge(w, f);
      times(controls.get('cycles'), () => vcycle(grids));
      u.copyTo(pressure.domain([0, 0], [n - 1, n - 1]));
      multigrid.project(pressure, w, w);
    },
    draw() {
      if (frames++ % 20 === 0) report().catch(() => {});
      if (controls.get('shown') === 'heat') device.draw(heat, canvas, { map: 'coolwarm', range: [-1, 1] });
      else device.draw(u, canvas, { map: 'viridis', range: [-mostPressure, mostPressure] });
    },
    point(event) {
      if (event.kind !== 'up') stroke(downwards(event), n / 16, [heat, event.isErasing ? -1 : 1, 0.9]);
    },
  };
}

/** -laplace(u) = f in doubles, to the last bits, by successive over-relaxation. */
function solved(m, f) {
  const u = new Float64Array(m * m);
  const relaxation = 2 / (1 + Math.sin(Math.PI / (m + 1)));
  const at = (x, y) => (x < 0 || y < 0 || x === m || y === m ? 0 : u[y * m + x]);
  times(30 * m, () => {
    for (let y = 0; y < m; ++y) {
      for (let x = 0; x < m; ++x) {
        const next = 0.25 * (f[y * m + x] / (m + 1) ** 2 + at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1));
        u[y * m + x] += relaxation * (next - u[y * m + x]);
      }
    }
  });
  return u;
}

/** The error after each cycle. */
async function* measure({ device, simulation, time }) {
  const n = 24;
  const [grids, large] = [gridsOf(device, n), gridsOf(device, simulation.n)];
  const [{ u, f }] = grids;
  const values = Float32Array.from({ length: f.size }, (_, i) => ((i * 37) % 101) / 64 - 0.75);
  f.write(values);
  const exact = solved(n - 1, Float64Array.from(values));
  for (const cycles of [8, 1, 2, 3, 4]) {
    u.fill(0);
    times(cycles, () => vcycle(grids));
    const error = relativeError(await u.read(), exact);
    yield { choice: cycles === 1 ? '1 cycle' : `${cycles} cycles`, note: `V(2, 2), ${n} × ${n} cells`, ms: await time(() => times(cycles, () => vcycle(large))), error };
  }
  for (const grid of [...grids, ...large]) Object.values(grid).forEach((stream) => stream.dispose());
}

openPage({
  width: 384,
  steps: 2,
  help: 'Drag to warm the air, with Shift or the second button to cool it. Keys: arrows move, Space warms, P pauses.',
  controls: [
    { name: 'cycles', label: 'V-cycles of a step', range: [1, 6, 1], value: 2 },
    { name: 'shown', label: 'Shown', choices: [['heat', 'Warm and cold air'], ['pressure', 'Pressure']], value: 'heat' },
  ],
  sources: ['sk/classics/multigrid.sk', 'sk/gallery/brush.sk'],
  create,
  accuracy: {
    note: 'Solutions of Poisson’s equation after 8 cycles, as far as floats take it, and after each of the first ones, against doubles in JavaScript. Times are those of the ' +
      'cycles for the picture.',
    measure,
  },
});
