// SPDX-License-Identifier: MIT
//
// A device: a WebGL2 context, its textures and programs. All GL state that passes need is set here.
import { abilitiesOf, contextOf, ownCanvas, type Abilities, type Canvas } from './abilities.js';
import { arithmeticOf, type Arithmetic } from './arithmetic.js';
import { SkError } from './error.js';
import { formatOf, type Format, type HostArray, type Scalar } from './format.js';
import type { Element, GeneratedFile, Parameter, StructElement } from './generated.js';
import { layoutOf, mayPack, type Layout, type Rect } from './layout.js';
import { Program } from './program.js';
import { Stream } from './stream.js';
import { builtInElement } from './elements.js';
import type { ElementType, ShapeOf, Struct } from './types.js';
import { drawStream, type DrawOptions } from './draw.js';
import { compileAll, type Compilable } from './compile.js';
import { Trace } from './trace.js';
import { texelsIn, Transfers } from './transfers.js';

export interface DeviceOptions {
  /** A WebGL2 context of the application, or a canvas without a context; by default, the device has a canvas of its own. */
  readonly context?: WebGL2RenderingContext;
  readonly canvas?: Canvas;
  readonly powerPreference?: WebGLPowerPreference;
  /** Streams keep what is written to them on the host, too, so that a context that the browser takes away can be restored with it. */
  readonly keepCopies?: boolean;
  /** Device.trace, from the beginning. */
  readonly trace?: boolean;
  /** Refuse a device that stores floats as halves (DeviceInfo.floats). */
  readonly requireFloats?: boolean;
  /** Refuse a device that computes on the processor, as browsers without a graphics driver do. */
  readonly refuseSoftware?: boolean;
}

/** What a device is and can do. */
export interface DeviceInfo {
  readonly vendor: string;
  readonly renderer: string;
  /** Whether programs run on the processor. */
  readonly isSoftware: boolean;
  /** How float streams are stored: with 24 bits, or with the 11 bits of halves where the device draws to no others. */
  readonly floats: 'float' | 'half';
  readonly limits: {
    readonly textureSize: number;
    /** Planes that a kernel writes and reads in one pass. */
    readonly drawBuffers: number;
    readonly textureUnits: number;
  };
  /** Whether the device's own filter interpolates 32-bit floats, for gathers with [[filter]]. */
  readonly filtersFloats: boolean;
  /** Whether scatter outputs combine values: `r[i] += v`, min and max. */
  readonly combinesScattered: boolean;
  /** Whether programs compile while the page goes on. */
  readonly compilesInParallel: boolean;
  /** What its floats do, which the first info() tests; null where the context is lost before that. */
  readonly arithmetic: Arithmetic | null;
}

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
  /** When one was last taken or given back, on Device.clock. */
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
  /** Its place in Device.made. */
  ref: WeakRef<Plane> | null;
  /** Device.generation when it was made. */
  readonly generation: number;
  /** Calls that are yet to read it. */
  holds: number;
  /** Whether no stream has it any more, while calls hold it. */
  isLeft: boolean;
  framebuffer: WebGLFramebuffer | null;
  /** Framebuffers of several planes whose first one it is. */
  joints: Joint[];
}

export class Device {
  /** Called when the browser takes the context away: calls fail until it is restored. */
  onlost: ((error: SkError) => void) | null = null;
  /** Called when the browser has given the context back. Streams with a host copy have its elements again. */
  onrestored: (() => void) | null = null;
  /** The device's context. Who draws with it must expect every binding to have changed after a call. */
  readonly context: WebGL2RenderingContext;
  readonly canvas: Canvas;

  /** @internal */ tracer: Trace | null = null;
  /** @internal */ readonly keepsCopies: boolean;
  /** What has been found out about the context; anew when it is restored. @internal */ abilities: Abilities;
  /** How often the context has been restored. Textures and programs of earlier times are gone. @internal */ generation = 0;
  /** Whether nobody else sees the device's canvas. @internal */ readonly hasHiddenCanvas: boolean;
  private readonly ownsContext: boolean;
  private arithmetic: Arithmetic | null = null;
  private transfers: Transfers;
  private isLost = false;
  private isDisposed = false;
  private readonly programs = new Map<unknown, Map<string, Program>>();
  private readonly layouts = new Map<string, WeakRef<Layout>>();
  private mostLayouts = 1024;
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
  private readonly listening = new AbortController();
  private readonly joints = new Set<Joint>();
  private boundProgram: Program | null = null;
  private boundFramebuffer: WebGLFramebuffer | null | undefined = undefined;
  private boundTextures: (WebGLTexture | null)[] = [];
  private boundFilters: (string | null)[] = [];
  private readonly filters = new Map<string, WebGLSampler>();
  private readonly viewport = [-1, -1, -1, -1];

