// SPDX-License-Identifier: MIT
//
// Canny's edges by the kernels of examples/applications/edges, of a drawing, a picture of the visitor's, or the camera.
import { relativeError } from '../accuracy.js';
import { hueWheel } from '../colours.js';
import { RoundToHalves } from '../field.js';
import { openPage } from '../page.js';
import { edges } from '../sk/edges/edges.sk.js';
import { drawStillLife } from '../still_life.js';

const mostLinks = 24; // steps of linking in a frame
const mostRadius = 16;

/** The light of each code of sRGB (IEC 61966-2-1). */
const linear = Float32Array.from({ length: 256 }, (_, code) => (code / 255 < 0.04045 ? code / 255 / 12.92 : ((code / 255 + 0.055) / 1.055) ** 2.4));

/** A Gaussian's weights for 0, 1, ... pixels away; the table has always the same length. */
function weightsOf(sigma) {
  const radius = Math.min(Math.ceil(3 * sigma), mostRadius);
  const bell = Array.from({ length: radius + 1 }, (_, i) => Math.exp(-0.5 * (i / sigma) ** 2));
  const sum = 2 * bell.reduce((a, b) => a + b) - bell[0];
  const weights = new Float32Array(mostRadius + 1);
  weights.set(bell.map((height) => height / sum));
  return { radius, weights };
}

/** Red, green and blue of each pixel. */
function codesOf({ data }) {
  const codes = new Int32Array((data.length / 4) * 3);
  for (let from = 0, to = 0; from < data.length; from += 4) {
    codes[to++] = data[from];
    codes[to++] = data[from + 1];
    codes[to++] = data[from + 2];
  }
  return codes;
}

/** The streams of one size of pictures, and what runs over them. */
class Detector {
  constructor(device, rows, columns) {
    const shape = [rows, columns];
    this.size = rows * columns;
    this.pixels = device.stream('int3', shape);
    this.linear = device.stream('float', [256]);
    this.linear.write(linear);
    this.weights = device.stream('float', [mostRadius + 1]);
    for (const name of ['grey', 'half', 'blurred', 'steepness', 'ridge', 'edge']) this[name] = device.stream('float', shape);
    this.slope = device.stream('float2', shape);
    this.mark = device.stream('int', shape);
    this.blurBy(1.4);
  }

  blurBy(sigma) {
    const { radius, weights } = weightsOf(sigma);
    this.radius = radius;
    this.weights.write(weights);
  }

  slopes() {
    edges.luminance(this.pixels, this.linear, this.grey);
    edges.blur(false, this.radius, this.weights, this.grey, this.half);
    edges.blur(true, this.radius, this.weights, this.half, this.blurred);
    edges.sobel(this.blurred, this.slope, this.steepness);
  }

  link(low, high) {
    edges.thin(this.slope, this.steepness, this.ridge);
    edges.classify(this.ridge, low, high, this.mark);
    for (let i = 0; i < mostLinks; ++i) edges.link(this.mark, this.mark);
    edges.keep(this.ridge, this.mark, this.edge);
  }

  dispose() {
    for (const stream of Object.values(this)) stream?.dispose?.();
  }
}

/** Where pictures come from: a canvas of the size of the result, which something is drawn to. */
class Source {
  constructor(width, height) {
    this.canvas = Object.assign(document.createElement('canvas'), { width, height });
    this.drawing = this.canvas.getContext('2d', { willReadFrequently: true });
    this.video = null;
    drawStillLife(this.drawing, width, height);
    this.isNew = true;
  }

  /** Draws a picture so that it fills the canvas. */
  fill(picture, width, height, isMirrored) {
    const { canvas, drawing } = this;
    const scale = Math.max(canvas.width / width, canvas.height / height);
    drawing.save();
    drawing.fillStyle = '#fff';
    drawing.fillRect(0, 0, canvas.width, canvas.height);
    drawing.translate(canvas.width / 2, canvas.height / 2);
    if (isMirrored) drawing.scale(-1, 1);
    drawing.drawImage(picture, (-width * scale) / 2, (-height * scale) / 2, width * scale, height * scale);
    drawing.restore();
    this.isNew = true;
  }

