// SPDX-License-Identifier: MIT
//
// One shader with ten outputs, by the kernel of examples/classics/one_source: skc has split it into passes of four planes, as many as every browser
// writes.
import { relativeError } from '../accuracy.js';
import { RoundToHalves } from '../field.js';
import { openPage } from '../page.js';
import { one_source, one_source_Reflection, one_source_Surface } from '../sk/classics/one_source.sk.js';
import { shaded } from '../sk/gallery/shaded.sk.js';
import { add, cross, dot, scaled, unit } from '../vectors.js';

const eye = [0, 0, 1];
const key = { direction: [-0.6, 0.64, 0.48], colour: [1.5, 1.375, 1.25] };
const fill = { direction: [0.8, 0.36, 0.48], colour: [0.375, 0.5, 0.75] };
const outputs = ['colour', 'albedo', 'normal', 'highlight', 'mirror'];

function ballOf(device, n) {
  const p = device.stream('float3', [n, n]);
  one_source.rasterize(p);
  return { p, surface: device.stream(one_source_Surface, [n, n]), light: device.stream(one_source_Reflection, [n, n]) };
}

/** How many passes the device draws for a call. */
function passesOf({ context }, call) {
  const count = { passes: 0 };
  const draw = context.drawArrays;
  context.drawArrays = (...given) => (++count.passes, draw.apply(context, given));
  call();
  delete context.drawArrays;
  return count.passes;
}

function create({ device, canvas, controls, tell }) {
  const ball = ballOf(device, canvas.width);
  const picture = device.stream('float3', ball.p.shape);
  const lamp = { ...key };
  let turn = 0;
  const shade = () => {
    const other = [0.877 * Math.cos(turn + 0.423), 0.877 * Math.sin(turn + 0.423), 0.48];
    one_source.shade(ball.p, eye, [lamp, { ...fill, direction: other }], ball.surface, ball.light);
  };
  const passes = passesOf(device, shade);
  return {
    elements: ball.p.size,
    ball,
    step() {
      if (controls.get('turns')) turn += 0.02;
      shade();
    },
    draw() {
      shaded.show(outputs.indexOf(controls.get('output')), ball.p, ball.surface, ball.light, picture);
      device.draw(picture, canvas);
      tell(`The shader has ten outputs, of 24 components. A pass writes up to 4 of them in every browser, so that it takes ${passes} passes here.`);
    },
    /** The lamp shines from where the pointer is. */
    point({ kind, x, y }) {
      if (kind === 'up') return;
      const at = [2.125 * x - 1.0625, 1.0625 - 2.125 * y];
      const out = Math.hypot(...at);
      const edge = Math.min(1, 0.98 / out);
      lamp.direction = unit([edge * at[0], edge * at[1], Math.sqrt(1 - (edge * out) ** 2)]);
      shade();
    },
  };
}

// The shader in doubles, as in one_source.sk.
function hash(p) {
  const mixed = (h, by) => Math.imul(h ^ (h >>> 15), by);
  const first = Math.imul(p[0], 0x8da6b343) ^ Math.imul(p[1], 0xd8163841) ^ Math.imul(p[2], 0xcb1ab31f);
  let h = mixed(first, 0x2c1b3c6d);
  h = Math.imul(h ^ (h >>> 12), 0x297a2d39);
  return (h ^ (h >>> 15)) >>> 0;
}

/** The gradient, and the value. */
function noise(q) {
  const base = q.map(Math.floor);
  const t = q.map((x, d) => x - base[d]);
  const sum = [0, 0, 0, 0];
  for (let i = 0; i < 8; ++i) {
    const corner = [i & 1, (i >> 1) & 1, i >> 2];
    const random = (hash(add(base, corner)) >>> 8) * 2 ** -23 - 1;
    const w = t.map((x, d) => { const rise = x ** 3 * (x * (6 * x - 15) + 10); return corner[d] ? rise : 1 - rise; });
    const dw = t.map((x, d) => (2 * corner[d] - 1) * 30 * x * x * (x * (x - 2) + 1));
    [[dw[0], w[1], w[2]], [w[0], dw[1], w[2]], [w[0], w[1], dw[2]], w].forEach((f, k) => (sum[k] += random * f[0] * f[1] * f[2]));
  }
  return sum;
}

