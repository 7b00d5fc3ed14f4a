// SPDX-License-Identifier: MIT
//
// Convection between plates in the Boussinesq approximation, by the kernels of examples/applications/lattice, in units of the height, the difference of
// temperatures and the time of a free fall.
import { relativeError } from '../accuracy.js';
import { InHalves, Painter, stroke } from '../field.js';
import { openPage } from '../page.js';
import { lattice as momentum } from '../sk/lattice/flow.sk.js';
import { lattice as heat } from '../sk/lattice/heat.sk.js';

const edge = { wrap: 0, wall: 2 };
const sides = {
  left: edge.wrap,
  right: edge.wrap,
  bottom: edge.wall,
  top: edge.wall,
  walls: [0, 0, 1, 0]
};
const prandtl = 0.71;
const sound = 3;

/** What kernels are called with; see coefficientsOf() in examples/applications/lattice/model.cpp. */
export function coefficientsOf(rayleigh, rows) {
  const h = 1 / rows;
  const viscosity = Math.sqrt(prandtl / rayleigh);
  const damping = 0.2 * sound * h;
  const diffusivity = 1 / Math.sqrt(rayleigh * prandtl);
  // The largest step for sound, 2 c^2 dt^2 + 4 (nu + lambda) dt <= h^2, and for heat.
  const b = 4 * (viscosity + damping);
  const dt = 0.8 * Math.min((Math.sqrt(b * b + 8 * sound * sound * h * h) - b) / (4 * sound * sound), (h * h) / (4 * diffusivity));
  const perCell = dt / (h * h);
  return {
    fluid: { carry: dt / h, viscosity: viscosity * perCell, damping: damping * perCell, lift: dt, rest: 1, slope: -1 / rows },
    spread: diffusivity * perCell,
    carry: dt / h,
    stiffness: (sound * sound * dt) / h,
  };
}

export function stepOf({ t, vx, vy, p }, c) {
  momentum.push(false, true, false, c.fluid, vx, vy, p, t, vx, vy);
  convect({t, vx, vy, p}, c);
}

function convect({t, vx, vy, p}, {spread, carry, stiffness}) {
  heat.convect(sides, {spread, carry, stiffness, t, vx, vy}, p, t, p);
}

function fieldsOf(device, rows, columns) {
  return Object.fromEntries(['t', 'vx', 'vy', 'p'].map((name) => [name, device.stream('float', [rows, columns])]));
}

/** What conduction makes of the temperature, disturbed by waves and by noise. */
function conducted(rows, columns, random) {
  const waves = [1, 2, 3, 4, 5, 6].map((count) => ({ count: (2 * Math.PI * count) / columns, phase: 2 * Math.PI * random() }));
  return Float32Array.from({ length: rows * columns }, (_, i) => {
    const up = (Math.floor(i / columns) + 0.5) / rows;
    const wave = waves.reduce((sum, { count, phase }) => sum + Math.sin(count * i + phase), 0) * Math.sin(Math.PI * up);
    return 1 - up + 0.04 * wave + 0.04 * (2 * random() - 1);
  });
}

function create({ device, canvas, controls, random }) {
  const columns = Math.max(32, canvas.width >> 1);
  const rows = Math.max(16, canvas.height >> 1);
  const fields = fieldsOf(device, rows, columns);
  fields.t.write(conducted(rows, columns, random));
  const derived = device.stream('float', [rows, columns]);
  const painters = { ember: new Painter(device, canvas, 'ember'), dusk: new Painter(device, canvas, 'dusk') };
  let c = coefficientsOf(10 ** controls.get('rayleigh'), rows);
  return {
    elements: 4 * rows * columns,
    fields,
    step: () => stepOf(fields, c),
    draw() {
      const shown = controls.get('shown');
      if (shown === 'temperature') return painters.ember.draw(fields.t, 0, 1);
      if (shown === 'speed') momentum.speedOf(fields.vx, fields.vy, derived);
      else momentum.curlOf(fields.vx, fields.vy, derived);
      if (shown === 'speed') painters.ember.draw(derived, 0, 0.6);
      else painters.dusk.draw(derived, -0.12, 0.12);
    },
    changed: () => (c = coefficientsOf(10 ** controls.get('rayleigh'), rows)),
    point(event) {
      if (event.kind !== 'up') stroke(event, rows / 12, [fields.t, event.isErasing ? 0 : 1, 0.8]);
    },
  };
}

