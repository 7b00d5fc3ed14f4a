// SPDX-License-Identifier: MIT
//
// The surface of examples/classics/sparse, a rough tube around a trefoil knot: its matrix, and its vertices as a mesh for mesh_view.js.
import { sparse } from './sk/classics/sparse.sk.js';

/** Streams of the matrix, whose rows are in the order of the vertices: the rectangles of rows of one length would be views, for which the module has no
 *  programs. */
export async function matrixOf(device, around) {
  const n = 8 * around * around;
  const shape = [n / around, around];
  const [vertex, count, Rx] = [0, 1, 2].map(() => device.stream('int', shape));
  const [texel, Ca] = [device.stream('int2', [n]), device.stream('int2', [0])];
  vertex.write(Int32Array.from({ length: n }, (_, i) => i));
  sparse.place(vertex, texel);
  await sparse.connect(around, vertex, texel, count, Ca);
  sparse.point.with({ scan: 'exclusive' })(count, Rx);
  texel.dispose();
  return { around, shape, vertex, count, Rx, Ca };
}

/** Positions and normals of a closed mesh, turned about the vertical by an angle and about the horizontal by another one. */
export function meshOf(x, { around }, turn, tilt) {
  const [rows, columns] = [8 * around + 1, around + 1];
  const [c, s, a, b] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
  const positions = new Float32Array(4 * rows * columns);
  const normals = new Float32Array(4 * rows * columns);
  const grid = (row, column) => ((row + rows - 1) % (rows - 1)) * columns + ((column + around) % around);
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const from = 3 * ((row % (rows - 1)) * around + (column % around));
      const [px, py, pz] = [0.25 * x[from], 0.25 * x[from + 1], 0.25 * x[from + 2]];
      const deep = c * pz - s * px;
      positions.set([c * px + s * pz, a * py - b * deep, b * py + a * deep, 1], 4 * (row * columns + column));
    }
  }
  const between = (to, from) => [0, 1, 2].map((i) => positions[4 * to + i] - positions[4 * from + i]);
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const [ux, uy, uz] = between(grid(row, column + 1), grid(row, column - 1));
      const [vx, vy, vz] = between(grid(row + 1, column), grid(row - 1, column));
      normals.set([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx, 0], 4 * (row * columns + column));
    }
  }
  return { rows, columns, positions, normals };
}
