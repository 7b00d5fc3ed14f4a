// SPDX-License-Identifier: MIT
//
// The reaction of Gray and Scott, by the kernels of examples/applications/lattice.
import { relativeError } from '../accuracy.js';
import { InHalves, Painter, stroke, sumRows } from '../field.js';
import { openPage } from '../page.js';
import { lattice as doubles } from '../sk/double/reaction.sk.js';
import { lattice } from '../sk/lattice/reaction.sk.js';

/** Feed and kill of J. Pearson's classes (1993), and of R. Munafo's extension of them. */
const patterns = {
  theta: [0.03, 0.057, 'Labyrinths that grow as rings'],
  lambda: [0.034, 0.065, 'Cells that divide until a lattice is full'],
  mu: [0.046, 0.065, 'Worms that lie down in parallel'],
  kappa: [0.05, 0.063, 'Corals and hedgerow mazes'],
  delta: [0.03, 0.055, 'Holes in a hexagonal lattice'],
  gamma: [0.022, 0.051, 'Worms that branch and never rest'],
  epsilon: [0.018, 0.055, 'Cells that divide and die of crowding'],
};
const perCell = (256 / 2.5) ** 2; // a time step of 1 on Pearson's grid

function mediumOf(name) {
  const [feed, kill] = patterns[name];
  return { feed, kill, spreadU: 2e-5 * perCell, spreadV: 1e-5 * perCell, dt: 1 };
}

/** u = 1 and v = 0, with discs of 1/2 and 1/4 that are disturbed by 1 %. */
function firstState(size, seeds, random) {
  const u = new Float32Array(size * size).fill(1);
  const v = new Float32Array(size * size);
  const disturbed = (value) => value * (1 + 0.01 * (2 * random() - 1));
  for (let seed = 0; seed < seeds; ++seed) {
    const [left, low] = [0, 0].map(() => Math.floor(random() * size));
    const side = 8 + Math.floor(random() * 10);
    for (let y = 0; y < side; ++y) {
      for (let x = 0; x < side; ++x) {
        if (Math.hypot(x - side / 2, y - side / 2) > side / 2) continue;
        const i = ((low + y) % size) * size + ((left + x) % size);
        u[i] = disturbed(0.5);
        v[i] = disturbed(0.25);
      }
    }
  }
  return { u, v };
}

function create({ device, canvas, controls, random }) {
  const size = Math.max(32, canvas.width >> 1);
  const [u, v] = [0, 1].map(() => device.stream('float', [size, size]));
  const first = firstState(size, Math.max(4, Math.round((size * size) / 7000)), random);
  u.write(first.u);
  v.write(first.v);
  const painter = new Painter(device, canvas, 'lagoon');
  let medium = mediumOf(controls.get('pattern'));
  return {
    elements: 2 * u.size,
    u,
    v,
    step: () => lattice.react(false, false, medium, u, v, u, v),
    draw: () => painter.draw(v, 0, 0.42, 5),
    changed: () => (medium = mediumOf(controls.get('pattern'))),
    point(event) {
      if (event.kind === 'up') return;
      const radius = Math.max(3, size / 40);
      stroke(event, radius, [v, event.isErasing ? 0 : 0.4, 0.9], [u, event.isErasing ? 1 : 0.4, 0.9]);
    },
  };
}

/** react on a torus, in doubles. */
function referenceStep({ u, v }, n, { feed, kill, spreadU, spreadV, dt }) {
  const next = { u: new Float64Array(n * n), v: new Float64Array(n * n) };
  for (let y = 0; y < n; ++y) {
    const [row, above, below] = [y, (y + n - 1) % n, (y + 1) % n].map((r) => r * n);
    for (let x = 0; x < n; ++x) {
      const [left, right] = [(x + n - 1) % n, (x + 1) % n];
      const spread = (f) => f[row + left] + f[row + right] + f[above + x] + f[below + x] - 4 * f[row + x];
      const [a, b] = [u[row + x], v[row + x]];
      const made = a * b * b;
      next.u[row + x] = a + spreadU * spread(u) + dt * (feed * (1 - a) - made);
      next.v[row + x] = b + spreadV * spread(v) + dt * (made - (feed + kill) * b);
    }
  }
  return next;
}

async function* measure({ device, simulation, time, timeAnswer }) {
  const [n, steps] = [32, 100];
  // Numbers with few bits, so that floats and doubles compute with the same ones.
  const medium = { feed: 1 / 32, kill: 1 / 16, spreadU: 0.25, spreadV: 0.125, dt: 1 };
  const first = { u: new Float32Array(n * n).fill(1), v: new Float32Array(n * n) };
  for (let y = 10; y < 22; ++y) first.v.fill(0.5, y * n + 8, y * n + 8 + y - 4);
  let exact = first;
  for (let i = 0; i < steps; ++i) exact = referenceStep(exact, n, medium);

  const { shape } = simulation.u;
  const fields = (type, of) => {
    const made = [device.stream(type, of), device.stream(type, of)];
    if (of !== shape) [first.u, first.v].forEach((values, i) => made[i].write(type === 'double' ? Float64Array.from(values) : values));
    return made;
  };
  const ways = [
    ['floats', 'float', (f) => () => lattice.react(false, false, medium, ...f, ...f)],
    ['halves between steps', 'float', (f) => {
      const halves = new InHalves(device, f);
      return () => halves.step(() => lattice.react(false, false, medium, ...f, ...f));
    }],
    ['doubles, as pairs of floats', 'double', (f) => () => doubles.react(false, false, medium, ...f, ...f)],
  ];
  for (const [choice, type, stepOf] of ways) {
    const [small, large] = [fields(type, [n, n]), fields(type, shape)];
    const step = stepOf(small);
    for (let i = 0; i < steps; ++i) step();
    const error = relativeError(await small[1].read(), exact.v);
    yield { choice, note: `v after ${steps} steps of ${n} × ${n} elements`, ms: await time(stepOf(large)), error };
    for (const stream of [...small, ...large]) stream.dispose();
  }
  yield* sumRows(simulation.v, { timeAnswer }, 'sum of v');
}

openPage({
  width: 768,
  steps: 24,
  help: 'Drag to paint more of the second substance, with Shift or the second button to erase it. Keys: arrows move, Space paints, P pauses.',
  controls: [
    { name: 'pattern', label: 'Pattern', choices: Object.entries(patterns).map(([key, [, , words]]) => [key, words]), value: 'theta' },
  ],
  sources: ['sk/lattice/reaction.inc', 'sk/lattice/boundary.sk', 'sk/gallery/brush.sk', 'sk/lattice/view.sk'],
  create,
  accuracy: {
    note: 'The same steps in three precisions, against doubles in JavaScript. The doubles are the same file, compiled with another type. Times are those of a step of the ' +
      'picture; errors are relative to the largest number.',
    measure,
  },
});
