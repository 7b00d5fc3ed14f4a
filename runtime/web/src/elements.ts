// SPDX-License-Identifier: MIT
//
// Elements that every file knows, and the arrays of their components on the host.
import { SkError } from './error.js';
import { formatOf, hostArrayOf, is64Bit, type HostArray, type Scalar } from './format.js';
import type { Element, Field, StructElement } from './generated.js';
import type { Layout, Rect } from './layout.js';

const bytesOf: Readonly<Record<Scalar, number>> = {
  bool: 1, char: 1, uchar: 1, unorm8: 1, snorm8: 1, half: 2, short: 2, ushort: 2, unorm16: 2, snorm16: 2, int: 4, uint: 4, float: 4, double: 8, long: 8, ulong: 8,
};

const builtIn = new Map<string, Element>();

/** The element of 'float3' or 'float2x2'. Throws SkError for another name. */
export function builtInElement(name: string): Element {
  let element = builtIn.get(name);
  if (element === undefined) {
    element = made(name);
    builtIn.set(name, element);
  }
  return element;
}

function made(name: string): Element {
  const matrix = /^float([234])x\1$/.exec(name);
  if (matrix) {
    const n = Number(matrix[1]);
    const fields = Array.from({ length: n }, (_, part): Field => ({ scalar: 'float', width: n, offset: 4 * n * part, part }));
    return { name, size: 4 * n * n, fields };
  }
  const parts = /^([a-z]+)([234]?)$/.exec(name) ?? /^([us]norm(?:8|16))(?:x([234]))?$/.exec(name);
  const scalar = parts?.[1] as Scalar;
  if (parts === null || !(scalar in bytesOf)) {
    throw new SkError(`'${name}' is no type of elements; name one like 'float', 'int2' or 'unorm8x4', or give a struct that a .sk.js file exports`, 'type');
  }
  const width = Number(parts[2] || 1);
  const bytes = bytesOf[scalar];
  if (!is64Bit(scalar) || width <= 2) return { name, size: bytes * width, fields: [{ scalar, width, offset: 0 }] };
  const halves = [2, width - 2].map((half, part): Field => ({ scalar, width: half, offset: 16 * part, part }));
  return { name, size: bytes * width, fields: halves };
}

/** Whether both have the same planes in host memory. */
export function isSameElement(a: Element, b: Element): boolean {
  if (a === b) return true;
  const same = (x: Field, y: Field) => x.scalar === y.scalar && x.width === y.width && x.offset === y.offset && x.part === y.part;
  return a.size === b.size && a.fields.length === b.fields.length && a.fields.every((field, i) => same(field, b.fields[i]!));
}

/** Whether four elements fit in a texel: one scalar of at most four bytes. */
export function mayPackElement(element: Element): boolean {
  const field = element.fields[0]!;
  return element.fields.length === 1 && field.path === undefined && field.width === 1 && !is64Bit(field.scalar);
}

function isStruct(element: Element): element is StructElement {
  return 'planes' in element;
}

/** The arrays of a struct, by member, as far as they are given. */
type Members = { [name: string]: HostArray | Members };

/** The parts of a host array that one plane's components are: `first` of every `step` components. */
interface PlaneArray {
  readonly array: HostArray;
  readonly first: number;
  readonly step: number;
}

/** Components before a field in the array that it shares with the other parts of its vector or matrix, and in all of it. */
function placeOf(element: Element, plane: number): { first: number; step: number } {
  const part = element.fields[plane]!.part ?? 0;
  let begin = plane;
  while (begin > 0 && part > 0 && (element.fields[begin]!.part ?? 0) > 0) --begin;
  let end = begin + 1;
  while ((element.fields[end]?.part ?? 0) > 0) ++end;
  let first = 0;
  let step = 0;
  for (let i = begin; i < end; ++i) {
    if (i < plane) first += element.fields[i]!.width;
    step += element.fields[i]!.width;
  }
  return { first, step };
}

/** "origin.x" and "rows[1]" as names of members. Rows and parts of vectors are in their member's array. */
function namesOf(element: StructElement, plane: number): string[] {
  const path = element.planes[plane]!;
  const isPart = element.fields[plane]!.part !== undefined;
  const names = path.split(/[.[\]]+/).filter((name) => name !== '');
  if (!isPart) return names;
  return path.endsWith(']') ? names.slice(0, -2) : names.slice(0, -1);
}

/** The array of a plane among the given ones, `count` elements. Throws SkError if it has another type or length. */
export function planeArray(element: Element, plane: number, given: unknown, count: number): PlaneArray {
  let array = given;
  let name = '';
  if (isStruct(element)) {
    for (const member of namesOf(element, plane)) {
      name += `.${member}`;
      array = (array as Members | undefined)?.[member];
    }
  }
  const { scalar } = element.fields[plane]!;
  const type = hostArrayOf(scalar);
  if (!(array instanceof type)) {
    const what = array === undefined ? 'nothing is given' : `${withArticle((array as object)?.constructor?.name ?? typeof array)} is given`;
    throw new SkError(`a stream of ${element.name} is written from ${withArticle(type.name)}${name === '' ? '' : ` in ${name.slice(1)}`}, but ${what}`, 'type');
  }
  const place = placeOf(element, plane);
  if (array.length !== count * place.step) {
    throw new SkError(
      `${count} element(s) of ${element.name} are ${count * place.step} number(s)${name === '' ? '' : ` in ${name.slice(1)}`}, but the array has ${array.length}`,
      'shape',
    );
  }
  return { array: array as HostArray, ...place };
}

export function withArticle(noun: string): string {
  return `${/^[AEIO]/i.test(noun) ? 'an' : 'a'} ${noun}`;
}

