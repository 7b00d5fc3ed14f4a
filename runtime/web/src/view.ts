// SPDX-License-Identifier: MIT
//
// Views: elements of a stream at regular distances, to be read and written like a stream; and inputs that are fitted to the
// domain. What C++ has in sk/stream.hpp and sk/call.hpp.
import { copyRegion, type Region } from './copy.js';
import type { Device } from './device.js';
import { SkError } from './error.js';
import { copy, fill } from './filling.js';
import type { Element } from './generated.js';
import { shapeText, sizeOf, stridesOf, xFirst, type Index4, type Layout } from './layout.js';
import { Stream } from './stream.js';
import type { ArrayOf, ElementType, ShapeOf, ValueOf } from './types.js';

type AnyStream = Stream<any, number>;

export class View<T extends ElementType, R extends number> {
  /** For types alone, as in Stream. */
  declare readonly type: T;
  /** The number of elements. */
  readonly size: number;
  /** The stream's shape when the view was made: kernels that push change it. */
  private readonly whole: string;

  /** Element i is element begin + i * steps of the stream, in each dimension. @internal */
  constructor(
    readonly stream: Stream<T, R>, readonly shape: ShapeOf<R>, /** @internal */ readonly begin: readonly number[],
    /** @internal */ readonly steps: readonly number[],
  ) {
    this.size = sizeOf(shape);
    this.whole = shapeText(stream.shape);
  }

  get device(): Device {
    return this.stream.device;
  }
  /** @internal */
  get element(): Element {
    return this.stream.element;
  }

  /** The box from `begin` (inclusive) to `end` (exclusive), rows first. Throws SkError unless it is inside. */
  domain(begin: ShapeOf<R>, end: ShapeOf<R>): View<T, R> {
    const [from, to, shape] = [begin, end, this.shape] as readonly (readonly number[])[];
    const isPart = from!.length === shape!.length && to!.length === shape!.length && shape!.every((extent, d) => isFrom0(from![d]!, to![d]!) && isFrom0(to![d]!, extent));
    if (!isPart) {
      throw new SkError(
        `domain: ${shapeText(from!)} (inclusive) to ${shapeText(to!)} (exclusive) is no box inside shape ${shapeText(shape!)}; give each a position in every dimension, rows first`,
        'shape',
      );
    }
    const extents = from!.map((start, d) => to![d]! - start) as unknown as ShapeOf<R>;
    return new View(this.stream, extents, this.begin.map((start, d) => start + from![d]! * this.steps[d]!), this.steps);
  }

  /** Throws SkError if the stream cannot be read or written in part, or has another shape since. @internal */
  check(what: string): void {
    this.stream.check(what);
    if (shapeText(this.stream.shape) === this.whole) return;
    throw new SkError(`${what} has shape ${shapeText(this.stream.shape)} since a kernel pushed to it, and the view is of ${this.whole}; make it anew`, 'shape');
  }

  /** Whether no element of the stream lies between these. @internal */
  isBox(): boolean {
    return this.steps.every((step, d) => step === 1 || (this.shape as readonly number[])[d]! <= 1);
  }

  /** Copies elements to the device, rows first. The array may change as soon as this returns. */
  write(elements: ArrayOf<T>): void {
    const { stream } = this;
    this.check('the stream');
    const whole = this.newStream();
    whole.write(elements);
    whole.unpack();
    stream.unpack();
    stream.own();
    if (this.size > 0) copyRegion(this.device, sizes(this), regionOf(whole), regionOf(this));
    whole.dispose();
  }

  /** Copies the elements to the host, as Stream.read() does. */
  read(): Promise<ArrayOf<T>> {
    this.check('the stream');
    const whole = this.copied();
    const arrays = whole.read();
    whole.dispose();
    return arrays;
  }

  /** As Stream.fill(). */
  fill(value: ValueOf<T>): void {
    fill(this, value);
  }

  /** As Stream.copyTo(). */
  copyTo(target: Stream<T, R> | View<T, R>): void {
    copy(this, target);
  }

  /** A stream with these elements. @internal */
  copied(): Stream<T, R> {
    const whole = this.newStream();
    whole.forget();
    this.stream.unpack();
    if (this.size > 0) copyRegion(this.device, sizes(this), regionOf(this), regionOf(whole));
    return whole;
  }

  private newStream(): Stream<T, R> {
    return new Stream<T, R>(this.device, this.element, this.shape);
  }
}

/** Whether a number of elements is whole, and from 0 to `most`. */
function isFrom0(count: number, most: number): boolean {
  return Number.isInteger(count) && count >= 0 && count <= most;
}