/** convect in doubles, with a flow that is given. */
function referenceStep(t, vx, vy, rows, columns, c) {
  const next = new Float64Array(rows * columns);
  for (let y = 0; y < rows; ++y) {
    for (let x = 0; x < columns; ++x) {
      const at = (a, dx, dy) => a[((y + dy + rows) % rows) * columns + ((x + dx + columns) % columns)];
      const here = t[y * columns + x];
      const [left, right] = [at(t, -1, 0), at(t, 1, 0)];
      const below = y === 0 ? 2 - here : at(t, 0, -1);
      const above = y === rows - 1 ? -here : at(t, 0, 1);
      const carried = at(vx, 1, 0) * (here + right) - at(vx, 0, 0) * (left + here) + at(vy, 0, 1) * (here + above) - at(vy, 0, 0) * (below + here);
      next[y * columns + x] = here + c.spread * (left + right + below + above - 4 * here) - 0.5 * c.carry * carried;
    }
  }
  return next;
}

async function* measure({ device, simulation, time }) {
  const [rows, columns, steps] = [24, 32, 120];
  const c = { spread: 0.125, carry: 0.25, stiffness: 0 };
  const quarters = (x) => Math.round(64 * x) / 64; // few bits
  const angle = (i) => (2 * Math.PI * (i % columns)) / columns;
  const first = Float32Array.from({ length: rows * columns }, (_, i) => quarters(1 - Math.floor(i / columns) / rows));
  const vy = Float32Array.from({ length: rows * columns }, (_, i) => (i < columns ? 0 : quarters(0.5 * Math.sin(angle(i)))));
  const vx = Float32Array.from({ length: rows * columns }, (_, i) => quarters(0.25 * Math.cos(angle(i))));
  let exact = first;
  for (let i = 0; i < steps; ++i) exact = referenceStep(exact, vx, vy, rows, columns, c);

  const large = simulation.fields;
  const [wide, tall] = [large.t.shape[1], large.t.shape[0]];
  for (const [choice, isHalf] of [['floats', false], ['halves between steps', true]]) {
    const small = fieldsOf(device, rows, columns);
    small.t.write(first);
    small.vx.write(vx);
    small.vy.write(vy);
    const big = fieldsOf(device, tall, wide);
    const run = (fields, kept) => {
      if (!isHalf) return () => convect(fields, c);
      const halves = new InHalves(device, kept);
      return () => halves.step(() => convect(fields, c));
    };
    const step = run(small, [small.t]);
    for (let i = 0; i < steps; ++i) step();
    const error = relativeError(await small.t.read(), exact);
    yield { choice, note: `heat carried by a flow, ${steps} steps of ${columns} × ${rows} elements`, ms: await time(run(big, [big.t])), error };
    for (const stream of [...Object.values(small), ...Object.values(big)]) stream.dispose();
  }
}

openPage({
  width: 960,
  aspect: 0.5,
  steps: 24,
  help: 'Drag to heat the fluid, with Shift or the second button to cool it. Keys: arrows move, Space heats, P pauses.',
  controls: [
    { name: 'rayleigh', label: 'Rayleigh number', range: [4, 8, 0.25], value: 7, show: (x) => (10 ** x).toExponential(0).replace('e+', ' · 10^') },
    { name: 'shown', label: 'Shown', choices: [['temperature', 'Temperature'], ['speed', 'Speed'], ['curl', 'Vorticity']], value: 'temperature' },
  ],
  sources: ['sk/lattice/flow.sk', 'sk/lattice/heat.sk', 'sk/lattice/boundary.sk', 'sk/gallery/brush.sk', 'sk/lattice/view.sk'],
  create,
  accuracy: {
    note: 'The kernel that carries heat, with temperatures of floats and of halves, against doubles in JavaScript. Times are those of a step of it in the picture, with ' +
      'the conversions; errors are relative to the largest number.',
    measure,
  },
});
