// SPDX-License-Identifier: MIT
//
// Arithmetic of vectors in space, as arrays of numbers.
export const add = (a, b, by = 1) => a.map((x, i) => x + by * b[i]);
export const scaled = (a, by) => a.map((x) => x * by);
export const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
export const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
export const unit = (a) => scaled(a, 1 / Math.hypot(...a));
