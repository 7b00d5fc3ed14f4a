// SPDX-License-Identifier: MIT
//
// Into which blocks a reduction divides its elements: runtime/src/call/box.cpp.

/** The grids of blocks, rows first, that are compatible with the result's shape. */
export function blockGrids(domain: readonly number[], result: readonly number[]): number[][] {
  const grids: number[][] = [];
  // bit d: dimension d belongs to the result
  for (let kept = 0; kept < 1 << domain.length; ++kept) {
    let next = 0;
    const grid = domain.map((_, d) => ((kept >> d) & 1 ? result[next++] ?? 1 : 1));
    const isOther = grids.every((known) => known.join() !== grid.join());
    const divides = grid.every((blocks, d) => (blocks === 0 ? domain[d] === 0 : domain[d]! % blocks === 0));
    if (next === result.length && divides && isOther) grids.push(grid);
  }
  return grids;
}
