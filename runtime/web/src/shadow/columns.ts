// SPDX-License-Identifier: MIT
//
// Components of streams on the host, as doubles: one array for each component of an element. The stream stays as it is, packed or not.
import { is64Bit, type HostArray, type Scalar } from '../format.js';
import type { Element, Field, StructElement } from '../generated.js';
import { lanes } from '../layout.js';
import { type Stream, type View, viewOf } from '../stream.js';
import type { Columns } from './errors.js';

export type AnyStream = Stream<any, number>;
export type Elements = AnyStream | View<any, number>;

/** Whether components of this type are real numbers, whose error has a size. */
export function isReal(scalar: Scalar): boolean {
  return scalar === 'float' || scalar === 'double' || scalar === 'half' || scalar.includes('norm');
}

export function scalarsOf(element: Element): Scalar[] {
  return element.fields.flatMap(({ scalar, width }) => Array.from({ length: width }, () => scalar));
}

/** ".y", ".at.x", or nothing for the only component of an element. */
export function componentNames(element: Element): string[] {
  const { planes } = element as Partial<StructElement>;
  return element.fields.flatMap(({ path, width, part }, i) => {
    const member = planes?.[i] ?? path;
    const row = part === undefined || planes !== undefined ? '' : `[${part}]`;
    const name = (member === undefined ? '' : `.${member}`) + row;
    return width === 1 ? [name] : Array.from({ length: width }, (_, c) => `${name}.${'xyzw'[c]}`);
  });
}

/** What a stored integer of a normalized type stands for. */
function scaleOf(scalar: Scalar): number {
  if (scalar === 'unorm8') return 1 / 255;
  if (scalar === 'snorm8') return 1 / 127;
  if (scalar === 'unorm16') return 1 / 65535;
  return scalar === 'snorm16' ? 1 / 32767 : 1;
}

/** The components of a plane's texels; integers beyond 2^53 are rounded. */
function componentsOf({ scalar, width }: Field, channels: HostArray, channelCount: number, isPacked: boolean): Float64Array[] {
  const words = channels as Uint32Array;
  const scale = scaleOf(scalar);
  if (isPacked) return [every(words, 0, 1, scale)];
  const components = Array.from({ length: width }, (_, c) => c);
  if (scalar === 'double') {
    const doubles = new Float64Array(words.buffer, words.byteOffset, words.length / 2);
    return components.map((c) => every(doubles, c, channelCount / 2, 1));
  }
  if (!is64Bit(scalar)) return components.map((c) => every(words, c, channelCount, scale));
  const upper = scalar === 'long' ? new Int32Array(words.buffer, words.byteOffset, words.length) : words;
  return components.map((c) => {
    const low = every(words, 2 * c, channelCount, 1);
    return every(upper, 2 * c + 1, channelCount, 2 ** 32).map((high, i) => high + low[i]!);
  });
}

/** Each `step`-th number from `first` on, times `scale`. */
function every(numbers: ArrayLike<number>, first: number, step: number, scale: number): Float64Array {
  const taken = new Float64Array(numbers.length / step);
  for (let i = 0; i < taken.length; ++i) taken[i] = numbers[first + i * step]! * scale;
  return taken;
}

/** Asks for the elements, as all calls before have left them. */
export function readColumns(of: Elements): Promise<Columns> {
  const view = viewOf(of);
  const { stream } = view;
  const { device, element, layout, planes } = stream;
  if (stream.size === 0) return Promise.resolve(scalarsOf(element).map(() => new Float64Array(0)));
  const channels = planes.map((plane) => device.readTexels(plane, layout.draws));
  const counts = planes.map(({ format }) => format.channels);
  const numbers = view.size === stream.size ? null : numbersOf(view);
  return Promise.all(channels).then((all) =>
    all.flatMap((each, i) => componentsOf(element.fields[i]!, each, counts[i]!, layout.packed)).map((whole) => {
      return numbers === null ? whole.subarray(0, view.size) : Float64Array.from(numbers, (n) => whole[n]!);
    }),
  );
}

/** The first components that are real numbers of some hundred elements, evenly spread; nothing if there are no real numbers. */
export function sampleOf(element: Element, columns: Columns): Float64Array {
  const most = 256;
  const all = columns[scalarsOf(element).findIndex(isReal)] ?? new Float64Array(0);
  const step = Math.max(1, Math.floor(all.length / most));
  return Float64Array.from({ length: Math.ceil(all.length / step) }, (_, i) => all[i * step]!);
}

/** Asks for one element, by its number in a stream: the value of each component. */
export async function readElement(stream: AnyStream, number: number): Promise<number[]> {
  const { device, element, layout, planes } = stream;
  const texel = layout.packed ? Math.floor(number / lanes) : number;
  const rects = [{ x: texel % layout.width, y: Math.floor(texel / layout.width), width: 1, height: 1 }];
  const counts = planes.map(({ format }) => format.channels);
  const all = await Promise.all(planes.map((plane) => device.readTexels(plane, rects)));
  return all.flatMap((each, i) => {
    const columns = componentsOf(element.fields[i]!, each, counts[i]!, layout.packed);
    return layout.packed ? [columns[0]![number % lanes]!] : columns.map((column) => column[0]!);
  });
}

/** The index, rows first, of a row-major number. */
export function indexIn(shape: readonly number[], number: number): number[] {
  const index = shape.map(() => 0);
  for (let d = shape.length - 1; d >= 0; --d) {
    index[d] = number % shape[d]!;
    number = Math.floor(number / shape[d]!);
  }
  return index;
}

/** The index in its stream of an element of a view. */
export function indexOf(of: Elements, number: number): number[] {
  const { begin, steps, shape } = viewOf(of);
  return indexIn(shape as readonly number[], number).map((i, d) => begin[d]! + i * steps[d]!);
}

function numberIn(shape: readonly number[], index: readonly number[]): number {
  return index.reduce((number, i, d) => number * shape[d]! + i, 0);
}

/** The numbers in their stream of a view's elements. */
function numbersOf(view: View<any, number>): Float64Array {
  const shape = view.stream.shape as readonly number[];
  return Float64Array.from({ length: view.size }, (_, i) => numberIn(shape, indexOf(view, i)));
}

/** The number in its stream of an input's element that belongs to an element of the domain; -1 if the shapes do not say. */
export function inputNumber(input: Elements, domain: readonly number[], number: number): number {
  const { stream, shape, begin, steps, size } = viewOf(input);
  const whole = stream.shape as readonly number[];
  const extents = shape as readonly number[];
  if (size !== 1 && extents.length !== domain.length) return -1;
  if (size !== 1 && extents.some((extent, d) => extent !== domain[d] && extent !== 1)) return -1;
  const index = size === 1 ? extents.map(() => 0) : indexIn(domain, number).map((i, d) => (extents[d] === 1 ? 0 : i));
  return numberIn(whole, index.map((i, d) => begin[d]! + i * steps[d]!));
}

/** Bytes on the host that the comparison of such elements takes. */
export function bytesOf(of: Elements): number {
  return 8 * viewOf(of).stream.size * scalarsOf(of.element).length;
}

