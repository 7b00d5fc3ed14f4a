// SPDX-License-Identifier: MIT
//
// Heat on a plate, with two pens that write by themselves.
import { relativeError } from '../accuracy.js';
import { Painter, stroke, sumRows } from '../field.js';
import { openPage } from '../page.js';
import { plate } from '../sk/gallery/heat.sk.js';

const loss = 0.0006;

/** A curve that never quite closes; from 0 to 1. */
function penAt(time, phase) {
  return [0.5 + 0.38 * Math.sin(1.31 * time + phase), 0.5 + 0.38 * Math.sin(2.07 * time + 1.7 * phase)];
}

function create({ device, canvas, controls, tell }) {
  const size = Math.max(16, canvas.width >> 1);
  const temperature = device.stream('float', [size, size]);
  const painter = new Painter(device, canvas, 'dusk');
  let steps = 0;
  let frames = 0;

  function write(pen, value) {
    const [from, to] = [steps - 1, steps].map((step) => penAt(step / 600, pen));
    stroke({ x: to[0], y: to[1], lastX: from[0], lastY: from[1] }, size / 34, [temperature, value, 0.5]);
  }

  return {
    elements: temperature.size,
    field: temperature,
    step() {
      ++steps;
      if (controls.get('pens')) {
        write(0, 1);
        write(2.4, -1);
      }
      plate.diffuse(controls.get('spread'), loss, temperature, temperature);
    },
    draw() {
      painter.draw(temperature, -0.8, 0.8, 0.6);
      if (frames++ % 20 === 0) plate.sum(temperature).then((sum) => tell(`Mean temperature ${(sum / temperature.size).toFixed(5)}`), () => {});
    },
    point(event) {
      if (event.kind !== 'up') stroke(event, size / 20, [temperature, event.isErasing ? -1 : 1, 0.8]);
    },
  };
}

/** diffuse in doubles. */
function referenceStep(t, n, spread) {
  const next = new Float64Array(n * n);
  for (let y = 0; y < n; ++y) {
    const [above, below] = [Math.max(y - 1, 0) * n, Math.min(y + 1, n - 1) * n];
    for (let x = 0; x < n; ++x) {
      const here = t[y * n + x];
      const around = t[y * n + Math.max(x - 1, 0)] + t[y * n + Math.min(x + 1, n - 1)] + t[above + x] + t[below + x];
      next[y * n + x] = here + spread * (around - 4 * here);
    }
  }
  return next;
}

async function* measure({ device, simulation, time, timeAnswer }) {
  const [n, steps, spread] = [48, 200, 0.125]; // the floats nearest to these are exact
  const first = Float32Array.from({ length: n * n }, (_, i) => Number((i % n > 16 && i % n < 32) !== i > 999));
  let exact = Float64Array.from(first);
  for (let i = 0; i < steps; ++i) exact = referenceStep(exact, n, spread);
  for (const type of ['float', 'half']) {
    const small = device.stream(type, [n, n]);
    small.write(first);
    for (let i = 0; i < steps; ++i) plate.diffuse(spread, 0, small, small);
    const error = relativeError(await small.read(), exact);
    const large = device.stream(type, simulation.field.shape);
    const ms = await time(() => plate.diffuse(spread, 0, large, large));
    yield { choice: `stored as ${type}`, note: `${steps} steps of ${n} × ${n} elements`, ms, error };
    for (const stream of [small, large]) stream.dispose();
  }
  yield* sumRows(simulation.field, { timeAnswer }, 'sum of the plate');
}

openPage({
  width: 768,
  steps: 8,
  help: 'Drag to heat the plate, with Shift or the second button to cool it. Keys: arrows move, Space presses, P pauses.',
  controls: [
    { name: 'spread', label: 'Spread of a step, D dt / h²', range: [0.01, 0.25, 0.01], value: 0.2, show: (x) => x.toFixed(2) },
    { name: 'pens', label: 'Pens write by themselves', isOn: true },
  ],
  sources: ['sk/gallery/heat.sk', 'sk/gallery/brush.sk', 'sk/lattice/view.sk'],
  create,
  accuracy: {
    note: 'The same steps with streams of floats and of halves, against doubles in JavaScript. Times are those of a step of the plate above; errors are relative to ' +
      'the largest number.',
    measure,
  },
});
