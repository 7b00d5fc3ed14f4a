// SPDX-License-Identifier: MIT
//
// What a browser and a context can do, found out by trial where extensions promise too much.
import { SkError } from './error.js';
import { formatOf, type Format } from './format.js';

/** An HTMLCanvasElement or an OffscreenCanvas. */
export interface Canvas extends EventTarget {
  width: number;
  height: number;
  getContext(kind: string, options?: unknown): unknown;
}

/** What a device's 32-bit floats can do. */
export interface Arithmetic {
  /**
   * Whether the rounding errors of sums and products can be computed exactly, which compensated, exact and extended sums need
   * (TwoSum: Knuth, TAOCP 2, 4.2.2; TwoProd: Dekker, Numerische Mathematik 18, 1971).
   */
  readonly exactSums: boolean;
  /** Whether numbers below 2^-126 stay what they are; on many devices they become 0. */
  readonly keepsSubnormals: boolean;
}

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

export interface Abilities extends Omit<DeviceInfo, 'compilesInParallel' | 'arithmetic'> {
  readonly parallel: { COMPLETION_STATUS_KHR: number } | null;
}

/** Parts of the names of renderers that run on the processor, as in runtime/src/gl/known_devices.def. @internal */
export const softwareRenderers = /llvmpipe|softpipe|swrast|software|swiftshader|swr|gdi generic|microsoft basic render driver/i;

/** A canvas that nobody sees. */
export function ownCanvas(): Canvas {
  const { OffscreenCanvas } = globalThis as { OffscreenCanvas?: new (width: number, height: number) => Canvas };
  if (OffscreenCanvas !== undefined) return new OffscreenCanvas(1, 1);
  if (typeof document !== 'undefined') return document.createElement('canvas');
  throw new SkError('there is no canvas here: devices need a browser, or a worker with OffscreenCanvas', 'device');
}

/** The WebGL2 context of a canvas. Throws SkError if the browser gives none. */
export function contextOf(canvas: Canvas, { powerPreference, refuseSoftware = false }: DeviceOptions): WebGL2RenderingContext {
  if (typeof canvas?.getContext !== 'function') throw new SkError('options.canvas is no canvas; give an HTMLCanvasElement or an OffscreenCanvas', 'device');
  const attributes = { alpha: true, antialias: false, depth: false, stencil: false, powerPreference, failIfMajorPerformanceCaveat: refuseSoftware };
  const context = canvas.getContext('webgl2', attributes) as WebGL2RenderingContext | null;
  if (context !== null) return context;
  const orSoftware = refuseSoftware ? ', or allow software by leaving out refuseSoftware' : '';
  throw new SkError(
    'this browser gives no WebGL2 context: use one with WebGL2 (Chrome 56, Firefox 51, Safari 15), allow hardware ' +
      `acceleration, or give a canvas that has no other context${orSoftware}`,
    'device',
  );
}

/** Extensions must be asked for before anything needs them, also in a context that has been restored. */
export function abilitiesOf(gl: WebGL2RenderingContext, options: DeviceOptions): Abilities {
  if (typeof gl?.texStorage2D !== 'function') throw new SkError("options.context is no WebGL2 context; give canvas.getContext('webgl2')", 'device');
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  const text = (name: number) => String(gl.getParameter(name) ?? '');
  const renderer = text(names?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
  const isSoftware = softwareRenderers.test(renderer);
  if (isSoftware && options.refuseSoftware) {
    throw new SkError(`this browser computes on the processor ('${renderer}'); allow hardware acceleration, or leave out refuseSoftware`, 'device');
  }
  const get = (name: number) => gl.getParameter(name) as number;
  const floats = floatStorage(gl, options.requireFloats ?? false);
  const blends = gl.getExtension('EXT_float_blend') !== null;
  return {
    vendor: text(names?.UNMASKED_VENDOR_WEBGL ?? gl.VENDOR),
    renderer,
    isSoftware,
    floats,
    limits: {
      textureSize: get(gl.MAX_TEXTURE_SIZE),
      drawBuffers: Math.min(get(gl.MAX_DRAW_BUFFERS), get(gl.MAX_COLOR_ATTACHMENTS)),
      textureUnits: get(gl.MAX_TEXTURE_IMAGE_UNITS),
    },
    // Every device filters halves.
    filtersFloats: gl.getExtension('OES_texture_float_linear') !== null || floats === 'half',
    combinesScattered: floats === 'float' && blends,
    parallel: gl.getExtension('KHR_parallel_shader_compile') as { COMPLETION_STATUS_KHR: number } | null,
  };
}

/** Some devices have the extension and refuse such framebuffers all the same. */
function floatStorage(gl: WebGL2RenderingContext, isFloatRequired: boolean): 'float' | 'half' {
  const drawsAll = (extension: string, scalar: 'float' | 'half') =>
    gl.getExtension(extension) !== null && [1, 2, 4].every((width) => draws(gl, formatOf(scalar, width)));
  if (drawsAll('EXT_color_buffer_float', 'float')) return 'float';
  const drawsHalves = drawsAll('EXT_color_buffer_half_float', 'half');
  if (drawsHalves && !isFloatRequired) return 'half';
  const wayOut = drawsHalves ? ', and only halves are left; leave out requireFloats, or use another browser or device' : ', nor to halves; use another browser or device';
  throw new SkError(`this device does not draw to textures of 32-bit floats (EXT_color_buffer_float)${wayOut}`, 'device');
}

/** Whether the device draws to such a texture. Leaves the application's bindings as they are. */
function draws(gl: WebGL2RenderingContext, format: Format): boolean {
  const bound = [gl.getParameter(gl.TEXTURE_BINDING_2D), gl.getParameter(gl.FRAMEBUFFER_BINDING)] as const;
  const [texture, framebuffer] = [gl.createTexture(), gl.createFramebuffer()];
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, format.internal, 1, 1);
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  const isComplete = gl.checkFramebufferStatus(gl.FRAMEBUFFER) === gl.FRAMEBUFFER_COMPLETE;
  gl.bindTexture(gl.TEXTURE_2D, bound[0] as WebGLTexture | null);
  gl.bindFramebuffer(gl.FRAMEBUFFER, bound[1] as WebGLFramebuffer | null);
  gl.deleteFramebuffer(framebuffer);
  gl.deleteTexture(texture);
  return isComplete;
}
