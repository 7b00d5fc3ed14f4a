// SPDX-License-Identifier: MIT
//
// Streams: elements of one type in textures of the device, one plane for each scalar, vector or row of a matrix. Views of them:
// elements at regular distances, to be read and written like a stream; and inputs that are fitted to the domain. What C++ has in
// sk/stream.hpp and sk/call.hpp.
import { type Region, copyRegion } from './copy.js';
import type { Device } from './device.js';
import { channelsOf, heldComponent, isSameElement, mayPackElement, newArrays, numbersOf, planeArray, takeChannels, texelsBefore } from './elements.js';
import { SkError } from './error.js';
import { formatOf } from './format.js';
import type { Element, Field } from './generated.js';
import { checkShape, type Index4, type Layout, lanes, shapeText, sizeOf, stridesOf, texelsOf, xFirst } from './layout.js';
import type { Plane } from './memory.js';
import { Program } from './program.js';
import type { ArrayOf, ElementType, ShapeOf, ValueOf } from './types.js';

type AnyStream = Stream<any, number>;
type Elements = AnyStream | View<any, number>;

export class Stream<T extends ElementType, R extends number> {
  /** For types alone: streams of different elements or ranks are different types. */
  declare readonly type: T;
  /** Extents, rows first. */
  readonly shape: ShapeOf<R>;
  /** The number of elements. */
  readonly size: number;
  /** Whether a call is yet to find out how many elements it has. @internal */ isAwaited = false;
  /** @internal */ layout: Layout;
  /** @internal */ planes: Plane[] = [];
  private isDisposed = false;
  /** The device's generation in which the planes were made. */
  private generation: number;
  /** Whether the elements went with a context, and nothing has written them since. @internal */ isGone = false;
  /** What was written or kept, for a context that is restored, and the number of the request for it. */
  private copy: { readonly elements: ArrayOf<T>; readonly shape: readonly number[]; readonly number: number } | null = null;
  private requests = 0;

  /** @internal */
  constructor(readonly device: Device, /** @internal */ readonly element: Element, shape: ShapeOf<R>) {
    const extents = shape as readonly number[];
    checkShape(extents);
    this.shape = shape;
    this.size = sizeOf(extents);
    this.layout = device.layoutOf(extents, this.mayPack());
    device.begin();
    this.generation = device.generation;
    this.planes = this.newPlanes(this.layout);
    this.clear();
  }

  private clear(): void {
    const gl = this.device.context;
    for (const plane of this.planes) {
      this.device.framebufferOf([plane]);
      if (plane.format.sampler === 'int') gl.clearBufferiv(gl.COLOR, 0, [0, 0, 0, 0]);
      else if (plane.format.sampler === 'uint') gl.clearBufferuiv(gl.COLOR, 0, [0, 0, 0, 0]);
      else gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    }
  }

  /** The box from `begin` (inclusive) to `end` (exclusive), rows first: a view. Throws SkError unless it is inside the stream. */
  domain(begin: ShapeOf<R>, end: ShapeOf<R>): View<T, R> {
    return viewOf(this).domain(begin, end);
  }

  /** Gives all elements one value, on the device. Normalized types take the integers that they store. */
  fill(value: ValueOf<T>): void {
    fill(this, value);
  }

  /** Copies the elements, on the device, to a stream or view of the same shape, of the same device. Both may overlap. */
  copyTo(target: Stream<T, R> | View<T, R>): void {
    copy(this, target);
  }

  /** Whether four elements may share a texel, as far as the type says. @internal */
  mayPack(): boolean {
    return mayPackElement(this.element);
  }

  /** The layout with four elements in a texel, or without. @internal */
  layoutIf(packed: boolean): Layout {
    return this.device.layoutOf(this.shape as readonly number[], packed && this.mayPack());
  }

  /** @internal */
  newPlanes(layout: Layout): Plane[] {
    if (this.size === 0) return [];
    const { device, element } = this;
    const what = () => `a stream of ${element.name} of shape ${shapeText(this.shape as readonly number[])}`;
    if (layout === this.layout && this.planes.length > 0) return this.planes.map(({ shelf }) => device.take(shelf, what));
    const { packed, width, height } = layout;
    return element.fields.map((field) => device.take(device.shelfOf(device.formatOf(field.scalar, packed ? lanes : field.width), width, height), what));
  }

