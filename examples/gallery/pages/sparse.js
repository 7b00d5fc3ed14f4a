// SPDX-License-Identifier: MIT
//
// A flow that smooths a surface, by the kernels of examples/classics/sparse: in each step, conjugate gradients solve a sparse system for three
// coordinates. The picture is drawn by mesh_view.js, in a context of its own.
import { relativeError } from '../accuracy.js';
import { matrixOf, meshOf } from '../knot.js';
import { MeshView } from '../mesh_view.js';
import { oneAtATime } from '../one_at_a_time.js';
import { openPage } from '../page.js';
import { sparse } from '../sk/classics/sparse.sk.js';

const enough = 300; // steps, before the tube is a thread
const aroundOf = (width) => Math.max(8, Math.round(width / 12));

function vectorsOf(device, { shape, Ca }) {
  const made = { Ax: device.stream('float', shape), Aa: device.stream('float', Ca.shape) };
  for (const name of ['x', 'b', 'r', 'p', 'q']) made[name] = device.stream('float3', shape);
  return made;
}

/** The system of a step: (M + dt K) x = b. dt is in squares of the length of an edge. */
const assemble = ({ around, count, Rx, Ca }, { x, Ax, Aa, b }, dt) => sparse.assemble((10 * dt) / around ** 2, count, Rx, Ca, x, x, Ax, Aa, b);

/** Conjugate gradients from x on; promises what is left of the right-hand side. */
async function solve({ count, Rx, Ca }, { Ax, Aa, x, b, r, p, q }, iterations) {
  const multiply = (v) => sparse.multiplyAny(count, Ax, Rx, Aa, Ca, v, v, q);
  multiply(x);
  const [bb, first] = await sparse.start(b, q, r, p);
  let rr = first;
  for (let i = 0; i < iterations; ++i) {
    multiply(p);
    const pq = await sparse.inner(p, q);
    const next = await sparse.advance(rr, pq, p, q, x, r, x, r);
    sparse.turn(next, rr, r, p, p);
    rr = next;
  }
  return Math.sqrt(Math.max(...rr.map((value, c) => value / bb[c])));
}

function create({ device, canvas, controls, tell, prepared: matrix }) {
  const v = vectorsOf(device, matrix);
  const view = (canvas.view ??= new MeshView(canvas, [0, 0, 3.1], 0.66));
  const camera = { turn: 0.3, tilt: 0.2 };
  let [steps, left] = [0, 0];
  const roughen = () => {
    steps = 0;
    sparse.knot(matrix.around, matrix.vertex, v.x);
  };
  roughen();
  const mesh = view.mesh(8 * matrix.around + 1, matrix.around + 1);
  return {
    elements: matrix.vertex.size,
    matrix,
    v,
    async step() {
      if (steps === enough) return;
      ++steps;
      await assemble(matrix, v, controls.get('dt'));
      left = await solve(matrix, v, controls.get('iterations'));
    },
    draw: oneAtATime(async () => {
      const { positions, normals } = meshOf(await v.x.read(), matrix, camera.turn, camera.tilt);
      view.fill(mesh, positions, normals);
      view.draw(mesh);
      tell(`${matrix.vertex.size.toLocaleString('en')} rows with ${matrix.Ca.size.toLocaleString('en')} entries off the diagonal. Step ${steps} leaves ${left.toExponential(1)} of its right-hand side.`);
    }),
    changed: (name) => name === 'rough' && roughen(),
    point({ kind, x, y, lastX, lastY }) {
      if (kind !== 'move') return;
      camera.turn += 3 * (x - lastX);
      camera.tilt = Math.min(Math.max(camera.tilt - 2 * (y - lastY), -1.5), 1.5);
    },
  };
}

/** A x = b in doubles, with the matrix of the device, by Jacobi's iteration to the last bits. */
async function solved({ shape, count, Rx, Ca }, { Ax, Aa, b }, first) {
  const [length, start, to, diagonal, entry, right] = await Promise.all([count, Rx, Ca, Ax, Aa, b].map((stream) => stream.read()));
  let x = Float64Array.from(first);
  for (let round = 0; round < 400; ++round) {
    x = x.map((_, k) => {
      const i = Math.floor(k / 3);
      if (length[i] === 0) return 0;
      let sum = right[k];
      for (let j = start[i]; j < start[i] + length[i]; ++j) sum -= entry[j] * x[3 * (to[2 * j + 1] * shape[1] + to[2 * j]) + (k % 3)];
      return sum / diagonal[i];
    });
  }
  return x;
}

async function* measure({ device, simulation, timeAnswer }) {
  const matrix = await matrixOf(device, 8);
  const [v, large] = [vectorsOf(device, matrix), vectorsOf(device, simulation.matrix)];
  sparse.knot(simulation.matrix.around, simulation.matrix.vertex, large.x);
  await assemble(simulation.matrix, large, 1);
  sparse.knot(matrix.around, matrix.vertex, v.x);
  const first = await v.x.read();
  await assemble(matrix, v, 1);
  const exact = await solved(matrix, v, first);
  for (const iterations of [20, 10, 5]) {
    v.x.write(first);
    await solve(matrix, v, iterations);
    const error = relativeError(await v.x.read(), exact);
    yield { choice: `${iterations} iterations`, note: `a step of ${exact.length / 3} vertices`, ms: await timeAnswer(() => solve(simulation.matrix, large, iterations)), error };
  }
  const { vertex, count, Rx, Ca } = matrix;
  for (const stream of [vertex, count, Rx, Ca, ...Object.values(v), ...Object.values(large)]) stream.dispose();
}

openPage({
  width: 480,
  aspect: 0.625,
  steps: 1,
  help: 'Drag to turn the surface. Keys: hold Space and press the arrows, P pauses.',
  prepare: (device, width) => matrixOf(device, aroundOf(width)),
  controls: [
    { name: 'dt', label: 'Length of a step', range: [0.02, 2, 0.02], value: 0.06, show: (x) => x.toFixed(2) },
    { name: 'iterations', label: 'Iterations of a step', range: [2, 40, 1], value: 12 },
    { name: 'rough', label: 'Make it rough again' },
  ],
  sources: ['sk/classics/sparse.sk'],
  create,
  accuracy: {
    note: 'A step of the flow by conjugate gradients in floats, against doubles in JavaScript that solve the same system to the last bits. Times are those of solving for the ' +
      'picture, with two sums an iteration that the page waits for.',
    measure,
  },
});
