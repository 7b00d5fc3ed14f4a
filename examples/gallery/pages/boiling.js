// SPDX-License-Identifier: MIT
//
// Boiling on a hot plate after T. Yanagita (1992), by the kernels of examples/applications/lattice: diffusion, buoyancy, latent heat.
import { relativeError } from '../accuracy.js';
import { InHalves, Painter, stroke } from '../field.js';
import { openPage } from '../page.js';
import { lattice } from '../sk/lattice/heat.sk.js';

const edge = { wrap: 0, wall: 2 };
const computed = 0;
const fluid = { point: 10, alpha: 30, sigma: 0.015, latent: 0.1 };

/** `warmed` is a field for what is between. */
function stepOf(t, warmed, walls, spread, boiling) {
  lattice.diffuse(
      {left: edge.wrap, right: edge.wrap, bottom: edge.wall, top: edge.wall, walls}, spread, t, warmed);
  lattice.rise(true, computed, boiling, warmed, warmed);
  lattice.exchange({x: false, y: true}, boiling, t, warmed, t);
}

function create({ device, canvas, controls, random }) {
  const columns = Math.max(32, canvas.width >> 1);
  const rows = Math.max(20, canvas.height >> 1);
  const [t, warmed] = [0, 1].map(() => device.stream('float', [rows, columns]));
  t.write(Float32Array.from({ length: rows * columns }, () => 9.9 + 0.05 * (2 * random() - 1)));
  const painter = new Painter(device, canvas, 'lagoon');
  return {
    elements: t.size,
    t,
    step: () => stepOf(t, warmed, [0, 0, controls.get('plate'), 9.9], 0.125, fluid),
    draw: () => painter.draw(t, 9.7, 10.4, 1),
    point(event) {
      if (event.kind !== 'up') stroke(event, rows / 14, [t, event.isErasing ? 9.8 : 10.5, 0.8]);
    },
  };
}

/** One step in doubles. */
function referenceStep(t, rows, columns, walls, spread, { point, alpha, sigma, latent }) {
  const every = (value) => Float64Array.from({ length: rows * columns }, (_, i) => value(i % columns, Math.floor(i / columns), i));
  const side = (a, x, y) => a[y * columns + ((x + columns) % columns)];
  const warmed = every((x, y, i) => {
    const below = y === 0 ? 2 * walls[2] - t[i] : t[i - columns];
    const above = y === rows - 1 ? 2 * walls[3] - t[i] : t[i + columns];
    return t[i] + spread * (side(t, x - 1, y) + side(t, x + 1, y) + below + above - 4 * t[i]);
  });
  const density = (value) => Math.tanh(alpha * (value - point));
  const risen = every((x, y, i) => {
    const below = y === 0 ? warmed[i] : warmed[i - columns];
    const above = y === rows - 1 ? warmed[i] : warmed[i + columns];
    return warmed[i] - 0.5 * sigma * warmed[i] * (density(above) - density(below));
  });
  const turned = every((x, y, i) => (risen[i] > point ? 1 : 0) - (t[i] > point ? 1 : 0));
  return every((x, y, i) => {
    const [below, above] = [y === 0 ? 0 : turned[i - columns], y === rows - 1 ? 0 : turned[i + columns]];
    return risen[i] - latent * (side(turned, x - 1, y) + side(turned, x + 1, y) + below + above);
  });
}

async function* measure({ device, simulation, time }) {
  const [rows, columns, steps] = [24, 32, 40];
  const boiling = { point: 10, alpha: 4, sigma: 1 / 64, latent: 0.125 };
  const walls = [0, 0, 10.75, 9.5];
  const first = Float32Array.from({ length: rows * columns }, (_, i) => 9.5 + ((i * 37) % 16) / 64);
  let exact = first;
  for (let i = 0; i < steps; ++i) exact = referenceStep(exact, rows, columns, walls, 0.125, boiling);
  for (const [choice, isHalf] of [['floats', false], ['halves between steps', true]]) {
    const streams = [[rows, columns], [rows, columns], simulation.t.shape, simulation.t.shape].map((shape) => device.stream('float', shape));
    const [t, warmed, large, warmedLarge] = streams;
    t.write(first);
    const run = (field, between) => {
      const step = () => stepOf(field, between, walls, 0.125, boiling);
      if (!isHalf) return step;
      const halves = new InHalves(device, [field]);
      return () => halves.step(step);
    };
    const step = run(t, warmed);
    for (let i = 0; i < steps; ++i) step();
    const error = relativeError(await t.read(), exact);
    yield { choice, note: `${steps} steps of ${columns} × ${rows} elements`, ms: await time(run(large, warmedLarge)), error };
    for (const stream of streams) stream.dispose();
  }
}

openPage({
  width: 832,
  aspect: 0.625,
  steps: 8,
  help: 'Drag to heat the fluid, with Shift or the second button to cool it. Keys: arrows move, Space heats, P pauses.',
  controls: [
    { name: 'plate', label: 'Temperature of the plate; it boils at 10', range: [9.9, 11.6, 0.05], value: 11, show: (x) => x.toFixed(2) },
  ],
  sources: ['sk/lattice/heat.sk', 'sk/lattice/phase.sk', 'sk/lattice/boundary.sk', 'sk/gallery/brush.sk', 'sk/lattice/view.sk'],
  create,
  accuracy: {
    note: 'The same steps with temperatures of floats and of halves, against doubles in JavaScript. A cell that boils a step too early gives off its heat a step too ' +
      'early: a small error may become a large one. Times are those of a step of the picture, with the conversions.',
    measure,
  },
});