  /** Takes other planes of this layout for its own, which go back to the device. @internal */
  exchange(planes: Plane[], layout: Layout): void {
    if (planes === this.planes) return;
    this.device.release(this.planes);
    this.planes = planes;
    this.layout = layout;
  }

  /** Takes elements of another number; `shape` has one dimension. @internal */
  take(planes: Plane[], layout: Layout, shape: readonly number[]): void {
    if (this.isDisposed) return this.device.release(planes);
    this.exchange(planes, layout);
    this.resize(shape);
    this.isGone = false;
  }

  private resize(shape: readonly number[]): void {
    Object.assign(this, { shape, size: sizeOf(shape) });
  }

  /** Whether a call is yet to read the planes. @internal */
  isHeld(): boolean {
    for (const plane of this.planes) if (plane.holds > 0) return true;
    return false;
  }

  /** Whether check() would do nothing. @internal */
  isReady(isRead: boolean): boolean {
    return !this.isDisposed && !this.isAwaited && this.generation === this.device.generation && !(isRead && this.isGone);
  }

  /** Makes sure that nothing else reads the planes, so that they may be drawn to in part. @internal */
  own(): void {
    if (!this.isHeld()) return;
    const planes = this.newPlanes(this.layout);
    planes.forEach((plane, i) => this.device.copyTexels(this.planes[i]!, plane, this.layout.draws));
    this.exchange(planes, this.layout);
  }

  /**
   * Throws SkError if the stream has been disposed of, or if it is to be read and its elements went with the context. @internal
   */
  check(what: string, isRead = true): void {
    if (this.isDisposed) throw new SkError(`${what} has been disposed of`, 'lost');
    if (this.isAwaited) throw new SkError(`${what} is being written by a call that counts what it pushes; await the promise of that call first`);
    if (this.generation !== this.device.generation) this.restore();
    if (isRead && this.isGone) {
      throw new SkError(`${what} has lost its elements with the device's context, and there is no copy of them; write() them, and keep() those that must outlive it`, 'lost');
    }
  }

  /** Makes new planes in a context that has been restored, with the elements of the copy. */
  private restore(): void {
    const { device, copy } = this;
    device.begin();
    this.generation = device.generation;
    if (copy !== null) this.resize(copy.shape);
    this.planes = []; // they went with the context
    this.layout = this.layoutIf(true);
    this.planes = this.newPlanes(this.layout);
    this.isGone = copy === null && this.size > 0;
    if (copy === null) this.clear();
    else this.upload(copy.elements);
  }

  /** Copies elements to the device, rows first. The array may change as soon as this returns. */
  write(elements: ArrayOf<T>): void {
    this.check('the stream', false);
    this.device.begin();
    this.upload(elements);
    this.device.observer?.written(this);
    if (!this.device.keepsCopies) return;
    this.copy = { elements: cloned(elements) as ArrayOf<T>, shape: this.shape as readonly number[], number: ++this.requests };
  }

  /**
   * Copies the elements to the host: if the browser takes the context away and restores it, the stream has these elements
   * again. Changes after this are lost then, until the next keep().
   */
  async keep(): Promise<void> {
    const number = ++this.requests;
    const shape = this.shape as readonly number[];
    const elements = await this.download();
    if (number >= (this.copy?.number ?? 0)) this.copy = { elements, shape, number }; // of two copies, the one asked for later stays
  }

  private upload(elements: ArrayOf<T>): void {
    const { fields } = this.element;
    const arrays = fields.map((_, plane) => planeArray(this.element, plane, elements, this.size));
    if (this.size === 0) return;
    const packed = this.layoutIf(true);
    if (this.layout !== packed || this.isHeld()) this.exchange(this.newPlanes(packed), packed);
    fields.forEach((field, i) => this.uploadPlane(this.planes[i]!, channelsOf(field, arrays[i]!, this.size)));
    this.isGone = false;
  }

  private uploadPlane(plane: Plane, channels: ArrayBufferView): void {
    const gl = this.device.context;
    const { format, type, channels: width } = plane.format;
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    this.device.bindTexture(0, plane.texture);
    gl.activeTexture(gl.TEXTURE0);
    for (const rect of this.layout.draws) {
      const at = texelsBefore(this.layout, rect) * width;
      gl.texSubImage2D(gl.TEXTURE_2D, 0, rect.x, rect.y, rect.width, rect.height, format, type, channels, at);
    }
  }

  /** Copies the elements to the host. Never blocks: they are those that all calls before have left. */
  async read(): Promise<ArrayOf<T>> {
    this.check('the stream');
    this.device.observer?.read(this);
    return this.download();
  }

