// SPDX-License-Identifier: MIT
//
// Where the elements of a stream lie in its textures: the decisions of runtime/src/gl_device/memory/layout.cpp and
// runtime/src/assemble/region_layout.cpp, for whole streams. Pure arithmetic.
import { SkError } from './error.js';

/** Fastest dimension first: a shape reversed. */
export type Index4 = readonly [number, number, number, number];

export interface Rect {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

/**
 * Plane: element (x, y) is texel (x, y). Linear: element number n is texel (n & (1 << shift) - 1, n >> shift). Packed: a
 * texel holds four elements that are consecutive in x.
 */
export interface Layout {
  readonly linear: boolean;
  readonly packed: boolean;
  readonly extent: Index4;
  /** The element strides of the stream if it is linear, else 1. */
  readonly stride: Index4;
  /** Linear: log2 of the texture's width. */
  readonly shift: number;
  /** The size of the texture; 0 if there are no elements. */
  readonly width: number;
  readonly height: number;
  /** What a pass over all elements draws: no texel beyond the last element. */
  readonly draws: readonly Rect[];
  /** Of views: the first element, as programs for views take it (stream.ts). */
  readonly origin?: Index4;
  /** Of inputs in such programs: how many elements of the domain an element serves; negative: of how many one is read. */
  readonly ratio?: Index4;
}

/** Elements per texel of a packed stream. */
export const lanes = 4;
/** Elements of a stream, which are numbered with an int. */
const mostElements = 2 ** 31 - 2 ** 16;

/** The largest extent of a stream. */
const mostExtent = 2 ** 30 - 1;

/** Throws SkError unless these are the extents of a stream or a domain. */
export function checkShape(shape: readonly number[]): void {
  if (shape.length >= 1 && shape.length <= 4 && shape.every((n) => Number.isInteger(n) && n >= 0 && n <= mostExtent)) return;
  throw new SkError(`${shapeText(shape)} is no shape: 1 to 4 extents, rows first, whole numbers from 0 to ${mostExtent}`, 'shape');
}

export function sizeOf(shape: readonly number[]): number {
  return shape.reduce((size, extent) => size * extent, 1);
}

export function xFirst(shape: readonly number[]): Index4 {
  const at = (d: number) => shape[shape.length - 1 - d] ?? 1;
  return [at(0), at(1), at(2), at(3)];
}

export function stridesOf(extent: Index4): Index4 {
  return [1, extent[0], extent[0] * extent[1], extent[0] * extent[1] * extent[2]];
}

/** The number of dimensions in which an index may be nonzero, at least 1. */
export function decodedRank(extent: Index4): number {
  let rank = 4;
  while (rank > 1 && extent[rank - 1]! <= 1) --rank;
  return rank;
}

/** The width and height of a texture of `count` linearised elements; null if no texture of this size is large enough. */
export function linearTexture(count: number, most: number): { width: number; height: number } | null {
  if (count > mostElements) return null;
  const widest = 31 - Math.clz32(most);
  let shift = 0;
  while (shift < widest && 2 ** (2 * shift) < count) ++shift;
  const height = Math.floor((count - 1) / 2 ** shift) + 1;
  return height <= most ? { width: 2 ** shift, height } : null;
}

/** The rectangles that hold the texels from number `begin` up to `end` of a linearised texture. */
export function consecutiveTexels(end: number, shift: number, begin = 0): Rect[] {
  const across = 2 ** shift;
  const rects: Rect[] = [];
  while (begin < end) {
    const x = begin % across;
    const left = end - begin;
    const rows = x === 0 ? Math.floor(left / across) : 0;
    const rect = { x, y: Math.floor(begin / across), width: rows > 0 ? across : Math.min(across - x, left), height: rows || 1 };
    rects.push(rect);
    begin += rect.width * rect.height;
  }
  return rects;
}

export function linearLayout(count: number, width: number, height: number): Layout {
  const extent: Index4 = [count, 1, 1, 1];
  const shift = 31 - Math.clz32(width);
  const stride = stridesOf(extent);
  const draws = consecutiveTexels(count, shift);
  return { linear: true, packed: false, extent, stride, shift, width, height, draws };
}

/** Streams of two dimensions are planes. Others are linearised, even short ones of one, so that kernels need fewer programs. */
function fitsTexture(shape: readonly number[], most: number): boolean {
  return shape.length === 2 && shape.every((extent) => extent <= most);
}

/** Whether a stream of this shape is not empty, and its rows have a multiple of four elements. */
export function mayPack(shape: readonly number[]): boolean {
  return sizeOf(shape) > 0 && shape[shape.length - 1]! % lanes === 0;
}

/** Throws SkError if no texture of `most` x `most` texels is large enough. */
export function layoutOf(shape: readonly number[], most: number, packed: boolean): Layout {
  const extent = xFirst(shape);
  const size = sizeOf(shape);
  if (size === 0) {
    const stride: Index4 = [1, 1, 1, 1];
    return { linear: false, packed: false, extent, stride, shift: 0, width: 0, height: 0, draws: [] };
  }
  const texels = packed ? [...shape.slice(0, -1), shape[shape.length - 1]! / lanes] : shape;
  if (fitsTexture(texels, most)) {
    const [width, height] = xFirst(texels);
    const draws = [{ x: 0, y: 0, width, height }];
    return { linear: false, packed, extent, stride: [1, 1, 1, 1], shift: 0, width, height, draws };
  }
  const count = sizeOf(texels);
  const texture = linearTexture(count, most);
  if (texture === null) {
    throw new SkError(
      `a stream of shape ${shapeText(shape)} has ${size} elements, but a texture of this device holds ${most} x ${most} texels; ` +
        'divide it into several streams',
      'shape',
    );
  }
  const linear = linearLayout(count, texture.width, texture.height);
  return { ...linear, packed, extent, stride: stridesOf(extent) };
}

/** The same texels as elements of a layout that is not packed. */
export function texelsOf(layout: Layout): Layout {
  const [x, y, z, w] = layout.extent;
  const [, a, b, c] = layout.stride;
  const stride: Index4 = layout.linear ? [1, a / lanes, b / lanes, c / lanes] : layout.stride;
  return { ...layout, packed: false, extent: [x / lanes, y, z, w], stride };
}

export function shapeText(shape: readonly number[]): string {
  return `[${shape.join(', ')}]`;
}
