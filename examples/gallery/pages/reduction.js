// SPDX-License-Identifier: MIT
//
// The pyramid of passes by which the first GPU programs folded a square of numbers, by the kernels of examples/classics/reduction. The picture has the
// level that the visitor chooses, and all levels beside it.
import { downwards, stroke } from '../field.js';
import { openPage } from '../page.js';
import { reduction } from '../sk/classics/reduction.sk.js';

const passes = { sum: reduction.reduceSum, maximum: reduction.reduceMax };

/** n x n, n/2 x n/2, ... 1 x 1, where half of an odd extent is rounded up. */
function pyramidOf(device, n) {
  const levels = [device.stream('float', [n, n])];
  for (; n > 1; levels.push(device.stream('float', [n, n]))) n = Math.ceil(n / 2);
  return levels;
}

function fold(pass, levels) {
  for (let k = 1; k < levels.length; ++k) pass(levels[k - 1], levels[k]);
}

function create({ device, canvas, controls, tell }) {
  const n = Math.round((2 * canvas.width) / 3);
  const levels = pyramidOf(device, n);
  reduction.galaxy(2004, levels[0]);
  const drawing = canvas.getContext('2d');
  const scratch = levels.map(({ shape }) => new OffscreenCanvas(shape[1], shape[0]));
  const show = (k, ...place) => {
    const white = 0.4 * (controls.get('fold') === 'sum' ? 4 ** k : 1); // a sum is of 4^k elements
    device.draw(levels[k], scratch[k], { map: 'magma', range: [0, white] });
    drawing.drawImage(scratch[k], ...place);
  };
  let frames = 0;
  const report = async () => {
    const [sum, most] = await Promise.all([reduction.total(levels[0]), reduction.largest(levels[0])]);
    const [found] = await levels.at(-1).read();
    const by = controls.get('fold') === 'sum' ? [found, sum] : [found, most];
    tell(`The ${controls.get('fold')} of ${levels[0].size.toLocaleString('en')} elements: ${by[0].toPrecision(9)} by ${levels.length - 1} passes, ${by[1].toPrecision(9)} by the declaration`);
  };
  return {
    elements: levels[0].size,
    levels,
    step: () => fold(passes[controls.get('fold')], levels),
    draw() {
      drawing.imageSmoothingEnabled = false;
      drawing.fillStyle = '#000';
      drawing.fillRect(0, 0, canvas.width, canvas.height);
      show(Math.min(controls.get('level'), levels.length - 1), 0, 0, n, n);
      for (let [k, top] = [1, 0]; k < levels.length; top += n / 2 ** k++) show(k, n + 2, top, n / 2 ** k, n / 2 ** k - 2);
      if (frames++ % 20 === 0) report().catch(() => {});
    },
    point(event) {
      if (event.kind === 'up') return;
      const wide = (x) => (x * canvas.width) / n;
      stroke(downwards({ ...event, x: wide(event.x), lastX: wide(event.lastX) }), n / 40, [levels[0], event.isErasing ? 0 : 0.6, 0.8]);
      this.step();
    },
  };
}

/** The sum of floats in doubles, with what each addition loses (Knuth's TwoSum). */
function exactSum(values) {
  let [sum, lost] = [0, 0];
  for (const value of values) {
    const next = sum + value;
    const added = next - sum;
    lost += sum - (next - added) + (value - added);
    sum = next;
  }
  return sum + lost;
}

/** Sums whose elements cancel: those of a Laplacian on a torus. */
async function* measure({ device, simulation, timeAnswer }) {
  const levels = simulation.levels.map(({ shape }) => device.stream('float', shape));
  reduction.galaxy(2004, simulation.levels[0]);
  reduction.laplacian(simulation.levels[0], levels[0]);
  const elements = await levels[0].read();
  const exact = exactSum(elements);
  const declared = (accumulate) => () => reduction.total.with({ accumulate })(levels[0]);
  const ways = [
    ['compensated', declared('compensated')],
    ['tree', declared('tree')],
    [`the pyramid of ${levels.length - 1} passes`, async () => {
      fold(reduction.reduceSum, levels);
      return (await levels.at(-1).read())[0];
    }],
    ['extended', declared('extended')],
    ['exact', declared('exact')],
  ];
  for (const [choice, add] of ways) {
    const error = Math.abs((await add()) - exact) / Math.abs(exact);
    yield { choice, note: `${elements.length.toLocaleString('en')} elements, which cancel`, ms: await timeAnswer(add), error };
  }
  for (const stream of levels) stream.dispose();
}

openPage({
  width: 768,
  aspect: 2 / 3,
  steps: 1,
  help: 'Drag to paint light, with Shift or the second button to take it away. Keys: arrows move, Space paints, P pauses.',
  controls: [
    { name: 'fold', label: 'What a pass computes of 2 × 2 elements', choices: [['sum', 'Their sum'], ['maximum', 'Their maximum']], value: 'sum' },
    { name: 'level', label: 'Level on the left', range: [0, 9, 1], value: 0 },
  ],
  sources: ['sk/classics/reduction.sk', 'sk/gallery/brush.sk'],
  create,
  accuracy: {
    note: 'The sum of the differences of a galaxy’s pixels from their neighbours, which is 0 but for rounding errors, in five ways; against doubles in JavaScript. Errors are ' +
      'relative to the sum, times include its transfer to the host. The galaxy is painted anew for this.',
    measure,
  },
});