  /**
   * Makes a device. Throws SkError, kind 'device', if the browser has no WebGL2, if it draws to textures of neither floats nor
   * halves, or if the options refuse what it has.
   */
  static async create(options: DeviceOptions = {}): Promise<Device> {
    return new Device(options);
  }

  private constructor(private readonly options: DeviceOptions) {
    const canvas = (options.context?.canvas as Canvas | undefined) ?? options.canvas ?? ownCanvas();
    this.context = options.context ?? contextOf(canvas, options);
    if (this.context.isContextLost?.()) throw new SkError('the context is lost; make a device of a new canvas', 'lost');
    this.canvas = canvas;
    this.ownsContext = options.context === undefined;
    this.hasHiddenCanvas = this.ownsContext && options.canvas === undefined;
    this.keepsCopies = options.keepCopies ?? false;
    this.abilities = abilitiesOf(this.context, options);
    this.transfers = new Transfers(this);
    this.trace = options.trace ?? false;
    const { signal } = this.listening;
    const onLost = (event: Event) => {
      if (this.ownsContext) event.preventDefault(); // which asks the browser to restore it
      this.lose();
    };
    canvas.addEventListener('webglcontextlost', onLost, { signal });
    canvas.addEventListener('webglcontextrestored', () => this.restore(), { signal });
  }

  /** Whether calls, passes, compilations and transfers make entries for the browser's performance panel. */
  get trace(): boolean {
    return this.tracer !== null;
  }
  set trace(isOn: boolean) {
    if (isOn !== this.trace) this.tracer = isOn ? new Trace(this) : null;
  }

  /** @internal */
  get limits(): DeviceInfo['limits'] {
    return this.abilities.limits;
  }

  /** @internal */
  get filtersFloats(): boolean {
    return this.abilities.filtersFloats;
  }

  /** @internal */
  get parallel(): { COMPLETION_STATUS_KHR: number } | null {
    return this.abilities.parallel;
  }

  private lose(): void {
    if (this.isLost) return;
    this.isLost = true;
    const error = this.lostError();
    this.transfers.end(error);
    if (!this.isDisposed) this.onlost?.(error);
  }

  /** The browser has given the context back, with nothing in it: programs are compiled again, and streams when they are used. */
  private restore(): void {
    if (this.isDisposed || !this.isLost) return;
    try {
      this.abilities = abilitiesOf(this.context, this.options);
    } catch (error) {
      this.onlost?.(error as SkError); // the browser has given another device, which cannot do what the first one could
      return;
    }
    ++this.generation;
    this.arithmetic = null;
    for (const shelf of this.shelves.values()) shelf.idle.length = shelf.planes = 0;
    this.made.clear();
    this.madeBytes = this.idleBytes = this.peakBytes = 0;
    this.joints.clear();
    this.filters.clear();
    this.transfers = new Transfers(this);
    this.layouts.clear(); // the largest texture may have another size
    this.forgetState();
    if (this.tracer !== null) this.tracer = new Trace(this);
    this.isLost = false;
    for (const programs of this.programs.values()) {
      for (const program of programs.values()) program.start();
    }
    this.onrestored?.();
  }

  /** @internal */
  lostError(): SkError {
    if (this.isDisposed) return new SkError('the device has been disposed of; make a new one', 'lost');
    const wayOut = 'wait for device.onrestored, or make a new device; keep() the elements of streams that must outlive it';
    return new SkError(`the browser has taken the context away, and the elements of all streams with it; ${wayOut}`, 'lost');
  }

  /** Whether the context is lost. */
  get lost(): boolean {
    return this.isLost;
  }

  info(): DeviceInfo {
    const { parallel, ...rest } = this.abilities;
    if (!this.isLost) this.arithmetic ??= arithmeticOf(this);
    return { ...rest, compilesInParallel: parallel !== null, arithmetic: this.arithmetic };
  }

  /** A stream of this shape, rows first, whose elements are 0. */
  stream<T extends ElementType, S extends readonly [number, ...number[]]>(type: T, shape: S): Stream<T, S['length']> {
    this.check();
    const isStruct = typeof type === 'object' && type !== null && 'fields' in type;
    const element = isStruct ? (type as unknown as StructElement) : builtInElement(type as string);
    if (!Array.isArray(shape)) throw new SkError(`${String(shape)} is no shape: give an array of 1 to 4 extents, rows first`, 'shape');
    return new Stream<T, S['length']>(this, element, [...shape] as unknown as ShapeOf<S['length']>);
  }

