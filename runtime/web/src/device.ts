// SPDX-License-Identifier: MIT
//
// A device: what a page makes and asks. What calls and streams need of it is a Context.
import { abilitiesOf, contextOf, ownCanvas, type Arithmetic, type Canvas, type DeviceInfo, type DeviceOptions } from './abilities.js';
import { arithmeticOf } from './arithmetic.js';
import { compileAll, type Compilable } from './compile.js';
import { Context } from './context.js';
import { drawStream, type DrawOptions } from './draw.js';
import { builtInElement } from './elements.js';
import { SkError } from './error.js';
import type { StructElement } from './generated.js';
import type { Shadow, ShadowOptions } from './shadow/shadow.js';
import { Stream } from './stream.js';
import { Trace } from './trace.js';
import type { ElementType, ShapeOf } from './types.js';

export class Device extends Context {
  /** Called when the browser takes the context away: calls fail until it is restored. */
  onlost: ((error: SkError) => void) | null = null;
  /** Called when the browser has given the context back. Streams with a host copy have its elements again. */
  onrestored: (() => void) | null = null;

  /** @internal */ readonly keepsCopies: boolean;
  private arithmetic: Arithmetic | null = null;
  private readonly listening = new AbortController();

  /**
   * Makes a device. Throws SkError, kind 'device', if the browser has no WebGL2, if it draws to textures of neither floats nor
   * halves, or if the options refuse what it has.
   */
  static async create(options: DeviceOptions = {}): Promise<Device> {
    return new Device(options);
  }

  private constructor(private readonly options: DeviceOptions) {
    const canvas = (options.context?.canvas as Canvas | undefined) ?? options.canvas ?? ownCanvas();
    const context = options.context ?? contextOf(canvas, options);
    if (context.isContextLost?.()) throw new SkError('the context is lost; make a device of a new canvas', 'lost');
    const ownsContext = options.context === undefined;
    super(context, canvas, abilitiesOf(context, options), ownsContext, ownsContext && options.canvas === undefined);
    this.keepsCopies = options.keepCopies ?? false;
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
    this.arithmetic = null;
    this.startAgain();
    this.onrestored?.();
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
    this.observer?.read(stream);
    drawStream(this, stream, canvas, options);
  }

  /** Compiles all programs of these kernels and reduces while the page goes on. `progress` gets a number from 0 to 1. */
  async compile(callables: readonly unknown[], progress?: (done: number) => void): Promise<void> {
    this.check();
    await compileAll(this, callables as readonly Compilable[], progress);
  }

  /**
   * Follows the calls on this device: what kernels compute is compared with what they would in pairs of floats, about 47 bits, until
   * stop(). Loads the module that does so. Throws SkError for options that are none, and if the device has a shadow already.
   */
  async shadow(options: ShadowOptions = {}): Promise<Shadow> {
    const { Shadow } = await import('./shadow/shadow.js');
    this.check();
    return Shadow.of(this, options);
  }

  /** Frees everything that the device has made. The context goes, too, if that is the device's own. */
  dispose(): void {
    if (this.isDisposed) return;
    this.isDisposed = true;
    this.lose();
    this.listening.abort();
    this.deleteAll();
    this.tracer = null;
    if (this.ownsContext) this.context.getExtension('WEBGL_lose_context')?.loseContext();
  }
}