  async open(file) {
    const picture = await createImageBitmap(file).catch(() => {
      throw new Error(`'${file.name}' is no picture that this browser reads; take a PNG, JPEG or WebP file`);
    });
    this.stop();
    this.fill(picture, picture.width, picture.height, false);
  }

  async film() {
    if (!navigator.mediaDevices) throw new Error('browsers give the camera only to pages from https or localhost; open this page from there');
    const stream = await navigator.mediaDevices.getUserMedia({ video: { width: { ideal: 1280 } } }).catch((error) => {
      throw new Error(`the camera is not to be had (${error.message}); allow it in the address bar, or drop a picture here`);
    });
    this.video = Object.assign(document.createElement('video'), { srcObject: stream, muted: true, playsInline: true });
    await this.video.play();
  }

  stop() {
    for (const track of this.video?.srcObject.getTracks() ?? []) track.stop();
    this.video = null;
  }

  /** Codes of a new picture, or null. */
  take() {
    if (this.video !== null) this.fill(this.video, this.video.videoWidth, this.video.videoHeight, true);
    if (!this.isNew) return null;
    this.isNew = false;
    return codesOf(this.drawing.getImageData(0, 0, this.canvas.width, this.canvas.height));
  }
}

function acceptDrops(frame, open) {
  const over = (isOver) => (event) => {
    event.preventDefault();
    frame.classList.toggle('dropping', isOver);
  };
  frame.ondragover = over(true);
  frame.ondragleave = over(false);
  frame.ondrop = (event) => {
    over(false)(event);
    if (event.dataTransfer.files.length > 0) open(event.dataTransfer.files[0]);
  };
}

function create({ device, canvas, controls, tell, redraw, page }) {
  const detector = new Detector(device, canvas.height, canvas.width);
  const source = new Source(canvas.width, canvas.height);
  const isDark = matchMedia('(prefers-color-scheme: dark)');
  const inks = device.stream('float3', [24]);
  const colour = device.stream('float3', [canvas.height, canvas.width]);

  function step() {
    const codes = source.take();
    if (codes !== null) detector.pixels.write(codes);
    detector.slopes();
    detector.link(0.6 * controls.get('threshold'), controls.get('threshold'));
  }
  const changed = () => {
    detector.blurBy(controls.get('sigma'));
    step();
    redraw();
  };
  const guarded = (work) => work.then(changed, (error) => tell(error.message[0].toUpperCase() + error.message.slice(1)));
  acceptDrops(document.getElementById('frame'), (file) => guarded(source.open(file)));
  detector.blurBy(controls.get('sigma'));

  return {
    elements: detector.size,
    detector,
    step,
    draw() {
      const shown = controls.get('shown');
      if (shown === 'light') return device.draw(detector.blurred, canvas, { map: 'gray' });
      if (shown === 'steepness') return device.draw(detector.steepness, canvas, { map: 'magma', range: [0, 0.08] });
      inks.write(hueWheel(24, isDark.matches ? 0.8 : 0.55, 0.13));
      edges.paint(detector.slope, detector.edge, 1 / controls.get('threshold'), isDark.matches ? [0.05, 0.06, 0.08] : [0.99, 0.985, 0.97], inks, colour);
      device.draw(colour, canvas);
    },
    async changed(name) {
      if (name === 'camera' && source.video === null) {
        await guarded(source.film().then(() => {
          controls.put('camera', 'Stop the camera');
          if (!page.loop.isPlaying) page.toggle();
        }));
      } else if (name === 'camera') {
        source.stop();
        controls.put('camera', 'Use the camera');
      } else if (name === 'file' && controls.get('file') !== null) {
        await guarded(source.open(controls.get('file')));
      } else {
        changed();
      }
    },
    dispose: () => source.stop(),
  };
}

