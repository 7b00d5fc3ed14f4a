// SPDX-License-Identifier: MIT
//
// Checks of arguments, with the messages of runtime/src/call.
import type { Device } from './device.js';
import { fractions, heldComponent, isSameElement, numbersOf, withArticle, type Component } from './elements.js';
import { is64Bit } from './format.js';
import { SkError, type ErrorKind } from './error.js';
import { isNeeded, specBits, type Element, type Field, type KernelData, type Parameter } from './generated.js';
import { decodedRank, shapeText, xFirst } from './layout.js';
import type { GivenDomain } from './over.js';
import { Fitted, Stream, View } from './stream.js';

export type AnyStream = Stream<any, number>;

export function fail(kernel: string, message: string, kind: ErrorKind = 'misuse'): never {
  throw new SkError(`${kernel}: ${message}`, kind);
}

/** A call's arguments, one for each parameter. */
export interface Checked {
  readonly streams: readonly (AnyStream | null)[];
  /** Which elements of its stream an argument is, if not all; and how it is fitted to the domain. */
  readonly views: readonly (View<any, number> | null)[];
  readonly fits: readonly (Fitted<any> | null)[];
  /** Components of uniforms that no stream holds; null for other parameters. Iterators have those of `begin`, then of `end`. */
  readonly values: readonly (readonly Component[] | null)[];
  /** The words of spec parameters, in order. */
  readonly specs: readonly number[];
}

/** The streams and values of a call. Throws SkError if there are too many or too few, or if one has another type. */
export function checkArguments(kernel: KernelData, elements: readonly Element[], given: readonly unknown[]): Checked {
  const { name, parameters } = kernel;
  if (given.length !== parameters.length) fail(name, `${given.length} arguments are given, but ${parameters.length} are declared`);
  const streams: (AnyStream | null)[] = [];
  const views: (View<any, number> | null)[] = [];
  const fits: (Fitted<any> | null)[] = [];
  const values: (readonly Component[] | null)[] = [];
  const specs: number[] = [];
  parameters.forEach((parameter, i) => {
    const fitted = given[i] instanceof Fitted ? (given[i] as Fitted<any>) : null;
    const argument = fitted?.view ?? given[i];
    let stream: AnyStream | null = null;
    let value: readonly Component[] | null = null;
    const isElements = argument instanceof Stream || argument instanceof View;
    switch (parameter.role) {
      case 'spec': specs.push(specOf(name, parameter, elements, argument)); break;
      case 'uniform':
        if (isElements) stream = streamOf(name, parameter, elements, argument);
        else value = uniformOf(name, parameter, elements[parameter.element]!, argument);
        break;
      case 'iterator': value = iteratorOf(name, parameter, elements[parameter.element]!, argument); break;
      default: stream = argument === null ? null : streamOf(name, parameter, elements, argument);
    }
    if (fitted !== null && parameter.role !== 'input') fail(name, `'${parameter.name}' is no input 'T x<>', and stretch() and stride() fit these alone; give the stream, or a view by stride(stream, steps)`, 'type');
    streams.push(stream);
    views.push(argument instanceof View && argument.size !== stream?.size ? argument : null); // a view of all elements is the stream
    fits.push(fitted);
    values.push(value);
  });
  parameters.forEach((parameter, i) => {
    if (streams[i] !== null || values[i] !== null || parameter.role === 'spec' || parameter.role === 'accumulator') return;
    if (!isNeeded(parameter, specs)) return;
    const where = parameter.condition === undefined ? '' : ` here, where ${parameter.condition} holds`;
    fail(name, `'${parameter.name}' is null, but the kernel needs it${where}; give a stream`);
  });
  return { streams, views, fits, values, specs };
}

/** The word of a spec parameter. Throws SkError if the value is none. */
export function specOf(kernel: string, parameter: Parameter, elements: readonly Element[], value: unknown): number {
  const { scalar } = elements[parameter.element]!.fields[0]!;
  const isNumber = typeof value === 'number' && (scalar === 'float' || Number.isInteger(value));
  if (!isNumber && typeof value !== 'boolean') fail(kernel, `'${parameter.name}' is a spec ${scalar}, but ${described(value)} is given`, 'type');
  return specBits(scalar, value as number | boolean);
}

