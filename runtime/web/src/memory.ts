// SPDX-License-Identifier: MIT
//
// The memory of a context: textures, those that nothing uses for a while among them, and the framebuffers that draw to them.
import { ContextState } from './context_state.js';
import { SkError } from './error.js';
import { formatOf, type Format, type Scalar } from './format.js';
import type { Rect } from './layout.js';

/** Planes of one format and size, of which nothing uses the idle ones. */
export interface Shelf {
  readonly key: number;
  readonly format: Format;
  readonly width: number;
  readonly height: number;
  /** What a plane takes. */
  readonly bytes: number;
  readonly idle: Plane[];
  /** How many there are, idle or not. */
  planes: number;
  /** When one was last taken or given back, on Memory.clock. */
  used: number;
}

/** Idle planes may take this much before the first are deleted, and a plane counts as this much at least, in bytes. */
const fewIdleBytes = 2 ** 26;
const leastBytes = 2 ** 16;

/** A framebuffer that draws to several planes. */
interface Joint {
  readonly planes: readonly Plane[];
  readonly framebuffer: WebGLFramebuffer;
}

/** A texture, and the framebuffer that draws to it alone. */
export interface Plane {
  readonly texture: WebGLTexture;
  readonly format: Format;
  readonly width: number;
  readonly height: number;
  /** Where it goes when nothing uses it any more. */
  readonly shelf: Shelf;
  /** Its place in Memory.made. */
  ref: WeakRef<Plane> | null;
  /** ContextState.generation when it was made. */
  readonly generation: number;
  /** Calls that are yet to read it. */
  holds: number;
  /** Whether no stream has it any more, while calls hold it. */
  isLeft: boolean;
  framebuffer: WebGLFramebuffer | null;
  /** Framebuffers of several planes whose first one it is. */
  joints: Joint[];
}

export abstract class Memory extends ContextState {
  private readonly shelves = new Map<number, Shelf>();
  /** All planes. Those of streams that are dropped without dispose() go with them, and their textures, too. */
  private readonly made = new Set<WeakRef<Plane>>();
  private readonly collected = new FinalizationRegistry<{ ref: WeakRef<Plane>; shelf: Shelf }>(({ ref, shelf }) => {
    if (this.made.delete(ref)) this.forget(shelf);
  });
  private madeBytes = 0;
  private idleBytes = 0;
  /** The most that were in use at once, of which a part is forgotten with each plane that is taken. */
  private peakBytes = 0;
  private clock = 0;
  private readonly joints = new Set<Joint>();

  /** The format of a plane of `width` components: of floats, that in which this device stores them. @internal */
  formatOf(scalar: Scalar, width: number): Format {
    return formatOf(scalar === 'float' ? this.abilities.floats : scalar, width);
  }

  /** @internal */
  shelfOf(format: Format, width: number, height: number): Shelf {
    const key = (format.internal * 2 ** 16 + width) * 2 ** 16 + height;
    let shelf = this.shelves.get(key);
    if (shelf === undefined) {
      const bytes = Math.max(leastBytes, width * height * format.channels * format.channel.BYTES_PER_ELEMENT);
      this.shelves.set(key, (shelf = { key, format, width, height, bytes, idle: [], planes: 0, used: 0 }));
    }
    return shelf;
  }

  /** @internal */
  acquire(format: Format, width: number, height: number, what: string): Plane {
    return this.take(this.shelfOf(format, width, height), what);
  }

  /** A plane of any content; `what` it is for, if there is no memory. @internal */
  take(shelf: Shelf, what: string | (() => string)): Plane {
    const idle = shelf.idle.pop();
    shelf.used = ++this.clock;
    if (idle !== undefined) {
      this.idleBytes -= shelf.bytes;
      this.notePeak();
      return idle;
    }
    const { format, width, height } = shelf;
    const gl = this.context;
    if (!this.ownsContext) this.takeErrors(); // the application's
    const texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    this.boundTextures[0] = texture;
    gl.texStorage2D(gl.TEXTURE_2D, 1, format.internal, width, height);
    const isFull = this.takeErrors();
    if (gl.isContextLost()) throw this.lostError(); // the event is yet to come
    if (texture === null || isFull) {
      gl.deleteTexture(texture);
      this.boundTextures[0] = null;
      throw new SkError(`there is no memory for ${typeof what === 'string' ? what : what()}`, 'memory');
    }
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
    const plane: Plane = { texture, format, width, height, shelf, ref: null, generation: this.generation, holds: 0, isLeft: false, framebuffer: null, joints: [] };
    const ref = (plane.ref = new WeakRef(plane));
    this.made.add(ref);
    this.collected.register(plane, { ref, shelf }, plane);
    ++shelf.planes;
    this.madeBytes += shelf.bytes;
    this.notePeak();
    return plane;
  }

  private notePeak(): void {
    this.peakBytes = Math.max(0.999 * this.peakBytes, this.madeBytes - this.idleBytes);
  }

  /** A plane of this shelf is no more. */
  private forget(shelf: Shelf): void {
    this.madeBytes -= shelf.bytes;
    if (--shelf.planes === 0) this.shelves.delete(shelf.key);
  }