/** The steepness in doubles; clamped at the rim, as the kernels. */
function referenceSteepness(codes, rows, columns, { radius, weights }) {
  const make = (value) => Float64Array.from({ length: rows * columns }, (_, i) => value(i % columns, Math.floor(i / columns)));
  const at = (a, x, y) => a[Math.min(Math.max(y, 0), rows - 1) * columns + Math.min(Math.max(x, 0), columns - 1)];
  const [red, green, blue] = [0.2126, 0.7152, 0.0722];
  const light = (i) => red * linear[codes[3 * i]] + green * linear[codes[3 * i + 1]] + blue * linear[codes[3 * i + 2]];
  const blur = (a, dx, dy) => make((x, y) => {
    let sum = weights[0] * at(a, x, y);
    for (let i = 1; i <= radius; ++i) sum += weights[i] * (at(a, x + i * dx, y + i * dy) + at(a, x - i * dx, y - i * dy));
    return sum;
  });
  const b = blur(blur(make((x, y) => light(y * columns + x)), 1, 0), 0, 1);
  return make((x, y) => {
    const side = (dx) => at(b, x + dx, y - 1) + 2 * at(b, x + dx, y) + at(b, x + dx, y + 1);
    const line = (dy) => at(b, x - 1, y + dy) + 2 * at(b, x, y + dy) + at(b, x + 1, y + dy);
    return Math.hypot(side(1) - side(-1), line(1) - line(-1)) / 8;
  });
}

async function* measure({ device, simulation, time }) {
  const [rows, columns] = [36, 48];
  const picture = new Source(columns, rows).take();
  const exact = referenceSteepness(picture, rows, columns, weightsOf(1.4));
  const small = new Detector(device, rows, columns);
  small.pixels.write(picture);
  for (const [choice, isHalf] of [['floats', false], ['halves between passes', true]]) {
    const run = (detector) => {
      if (!isHalf) return () => detector.slopes();
      const rounded = new RoundToHalves(device, detector.grey.shape);
      return () => {
        edges.luminance(detector.pixels, detector.linear, detector.grey);
        rounded.pass(detector.grey);
        edges.blur(false, detector.radius, detector.weights, detector.grey, detector.half);
        rounded.pass(detector.half);
        edges.blur(true, detector.radius, detector.weights, detector.half, detector.blurred);
        rounded.pass(detector.blurred);
        edges.sobel(detector.blurred, detector.slope, detector.steepness);
      };
    };
    run(small)();
    const error = relativeError(await small.steepness.read(), exact);
    yield { choice, note: `steepness of a picture of ${columns} × ${rows} pixels`, ms: await time(run(simulation.detector)), error };
  }
  small.dispose();
}

openPage({
  width: 720,
  aspect: 0.75,
  steps: 1,
  help: 'Drop a picture here, choose a file, or use the camera. Key: P pauses.',
  controls: [
    { name: 'sigma', label: 'Blur, pixels', range: [0.6, 5, 0.1], value: 1.4, show: (x) => x.toFixed(1) },
    { name: 'threshold', label: 'Steepness of an edge', range: [0.004, 0.06, 0.001], value: 0.011, show: (x) => x.toFixed(3) },
    { name: 'shown', label: 'Shown', choices: [['edges', 'Edges, in the colour of their direction'], ['steepness', 'Steepness'], ['light', 'Light, blurred']], value: 'edges' },
    { name: 'file', label: 'A picture of yours', accept: 'image/*' },
    { name: 'camera', label: 'Use the camera' },
  ],
  sources: ['sk/edges/edges.sk'],
  create,
  accuracy: {
    note: 'Light, blur and slopes with floats and with halves between the passes, against doubles in JavaScript. Times are those of the passes over the picture, with the ' +
      'conversions; errors are relative to the steepest place.',
    measure,
  },
});
