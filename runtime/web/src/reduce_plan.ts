// SPDX-License-Identifier: MIT
//
// The passes of a reduction to a value or to a smaller stream: the decisions of runtime/src/assemble/reduce/reduce_plan.cpp
// for draws over whole streams. Pure arithmetic.
import { decodedRank, lanes, linearLayout, linearTexture, sizeOf, stridesOf, texelsOf, type Index4, type Layout, type Rect } from './layout.js';

export type Walk = 'line' | 'plane' | 'index' | 'rows' | 'partials' | 'partialRows' | 'nothing';
export type Uniform = readonly [name: string, value: number | Index4];

export interface ReducePass {
  readonly walk: Walk;
  /** The choices of the pass, as in the key of its program: "rows run8 column packed". */
  readonly key: string;
  readonly toResult: boolean;
  /** The size of the texture that it draws to. */
  readonly width: number;
  readonly height: number;
  readonly draws: readonly Rect[];
  readonly uniforms: readonly Uniform[];
  /** Of a scan: it reads the results of the runs before, if there are any. */
  readonly carried?: boolean;
}

export interface Division {
  /** Elements are found by their index; else they lie alike in all inputs. Programs take any number of blocks then. */
  readonly byIndex: boolean;
  /** Elements are packed, and runs step by texels. */
  readonly byTexel: boolean;
  readonly inAnyOrder: boolean;
  /** The number of blocks in each dimension; by default one. Several need `byIndex`. */
  readonly blocks?: Index4;
}

export interface ReduceLimits {
  readonly textureSize: number;
  /** From this many elements or texels on, programs are specialised for the length of runs. */
  readonly knownRuns: number;
}

/** Elements per run, at most. */
const fanIn = 32;
export const leastKnownRuns = 2 ** 16;

interface Extent2 {
  readonly width: number;
  readonly height: number;
}

const none: Index4 = [0, 0, 0, 0];
const one: Index4 = [1, 1, 1, 1];
/** Where a value lies. */
export const valueLayout: Layout = linearLayout(1, 1, 1);

export const divideUp = (a: number, b: number) => Math.floor((a - 1) / b) + 1;

/** A divisor of `extent` near `most`; `most` if there is none. */
function dividing(extent: number, most: number): number {
  for (let length = most; 2 * length > most; --length) {
    if (extent % length === 0) return length;
  }
  return most;
}

/** The components that a program decodes of an index: programs for linearised streams decode one, or all four. */
export function indexAxes(elements: Layout): number {
  return !elements.linear ? 2 : decodedRank(elements.extent) === 1 ? 1 : 4;
}

/** Where a pass draws. `isPlane`: its program takes all textures for planes, whose texels it numbers row by row. */
export function domainUniforms(domain: Layout, isPlane: boolean): Uniform[] {
  return [
    ['sk_domain_shape', isPlane ? [domain.width, domain.height, 1, 1] : domain.extent],
    ['sk_domain_stride', domain.stride],
    ['sk_domain_shift', domain.shift],
    ['sk_domain_step', stridesOf(domain.extent)],
  ];
}

class Planner {
  private readonly input: Layout;
  private readonly passes: ReducePass[] = [];
  /** Elements, texels or partial results of a block. */
  private left: number;
  private rows: Extent2 = { width: 0, height: 0 };
  private tail = 0;
  private sourceShift = 0;
  private readonly grid: Index4;
  private readonly blocks: number;

  constructor(
    private readonly elements: Layout, private readonly result: Layout, private readonly limits: ReduceLimits, private readonly division: Division,
  ) {
    this.input = division.byTexel ? texelsOf(elements) : elements;
    this.grid = division.blocks ?? one;
    this.blocks = sizeOf(this.grid);
    this.left = sizeOf(this.input.extent) / this.blocks;
  }

  plan(): ReducePass[] {
    const isByRows = this.findRows();
    if (isByRows) this.addRows('rows');
    else this.addPass(this.division.byIndex ? 'index' : 'line');
    while (!this.passes[this.passes.length - 1]!.toResult) {
      if (isByRows) this.addRows('partialRows');
      else this.addPass('partials');
    }
    return this.passes;
  }

  /** Whether the elements are rows of texels. The last may be shorter if there is another and order does not matter. */
  private findRows(): boolean {
    if (this.division.byIndex) return false;
    const { input, left } = this;
    if (!input.linear) {
      this.rows = { width: input.extent[0], height: input.extent[1] };
      return true;
    }
    const width = 2 ** input.shift;
    this.rows = left < width ? { width: left, height: 1 } : { width, height: Math.floor(left / width) };
    this.tail = left < width ? 0 : left % width;
    return this.tail === 0 || this.division.inAnyOrder;
  }

