// SPDX-License-Identifier: MIT
//
// Boiling as a coupled map lattice, by the kernels of examples/classics/boiling: a row of burners, and four operators a step.
import { InHalves, Painter, stroke } from '../field.js';
import { openPage } from '../page.js';
import { boiling } from '../sk/classics/boiling.sk.js';
import { compareSteps } from '../steps.js';

const water = { Tc: 10, diffusion: 0.3, sigma: 0.02, alpha: 8, eta: 0.02 };
const cold = 9.7;
const stepsOfABurner = 40;
const cubics = false; // the browser computes tanh where C++ programs look it up

/** Diffusion, buoyancy and latent heat; `next` is for what is between. */
function operators(w, t, next) {
  boiling.diffusion(w, t, next);
  boiling.buoyancy(cubics, w, next, next);
  boiling.latentHeat(w, t, next, t);
}

function create({ device, canvas, controls, tell }) {
  const [rows, columns] = [canvas.height >> 1, canvas.width >> 1];
  const [t, next] = [0, 1].map(() => device.stream('float', [rows, columns]));
  const plate = device.stream('float', [1, columns]);
  t.fill(cold);
  const painter = new Painter(device, canvas, 'lagoon');
  let [time, frames] = [0, 0];
  return {
    elements: t.size,
    t,
    step() {
      const burners = { hot: controls.get('hot'), cold, burner: 16, share: controls.get('share') };
      boiling.heating(burners, Math.floor(time++ / stepsOfABurner), plate);
      plate.copyTo(t.domain([0, 0], [1, columns]));
      operators(water, t, next);
    },
    draw() {
      painter.draw(t, 9.4, 10.4);
      if (frames++ % 20 === 0) boiling.vapour(water, t).then((cells) => tell(`${((100 * cells) / t.size).toFixed(1)} % of the cells boil`), () => {});
    },
    point(event) {
      if (event.kind !== 'up') stroke(event, rows / 14, [t, event.isErasing ? 9.4 : 10.6, 0.8]);
    },
  };
}

/** The same operators in doubles. Rows 0 and last keep their temperatures. */
function referenceStep(t, rows, columns, w) {
  const map = (values, f) => values.map((here, i) => {
    const [row, x] = [i - (i % columns), i % columns];
    if (row === 0 || row === (rows - 1) * columns) return here;
    return f(here, i, [row + ((x + 1) % columns), row + ((x + columns - 1) % columns), i + columns, i - columns]);
  });
  const diffused = map(t, (here, i, n) => here + 0.25 * w.diffusion * (n.reduce((sum, k) => sum + t[k], 0) - 4 * here));
  const rho = (i) => Math.tanh(w.alpha * (diffused[i] - w.Tc));
  const risen = map(diffused, (here, i, [, , above, below]) => here * (1 - 0.5 * w.sigma * (rho(above) - rho(below))));
  const change = (i) => (risen[i] > w.Tc) - (t[i] > w.Tc);
  return map(risen, (here, i, n) => here - w.eta * n.reduce((sum, k) => sum + change(k), 0));
}

async function* measure(tools) {
  const { device, simulation } = tools;
  const [rows, columns, steps] = [24, 32, 40];
  // Numbers with few bits, so that floats and doubles compute with the same ones.
  const w = { Tc: 10, diffusion: 0.25, sigma: 1 / 64, alpha: 4, eta: 1 / 32 };
  const first = Float32Array.from({ length: rows * columns }, (_, i) => (i < columns && i % 8 < 3 ? 11 : 9.5 + ((i * 37) % 16) / 64));
  let exact = Float64Array.from(first);
  for (let i = 0; i < steps; ++i) exact = referenceStep(exact, rows, columns, w);
  const streams = (shape) => ({ t: device.stream('float', shape), next: device.stream('float', shape) });
  yield* compareSteps(tools, {
    ways: [
      ['floats', ({ t, next }) => () => operators(w, t, next)],
      ['halves between steps', ({ t, next }) => {
        const halves = new InHalves(device, [t]);
        return () => halves.step(() => operators(w, t, next));
      }],
    ],
    steps,
    note: `${steps} steps of ${columns} × ${rows} cells`,
    small() {
      const made = streams([rows, columns]);
      made.t.write(first);
      return made;
    },
    large: () => streams(simulation.t.shape),
    result: ({ t }) => t.read(),
    exact,
  });
}

openPage({
  width: 832,
  aspect: 0.625,
  steps: 8,
  help: 'Drag to heat the water, with Shift or the second button to cool it. Keys: arrows move, Space heats, P pauses.',
  controls: [
    { name: 'hot', label: 'Temperature of a burner; it boils at 10', range: [9.8, 12, 0.05], value: 11, show: (x) => x.toFixed(2) },
    { name: 'share', label: 'Part of the burners that are on', range: [0, 1, 0.05], value: 0.1, show: (x) => `${Math.round(100 * x)} %` },
  ],
  sources: ['sk/classics/boiling.sk', 'sk/gallery/brush.sk', 'sk/lattice/view.sk'],
  create,
  accuracy: {
    note: 'The same operators with temperatures of floats and of halves, against doubles in JavaScript. A cell that boils a step too early gives off its heat a step too ' +
      'early: a small error may become a large one. Times are those of a step of the picture, with the conversions.',
    measure,
  },
});
