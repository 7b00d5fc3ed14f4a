// SPDX-License-Identifier: MIT
//
// A random web, as a sparse matrix: what main.cpp of examples/classics/points makes.
import { points_Vertex, points_Vertex4 } from './sk/classics/points.sk.js';

const linksOfPage = 5;

/** Links of side x side pages, sorted by row, which is the page that a link leads to. A new page links to older ones nearby, or to what these link to, and
 *  half of the links are returned. */
export function growWeb(side, random) {
  const n = side * side;
  const below = (count) => Math.floor(random() * count);
  const near = (i, reach) => {
    const low = Math.max(i - reach, 0);
    return low + below(Math.min(i + reach, side - 1) - low + 1);
  };
  const pages = Array.from({ length: n }, (_, page) => page);
  for (let i = n - 1; i > 0; --i) {
    const j = below(i + 1);
    [pages[i], pages[j]] = [pages[j], pages[i]];
  }
  const targets = new Array(n).fill(null);
  targets[pages[0]] = new Array(linksOfPage).fill(pages[0]);
  const links = [];
  for (const page of pages.slice(1)) {
    const own = [];
    for (let link = 0; link < linksOfPage; ++link) {
      let other = page;
      for (let reach = 1; targets[other] === null; reach = Math.min(2 * reach, side)) other = side * near(Math.floor(page / side), reach) + near(page % side, reach);
      if (below(5) < 2) other = targets[other][below(linksOfPage)];
      own.push(other);
      links.push([other, page]);
      if (below(2) === 0) links.push([page, other]);
    }
    targets[page] = own;
  }
  const degree = new Array(n).fill(0);
  for (const [, from] of links) ++degree[from];
  return links.sort(([a, b], [c, d]) => a - c || b - d).map(([position, texcoord]) => ({ position, texcoord, colour: Math.fround(1 / degree[texcoord]) }));
}

function streamOf(device, type, elements, members) {
  const made = device.stream(type, [elements.length]);
  made.write(Object.fromEntries(members.map(([name, Type]) => [name, Type.from(elements.flatMap((element) => element[name]))])));
  return made;
}

const members = [['position', Int32Array], ['texcoord', Int32Array], ['colour', Float32Array]];
export const pointsOf = (device, links) => streamOf(device, points_Vertex, links, members);

/** Arrays in which no two points meet: the first has the first four links of each row, the next one the next four. */
export function arraysOf(device, links) {
  const arrays = [];
  let [row, count] = [-1, 0];
  for (const { position, texcoord, colour } of links) {
    count = position === row ? count + 1 : 0;
    row = position;
    const array = (arrays[count >> 2] ??= []);
    if (count % 4 === 0) array.push({ position, texcoord: [0, 0, 0, 0], colour: [0, 0, 0, 0] });
    const point = array[array.length - 1];
    point.texcoord[count % 4] = texcoord;
    point.colour[count % 4] = colour;
  }
  return arrays.map((array) => streamOf(device, points_Vertex4, array, members));
}