  /** @internal */
  release(planes: readonly Plane[]): void {
    for (const plane of planes) {
      if (plane.generation !== this.generation || this.isDisposed) continue; // it went with the context
      if (plane.holds > 0) {
        plane.isLeft = true;
        continue;
      }
      plane.shelf.idle.push(plane);
      plane.shelf.used = ++this.clock;
      this.idleBytes += plane.shelf.bytes;
    }
    if (this.idleBytes > this.mostIdleBytes()) this.forgetIdle();
  }

  private mostIdleBytes(): number {
    return Math.max(fewIdleBytes, 2 * this.peakBytes);
  }

  /** Deletes the idle planes that have waited longest, until half as many may come again. */
  private forgetIdle(): void {
    const most = this.mostIdleBytes() / 2;
    const shelves = [...this.shelves.values()].filter(({ idle }) => idle.length > 0).sort((a, b) => a.used - b.used);
    const unused: Plane[] = [];
    for (const { idle, bytes } of shelves) {
      if (this.idleBytes <= most) break;
      const count = Math.min(idle.length, Math.ceil((this.idleBytes - most) / bytes));
      unused.push(...idle.splice(0, count));
      this.idleBytes -= count * bytes;
    }
    this.deletePlanes(unused);
  }

  /** Keeps planes as they are until letGo(): whoever writes their streams meanwhile draws to others. @internal */
  hold(planes: readonly Plane[]): Plane[] {
    planes.forEach((plane) => ++plane.holds);
    return [...planes];
  }

  /** Ends hold(), and empties the list. @internal */
  letGo(planes: Plane[]): void {
    for (const plane of planes.splice(0)) {
      if (--plane.holds > 0 || !plane.isLeft) continue;
      plane.isLeft = false;
      this.release([plane]);
    }
  }

  /** Deletes textures that no stream uses. */
  trim(): void {
    const unused = [...this.shelves.values()].flatMap(({ idle }) => idle.splice(0));
    this.idleBytes = 0;
    this.deletePlanes(unused);
  }

  /** Deletes planes that nothing uses, with all framebuffers that draw to them. */
  private deletePlanes(planes: readonly Plane[]): void {
    const gl = this.context;
    const unused = new Set(planes);
    const framebuffers = planes.map(({ framebuffer }) => framebuffer);
    for (const joint of this.joints) {
      if (!joint.planes.some((plane) => unused.has(plane))) continue;
      framebuffers.push(joint.framebuffer);
      this.joints.delete(joint);
      const first = joint.planes[0]!;
      first.joints = first.joints.filter((other) => other !== joint);
    }
    for (const framebuffer of framebuffers) gl.deleteFramebuffer(framebuffer);
    if (framebuffers.includes(this.boundFramebuffer ?? null)) this.boundFramebuffer = undefined;
    const textures = new Set<WebGLTexture | null>(planes.map(({ texture }) => texture));
    for (const texture of textures) gl.deleteTexture(texture);
    this.boundTextures = this.boundTextures.map((texture) => (textures.has(texture) ? null : texture));
    for (const plane of unused) {
      this.made.delete(plane.ref!);
      this.collected.unregister(plane);
      this.forget(plane.shelf);
    }
  }

  /** Deletes all planes. */
  protected deleteMemory(): void {
    this.deletePlanes([...this.made].flatMap((ref) => ref.deref() ?? []));
    this.shelves.clear();
  }

  /** All planes went with the context. */
  protected forgetMemory(): void {
    for (const shelf of this.shelves.values()) shelf.idle.length = shelf.planes = 0;
    this.made.clear();
    this.madeBytes = this.idleBytes = this.peakBytes = 0;
    this.joints.clear();
  }

  /** Binds a plane whose texels are fetched as they are. @internal */
  bindPlane(unit: number, plane: Plane): void {
    this.bindTexture(unit, plane.texture);
    this.bindFilter(unit, null);
  }

  /** Binds a framebuffer that draws to these planes. @internal */
  framebufferOf(planes: readonly Plane[]): void {
    const first = planes[0]!;
    const known = planes.length === 1 ? first.framebuffer : jointOf(first, planes);
    if (known !== null) return this.bindFramebuffer(known);
    const gl = this.context;
    const framebuffer = gl.createFramebuffer()!;
    this.bindFramebuffer(framebuffer);
    planes.forEach((plane, i) =>
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, plane.texture, 0),
    );
    gl.drawBuffers(planes.map((_, i) => gl.COLOR_ATTACHMENT0 + i));
    if (planes.length === 1) {
      first.framebuffer = framebuffer;
      return;
    }
    const joint = { planes: [...planes], framebuffer };
    first.joints.push(joint);
    this.joints.add(joint);
  }

  /** Copies texels between planes of one format. @internal */
  copyTexels(from: Plane, to: Plane, rects: readonly Rect[]): void {
    const gl = this.context;
    this.framebufferOf([from]);
    this.bindTexture(0, to.texture);
    gl.activeTexture(gl.TEXTURE0);
    for (const { x, y, width, height } of rects) gl.copyTexSubImage2D(gl.TEXTURE_2D, 0, x, y, x, y, width, height);
  }
}

/** The framebuffer that draws to these planes, of which `first` is one, if there is one. */
function jointOf(first: Plane, planes: readonly Plane[]): WebGLFramebuffer | null {
  for (const joint of first.joints) {
    if (joint.planes.length === planes.length && joint.planes.every((plane, i) => plane === planes[i])) return joint.framebuffer;
  }
  return null;
}