  /**
   * Shows a stream in a canvas without a transfer to the host: in the one that the device was made with, or, of a device
   * with a canvas of its own, in any. Numbers are mapped to colours; elements of three or four components are colours
   * from 0 to 1.
   */
  draw(stream: Stream<any, number>, canvas: Canvas = this.canvas, options: DrawOptions = {}): void {
    this.check();
    drawStream(this, stream, canvas, options);
  }

  /** Compiles all programs of these kernels and reduces while the page goes on. `progress` gets a number from 0 to 1. */
  async compile(callables: readonly unknown[], progress?: (done: number) => void): Promise<void> {
    this.check();
    await compileAll(this, callables as readonly Compilable[], progress);
  }

  /** Frees everything that the device has made. The context goes, too, if that is the device's own. */
  dispose(): void {
    if (this.isDisposed) return;
    this.isDisposed = true;
    this.lose();
    this.listening.abort();
    const gl = this.context;
    this.deletePlanes([...this.made].flatMap((ref) => ref.deref() ?? []));
    this.shelves.clear();
    for (const sampler of this.filters.values()) gl.deleteSampler(sampler);
    for (const programs of this.programs.values()) {
      for (const program of programs.values()) program.end();
    }
    this.programs.clear();
    this.tracer = null;
    if (this.ownsContext) this.context.getExtension('WEBGL_lose_context')?.loseContext();
  }

  // ---- for streams and calls ------------------------------------------------------------------------

  /** Throws SkError if the context is lost. @internal */
  check(): void {
    if (this.isLost) throw this.lostError();
  }

  /** Layouts are shared: streams of one shape have the same object. @internal */
  layoutOf(shape: readonly number[], packed: boolean): Layout {
    const packs = packed && mayPack(shape);
    const key = shape.join() + packs;
    let layout = this.layouts.get(key)?.deref();
    if (layout === undefined) {
      layout = layoutOf(shape, this.limits.textureSize, packs);
      this.layouts.set(key, new WeakRef(layout));
      if (this.layouts.size > this.mostLayouts) this.forgetLayouts();
    }
    return layout;
  }

  /** Streams that kernels push to have many shapes in their life. */
  private forgetLayouts(): void {
    for (const [key, layout] of this.layouts) {
      if (layout.deref() === undefined) this.layouts.delete(key);
    }
    this.mostLayouts = Math.max(1024, 2 * this.layouts.size);
  }

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

  /** Reads and clears the context's error flags. Returns whether memory was exhausted. @internal */
  takeErrors(): boolean {
    const gl = this.context;
    let isFull = false;
    const mostFlags = 8; // a context that is lost may report errors forever
    for (let flag = 0; flag < mostFlags; ++flag) {
      const error = gl.getError();
      if (error === gl.NO_ERROR) break;
      isFull ||= error === gl.OUT_OF_MEMORY;
    }
    return isFull;
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

  private forgetState(): void {
    this.boundProgram = null;
    this.boundFramebuffer = undefined;
    this.boundTextures = [];
    this.boundFilters = [];
    this.viewport[2] = -1;
  }

  /** Begins a call: an application's context may be in any state. @internal */
  begin(): void {
    this.check();
    if (this.ownsContext) return;
    this.resetState();
  }

  /** Sets the state of runtime/src/gl/pass_state.def that browsers have, and more. @internal */
  resetState(): void {
    const gl = this.context;
    this.forgetState();
    const toggles = [
      gl.SCISSOR_TEST, gl.BLEND, gl.DEPTH_TEST, gl.STENCIL_TEST, gl.CULL_FACE, gl.RASTERIZER_DISCARD, gl.DITHER, gl.SAMPLE_ALPHA_TO_COVERAGE,
      gl.SAMPLE_COVERAGE,
    ];
    for (const name of toggles) gl.disable(name);
    gl.colorMask(true, true, true, true);
    gl.bindVertexArray(null);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, null);
    const pixelParameters = [
      gl.UNPACK_ROW_LENGTH, gl.UNPACK_IMAGE_HEIGHT, gl.UNPACK_SKIP_PIXELS, gl.UNPACK_SKIP_ROWS, gl.UNPACK_SKIP_IMAGES, gl.PACK_ROW_LENGTH,
      gl.PACK_SKIP_PIXELS, gl.PACK_SKIP_ROWS,
    ];
    for (const name of pixelParameters) gl.pixelStorei(name, 0);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.pixelStorei(gl.PACK_ALIGNMENT, 1);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
    for (let unit = 0; unit < this.limits.textureUnits; ++unit) gl.bindSampler(unit, null);
  }

