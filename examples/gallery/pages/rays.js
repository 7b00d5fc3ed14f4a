// SPDX-License-Identifier: MIT
//
// Path tracing by the kernel of examples/applications/rays: one sample for every pixel in a step, and the sum of all since the view has changed. The
// module has the program for a list of pixels; the list here has all of them.
import { openPage } from '../page.js';
import { sceneOf } from '../rays_scene.js';
import { collect } from '../sk/gallery/collect.sk.js';
import { rays_kernels as rays } from '../sk/rays/path.sk.js';
import { add, cross, scaled, unit } from '../vectors.js';

const sobol = 1; // of sampling.sk
const enough = 4000; // samples of a pixel

/** A camera that looks at `to` from a direction; see viewOf() in examples/applications/rays/camera.cpp. */
function viewOf({ turn, height, distance }, [rows, width], lens) {
  const to = [0, 0.26, 0];
  const out = [Math.sin(turn) * Math.cos(height), Math.sin(height), Math.cos(turn) * Math.cos(height)];
  const origin = add(to, out, distance);
  const forward = scaled(out, -1);
  const right = unit(cross(forward, [0, 1, 0]));
  const up = cross(right, forward);
  const tall = 2 * Math.tan(0.3);
  const wide = (tall * width) / rows;
  const corner = add(add(forward, right, -0.5 * wide), up, 0.5 * tall);
  return { origin, corner, across: scaled(right, wide), down: scaled(up, -tall), lensX: scaled(right, lens), lensY: scaled(up, -lens), focus: distance - 0.25, size: [width, rows] };
}

/** The pixels of a picture, row by row. */
function pixelsOf(device, rows, columns) {
  const pixels = device.stream('int2', [rows * columns]);
  pixels.write(Int32Array.from({ length: 2 * rows * columns }, (_, i) => (i % 2 === 0 ? (i / 2) % columns : Math.floor(i / 2 / columns))));
  return pixels;
}

/** One sample of every pixel of the list. */
function sampleInto(radiance, pixels, { scene, hierarchy }, view, sample, depth) {
  rays.followPaths(scene, hierarchy, { view, pixels, depth, sampling: sobol, sample, seed: 1 }, radiance);
}

function create({ device, canvas, controls, random, tell }) {
  const shape = [canvas.height, canvas.width];
  const [radiance, sum] = [0, 1].map(() => device.stream('float3', [canvas.height * canvas.width]));
  const colour = device.stream('float3', shape);
  const pixels = pixelsOf(device, ...shape);
  const scene = sceneOf(device, random);
  const camera = { turn: 0.25, height: 0.3, distance: 3.4 };
  let samples = 0;
  const lookAnew = () => {
    samples = 0;
    collect.clear(sum);
  };
  lookAnew();
  return {
    elements: radiance.size,
    radiance,
    scene,
    viewOf: (shape) => viewOf(camera, shape, controls.get('lens')),
    step() {
      if (samples >= enough) return;
      sampleInto(radiance, pixels, scene, this.viewOf(shape), samples++, controls.get('depth'));
      collect.add(radiance, sum, sum);
    },
    draw() {
      collect.develop((2 ** controls.get('exposure')) / Math.max(samples, 1), sum, colour);
      device.draw(colour, canvas);
      tell(`${samples} samples of every pixel`);
    },
    changed: (name) => name !== 'exposure' && lookAnew(),
    point({ kind, x, y, lastX, lastY }) {
      if (kind !== 'move') return;
      camera.turn -= 3 * (x - lastX);
      camera.height = Math.min(Math.max(camera.height + 2 * (y - lastY), 0.03), 1.4);
      lookAnew();
      this.step();
    },
  };
}

/** Sums of samples in three types, against the sum of the same samples in JavaScript. */
async function* measure({ device, simulation, time }) {
  const [rows, columns, samples] = [10, 16, 32];
  const shapes = [[rows * columns], simulation.radiance.shape];
  const pixels = pixelsOf(device, rows, columns);
  const [sample, largeSample] = shapes.map((shape) => device.stream('float3', shape));
  const exact = new Float64Array(3 * rows * columns);
  const ways = [['float', collect.add], ['half', collect.addHalf], ['double', collect.addDouble]];
  const sums = ways.map(([type]) => device.stream(`${type}3`, shapes[0]));
  for (let i = 0; i < samples; ++i) {
    sampleInto(sample, pixels, simulation.scene, simulation.viewOf([rows, columns]), i, 6);
    ways.forEach(([, addTo], k) => addTo(sample, sums[k], sums[k]));
    (await sample.read()).forEach((x, n) => (exact[n] += x));
  }
  for (const [k, [type, addTo]] of ways.entries()) {
    const got = await sums[k].read();
    const error = got.reduce((most, x, n) => Math.max(most, Math.abs(x - exact[n]) / Math.max(exact[n], 1e-6)), 0);
    const large = device.stream(`${type}3`, shapes[1]);
    const ms = await time(() => addTo(largeSample, large, large));
    yield { choice: type === 'double' ? 'sums of doubles, as pairs of floats' : `sums of ${type === 'half' ? 'halves' : 'floats'}`, note: `${samples} samples of ${columns} × ${rows} pixels`, ms, error };
    large.dispose();
  }
  for (const stream of [sample, largeSample, pixels, ...sums]) stream.dispose();
}

openPage({
  width: 640,
  aspect: 0.625,
  steps: 4,
  help: 'Drag to turn the scene. Keys: hold Space and press the arrows, P pauses.',
  controls: [
    { name: 'exposure', label: 'Exposure, stops', range: [-3, 3, 0.1], value: 0.4, show: (x) => x.toFixed(1) },
    { name: 'lens', label: 'Radius of the lens', range: [0, 0.12, 0.005], value: 0.03, show: (x) => x.toFixed(3) },
    { name: 'depth', label: 'Segments of a path', range: [1, 12, 1], value: 8 },
  ],
  sources: ['sk/rays/path.sk', 'sk/rays/scene.sk', 'sk/rays/segment.sk', 'sk/rays/traverse.sk', 'sk/rays/scattering.sk', 'sk/rays/sampling.sk', 'sk/gallery/collect.sk'],
  create,
  accuracy: {
    note: 'Sums of samples in three types, against the sum of the same samples in JavaScript’s doubles. Errors are relative to each sum; times are those of adding one sample ' +
      'for every pixel of the picture.',
    measure,
  },
});
