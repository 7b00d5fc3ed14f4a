// SPDX-License-Identifier: MIT
//
// Streams of doubles from streams of floats, on the device: exact, and nothing waits for the host.
import { isSameElement } from '../elements.js';
import { SkError } from '../error.js';
import { formatOf } from '../format.js';
import type { Element } from '../generated.js';
import { Stream } from '../stream.js';
import type { AnyStream } from './columns.js';

/** Where the components of a plane come from: `width` of them, from `first` on, of another plane. */
interface Piece {
  readonly plane: number;
  readonly first: number;
  readonly width: number;
}

/** For each plane of `wide`, its components among those of `plain`. Throws SkError if they are not the same components. */
function piecesOf(plain: Element, wide: Element): Piece[] {
  const places = plain.fields.flatMap(({ width }, plane) => Array.from({ length: width }, (_, c) => ({ plane, c })));
  const components = wide.fields.reduce((count, { width }) => count + width, 0);
  let next = 0;
  const pieces = wide.fields.map(({ width }): Piece => {
    const first = places[next]!;
    next += width;
    return { plane: first.plane, first: first.c, width };
  });
  const isWithin = ({ plane, first, width }: Piece) => first + width <= plain.fields[plane]!.width;
  if (components !== places.length || !pieces.every(isWithin)) throw new SkError(`${plain.name} has no counterpart in doubles`, 'type');
  return pieces;
}

/** A new stream with the elements of `source`, which stays as it is, as `element`: doubles for its floats. */
export function widened(source: AnyStream, element: Element): AnyStream {
  const { device } = source;
  const target = new Stream<any, number>(device, isSameElement(source.element, element) ? source.element : element, source.shape);
  if (source.size === 0) return target;
  if (target.element === source.element) {
    source.copyTo(target);
    return target;
  }
  target.forget();
  const plain = target.layout;
  const from = source.layout;
  const shifts = [plain.linear ? plain.shift : -1, from.linear ? from.shift : -1, plain.extent[0], 0];
  piecesOf(source.element, element).forEach((piece, i) => {
    const isWidened = element.fields[i]!.scalar === 'double' && source.element.fields[piece.plane]!.scalar !== 'double';
    const plane = source.planes[piece.plane]!;
    if (!isWidened && !from.packed) return device.copyTexels(plane, target.planes[i]!, plain.draws);
    const program = wideProgram(piece, from.packed);
    const current = device.program(wideProgram, program.key, 'widening', () => program.text, [], [], () => true);
    device.useProgram(current);
    device.bindPlane(0, plane);
    current.setInteger('shifts', shifts);
    device.framebufferOf([target.planes[i]!]);
    device.drawRects(plain.draws);
  });
  return target;
}

/** The bits of doubles in two words, the low one first. A packed texel has four elements (unpackProgram() in stream.ts). */
function wideProgram({ first, width }: Piece, isPacked: boolean): { key: string; text: string } {
  const channels = formatOf('double', width).channels;
  const values = Array.from({ length: 2 }, (_, c) => (c < width ? `wide(texel[${isPacked ? 'n & 3' : first + c}])` : 'uvec2(0)'));
  const text = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
uniform sampler2D plane;
uniform ivec4 shifts;
out uvec4 element;
uvec2 wide(float x) {
  uint bits = floatBitsToUint(x), sign = bits & 0x80000000u, power = (bits >> 23) & 255u, digits = bits & 0x7fffffu;
  if (power == 255u) return uvec2(digits << 29, sign | 0x7ff00000u | (digits >> 3));
  if (power == 0u) {
    if (digits == 0u) return uvec2(0u, sign);
    power = 897u;
    for (int i = 0; i < 23 && (digits & 0x800000u) == 0u; ++i) {
      digits <<= 1;
      --power;
    }
    digits &= 0x7fffffu;
  } else {
    power += 896u;
  }
  return uvec2(digits << 29, sign | (power << 20) | (digits >> 3));
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  int n = shifts.x < 0 ? at.y * shifts.z + at.x : (at.y << shifts.x) | at.x;
  int texelNumber = n >> 2, width = shifts.z >> 2;
  ivec2 packedAt = shifts.y < 0 ? ivec2(texelNumber % width, texelNumber / width) : ivec2(texelNumber & ((1 << shifts.y) - 1), texelNumber >> shifts.y);
  vec4 texel = texelFetch(plane, ${isPacked ? 'packedAt' : 'at'}, 0);
  element = uvec4(${values.join(', ')});
}
`;
  return { key: `${first} ${width} ${channels} ${isPacked}`, text };
}
