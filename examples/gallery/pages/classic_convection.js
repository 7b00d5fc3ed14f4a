// SPDX-License-Identifier: MIT
//
// Convection as a coupled map lattice, by the kernels of examples/classics/convection: one stream holds three lattices, from the bottom of the
// picture to its top, with smaller and smaller differences of temperature.
import { InHalves, Painter, stroke } from '../field.js';
import { openPage } from '../page.js';
import { convection } from '../sk/classics/convection.sk.js';
import { layers } from '../sk/gallery/layers.sk.js';
import { compareSteps } from '../steps.js';

const fluid = { c: 0.5, lambda: 0.4, nu: 0.2, eta: 0.15, along: 0.5 };
const differences = [2, 0.6, 0.2];
const shown = {
  temperature: [[0, 0, 1], 'ember', -1, 1],
  rising: [[0, 1, 0], 'dusk', -0.5, 0.5],
  sideways: [[1, 0, 0], 'dusk', -0.5, 0.5],
};

function step(f, cell) {
  convection.buoyancy(f, cell, cell);
  convection.heatDiffusion(f, cell, cell);
  convection.viscosityAndPressure(f, cell, cell);
  convection.lagrangian(cell, cell);
}

/** The last procedure as the papers have it: particles add to the cells where they arrive. */
function scatteredStep(f, cell, next) {
  convection.buoyancy(f, cell, cell);
  convection.heatDiffusion(f, cell, cell);
  convection.viscosityAndPressure(f, cell, cell);
  next.fill([0, 0, 0]);
  convection.lagrangianScatter(cell, next);
  const [layersOf, rows, columns] = cell.shape;
  next.domain([0, 1, 0], [layersOf, rows - 1, columns]).copyTo(cell.domain([0, 1, 0], [layersOf, rows - 1, columns])); // but the plates
}

/** At rest, conducting heat; `random` disturbs it. */
function firstState(width, height, temperatures, random) {
  return Float32Array.from({ length: 3 * width * (height + 1) * temperatures.length }, (_, n) => {
    const y = Math.floor(n / 3 / width) % (height + 1);
    const e = (0.5 - y / height) * temperatures[Math.floor(n / 3 / width / (height + 1))];
    return n % 3 < 2 ? 0 : y === 0 || y === height ? e : e * (1 - 0.03 * random());
  });
}

function create({ device, canvas, controls, random }) {
  const [width, rows] = [canvas.width >> 1, Math.floor(canvas.height / 6)];
  const cell = device.stream('float3', [differences.length, rows, width]);
  cell.write(firstState(width, rows - 1, differences, random));
  const field = device.stream('float', [differences.length * rows, width]);
  const one = device.stream('float3', [1, rows, width]);
  const painters = { ember: new Painter(device, canvas, 'ember'), dusk: new Painter(device, canvas, 'dusk') };
  return {
    elements: cell.size,
    cell,
    step: () => step(fluid, cell),
    draw() {
      const [part, colours, low, high] = shown[controls.get('shown')];
      layers.show(part, cell, field);
      painters[colours].draw(field, low, high);
    },
    point(event) {
      if (event.kind === 'up') return;
      const up = Math.min(differences.length * (1 - event.y), differences.length - 1e-3);
      const layer = Math.floor(up);
      const within = (y) => 1 - (differences.length * (1 - y) - layer);
      const lattice = cell.domain([layer, 1, 0], [layer + 1, rows - 1, width]);
      const part = one.domain([0, 1, 0], [1, rows - 1, width]); // but the plates
      cell.domain([layer, 0, 0], [layer + 1, rows, width]).copyTo(one);
      const warm = (event.isErasing ? -0.5 : 0.5) * differences[layer];
      stroke({ ...event, y: within(event.y), lastY: within(event.lastY) }, rows / 8, [one, [0, 0, warm], [0, 0, 0.8]]);
      part.copyTo(lattice);
    },
  };
}

