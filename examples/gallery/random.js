// SPDX-License-Identifier: MIT
//
// Random numbers from a seed, the same in every browser (G. Marsaglia's xorshift, 2003, started by a hash).

/** A function that gives numbers in [0, 1). */
export function randomFrom(seed) {
  let state = Math.imul(seed ^ 0x9e3779b9, 0x85ebca6b) | 1;
  return () => {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    return (state >>> 0) / 2 ** 32;
  };
}
