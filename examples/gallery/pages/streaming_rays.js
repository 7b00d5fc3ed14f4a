// SPDX-License-Identifier: MIT
//
// The streaming ray tracer, by the kernels of examples/classics/streaming_rays: its four uses, on a machine that branches, which makes a sample for
// each pixel in a step, or on one that does not, which makes one or two passes in a step.
import { relativeError } from '../accuracy.js';
import { landscapeOn } from '../landscape.js';
import { openPage } from '../page.js';
import { streaming_rays as rays, streaming_rays_Ray, streaming_rays_Walk } from '../sk/classics/streaming_rays.sk.js';
import { collect } from '../sk/gallery/collect.sk.js';
import { unit } from '../vectors.js';

const uses = ['Ray casting', 'Shadow casting', 'Whitted', 'Path tracing'];
const enough = 4000; // samples of a pixel

const raysOf = (device, shape) => ({ ray: device.stream(streaming_rays_Ray, shape), walk: device.stream(streaming_rays_Walk, shape) });

/** Passes of the machine without branches, by a kernel that many rays wait for, or null if all rays are done. It shades soon, so that the picture grows;
 *  other kernels make two passes, since the page waits for the numbers of rays. */
async function advance(scene, { ray, walk }) {
  const [traversing, intersecting, shading] = await rays.count(walk);
  const waiting = { traversing, intersecting, shading };
  if (traversing + intersecting + shading === 0) return null;
  if (8 * shading >= traversing + intersecting) {
    rays.shade(scene, ray, walk, ray, walk);
    return { ...waiting, passes: 1 };
  }
  const kernel = 4 * intersecting >= traversing ? rays.intersect : rays.traverse;
  for (let i = 0; i < 2; ++i) kernel(scene, ray, walk, walk);
  return { ...waiting, passes: 2 };
}

function create({ device, canvas, controls, tell, prepared }) {
  const shape = [canvas.height, canvas.width];
  const [sum, shown, colour] = [0, 1, 2].map(() => device.stream('float3', shape));
  const state = raysOf(device, shape);
  const camera = { eye: [0, 0.3, 1.5], sun: [-0.6, 0.64, 0.48] };
  let [samples, passes] = [0, 0]; // passes: of the sample on its way
  let waiting = null;
  let isStale = true;
  const scene = () => ({ ...prepared, ...camera, sample: samples, use: Number(controls.get('use')) });
  const lookAnew = () => (isStale = true);
  return {
    elements: sum.size,
    shape,
    scene,
    async step() {
      if (isStale) {
        [samples, passes, waiting, isStale] = [0, 0, null, false];
        sum.fill([0, 0, 0]);
      }
      if (samples >= enough) return;
      if (controls.get('machine') === 'branching') {
        rays.trace(scene(), sum, sum);
        ++samples;
        return;
      }
      if (passes === 0) rays.generate(scene(), state.ray, state.walk);
      waiting = await advance(scene(), state);
      passes += waiting?.passes ?? 0;
      if (waiting !== null) return;
      rays.colourOf(state.ray, shown);
      collect.add(shown, sum, sum);
      ++samples;
      passes = 0;
    },
    draw() {
      const isOnTheWay = passes > 0;
      if (isOnTheWay) {
        rays.colourOf(state.ray, shown);
        collect.add(shown, sum, shown);
      }
      collect.average(Math.max(samples + isOnTheWay, 1), isOnTheWay ? shown : sum, colour);
      device.draw(colour, canvas);
      const ways = waiting && `, pass ${passes}: ${waiting.traversing} rays traverse, ${waiting.intersecting} intersect, ${waiting.shading} shade`;
      tell(`${samples} samples of every pixel${ways ?? ''}`);
    },
    changed: lookAnew,
    point({ kind, x, y, lastX, lastY, isErasing }) {
      if (kind !== 'move') return;
      const { eye, sun } = camera;
      if (isErasing) camera.sun = unit([sun[0] + 2 * (x - lastX), Math.max(sun[1] - 2 * (y - lastY), 0.1), sun[2]]);
      else camera.eye = [Math.min(Math.max(eye[0] - (x - lastX), -0.9), 0.9), Math.min(Math.max(eye[1] + (y - lastY), 0.05), 1), eye[2]];
      lookAnew();
    },
  };
}

/** Sums of samples in floats and in halves, against the sum of the same samples in JavaScript, and one machine against the other. */
async function* measure({ device, simulation, time }) {
  const [n, samples] = [16, 8];
  const stream = (type, shape) => device.stream(type, shape);
  const [sample, floats, halves, none] = ['float3', 'float3', 'half3', 'float3'].map((type) => stream(type, [n, n]));
  const [large, largeHalves, zero] = ['float3', 'half3', 'float3'].map((type) => stream(type, simulation.shape));
  const exact = new Float64Array(3 * n * n);
  for (let i = 0; i < samples; ++i) {
    const scene = { ...simulation.scene(), sample: i };
    rays.trace(scene, floats, floats);
    rays.trace(scene, none, sample);
    collect.addHalf(sample, halves, halves);
    (await sample.read()).forEach((x, k) => (exact[k] += x));
  }
  const errorOf = (got) => got.reduce((most, x, k) => Math.max(most, Math.abs(x - exact[k]) / Math.max(exact[k], 1e-6)), 0);
  const note = `${samples} samples of ${n} × ${n} pixels`;
  yield { choice: 'sums of floats', note, ms: await time(() => collect.add(zero, large, large)), error: errorOf(await floats.read()) };
  yield { choice: 'sums of halves', note, ms: await time(() => collect.addHalf(zero, largeHalves, largeHalves)), error: errorOf(await halves.read()) };

  const casting = { ...simulation.scene(), sample: 0, use: 0 };
  const ms = await time(() => rays.trace(casting, zero, large));
  const branching = await large.read();
  const state = raysOf(device, simulation.shape);
  const start = performance.now();
  rays.generate(casting, state.ray, state.walk);
  let passes = 1;
  for (let done; (done = await advance(casting, state)) !== null; ) passes += done.passes;
  const took = performance.now() - start;
  rays.colourOf(state.ray, large);
  const error = relativeError(await large.read(), branching);
  yield { choice: 'rays cast on the branching machine', ms, error: 0 };
  yield { choice: `rays cast in ${passes} passes`, note: 'error: against the branching machine', ms: took, error };
  for (const made of [sample, floats, halves, none, large, largeHalves, zero, ...Object.values(state)]) made.dispose();
}

openPage({
  width: 480,
  steps: 4,
  help: 'Drag to move the eye, with Shift or the second button the sun. Keys: hold Space and press the arrows, P pauses.',
  prepare: landscapeOn,
  controls: [
    { name: 'use', label: 'Use', choices: uses.map((name, i) => [String(i), name]), value: '2' },
    { name: 'machine', label: 'Machine', choices: [['branching', 'With branches: a sample in a step'], ['passes', 'Without branches: in many passes']], value: 'branching' },
  ],
  sources: ['sk/classics/streaming_rays.sk', 'sk/gallery/collect.sk'],
  create,
  accuracy: {
    note: 'Sums of samples in floats and in halves, against the sum of the same samples in JavaScript’s doubles, and the picture by ray casting on each of the paper’s two ' +
      'machines. Errors of sums are relative to each sum; times are those of the picture.',
    measure,
  },
});