/** The components of a uniform. Throws SkError if the value is none. */
export function uniformOf(kernel: string, parameter: Parameter, element: Element, value: unknown): readonly Component[] {
  const [{ scalar, width }] = element.fields as [Field];
  if (typeof value === 'number' && width === 1 && element.fields.length === 1 && fractions.includes(scalar)) return [value];
  const numbers = typeof value === 'number' || typeof value === 'bigint' ? [value] : numbersOf(element, value);
  const wanted = element.fields.reduce((count, field) => count + field.width, 0);
  if (numbers.length !== wanted || (typeof value !== 'object' && wanted > 1)) {
    fail(kernel, `'${parameter.name}' is declared as ${element.name}, ${wanted} number(s), but ${described(value)} is given`, 'type');
  }
  return heldComponents(kernel, parameter, element, numbers);
}

function heldComponents(kernel: string, parameter: Parameter, element: Element, numbers: Component[]): readonly Component[] {
  let i = 0;
  for (const { scalar, width } of element.fields) {
    for (let c = 0; c < width; ++c, ++i) {
      const held = heldComponent(scalar, numbers[i]!);
      if (held !== undefined) {
        numbers[i] = held;
        continue;
      }
      const what = is64Bit(scalar) ? 'no such integer' : typeof numbers[i] === 'bigint' ? 'no number' : 'no whole number';
      fail(kernel, `'${parameter.name}' is declared as ${element.name}, but ${described(numbers[i])} is ${what}`, 'type');
    }
  }
  return numbers;
}

/** The components of an iterator's ends. Throws SkError if the value has none. */
export function iteratorOf(kernel: string, parameter: Parameter, element: Element, value: unknown): readonly Component[] {
  const ends = value as { begin: unknown; end: unknown } | null | undefined;
  if (typeof ends !== 'object' || ends === null || !('begin' in ends) || !('end' in ends)) {
    fail(kernel, `'${parameter.name}' is an iterator, but ${described(value)} is given; give { begin, end }`, 'type');
  }
  return [...uniformOf(kernel, parameter, element, ends!.begin), ...uniformOf(kernel, parameter, element, ends!.end)];
}

function streamOf(kernel: string, parameter: Parameter, elements: readonly Element[], value: unknown): AnyStream {
  const isView = value instanceof View;
  if (!(value instanceof Stream) && !isView) fail(kernel, `'${parameter.name}' is a stream, but ${described(value)} is given; make one by device.stream()`, 'type');
  const stream = (isView ? (value as View<any, number>).stream : value) as AnyStream;
  const { shape, size } = value as AnyStream | View<any, number>;
  const what = `${kernel}: the stream of '${parameter.name}'`;
  if (isView) (value as View<any, number>).check(what);
  else stream.check(what, !isWritten(parameter));
  const declared = elements[parameter.element]!;
  if (!isSameElement(stream.element, elements[parameter.held ?? parameter.element]!)) {
    fail(kernel, `'${parameter.name}' is declared as ${declared.name}, but its stream holds ${stream.element.name}`, 'type');
  }
  if (parameter.role === 'gather' && shape.length !== parameter.rank) {
    fail(kernel, `'${parameter.name}' is declared with ${parameter.rank} dimension(s), but its stream has shape ${shapeText(shape)}`, 'shape');
  }
  if (parameter.role === 'gather' && size === 0) {
    fail(kernel, `'${parameter.name}' has shape ${shapeText(shape)}: there is no element to read`, 'shape');
  }
  if (parameter.role === 'uniform' && size !== 1) {
    fail(kernel, `'${parameter.name}' is one value for all elements, but its stream has shape ${shapeText(shape)}; give a value, or a stream or view of one element`, 'shape');
  }
  if (parameter.role === 'uniform' && parameter.fromStream === undefined && !isPlain(declared)) {
    fail(kernel, `'${parameter.name}' is one value for all elements, and no stream stands for it here; read the stream, and give its value`, 'type');
  }
  return stream;
}

/** Whether a stream may hold a value without further text: floats, ints, uints and their vectors. */
function isPlain({ fields }: Element): boolean {
  const { scalar, path, part } = fields[0]!;
  return fields.length === 1 && path === undefined && part === undefined && (scalar === 'float' || scalar === 'int' || scalar === 'uint');
}

function described(value: unknown): string {
  if (value === null || value === undefined) return String(value);
  if (value instanceof Stream) return `a stream of ${value.element.name}`;
  if (value instanceof View) return `a view of ${value.element.name}`;
  if (typeof value === 'object') return `${withArticle(value.constructor?.name ?? 'object')}${Array.isArray(value) ? ` of ${value.length}` : ''}`;
  return typeof value === 'function' ? 'a function' : `${typeof value} ${String(value)}`;
}