  /** What read() does, but no observer sees it. @internal */
  async download(): Promise<ArrayOf<T>> {
    this.check('the stream');
    this.device.begin();
    const { size } = this;
    const arrays = newArrays(this.element, size) as ArrayOf<T>;
    if (size === 0) return arrays;
    const transfers = this.planes.map((plane) => this.device.readTexels(plane, this.layout.draws));
    const { fields } = this.element;
    (await Promise.all(transfers)).forEach((channels, i) =>
      takeChannels(fields[i]!, channels, planeArray(this.element, i, arrays, size), size),
    );
    return arrays;
  }

  /** Converts a packed stream to one element in a texel. @internal */
  unpack(): void {
    if (!this.layout.packed) return;
    const { device } = this;
    const plain = this.layoutIf(false);
    const planes = this.newPlanes(plain);
    const program = unpackProgram(device, this.element.fields[0]!);
    device.useProgram(program);
    device.bindTexture(0, this.planes[0]!.texture);
    const from = this.layout;
    program.setInteger('shifts', [plain.linear ? plain.shift : -1, from.linear ? from.shift : -1, plain.extent[0], 0]);
    device.framebufferOf(planes);
    device.drawRects(plain.draws);
    this.exchange(planes, plain);
  }

  /** Takes one element in a texel, as unpack() does, but the elements are what they may be. @internal */
  forget(): void {
    const plain = this.layoutIf(false);
    if (this.layout !== plain) this.exchange(this.newPlanes(plain), plain);
  }

  /** Frees the elements. */
  dispose(): void {
    if (this.isDisposed) return;
    this.isDisposed = true;
    this.device.observer?.disposed(this);
    if (!this.device.lost) this.device.release(this.planes);
    this.planes = [];
    this.copy = null;
  }
}

/** A copy of an array, or of a struct's arrays. */
function cloned(arrays: unknown): unknown {
  if (ArrayBuffer.isView(arrays)) return (arrays as Float32Array).slice();
  return Object.fromEntries(Object.entries(arrays as object).map(([name, member]) => [name, cloned(member)]));
}

const unpackKey = {};

/** Component n & 3 of texel n >> 2; a packed plane may belong to a linearised stream. */
function unpackProgram(device: Device, field: Field): Program {
  const { sampler } = formatOf(field.scalar, lanes);
  const prefix = sampler === 'float' ? '' : sampler[0]!;
  const text = () => `#version 300 es
precision highp float;
precision highp int;
precision highp ${prefix}sampler2D;
uniform ${prefix}sampler2D packed4;
uniform ivec4 shifts;
out ${prefix}vec4 element;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  int n = shifts.x < 0 ? at.y * shifts.z + at.x : (at.y << shifts.x) | at.x;
  int texel = n >> 2, width = shifts.z >> 2;
  ivec2 from = shifts.y < 0 ? ivec2(texel % width, texel / width) : ivec2(texel & ((1 << shifts.y) - 1), texel >> shifts.y);
  element = ${prefix}vec4(texelFetch(packed4, from, 0)[n & 3], 0, 0, 0);
}
`;
  return device.program(unpackKey, sampler, 'unpacking', text, [], [], () => true);
}

// ---- views ----------------------------------------------------------------------------------------

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
    this.device.observer?.written(this);
  }

  /** Copies the elements to the host, as Stream.read() does. */
  read(): Promise<ArrayOf<T>> {
    this.check('the stream');
    this.device.observer?.read(this);
    const whole = this.copied();
    const arrays = whole.download();
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

// ---- filling and copying: runtime/src/api/stream.cpp ---------------------------------------------

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
    for (let c = 0; c < width; ++c) {
      const number = heldComponent(scalar, numbers[next]!);
      if (number === undefined) throw new SkError(`fill: ${numbers[next]} is no whole number, as ${element.name} holds`, 'type');
      ++next;
      for (let i = 0; i < count; ++i) array[i * step + first + c] = number as never;
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
  stream.device.observer?.written(of);
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
    a.device.observer?.copied(of, target);
    return;
  }
  const source = a === b ? from.copied() : of;
  a.unpack();
  b.unpack();
  b.own();
  copyRegion(a.device, xFirst(from.shape as readonly number[]), regionOf(source), regionOf(target));
  if (source !== of) (source as Stream<any, number>).dispose();
  a.device.observer?.copied(of, target);
}