/** New arrays for `count` elements, by which planeArray() finds all planes. */
export function newArrays(element: Element, count: number): unknown {
  if (!isStruct(element)) {
    const { step } = placeOf(element, 0);
    return new (hostArrayOf(element.fields[0]!.scalar))(count * step);
  }
  const members: Members = {};
  element.fields.forEach((field, plane) => {
    const names = namesOf(element, plane);
    let within = members;
    names.slice(0, -1).forEach((name) => (within = (within[name] ??= {}) as Members));
    const { step } = placeOf(element, plane);
    within[names[names.length - 1]!] ??= new (hostArrayOf(field.scalar))(count * step);
  });
  return members;
}

/** The array itself, or the words of components of 64 bits. */
function wordsOf(array: HostArray, words: number): Exclude<HostArray, BigInt64Array | BigUint64Array> {
  return words === 2 ? new Uint32Array(array.buffer, array.byteOffset, array.length * 2) : (array as Uint32Array);
}

/** The channels of a plane's texels, in the order of elements. */
export function channelsOf(field: Field, from: PlaneArray, count: number): HostArray {
  const format = formatOf(field.scalar, field.width);
  const words = is64Bit(field.scalar) ? 2 : 1;
  const source = wordsOf(from.array, words);
  if (from.step === field.width && field.width * words === format.channels && field.scalar !== 'bool') return source;
  const channels = new format.channel(count * format.channels);
  for (let i = 0; i < count; ++i) {
    for (let c = 0; c < field.width * words; ++c) {
      const value = source[(i * from.step + from.first) * words + c]!;
      channels[i * format.channels + c] = field.scalar === 'bool' ? Number(value !== 0) : value;
    }
  }
  return channels;
}

/** The reverse of channelsOf(). */
export function takeChannels(field: Field, channels: HostArray, to: PlaneArray, count: number): void {
  const format = formatOf(field.scalar, field.width);
  const words = is64Bit(field.scalar) ? 2 : 1;
  const target = wordsOf(to.array, words);
  if (to.step === field.width && field.width * words === format.channels) {
    target.set(channels as never);
    return;
  }
  for (let i = 0; i < count; ++i) {
    for (let c = 0; c < field.width * words; ++c) {
      target[(i * to.step + to.first) * words + c] = channels[i * format.channels + c] as number;
    }
  }
}

/** A component of a value; an integer of 64 bits is a bigint. */
export type Component = number | bigint;

/** One value from numbers, bigints and booleans: components in the order of fields. */
export function numbersOf(element: Element, value: unknown): Component[] {
  const numbers: Component[] = [];
  if (!isStruct(element)) return addNumbers(value, numbers);
  element.fields.forEach((_, plane) => {
    if ((element.fields[plane]!.part ?? 0) > 0) return; // its first part has taken all
    let member: unknown = value;
    for (const name of namesOf(element, plane)) member = (member as { [name: string]: unknown } | undefined)?.[name];
    addNumbers(member, numbers);
  });
  return numbers;
}

/** Appends the numbers of a value, of which there are none if it is no value at all. */
function addNumbers(value: unknown, numbers: Component[]): Component[] {
  if (typeof value === 'bigint') {
    numbers.push(value);
  } else if (typeof value === 'number' || typeof value === 'boolean') {
    numbers.push(Number(value));
  } else if (typeof value === 'object' && value !== null) {
    const members = (ArrayBuffer.isView(value) || Array.isArray(value) ? value : Object.values(value)) as ArrayLike<unknown>;
    for (let i = 0; i < members.length; ++i) addNumbers(members[i], numbers);
  }
  return numbers;
}

/** The value that has these components: the reverse of numbersOf(). */
export function valueOf(element: Element, arrays: unknown): unknown {
  if (!isStruct(element)) return scalarOrVector(element.fields[0]!.scalar, arrays as HostArray);
  const take = (members: Members): unknown =>
    Object.fromEntries(Object.entries(members).map(([name, member]) => [name, ArrayBuffer.isView(member) ? member : take(member)]));
  const value = take(arrays as Members) as { [name: string]: unknown };
  element.fields.forEach((field, plane) => {
    const names = namesOf(element, plane);
    let within: any = value;
    for (const name of names.slice(0, -1)) within = within[name];
    const last = names[names.length - 1]!;
    if (ArrayBuffer.isView(within[last])) within[last] = scalarOrVector(field.scalar, within[last] as HostArray);
  });
  return value;
}

/**
 * The component that a field holds for a given one; undefined if it holds no such number. WebGL makes integers of everything: of
 * NaN 0.
 */
export function heldComponent(scalar: Scalar, given: Component): Component | undefined {
  if (scalar === 'long' || scalar === 'ulong') {
    if (typeof given === 'number' && !Number.isSafeInteger(given)) return undefined;
    const whole = BigInt(given);
    const held = scalar === 'long' ? BigInt.asIntN(64, whole) : BigInt.asUintN(64, whole);
    return held === whole ? held : undefined;
  }
  if (typeof given === 'bigint') return undefined;
  return Number.isInteger(given) || fractions.includes(scalar) ? given : undefined;
}

/** Components that have fractions. */
export const fractions: readonly Scalar[] = ['float', 'double', 'half', 'unorm8', 'snorm8', 'unorm16', 'snorm16'];

function scalarOrVector(scalar: Scalar, array: HostArray): unknown {
  const components = Array.from(array as Iterable<Component>);
  const values: unknown[] = scalar === 'bool' ? components.map((word) => word !== 0) : components;
  return values.length === 1 ? values[0] : values;
}

/** Where the texels of `rects` are in an array of all of a layout's elements, in order. */
export function texelsBefore(layout: Layout, rect: Rect): number {
  return layout.linear ? rect.y * layout.width + rect.x : 0;
}
