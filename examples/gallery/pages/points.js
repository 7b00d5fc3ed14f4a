// SPDX-License-Identifier: MIT
//
// The ranks of the pages of a random web, by the kernels of examples/classics/points: a product with a sparse matrix draws each link as a point. The
// picture has the web, and the matrix beside it; both are drawn as points, too.
import { relativeError } from '../accuracy.js';
import { RoundToHalves } from '../field.js';
import { oneAtATime } from '../one_at_a_time.js';
import { openPage } from '../page.js';
import { points } from '../sk/classics/points.sk.js';
import { arraysOf, growWeb, pointsOf } from '../web_of_pages.js';

const best = 16; // pages whose links are drawn

/** y = A x. */
function multiply(vertices, x, y) {
  y.fill(0);
  points.clMatVec(vertices, x, y);
}

function multiplyByArrays(arrays, x, y) {
  y.fill(0);
  for (const array of arrays) points.clMatVec4(array, x, y);
}

function create({ device, canvas, controls, random, tell }) {
  const pixels = canvas.height;
  const side = Math.max(12, pixels >> 2);
  const n = side * side;
  const links = growWeb(side, random);
  const vertices = pointsOf(device, links);
  const [rank, y, change] = [[n], [n], [1]].map((shape) => device.stream('float', shape));
  const square = (type) => device.stream(type, [pixels, pixels]);
  const [entries, lines, discs, web] = [square('uint'), square('uint'), square('float'), square('float3')];
  const picture = device.stream('float3', [pixels, 2 * pixels]);
  rank.fill(1 / n);
  points.drawEntries(n, pixels, vertices, entries);
  points.paintEntries(entries, web);
  web.copyTo(picture.domain([0, pixels], [pixels, 2 * pixels]));
  return {
    elements: vertices.size,
    vertices,
    links,
    rank,
    step() {
      multiply(vertices, rank, y);
      points.surf(controls.get('follows'), n, y, rank, rank, change);
    },
    draw: oneAtATime(async () => {
      const [ranks, [moved]] = [await rank.read(), await change.read()];
      const least = ranks.slice().sort().at(-1 - best);
      lines.fill(0);
      discs.fill(0);
      await points.drawLinks(side, pixels, least, vertices, rank, lines);
      await points.drawPages(side, pixels, rank, discs);
      points.paintWeb(lines, discs, web);
      web.copyTo(picture.domain([0, 0], [pixels, pixels]));
      device.draw(picture, canvas);
      tell(`${links.length.toLocaleString('en')} links of ${n.toLocaleString('en')} pages. The last step has moved ${(100 * moved).toPrecision(2)} % of the surfers.`);
    }),
    /** All surfers begin at the page that is pressed, in the web or by its row in the matrix. */
    point({ kind, x, y }) {
      if (kind === 'up') return;
      const last = (count, place) => Math.min(Math.floor(count * place), count - 1);
      const page = x < 0.5 ? last(side, y) * side + last(side, 2 * x) : last(n, y);
      rank.write(Float32Array.from({ length: n }, (_, i) => (i === page ? 1 : 0)));
      change.fill(0);
    },
  };
}

async function* measure({ device, simulation, time }) {
  const side = 12;
  const n = side * side;
  let state = 7;
  const links = growWeb(side, () => (state = (state * 16807) % 2147483647) / 2147483647);
  const [x, y] = [0, 1].map(() => device.stream('float', [n]));
  const largeY = device.stream('float', simulation.rank.shape);
  const ranks = Float32Array.from({ length: n }, (_, i) => 1 / (3 + ((i * 37) % 101)));
  x.write(ranks);
  const exact = new Float64Array(n);
  for (const { position, texcoord, colour } of links) exact[position] += colour * ranks[texcoord];
  const [vertices, arrays, largeArrays] = [pointsOf(device, links), arraysOf(device, links), arraysOf(device, simulation.links)];
  const byPoints = () => multiply(simulation.vertices, simulation.rank, largeY);
  const ways = [
    ['points in order', () => multiply(vertices, x, y), byPoints],
    ['points in order, ranks in halves', () => {
      new RoundToHalves(device, x.shape).pass(x);
      multiply(vertices, x, y);
      x.write(ranks);
    }, byPoints],
    [`${largeArrays.length} arrays of points of four links`, () => multiplyByArrays(arrays, x, y), () => multiplyByArrays(largeArrays, simulation.rank, largeY)],
  ];
  for (const [choice, few, many] of ways) {
    few();
    const error = relativeError(await y.read(), exact);
    yield { choice, note: `a product with ${links.length} entries`, ms: await time(many), error };
  }
  for (const stream of [x, y, largeY, vertices, ...arrays, ...largeArrays]) stream.dispose();
}

openPage({
  width: 800,
  aspect: 0.5,
  steps: 1,
  help: 'Press on a page in the web, or on its row in the matrix: all surfers start there. Keys: arrows move, Space presses, P pauses.',
  controls: [
    { name: 'follows', label: 'Part of the steps that follow a link', range: [0.5, 1, 0.01], value: 0.85, show: (x) => x.toFixed(2) },
  ],
  sources: ['sk/classics/points.sk'],
  create,
  accuracy: {
    note: 'A product of a sparse matrix with a vector, against doubles in JavaScript: a point for each entry, which add up in order, and points of four entries, of which no two ' +
      'meet. Times are those of a product with the matrix of the picture.',
    measure,
  },
});
