// SPDX-License-Identifier: MIT
//
// A net that falls and hangs, in doubles, and by the kernels of examples/applications/cloth in the forms that they offer.
import { cloth } from './sk/cloth/cloth.sk.js';

const [columns, rows] = [12, 9];
const steps = 120;
const rest = 1 / 8;
const factor = 1 / 4;
const gravity = [0, -(2 ** -13), 0]; // of a step
const calm = { velocity: [0, 0, 0], across: 0, along: 0, gust: 0, swirl: 0, phase: 0, wave: [0, 0, 0] };
const far = 16;

function firstPositions() {
  const p = new Float32Array(4 * columns * rows);
  for (let i = 0; i < columns * rows; ++i) {
    const [x, y] = [i % columns, Math.floor(i / columns)];
    p.set([far + x * rest, far, far + y * rest, y === 0 ? 0 : 1], 4 * i); // lies flat, held at one side
  }
  return p;
}

/** One step of integrate and relax with the exact law, in doubles. */
function referenceStep(p, d) {
  const count = columns * rows;
  for (let i = 0; i < count; ++i) {
    for (let c = 0; c < 3; ++c) {
      d[3 * i + c] = p[4 * i + 3] > 0 ? d[3 * i + c] + gravity[c] : 0;
      p[4 * i + c] += d[3 * i + c];
    }
  }
  const pulls = new Float64Array(3 * count);
  for (let i = 0; i < count; ++i) {
    const [x, y] = [i % columns, Math.floor(i / columns)];
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      if (x + dx < 0 || x + dx >= columns || y + dy < 0 || y + dy >= rows) continue;
      const k = i + dx + dy * columns;
      const way = [0, 1, 2].map((c) => p[4 * k + c] - p[4 * i + c]);
      const share = p[4 * i + 3] / Math.max(p[4 * i + 3] + p[4 * k + 3], 1e-37);
      const by = factor * share * (1 - rest / Math.hypot(...way));
      for (let c = 0; c < 3; ++c) pulls[3 * i + c] += by * way[c];
    }
  }
  for (let i = 0; i < count; ++i) {
    for (let c = 0; c < 3; ++c) {
      p[4 * i + c] += pulls[3 * i + c];
      d[3 * i + c] += pulls[3 * i + c];
    }
  }
}

export async function* measure({ device, simulation, time }) {
  const exact = Float64Array.from(firstPositions());
  const moved = new Float64Array(3 * columns * rows);
  for (let i = 0; i < steps; ++i) referenceStep(exact, moved);

  const links = { right: rest, down: rest, diagonal: rest, structural: factor, shear: 0, bend: 0 };
  const stepOf = (p, d, law, verlet) => () => {
    const loose = {structural: false, shear: false, bend: false, tearing: false, law, links, p};
    cloth.integrate(
        loose, {motion: {gravity, keep: 1}, windy: false, air: calm}, {carried: false}, verlet, d, null, null,
        p, d);
    const [inD, outD] = verlet === 0 ? [d, d] : [null, null];
    cloth.relax({...loose, structural: true}, verlet, inD, null, p, outD);
  };
  const ways = [['displacements, exact lengths', 0, 0], ['last positions, exact lengths', 0, 1], ['displacements, no square root', 1, 0]];
  for (const [choice, law, verlet] of ways) {
    const shapes = [[rows, columns], simulation.p.shape];
    const [p, large] = shapes.map((shape) => device.stream('float4', shape));
    const [d, largeD] = shapes.map((shape) => device.stream('float3', shape));
    const first = firstPositions();
    p.write(first);
    if (verlet === 1) d.write(first.filter((_, i) => i % 4 < 3)); // at rest before, too
    const step = stepOf(p, d, law, verlet);
    for (let i = 0; i < steps; ++i) step();
    const got = await p.read();
    const error = got.reduce((most, x, i) => Math.max(most, Math.abs(x - exact[i])), 0) / (rest * (rows - 1));
    yield { choice, note: `${steps} steps of ${columns} × ${rows} points`, ms: await time(stepOf(large, largeD, law, verlet)), error };
    for (const stream of [p, d, large, largeD]) stream.dispose();
  }
}
