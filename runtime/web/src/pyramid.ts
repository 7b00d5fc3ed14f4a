// SPDX-License-Identifier: MIT
//
// A histogram pyramid, with which an entry of a list finds the element that pushed it: the decisions of
// runtime/src/assemble/append/histo_pyramid.cpp, and runtime/src/gl_device/append/histo_pyramid.cpp. (Ziegler, Tevs, Theobalt, Seidel 2006,
// "On-the-fly Point Clouds through Histogram Pyramids".)
import type { Context } from './context.js';
import { SkError } from './error.js';
import { consecutiveTexels, linearTexture, sizeOf, type Layout, type Rect } from './layout.js';
import type { Plane } from './memory.js';
import type { Program } from './program.js';

/** Values that one call pushes to one stream at most: the sum of four counts is an int. */
export const mostPushes = 2 ** 29 - 2;

interface Level {
  /** Nodes, or counts, of the level below. */
  readonly children: number;
  /** First row of texels in its texture. */
  readonly row: number;
  readonly draws: readonly Rect[];
}

export interface PyramidPlan {
  readonly width: number;
  /** Rows of the textures of odd and even levels; there may be no even level. */
  readonly oddRows: number;
  readonly evenRows: number;
  /** Level 1 has a node for four counts; the last one has a single node. */
  readonly levels: readonly Level[];
}

/** The pyramid over `count` elements, at least 1, in textures of at most `most` rows. */
export function planPyramid(count: number, most: number): PyramidPlan {
  const texture = linearTexture(Math.ceil(count / 4), most);
  const levels: Level[] = [];
  const rows = [0, 0];
  const width = texture?.width ?? most;
  let children = count;
  do {
    const isEven = levels.length % 2;
    const row = rows[isEven]!;
    const nodes = Math.floor((children - 1) / 4) + 1;
    const draws = consecutiveTexels(nodes, 31 - Math.clz32(width)).map((rect) => ({ ...rect, y: rect.y + row }));
    levels.push({ children, row, draws });
    rows[isEven] = row + Math.floor((nodes - 1) / width) + 1;
    children = nodes;
  } while (children > 1);
  if (texture === null || rows[0]! > most) {
    throw new SkError(`the pushes of ${count} elements are too many to count on this device; divide the domain`, 'shape');
  }
  return { width, oddRows: rows[0]!, evenRows: rows[1]!, levels };
}

/** Sums of counts, on the device. */
export class Pyramid {
  readonly plan: PyramidPlan;
  /** Of odd and of even levels. */
  readonly planes: readonly [Plane, Plane];

  /** Draws all levels over the counts of the elements. `ofCounts` draws the first one, `ofNodes` the others. */
  constructor(private readonly device: Context, counts: Plane, domain: Layout, ofCounts: Program, ofNodes: Program) {
    this.plan = planPyramid(sizeOf(domain.extent), device.limits.textureSize);
    const { width, oddRows, evenRows, levels } = this.plan;
    const format = device.formatOf('int', 4);
    const odd = device.acquire(format, width, oddRows, 'the sums of what a kernel pushes');
    const even = evenRows > 0 ? device.acquire(format, width, evenRows, 'the sums of what a kernel pushes') : odd;
    this.planes = [odd, even];
    levels.forEach((level, i) => {
      const program = i === 0 ? ofCounts : ofNodes;
      device.useProgram(program);
      device.bindPlane(0, i === 0 ? counts : this.planes[(i - 1) % 2]!);
      program.setInteger('sk_below', 0);
      program.setInteger('sk_children', level.children);
      program.setInteger('sk_tree_shift', this.shift);
      program.setInteger('sk_row', level.row);
      if (i === 0) program.setInteger('sk_below_width', domain.width);
      else program.setInteger('sk_below_row', levels[i - 1]!.row);
      device.framebufferOf([this.planes[i % 2]!]);
      device.drawRects(level.draws);
    });
  }

  private get shift(): number {
    return 31 - Math.clz32(this.plan.width);
  }

  /** The number of all pushes. Does not block. */
  async total(): Promise<number> {
    const { levels } = this.plan;
    const last = levels.length - 1;
    const sums = await this.device.readTexels(this.planes[last % 2]!, [{ x: 0, y: levels[last]!.row, width: 1, height: 1 }]);
    return sums[3] as number;
  }

  /** Binds the textures for the program of a list, which is current, from this unit on. */
  bind(program: Program, unit: number): void {
    this.planes.forEach((plane, i) => {
      this.device.bindPlane(unit + i, plane);
      program.setInteger(i === 0 ? 'sk_odd' : 'sk_even', unit + i);
    });
    const { levels } = this.plan;
    program.setInteger('sk_tree_shift', this.shift);
    program.setInteger('sk_levels', levels.length);
    program.setIntegers('sk_rows', [0, ...levels.map(({ row }) => row)]);
  }

  release(): void {
    this.device.release(this.planes[0] === this.planes[1] ? [this.planes[0]] : this.planes);
  }
}
