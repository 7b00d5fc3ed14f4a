// SPDX-License-Identifier: MIT
//
// A cloth that is draped over a ball, by the kernels of examples/classics/cloth, in metres: simulated and drawn on the device, which gives nothing but
// the finished picture.
import { InHalves } from '../field.js';
import { openPage } from '../page.js';
import { cloth } from '../sk/classics/cloth.sk.js';
import { compareSteps } from '../steps.js';
import { add, cross, dot, scaled, unit } from '../vectors.js';

const ball = { radius: 0.55, level: 0, thickness: 0.01, friction: 0.4 };
const [side, drag, rounds] = [2, 1, 4];
const squares = 16; // of the cloth, along a side

/** What a step of a cloth of n x n particles is called with; a correction passes on by a link in a round. */
function coefficientsOf(n, stiffness) {
  const dt = 0.1 / n;
  return { keep: 1 - drag * dt, a: [0, -9.81 * dt * dt, 0], restlength: side / (n - 1), stiffness };
}

function step(c, scene, x, oldx) {
  cloth.integrate(c.keep, c.a, x, oldx, x, oldx);
  for (let i = 0; i < rounds; ++i) cloth.satisfyConstraints(c.restlength, c.stiffness, scene, x, oldx, x);
}

const flat = (n) => Float32Array.from({ length: 3 * n * n }, (_, i) => {
  const particle = Math.floor(i / 3);
  return [side * ((particle % n) / (n - 1) - 0.5), 1.25, side * (Math.floor(particle / n) / (n - 1) - 0.5)][i % 3];
});

function lookAt(eye, at, focal) {
  const forward = unit(add(at, eye, -1));
  const right = unit(cross(forward, [0, 1, 0]));
  return { eye, right, up: cross(right, forward), forward, focal };
}

function create({ device, canvas, controls }) {
  const n = Math.max(16, Math.round(canvas.width / 7.5));
  const [height, width] = [2 * canvas.height, 2 * canvas.width]; // four samples in a pixel
  const points = Math.ceil((1.25 * width) / n); // of a link, so that they leave no gaps
  const samples = points * (n - 1) + 1;
  const stream = (type, ...shape) => device.stream(type, shape);
  const [x, oldx, normal] = [0, 1, 2].map(() => stream('float3', n, n));
  const [colour, depth, shadow, picture] = [stream('float3', height, width), stream('float', height, width), stream('float', width, width), stream('float3', height / 2, width / 2)];
  x.write(flat(n));
  x.copyTo(oldx);
  const camera = lookAt([2.6, 1.7, 2.2], [-0.1, 0.5, 0.1], 1.5 * width);
  const lamp = lookAt([-1.2, 5, 3], [-0.1, 0.3, 0], 1.7 * width);
  const scene = { ...ball, centre: [-0.2, 0.55, 0.15] };
  return {
    elements: n * n,
    x,
    step: () => step(coefficientsOf(n, controls.get('stiffness')), { ...scene, friction: controls.get('friction') }, x, oldx),
    draw() {
      const light = { lamp, shadow };
      cloth.normals(x, normal);
      shadow.fill(1e30);
      cloth.drawDepth.over([samples, samples])(lamp, 1 / points, x, shadow);
      cloth.drawScene(camera, light, scene, colour, depth);
      cloth.drawDepth.over([samples, samples])(camera, 1 / points, x, depth);
      cloth.drawCloth.over([samples, samples])(camera, light, 1 / points, (n - 1) / squares, x, normal, depth, colour);
      cloth.sum(colour, picture);
      cloth.develop(picture, picture);
      device.draw(picture, canvas);
    },
    /** The ball follows the pointer, in the plane that faces the camera. */
    point(event) {
      if (event.kind !== 'move') return;
      const away = dot(add(scene.centre, camera.eye, -1), camera.forward) / camera.focal;
      const [right, down] = [(event.x - event.lastX) * width * away, (event.y - event.lastY) * height * away];
      const to = add(add(scene.centre, camera.right, right), camera.up, -down);
      scene.centre = [Math.min(Math.max(to[0], -1.5), 1), Math.min(Math.max(to[1], 0.2), 1.4), Math.min(Math.max(to[2], -1), 1)];
    },
  };
}