function colourOf(p, lamps) {
  const q = scaled(p, 2);
  let [slope, height] = [[0, 0, 0], 0];
  for (let octave = 0; octave < 5; ++octave) {
    const [x, y, z, value] = noise(q.map((c) => 2 ** octave * c + 0.375 * octave));
    slope = add(slope, [x, y, z]);
    height += value / 2 ** octave;
  }
  const band = q[0] + 0.5 * q[1] + 1.5 * height;
  const vein = (2 * (band - Math.floor(band)) - 1) ** 4;
  const albedo = add([0.0625, 0.1875, 0.15625], [0.75, 0.625, 0.5], vein);
  const n = unit(add(p, add(slope, p, -dot(slope, p)), -0.03125));
  const t = unit(cross([0.125, 0.75, -0.5], n));
  const sine = (a, b) => Math.hypot(...cross(a, b));
  let [diffuse, highlight] = [[0.0625, 0.0625, 0.0625], [0, 0, 0]];
  for (const { direction: l, colour } of lamps) {
    const power = scaled(colour, Math.max(dot(n, l), 0));
    const shine = Math.max(sine(l, t) * sine(eye, t) - dot(l, t) * dot(eye, t), 0.125) ** 32;
    diffuse = add(diffuse, power);
    highlight = add(highlight, power, shine);
  }
  const up = 0.5 + 0.5 * (2 * dot(n, eye) * n[1] - eye[1]);
  const fresnel = 0.0625 + 0.9375 * (1 - Math.max(dot(n, eye), 0)) ** 5;
  const mirror = add([0.25, 0.1875, 0.125], [0.25, 0.5, 0.875], up * up * (3 - 2 * up));
  return albedo.map((a, c) => a * diffuse[c] + 0.5 * highlight[c] + fresnel * mirror[c]);
}

async function* measure({ device, simulation, time }) {
  const n = 24;
  const { p, surface, light } = ballOf(device, n);
  const colour = device.stream('float3', [n, n]);
  const lamps = [key, fill].map((lamp) => ({ ...lamp, direction: lamp.direction.map(Math.fround) })); // as the device gets them
  const points = await p.read();
  const exact = Array.from({ length: n * n }, (_, i) => colourOf([...points.subarray(3 * i, 3 * i + 3)], lamps)).flat();
  const { ball } = simulation;
  for (const [choice, isRounded] of [['floats', false], ['points of the ball in halves', true]]) {
    if (isRounded) new RoundToHalves(device, p.shape, 'half3').pass(p);
    one_source.shade(p, eye, lamps, surface, light);
    shaded.colourOf(light, colour);
    const error = relativeError(await colour.read(), exact);
    yield { choice, note: `colours of ${n} × ${n} pixels`, ms: await time(() => one_source.shade(ball.p, eye, lamps, ball.surface, ball.light)), error };
  }
  for (const stream of [p, surface, light, colour]) stream.dispose();
}

openPage({
  width: 640,
  steps: 1,
  help: 'Drag the lamp over the ball. Keys: arrows move, Space moves the lamp, P pauses.',
  controls: [
    { name: 'output', label: 'Output of the shader', choices: outputs.map((name) => [name, name[0].toUpperCase() + name.slice(1)]), value: 'colour' },
    { name: 'turns', label: 'The second lamp turns', isOn: true },
  ],
  sources: ['sk/classics/one_source.sk', 'sk/gallery/shaded.sk'],
  create,
  accuracy: {
    note: 'The colours of the same shader, for points that lie on the ball and for points that halves have rounded, against doubles in JavaScript. Times are those of ' +
      'shading the picture.',
    measure,
  },
});
