// SPDX-License-Identifier: MIT
//
// A stream: elements of one type in textures of the device, one plane for each scalar, vector or row of a matrix.
import type { Device, Plane } from './device.js';
import { channelsOf, mayPackElement, newArrays, planeArray, takeChannels, texelsBefore } from './elements.js';
import { SkError } from './error.js';
import { copy, fill } from './filling.js';
import { formatOf } from './format.js';
import type { Element, Field } from './generated.js';
import { lanes, shapeText, sizeOf, type Layout } from './layout.js';
import { Program } from './program.js';
import type { ArrayOf, ElementType, ShapeOf, ValueOf } from './types.js';
import { viewOf, type View } from './view.js';

/** The largest extent of a stream. */
const mostExtent = 2 ** 30 - 1;

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
    const isShape = extents.length >= 1 && extents.length <= 4 && extents.every((n) => Number.isInteger(n) && n >= 0 && n <= mostExtent);
    if (!isShape) {
      throw new SkError(`${shapeText(extents)} is no shape: 1 to 4 extents, rows first, whole numbers from 0 to ${mostExtent}`, 'shape');
    }
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
    const elements = await this.read();
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