/** A step in doubles: the formulas of cloth.sk, particle by particle. */
function referenceStep({ x, oldx }, n, c, scene) {
  let next = x.map((p, i) => add(add(p, add(p, oldx[i], -1), c.keep), c.a));
  const leave = (p, old, normal, depth) => {
    if (depth <= 0) return p;
    const out = add(p, normal, depth);
    const way = add(out, old, -1);
    const slip = add(way, normal, -dot(way, normal));
    return add(out, slip, -Math.min((scene.friction * depth) / Math.max(Math.hypot(...slip), 1e-30), 1));
  };
  const links = [[1, 0], [0, 1], [1, 1], [1, -1], [2, 0], [0, 2]].flatMap(([dx, dy]) => [[dx, dy], [-dx, -dy]]);
  for (let round = 0; round < rounds; ++round) {
    next = next.map((p, i) => {
      let moved = p;
      for (const [dx, dy] of links) {
        const [column, row] = [(i % n) + dx, Math.floor(i / n) + dy];
        if (Math.min(column, row) < 0 || Math.max(column, row) >= n) continue;
        const delta = add(next[row * n + column], p, -1);
        moved = add(moved, delta, c.stiffness * (1 - (Math.hypot(dx, dy) * c.restlength) / Math.hypot(...delta)));
      }
      const out = add(moved, scene.centre, -1);
      moved = leave(moved, x[i], unit(out), scene.radius + scene.thickness - Math.hypot(...out));
      return leave(moved, x[i], [0, 1, 0], scene.level + scene.thickness - moved[1]);
    });
  }
  return { x: next, oldx: x };
}

async function* measure(tools) {
  const { device, simulation } = tools;
  const [n, steps, scene] = [16, 8, { ...ball, centre: [0, 0.75, 0] }];
  const c = coefficientsOf(n, 0.125);
  const first = flat(n);
  const particles = Array.from({ length: n * n }, (_, i) => [...first.subarray(3 * i, 3 * i + 3)]);
  let exact = { x: particles, oldx: particles };
  for (let i = 0; i < steps; ++i) exact = referenceStep(exact, n, c, scene);
  const streams = (shape) => ({ x: device.stream('float3', shape), oldx: device.stream('float3', shape) });
  yield* compareSteps(tools, {
    ways: [
      ['floats', ({ x, oldx }) => () => step(c, scene, x, oldx)],
      ['halves between steps', ({ x, oldx }) => {
        const halves = new InHalves(device, [x, oldx], 'half3');
        return () => halves.step(() => step(c, scene, x, oldx));
      }],
    ],
    steps,
    note: `${steps} steps of ${n} × ${n} particles`,
    small() {
      const made = streams([n, n]);
      made.x.write(first);
      made.oldx.write(first);
      return made;
    },
    large: () => streams(simulation.x.shape),
    result: ({ x }) => x.read(),
    exact: exact.x.flat(),
  });
}

openPage({
  width: 480,
  aspect: 0.75,
  steps: 12,
  help: 'Drag the ball under the cloth. Keys: hold Space and press the arrows, P pauses.',
  controls: [
    { name: 'stiffness', label: 'Part of a length that a round corrects', range: [0.02, 0.16, 0.01], value: 0.15, show: (x) => x.toFixed(2) },
    { name: 'friction', label: 'Friction', range: [0, 1, 0.05], value: 0.4, show: (x) => x.toFixed(2) },
  ],
  sources: ['sk/classics/cloth.sk'],
  create,
  accuracy: {
    note: 'The same steps with positions of floats and of halves, against doubles in JavaScript. A velocity is the difference of two positions, of which halves have 11 bits. ' +
      'Times are those of a step of the picture, with the conversions.',
    measure,
  },
});