/** A step of all lattices in doubles. Cells are three numbers each. */
function referenceStep(cell, width, rows, f) {
  const at = (a, x, y, c) => a[3 * (y * width + ((x + width) % width)) + c];
  const map = (a, change) => a.map((value, n) => {
    const [c, x, y] = [n % 3, Math.floor(n / 3) % width, Math.floor(n / 3 / width)];
    return y % rows === 0 || y % rows === rows - 1 ? value : change(value, c, (dx, dy, i) => at(a, x + dx, y + dy, i));
  });
  const lifted = map(cell, (v, c, n) => (c === 1 ? v + 0.5 * f.c * (2 * n(0, 0, 2) - n(1, 0, 2) - n(-1, 0, 2)) : v));
  const pressed = map(lifted, (v, c, n) => {
    const along = (dx, dy) => n(dx, dy, c) + n(-dx, -dy, c) - 2 * v;
    const [sideways, upright] = [along(1, 0), along(0, 1)];
    if (c === 2) return v + 0.25 * f.lambda * (sideways + upright);
    const mixed = 0.25 * (n(1, 1, 1 - c) + n(-1, -1, 1 - c) - n(-1, 1, 1 - c) - n(1, -1, 1 - c));
    return v + 0.25 * f.nu * (sideways + upright) + f.eta * (f.along * (c === 0 ? sideways : upright) + mixed);
  });
  return map(pressed, (v, c, n) => {
    let sum = 0;
    for (let y = -1; y <= 1; ++y) {
      for (let x = -1; x <= 1; ++x) {
        const share = (place, way) => Math.max(1 - Math.abs(place + n(x, y, way)), 0);
        sum += share(x, 0) * share(y, 1) * n(x, y, c);
      }
    }
    return sum;
  });
}

async function* measure(tools) {
  const { device, simulation } = tools;
  const [width, rows, steps, temperatures] = [24, 13, 20, [1, 0.5, 0.25]];
  const f = { c: 0.5, lambda: 0.5, nu: 0.25, eta: 0.125, along: 0.5 };
  let state = 1;
  const first = firstState(width, rows - 1, temperatures, () => ((state = (state * 37) % 64) / 64)); // few bits
  let exact = Float64Array.from(first);
  for (let i = 0; i < steps; ++i) exact = referenceStep(exact, width, rows, f);
  const streams = (shape) => ({ cell: device.stream('float3', shape), next: device.stream('float3', shape) });
  yield* compareSteps(tools, {
    ways: [
      ['floats', ({ cell }) => () => step(f, cell)],
      ['halves between steps', ({ cell }) => {
        const halves = new InHalves(device, [cell], 'half3');
        return () => halves.step(() => step(f, cell));
      }],
      ['floats, scattered by particles', ({ cell, next }) => () => scatteredStep(f, cell, next)],
    ],
    steps,
    note: `${steps} steps of ${temperatures.length} × ${width} × ${rows} cells`,
    small() {
      const made = streams([temperatures.length, rows, width]);
      made.cell.write(first);
      return made;
    },
    large: () => streams(simulation.cell.shape),
    result: ({ cell }) => cell.read(),
    exact,
  });
}

openPage({
  width: 768,
  aspect: 0.78,
  steps: 8,
  help: 'Three lattices, with differences of temperature of 0.2, 0.6 and 2. Drag to heat the fluid, with Shift or the second button to cool it. Keys: arrows move, Space ' +
    'heats, P pauses.',
  controls: [
    { name: 'shown', label: 'Shown', choices: [['temperature', 'Temperature'], ['rising', 'Speed upwards'], ['sideways', 'Speed sideways']], value: 'temperature' },
  ],
  sources: ['sk/classics/convection.sk', 'sk/gallery/layers.sk', 'sk/gallery/brush.sk'],
  create,
  accuracy: {
    note: 'The same steps in floats, with halves in between, and with particles that add to the cells where they arrive, as in the papers; against doubles in JavaScript. ' +
      'Times are those of a step of all three lattices.',
    measure,
  },
});
