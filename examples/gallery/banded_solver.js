// SPDX-License-Identifier: MIT
//
// A step of water by the operators of examples/classics/banded: conjugate gradients whose scalars stay on the device.
import { banded } from './sk/classics/banded.sk.js';
import { scalars } from './sk/gallery/scalars.sk.js';

/** Vectors of w x w elements, the five diagonals of a matrix, which share textures with their mirrors, and scalars. */
export function vectorsOf(device, w) {
  const made = {};
  for (const name of ['now', 'last', 'x', 'b', 'r', 'p', 'q', 'd0', 'd1', 'd2', 'd3', 'd4']) made[name] = device.stream('float', [w, w]);
  for (const name of ['rho', 'next', 'pq', 'step', 'minus']) made[name] = device.stream('float', [1]);
  return made;
}

export function fillMatrix({ d0, ...rest }, alpha) {
  d0.fill(1 + 4 * alpha);
  for (const name of ['d1', 'd2', 'd3', 'd4']) rest[name].fill(-alpha);
}

/** y = A x: the diagonal, and then four others at once, whose distances are those of the neighbors on the ring. */
function multiply({ d0, d1, d2, d3, d4 }, x, y) {
  const w = x.shape[0];
  banded.clMatVec(false, [0, 0], d0, x, null, y);
  banded.clMatVec4([[1, 0], [w - 1, w - 1], [0, 1], [0, w - 1]], d1, d2, d3, d4, x, y, y);
}

/** (I - a L) x = 3 now - (I - a L) now - last, from what the last two states let expect. */
export function step(v, iterations) {
  const { now, last, x, b, r, p, q, rho, next, pq } = v;
  multiply(v, now, q);
  banded.clVecOp(3, -1, now, q, b);
  banded.clVecOp(1, -1, b, last, b);
  banded.clVecOp(2, -1, now, last, x);
  multiply(v, x, r);
  banded.clVecOp(1, -1, b, r, r);
  r.copyTo(p);
  banded.clVecReduce(r, r, rho);
  for (let i = 0; i < iterations; ++i) {
    multiply(v, p, q);
    banded.clVecReduce(p, q, pq);
    scalars.quotient(rho, pq, v.step, v.minus);
    banded.clVecOp(1, v.step, x, p, x);
    banded.clVecOp(1, v.minus, r, q, r);
    banded.clVecReduce(r, r, next);
    scalars.quotient(next, rho, v.step, v.minus);
    banded.clVecOp(1, v.step, r, p, p);
    next.copyTo(rho);
  }
  now.copyTo(last);
  x.copyTo(now);
}