/** The view of all elements. */
export function viewOf<T extends ElementType, R extends number>(of: Stream<T, R> | View<T, R>): View<T, R> {
  if (of instanceof View) return of;
  const shape = of.shape as readonly number[];
  return new View(of, of.shape, shape.map(() => 0), shape.map(() => 1));
}

/** An input that is fitted to the domain, made by stretch() and stride(). */
export class Fitted<T extends ElementType> {
  declare readonly type: T;
  /** @internal */
  constructor(/** @internal */ readonly view: View<T, number>, /** @internal */ readonly stretches: boolean, /** @internal */ readonly strides: boolean) {}

  get device(): Device {
    return this.view.device;
  }
}

type Fittable<T extends ElementType> = Stream<T, number> | View<T, number> | Fitted<T>;

function fitted<T extends ElementType>(input: Fittable<T>, stretches: boolean, strides: boolean): Fitted<T> {
  if (input instanceof Fitted) return new Fitted(input.view, stretches || input.stretches, strides || input.strides);
  return new Fitted(viewOf(input), stretches, strides);
}

/** For an input: each element serves several of the domain, whose extents are multiples of the input's. */
export function stretch<T extends ElementType>(input: Fittable<T>): Fitted<T> {
  return fitted(input, true, false);
}

/** For an input: every n-th element is read, as its extents are multiples of the domain's. */
export function stride<T extends ElementType>(input: Fittable<T>): Fitted<T>;
/** Every steps[d]-th element in each dimension from offsets[d] on, rows first: a view, to be read and written. */
export function stride<T extends ElementType, R extends number>(of: Stream<T, R> | View<T, R>, steps: ShapeOf<R>, offsets?: ShapeOf<R>): View<T, R>;
export function stride(of: Fittable<any>, steps?: readonly number[], offsets?: readonly number[]): unknown {
  if (steps === undefined) return fitted(of, false, true);
  const view = viewOf(of as AnyStream);
  const shape = view.shape as readonly number[];
  const from = offsets ?? shape.map(() => 0);
  const isPossible = steps.length === shape.length && from.length === shape.length && shape.every((extent, d) => isFrom0(steps[d]! - 1, Infinity) && isFrom0(from[d]!, extent));
  if (!isPossible) {
    throw new SkError(
      `stride: steps ${shapeText(steps)} from ${shapeText(from)} do not go through shape ${shapeText(shape)}; give each dimension, rows first, a step of at least 1 and an offset from 0 to its extent`,
      'shape',
    );
  }
  const extents = shape.map((extent, d) => Math.ceil((extent - from[d]!) / steps[d]!));
  return new View(view.stream, extents, view.begin.map((start, d) => start + from[d]! * view.steps[d]!), view.steps.map((step, d) => step * steps[d]!));
}

// ---- where the elements of a view lie -------------------------------------------------------------

function sizes(of: { readonly shape: unknown }): Index4 {
  return xFirst(of.shape as readonly number[]);
}

/** Fastest dimension first, with 0 for those that are missing. */
function origin(begin: readonly number[]): Index4 {
  const at = (d: number) => begin[begin.length - 1 - d] ?? 0;
  return [at(0), at(1), at(2), at(3)];
}

const four = (of: (d: number) => number): Index4 => [of(0), of(1), of(2), of(3)];
const dot = (a: Index4, b: Index4) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];

/** The elements of a view or stream, which is not packed, by their numbers in its textures. */
export function regionOf(of: AnyStream | View<any, number>): Region {
  const { stream, begin, steps } = viewOf(of);
  const strides = stridesOf(sizes(stream));
  const step = xFirst(steps);
  const { layout } = stream;
  return {
    planes: stream.planes, first: dot(origin(begin), strides), strides: four((d) => step[d]! * strides[d]!), width: layout.width, linear: layout.linear,
  };
}

/**
 * How programs for views address the elements of a view of an unpacked stream. `ratio`: of an input, k > 0 if each element
 * serves k of the domain, -k if every k-th is read.
 */
export function strided(view: View<any, number>, ratio: Index4): Layout {
  const whole = view.stream.layout;
  const step = xFirst(view.steps);
  const begin = origin(view.begin);
  const extent = sizes(view);
  if (!whole.linear) return { ...whole, extent, stride: step, origin: begin, ratio };
  return { ...whole, extent, stride: four((d) => step[d]! * whole.stride[d]!), origin: [dot(begin, whole.stride), 0, 0, 0], ratio };
}

/** The layout whose origin is the texel of a view's only element. */
export function texelOf(view: View<any, number>): Layout {
  const whole = view.stream.layout;
  const number = dot(origin(view.begin), stridesOf(sizes(view.stream)));
  return { ...whole, origin: [number % whole.width, Math.floor(number / whole.width), 0, 0] };
}
