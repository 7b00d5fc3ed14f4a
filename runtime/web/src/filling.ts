// SPDX-License-Identifier: MIT
//
// Fills and copies the elements of streams and views on the device: runtime/src/api/stream.cpp.
import { copyRegion } from './copy.js';
import { isSameElement, newArrays, numbersOf, planeArray } from './elements.js';
import { SkError } from './error.js';
import { hostArrayOf } from './format.js';
import type { Element } from './generated.js';
import { lanes, shapeText, stridesOf, texelsOf, xFirst } from './layout.js';
import { Stream } from './stream.js';
import { regionOf, View, viewOf } from './view.js';

type Elements = Stream<any, number> | View<any, number>;

function checkElements(of: Elements, what: string, isRead: boolean): void {
  if (of instanceof View) of.check(what);
  else of.check(what, isRead);
}

/** Host arrays of `count` elements with this value. Throws SkError if it is no value of such an element. */
function repeated(element: Element, value: unknown, count: number): unknown {
  const numbers = numbersOf(element, value);
  const wanted = element.fields.reduce((sum, { width }) => sum + width, 0);
  if (numbers.length !== wanted) throw new SkError(`fill: a value of ${element.name} has ${wanted} number(s), but ${numbers.length} are given`, 'type');
  const arrays = newArrays(element, count);
  let next = 0;
  element.fields.forEach(({ scalar, width }, plane) => {
    const { array, first, step } = planeArray(element, plane, arrays, count);
    const isFraction = [Float32Array, Float64Array].includes(hostArrayOf(scalar) as never);
    for (let c = 0; c < width; ++c) {
      const number = numbers[next++]!;
      if (!isFraction && !Number.isInteger(number)) throw new SkError(`fill: ${number} is no whole number, as ${element.name} holds`, 'type');
      for (let i = 0; i < count; ++i) array[i * step + first + c] = number;
    }
  });
  return arrays;
}

/** Gives all elements one value. */
export function fill(of: Elements, value: unknown): void {
  checkElements(of, 'fill: the stream', false);
  const { stream, size, shape } = viewOf(of);
  const isWhole = size === stream.size;
  const layout = stream.layoutIf(isWhole);
  const count = layout.packed ? lanes : 1; // of a texel
  const elements = repeated(stream.element, value, count);
  if (size === 0) return;
  const one = new Stream<any, number>(stream.device, stream.element, [count]);
  one.write(elements as never);
  if (isWhole) {
    if (stream.layout !== layout || stream.isHeld()) stream.exchange(stream.newPlanes(layout), layout);
    stream.isGone = false;
  } else {
    stream.unpack();
    stream.own();
  }
  const source = { planes: one.planes, first: 0, strides: [0, 0, 0, 0] as const, width: 1, linear: false };
  if (isWhole) {
    const { extent } = layout.packed ? texelsOf(layout) : layout;
    copyRegion(stream.device, extent, source, { planes: stream.planes, first: 0, strides: stridesOf(extent), width: layout.width, linear: layout.linear });
  } else {
    copyRegion(stream.device, xFirst(shape as readonly number[]), source, regionOf(of));
  }
  one.dispose();
}

/** Copies the elements to a stream or view of the same shape. The elements of both may overlap. */
export function copy(of: Elements, target: Elements): void {
  if (!(target instanceof Stream || target instanceof View)) throw new SkError('copyTo: the target is no stream and no view; make one by device.stream()', 'type');
  checkElements(of, 'copyTo: the source', true);
  checkElements(target, 'copyTo: the target', false);
  const [from, to] = [viewOf(of), viewOf(target)];
  const [a, b] = [from.stream, to.stream];
  if (a.device !== b.device) throw new SkError('copyTo: the streams are of two devices; read() the source, and write() the target', 'device');
  if (!isSameElement(a.element, b.element)) throw new SkError(`copyTo: the source holds ${a.element.name}, the target ${b.element.name}; copy between streams of one type, or convert in a kernel`, 'type');
  const [shape, other] = [shapeText(from.shape as readonly number[]), shapeText(to.shape as readonly number[])];
  if (shape !== other) throw new SkError(`copyTo: the source has shape ${shape}, the target ${other}; copy between equal shapes, such as views by domain()`, 'shape');
  const isWhole = from.size === a.size && to.size === b.size;
  if (from.size === 0 || (isWhole && a === b)) return;
  if (isWhole) {
    a.device.begin();
    if (b.layout !== a.layout || b.isHeld()) b.exchange(b.newPlanes(a.layout), a.layout);
    a.planes.forEach((plane, i) => a.device.copyTexels(plane, b.planes[i]!, a.layout.draws));
    b.isGone = false;
    return;
  }
  const source = a === b ? from.copied() : of;
  a.unpack();
  b.unpack();
  b.own();
  copyRegion(a.device, xFirst(from.shape as readonly number[]), regionOf(source), regionOf(target));
  if (source !== of) (source as Stream<any, number>).dispose();
}
