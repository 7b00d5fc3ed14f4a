// SPDX-License-Identifier: MIT
//
// The passes of a scan: the decisions of runtime/src/assemble/reduce/scan_plan.cpp for draws over whole streams that are not
// packed. Pure arithmetic.
import { linearLayout, linearTexture, sizeOf, stridesOf, type Layout } from './layout.js';
import { divideUp, domainUniforms, indexAxes, type ReducePass, type Uniform } from './reduce_plan.js';

/** Elements per run. */
const run = 16;

export interface ScanPlan {
  /** From the elements to one run in each line. */
  readonly folds: readonly ReducePass[];
  /** One more, back to the elements; the last writes the results. */
  readonly scans: readonly ReducePass[];
}

/** The elements, or results of runs: `inner` is the distance of those of a line. */
interface Level {
  readonly length: number;
  readonly inner: number;
  readonly layout: Layout;
}

/**
 * Plans the scan of `elements`, of which there is one or more, to `result`, which has the same extent. `along`: the dimension of
 * lines that are scanned each by itself, x being 0; if it is absent, all elements are one line.
 */
export function planScan(elements: Layout, result: Layout, textureSize: number, along: number | undefined, byIndex: boolean, isExclusive: boolean): ScanPlan {
  const { extent } = elements;
  const length = along === undefined ? sizeOf(extent) : extent[along]!;
  const lines = sizeOf(extent) / length;
  const levels: Level[] = [{ length, inner: along === undefined || length === 1 ? 1 : stridesOf(extent)[along]!, layout: elements }];

  /** A pass that reads a level and writes to `to`. */
  const passOver = (level: number, scan: 'folds' | 'inclusive' | 'exclusive', to: Layout, toResult: boolean): ReducePass => {
    const source = levels[level]!;
    const walk = level > 0 ? 'partials' : byIndex ? 'index' : elements.linear ? 'line' : 'plane';
    const carry = scan === 'folds' ? undefined : levels[level + 1];
    const axes = walk === 'index' ? indexAxes(elements) : 1;
    // Programs take any number of lines, and textures of any width.
    const key = `${walk} split to plane${axes === 1 ? '' : ` axes${axes}`} run${run} ${scan}${scan === 'folds' ? '' : ' carried'}`;
    const uniforms: Uniform[] = [
      ['sk_inner', source.inner],
      ['sk_length', source.length],
      ['sk_lines', lines],
      ['sk_shift', source.layout.shift],
      ['sk_start', 0],
      ['sk_width', extent[0]],
      ['sk_item_shape', extent],
      ['sk_item_step', stridesOf(extent)],
      ...domainUniforms(to, true),
      ['sk_carry_shift', carry?.layout.shift ?? 0],
    ];
    return { walk, key, toResult, width: to.width, height: to.height, draws: to.draws, uniforms, carried: scan !== 'folds' };
  };

  const folds: ReducePass[] = [];
  for (let level = 0; levels[level]!.length > run; ++level) {
    const runs = divideUp(levels[level]!.length, run);
    const { width, height } = linearTexture(runs * lines, textureSize)!;
    levels.push({ length: runs, inner: lines, layout: linearLayout(runs * lines, width, height) });
    folds.push(passOver(level, 'folds', levels[level + 1]!.layout, false));
  }
  const scans: ReducePass[] = [];
  for (let level = levels.length - 1; level > 0; --level) scans.push(passOver(level, 'inclusive', levels[level]!.layout, false));
  scans.push(passOver(0, isExclusive ? 'exclusive' : 'inclusive', result, true));
  return { folds, scans };
}