/** Whether a call writes all of a stream, and reads none of it. */
export function isWritten({ role }: Parameter): boolean {
  return role === 'output' || role === 'variableOutput' || role === 'accumulator';
}

/** Whether a call reads the stream of a parameter. */
export function isRead(kernel: KernelData, i: number, call: Checked): boolean {
  const { role } = kernel.parameters[i]!;
  if (role === 'uniform') return call.streams[i] !== null;
  return (role === 'input' || role === 'gather') && isNeeded(kernel.parameters[i]!, call.specs);
}

/** The shape of a stream or view. */
export function shapeAt(call: Checked, i: number): readonly number[] {
  return (call.views[i] ?? call.streams[i]!).shape as readonly number[];
}

/**
 * The same call, but every view is a stream with its elements, which the caller disposes of: `copies`. For what has no
 * programs for views.
 */
export function withoutViews(call: Checked): { call: Checked; copies: readonly AnyStream[] } {
  if (call.views.every((view) => view === null)) return { call, copies: [] };
  const copies: AnyStream[] = [];
  const streams = call.streams.map((stream, i) => {
    const view = call.views[i];
    if (!view) return stream;
    copies.push(view.copied());
    return copies[copies.length - 1]!;
  });
  return { call: { ...call, streams, views: call.views.map(() => null) }, copies };
}

/** The common device of the streams or, if there are none, the given one. Throws SkError if there are two, or none. */
export function deviceOf({ name, parameters }: KernelData, streams: readonly (AnyStream | null)[], over: GivenDomain | null): Device {
  let first = -1;
  streams.forEach((stream, i) => {
    if (stream === null) return;
    if (first < 0) first = i;
    else if (stream.device !== streams[first]!.device) {
      const [a, b] = [parameters[first]!.name, parameters[i]!.name];
      fail(name, `'${a}' and '${b}' are streams of two devices; copy one of them through the host`, 'device');
    }
  });
  const given = over?.device;
  if (first < 0 && !given) fail(name, `no stream is given that says what device to run on; give one, or call it over a shape on a device, ${name}.over(device, [...])(...)`);
  const device = first < 0 ? given! : streams[first]!.device;
  if (given && given !== device) fail(name, 'over() gives the call to another device than that of its streams; give both one device', 'device');
  return device;
}

export function isSameShape(a: readonly number[], b: readonly number[]): boolean {
  return a.length === b.length && a.every((extent, d) => extent === b[d]);
}

/** Whether an iterator's components all advance with the number of the element, as those of scalars do. */
export function countsElements(element: Element, rank: number): boolean {
  return rank === 1 || element.fields[0]!.width === 1;
}

/** How an iterator is addressed over a domain of this shape. */
export function iterationOf(element: Element, shape: readonly number[]): 'linear' | 'aligned' {
  const isFlat = decodedRank(xFirst(shape)) === 1;
  return countsElements(element, shape.length) && !(element.fields[0]!.width === 1 && isFlat) ? 'linear' : 'aligned';
}

/** The first value of an iterator, and its step in each component. */
export function stepsOf(kernel: string, parameter: Parameter, element: Element, given: readonly Component[], shape: readonly number[]): { begin: number[]; step: number[] } {
  const ends = given as readonly number[]; // no iterator has 64 bits
  const { width, scalar } = element.fields[0]!;
  const counts = countsElements(element, shape.length);
  if (!counts && width !== shape.length) {
    fail(kernel, `the iterator '${parameter.name}' has ${width} components, but the domain ${shapeText(shape)} has ${shape.length} dimensions; give it one for each, or a scalar to count the elements`, 'shape');
  }
  const size = shape.reduce((a, b) => a * b, 1);
  const begin = ends.slice(0, width);
  const step = begin.map((from, c) => {
    const steps = counts ? size : shape[shape.length - 1 - c]!;
    const difference = ends[width + c]! - from;
    if (scalar !== 'float' && difference % steps !== 0) {
      fail(kernel, `the iterator '${parameter.name}' goes from ${from} to ${ends[width + c]} in ${steps} steps, which are not whole; choose ends whose difference ${steps} divides, or iterate over float`, 'shape');
    }
    return steps === 1 && scalar === 'float' ? 0 : difference / steps;  // one step may be too long for a float
  });
  return { begin, step };
}
