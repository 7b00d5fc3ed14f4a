// SPDX-License-Identifier: MIT
//
// Copies elements from one stream to another on the device, at regular distances in both.
import type { Context } from './context.js';
import { consecutiveTexels, type Index4, type Rect } from './layout.js';
import type { Plane } from './memory.js';
import type { Program } from './program.js';

/** Elements of a stream that is not packed: element i has the number first + sum(i * strides) in its textures. */
export interface Region {
  readonly planes: readonly Plane[];
  readonly first: number;
  readonly strides: Index4;
  /** Of the textures. */
  readonly width: number;
  readonly linear: boolean;
}

/** What a pass over a region draws: its elements, and what lies between them. */
export function drawsOf(extent: Index4, { first, strides, width, linear }: Region): Rect[] {
  const last = extent.reduce((number, n, d) => number + (n - 1) * strides[d]!, first);
  if (linear) return consecutiveTexels(last + 1, 31 - Math.clz32(width), first);
  const [x, y] = [first % width, Math.floor(first / width)];
  return [{ x, y, width: (last % width) - x + 1, height: Math.floor(last / width) - y + 1 }];
}

const copyKey = {};

/** Copies as many elements as `extent`, x first, says. The regions are of different streams of one type of elements. */
export function copyRegion(device: Context, extent: Index4, from: Region, to: Region): void {
  device.begin();
  const strides = ({ strides }: Region) => strides.map((stride, d) => (extent[d]! > 1 ? stride : 0x7fffffff)); // no number reaches it
  const draws = drawsOf(extent, to);
  to.planes.forEach((plane, i) => {
    const program = copyProgram(device, plane.format.sampler);
    device.useProgram(program);
    device.bindTexture(0, from.planes[i]!.texture);
    device.bindFilter(0, null);
    program.setInteger('extent', extent);
    program.setInteger('source', strides(from));
    program.setInteger('target', strides(to));
    program.setInteger('numbers', [from.first, from.width, to.first, to.width]);
    device.framebufferOf([plane]);
    device.drawRects(draws);
  });
}

/** Takes the longest stride as often as possible, then the next: nothing is left of an element's number. */
function copyProgram(device: Context, sampler: string): Program {
  const prefix = sampler === 'float' ? '' : sampler[0]!;
  const text = () => `#version 300 es
precision highp float;
precision highp int;
precision highp ${prefix}sampler2D;
uniform ${prefix}sampler2D elements;
uniform ivec4 extent, source, target, numbers;
out ${prefix}vec4 element;
void main() {
  int left = int(gl_FragCoord.y) * numbers.w + int(gl_FragCoord.x) - numbers.z, n = numbers.x;
  if (left < 0) discard;
  for (int d = 3; d >= 0; --d) {
    int i = left / target[d];
    if (i >= extent[d]) discard;
    left -= i * target[d];
    n += i * source[d];
  }
  if (left != 0) discard;
  element = texelFetch(elements, ivec2(n % numbers.y, n / numbers.y), 0);
}
`;
  return device.program(copyKey, sampler, 'copying', text, [], [], () => true);
}