  private runOf({ width, height }: Extent2, most: number, ofPartials: boolean): Extent2 {
    const side = 8;
    const { inAnyOrder } = this.division;
    if (inAnyOrder && ofPartials && most >= side && width >= side && height >= Math.floor(most / side)) {
      return { width: side, height: Math.floor(most / side) };
    }
    if (inAnyOrder && height >= most) return { width: 1, height: dividing(height, most) };
    if (width < most && height > 1) return { width, height: Math.min(height, Math.floor(most / width)) };
    return { width: dividing(width, Math.min(width, most)), height: 1 };
  }

  /** The run of the first pass. A texel of the partial row below extends the last run of its column. */
  private firstRun(): Extent2 {
    const most = this.division.byTexel ? fanIn / lanes : fanIn;
    if (this.tail > 0) return { width: 1, height: Math.min(Math.max(this.rows.height, 1), most - 1) };
    return this.runOf(this.rows, most, false);
  }

  /** Whether a program for this length folds the first runs: if all have it and there is enough work. */
  private hasKnownRun(run: Extent2): boolean {
    const { width, height } = this.rows;
    const isEven = this.tail === 0 && width % run.width === 0 && height % run.height === 0;
    const isLine = run.width === 1 || run.height === 1;
    return isEven && isLine && width * height >= this.limits.knownRuns && (run.width * run.height) % 4 === 0;
  }

  private addRows(walk: 'rows' | 'partialRows'): void {
    const isFirst = walk === 'rows';
    const before = this.rows;
    const run = isFirst ? this.firstRun() : this.runOf(before, fanIn, true);
    let key: string = walk;
    if (isFirst) {
      const isKnown = this.hasKnownRun(run);
      if (isKnown) key += ` run${run.width * run.height}`;
      if (run.width === 1 && (isKnown || this.tail > 0)) key += ' column';
      if (this.division.byTexel) key += ' packed';
    }
    const width = divideUp(before.width, run.width);
    const height = divideUp(before.height, run.height);
    this.rows = { width, height };
    this.left = width * height;
    const draw = { x: 0, y: 0, width, height };
    this.passes.push({
      walk,
      key,
      toResult: this.left === 1,
      width,
      height,
      draws: [draw],
      uniforms: [
        ['sk_item_shape', this.elements.extent],
        ['sk_origin', none],
        ['sk_source', [before.width, before.height, isFirst ? this.tail : 0, 0]],
        ['sk_run_shape', [run.width, run.height, 0, 0]],
        ['sk_target', none],
      ],
    });
  }

  private addPass(walk: 'line' | 'index' | 'partials'): void {
    const isOfTexels = this.division.byTexel && walk !== 'partials';
    const most = isOfTexels ? fanIn / lanes : fanIn;
    const runs = divideUp(this.left, most);
    const toResult = runs === 1;
    const uniforms: Uniform[] = [
      ['sk_fan', divideUp(this.left, runs)],
      ['sk_block_length', this.left],
      ['sk_blocks', this.blocks],
      ['sk_item_shape', this.elements.extent],
    ];
    const domain = toResult ? this.result : this.partials(runs * this.blocks);
    let key: string = walk;
    const { byIndex } = this.division;
    if (byIndex) key += ' split to plane';
    if (walk === 'partials') {
      uniforms.push(['sk_shift', this.sourceShift]);
    } else if (walk === 'line') {
      uniforms.push(['sk_start', 0], ['sk_shift', this.input.shift]);
    } else {
      const axes = indexAxes(this.elements);
      if (axes !== 1) key += ` axes${axes}`;
      const shape = this.input.extent.map((extent, d) => extent / this.grid[d]!) as unknown as Index4;
      uniforms.push(['sk_block_shape', shape], ['sk_block_step', stridesOf(shape)], ['sk_blocks_step', stridesOf(this.grid)]);
    }
    if (isOfTexels) key += ' packed';
    uniforms.push(...domainUniforms(domain, byIndex));
    this.sourceShift = domain.shift;
    this.left = runs;
    this.passes.push({ walk, key, toResult, width: domain.width, height: domain.height, draws: domain.draws, uniforms });
  }

  private partials(count: number): Layout {
    const { width, height } = linearTexture(count, this.limits.textureSize)!;
    return linearLayout(count, width, height);
  }
}

/**
 * Plans the passes that fold elements, of which there is one or more, to `result`: an element for each block, in order. If
 * there is one block, it is valueLayout.
 */
export function planReduction(elements: Layout, limits: ReduceLimits, division: Division, result: Layout = valueLayout): ReducePass[] {
  return new Planner(elements, result, limits, division).plan();
}

/** The pass that writes the identities to `result`, where there are no elements. */
export function planIdentities({ width, height, draws }: Layout): ReducePass {
  return { walk: 'nothing', key: 'nothing', toResult: true, width, height, draws, uniforms: [] };
}

export function isOfPartials(walk: Walk): boolean {
  return walk === 'partials' || walk === 'partialRows';
}
