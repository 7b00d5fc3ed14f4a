// SPDX-License-Identifier: MIT
//
// The reaction of Gray and Scott, by the kernels of examples/classics/reaction.
import { palette } from '../colours.js';
import { downwards, InHalves, stroke } from '../field.js';
import { openPage } from '../page.js';
import { reaction } from '../sk/classics/reaction.sk.js';
import { compareSteps } from '../steps.js';

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
  const c = Float32Array.from({ length: 2 * size * size }, (_, i) => 1 - (i % 2));
  const disturbed = (value) => value * (1 + 0.01 * (2 * random() - 1));
  for (let seed = 0; seed < seeds; ++seed) {
    const [left, top] = [0, 0].map(() => Math.floor(random() * size));
    const side = 8 + Math.floor(random() * 10);
    for (let y = 0; y < side; ++y) {
      for (let x = 0; x < side; ++x) {
        if (Math.hypot(x - side / 2, y - side / 2) > side / 2) continue;
        c.set([disturbed(0.5), disturbed(0.25)], 2 * (((top + y) % size) * size + ((left + x) % size)));
      }
    }
  }
  return c;
}

function create({ device, canvas, controls, random, tell }) {
  const size = canvas.width;
  const c = device.stream('float2', [size, size]);
  c.write(firstState(size, Math.max(4, Math.round((size * size) / 7000)), random));
  const colours = device.stream('float3', [256]);
  colours.write(palette('lagoon'));
  const picture = device.stream('float3', c.shape);
  let frames = 0;
  return {
    elements: c.size,
    c,
    step: () => reaction.advance(mediumOf(controls.get('pattern')), c, c),
    draw() {
      reaction.paint(colours, 0.42, c, picture);
      device.draw(picture, canvas);
      const show = ([low, high]) => tell(`U is between ${low[0].toFixed(3)} and ${high[0].toFixed(3)}, V between ${low[1].toFixed(3)} and ${high[1].toFixed(3)}`);
      if (frames++ % 20 === 0) reaction.range(c).then(show, () => {});
    },
    point(event) {
      if (event.kind === 'up') return;
      stroke(downwards(event), Math.max(4, size / 40), [c, event.isErasing ? [1, 0] : [0.4, 0.4], [0.9, 0.9]]);
    },
  };
}

/** `advance` on a torus, in doubles. */
function referenceStep(c, n, { feed, kill, spreadU, spreadV, dt }) {
  const next = new Float64Array(c.length);
  for (let y = 0; y < n; ++y) {
    for (let x = 0; x < n; ++x) {
      const at = (dx, dy, i) => c[2 * (((y + dy + n) % n) * n + ((x + dx + n) % n)) + i];
      const spread = (i) => at(-1, 0, i) + at(1, 0, i) + at(0, -1, i) + at(0, 1, i) - 4 * at(0, 0, i);
      const [u, v] = [at(0, 0, 0), at(0, 0, 1)];
      const made = u * v * v;
      next[2 * (y * n + x)] = u + dt * (spreadU * spread(0) - made + feed * (1 - u));
      next[2 * (y * n + x) + 1] = v + dt * (spreadV * spread(1) + made - (feed + kill) * v);
    }
  }
  return next;
}

async function* measure(tools) {
  const { device, simulation } = tools;
  const [n, steps] = [32, 100];
  // Numbers with few bits, so that floats and doubles compute with the same ones.
  const medium = { feed: 1 / 32, kill: 1 / 16, spreadU: 0.25, spreadV: 0.125, dt: 1 };
  const isSeed = (x, y) => y >= 10 && y < 22 && x >= 8 && x < 4 + y;
  const first = Float32Array.from({ length: 2 * n * n }, (_, i) => (i % 2 === 0 ? 1 : isSeed((i >> 1) % n, Math.floor(i / 2 / n)) ? 0.5 : 0));
  let exact = first;
  for (let i = 0; i < steps; ++i) exact = referenceStep(exact, n, medium);
  const step = (c) => () => reaction.advance(medium, c, c);
  yield* compareSteps(tools, {
    ways: [
      ['floats', ({ c }) => step(c)],
      ['halves between steps', ({ c }) => {
        const halves = new InHalves(device, [c], 'half2');
        return () => halves.step(step(c));
      }],
    ],
    steps,
    note: `${steps} steps of ${n} × ${n} cells`,
    small() {
      const c = device.stream('float2', [n, n]);
      c.write(first);
      return { c };
    },
    large: () => ({ c: device.stream('float2', simulation.c.shape) }),
    result: ({ c }) => c.read(),
    exact,
  });
}

openPage({
  width: 512,
  steps: 24,
  help: 'Drag to paint more of the second substance, V; with Shift or the second button, erase it. Keys: arrows move, Space paints, P pauses.',
  controls: [
    { name: 'pattern', label: 'Pattern', choices: Object.entries(patterns).map(([key, [, , words]]) => [key, words]), value: 'theta' },
  ],
  sources: ['sk/classics/reaction.sk', 'sk/gallery/brush.sk'],
  create,
  accuracy: {
    note: 'The same steps with states of floats and of halves, against doubles in JavaScript. Times are those of a step of the picture, with the conversions; errors are ' +
      'relative to the largest number.',
    measure,
  },
});
