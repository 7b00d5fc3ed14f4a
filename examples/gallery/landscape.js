// SPDX-License-Identifier: MIT
//
// The landscape of examples/classics/streaming_rays, and the grid of voxels around it: what its main.cpp makes before the first ray.
import { streaming_rays, streaming_rays_Triangle } from './sk/classics/streaming_rays.sk.js';

const [fields, voxels, low] = [48, 32, -1.01];
const size = (-2 * low) / voxels;

/** The voxels, from a first to a last one, that an edge from `least` to `most` may meet; rounding on a ray's way loses no hit. */
function range(least, most) {
  const voxelOf = (x) => Math.min(Math.max(Math.floor((x - low) / size), 0), voxels - 1);
  return [voxelOf(least - 0.002), voxelOf(most + 0.002)];
}

/** What the member Scene of kernels holds, but for the eye, the sample and the use. */
export async function landscapeOn(device) {
  const triangle = device.stream(streaming_rays_Triangle, [2 * fields * fields]);
  streaming_rays.landscape(fields, triangle);
  const { v0, v1, v2 } = await triangle.read();
  const lists = Array.from({ length: voxels ** 3 }, () => []);
  for (let id = 0; id < triangle.size; ++id) {
    const [x, y, z] = [0, 1, 2].map((c) => [v0, v1, v2].map((v) => v[3 * id + c])).map((of) => range(Math.min(...of), Math.max(...of)));
    for (let k = z[0]; k <= z[1]; ++k) for (let j = y[0]; j <= y[1]; ++j) for (let i = x[0]; i <= x[1]; ++i) lists[(k * voxels + j) * voxels + i].push(id);
  }
  const entries = [];
  const starts = lists.map((list) => (list.length === 0 ? -1 : entries.push(...list, -1) - list.length - 1));
  const cell = device.stream('int', [voxels, voxels, voxels]);
  cell.write(Int32Array.from(starts));
  const list = device.stream('int', [entries.length]);
  list.write(Int32Array.from(entries));
  return { low, size, cell, list, triangle };
}