  /** The program of a callable of a file under this key; `text` is asked for once. @internal */
  program(
    owner: unknown, key: string, name: string, text: () => string, parameters: readonly Parameter[], elements: readonly Element[],
    isUsed: (parameter: Parameter) => boolean, vertices?: string, isHeld?: (index: number) => boolean,
  ): Program {
    let programs = this.programs.get(owner);
    if (programs === undefined) this.programs.set(owner, (programs = new Map()));
    let program = programs.get(key);
    if (program === undefined) {
      program = new Program(this, name, text(), parameters, elements, isUsed, vertices, isHeld);
      programs.set(key, program);
    }
    return program;
  }

  /** @internal */
  useProgram(program: Program): void {
    if (this.boundProgram === program) return;
    program.use();
    this.context.useProgram(program.handle);
    this.boundProgram = program;
  }

  /** @internal */
  bindTexture(unit: number, texture: WebGLTexture): void {
    if (this.boundTextures[unit] === texture) return;
    const gl = this.context;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    this.boundTextures[unit] = texture;
  }

  /** Binds a plane whose texels are fetched as they are. @internal */
  bindPlane(unit: number, plane: Plane): void {
    this.bindTexture(unit, plane.texture);
    this.bindFilter(unit, null);
  }

  /** Binds a linear filter with this boundary, or none, which leaves texels as they are. @internal */
  bindFilter(unit: number, boundary: 'clamp' | 'wrap' | 'mirror' | null): void {
    if ((this.boundFilters[unit] ?? null) === boundary) return;
    const gl = this.context;
    this.boundFilters[unit] = boundary;
    if (boundary === null) return gl.bindSampler(unit, null);
    let sampler = this.filters.get(boundary);
    if (sampler === undefined) {
      sampler = gl.createSampler()!;
      const wrap = { clamp: gl.CLAMP_TO_EDGE, wrap: gl.REPEAT, mirror: gl.MIRRORED_REPEAT }[boundary];
      for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.samplerParameteri(sampler, name, gl.LINEAR);
      for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.samplerParameteri(sampler, name, wrap);
      this.filters.set(boundary, sampler);
    }
    gl.bindSampler(unit, sampler);
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

  /** @internal */
  bindFramebuffer(framebuffer: WebGLFramebuffer | null): void {
    if (this.boundFramebuffer === framebuffer) return;
    this.context.bindFramebuffer(this.context.FRAMEBUFFER, framebuffer);
    this.boundFramebuffer = framebuffer;
  }

  /** @internal */
  setViewport(x: number, y: number, width: number, height: number): void {
    const last = this.viewport;
    if (last[0] === x && last[1] === y && last[2] === width && last[3] === height) return;
    this.context.viewport(x, y, width, height);
    last[0] = x;
    last[1] = y;
    last[2] = width;
    last[3] = height;
  }

  /** Draws rectangles with the current program and framebuffer. @internal */
  drawRects(rects: readonly Rect[]): void {
    if (this.tracer === null) return this.drawEach(rects);
    this.tracePass(texelsIn(rects), () => this.drawEach(rects));
  }

  /** Draws a pass of the current program, which the tracer sees if there is one. @internal */
  tracePass(texels: number, draw: () => void): void {
    if (this.tracer === null) draw();
    else this.tracer.pass(this.boundProgram!.name, texels, draw);
  }

  private drawEach(rects: readonly Rect[]): void {
    const gl = this.context;
    for (const { x, y, width, height } of rects) {
      this.setViewport(x, y, width, height);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
  }

  /** Copies texels between planes of one format. @internal */
  copyTexels(from: Plane, to: Plane, rects: readonly Rect[]): void {
    const gl = this.context;
    this.framebufferOf([from]);
    this.bindTexture(0, to.texture);
    gl.activeTexture(gl.TEXTURE0);
    for (const { x, y, width, height } of rects) gl.copyTexSubImage2D(gl.TEXTURE_2D, 0, x, y, x, y, width, height);
  }

  /** Reads the texels of rectangles, one after the other: channels of the texture's format. @internal */
  readTexels(plane: Plane, rects: readonly Rect[]): Promise<HostArray> {
    this.framebufferOf([plane]);
    return this.transfers.read(plane.format, rects);
  }
}

/** The framebuffer that draws to these planes, of which `first` is one, if there is one. */
function jointOf(first: Plane, planes: readonly Plane[]): WebGLFramebuffer | null {
  for (const joint of first.joints) {
    if (joint.planes.length === planes.length && joint.planes.every((plane, i) => plane === planes[i])) return joint.framebuffer;
  }
  return null;
}

/** The elements of a file's kernels, and the structs that it exports. @internal */
export function structOf(file: GeneratedFile, name: string): Struct<string, unknown, unknown> {
  return file.structs.find((struct) => struct.name === name) as unknown as Struct<string, unknown, unknown>;
}
