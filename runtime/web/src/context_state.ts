// SPDX-License-Identifier: MIT
//
// A WebGL2 context and its state: whether it is lost, and what is bound, so that nothing is bound twice.
import type { Abilities, Canvas, DeviceInfo } from './abilities.js';
import { SkError } from './error.js';

export abstract class ContextState {
  /** The device's context. Who draws with it must expect every binding to have changed after a call. */
  readonly context: WebGL2RenderingContext;
  /** What has been found out about the context; anew when it is restored. @internal */ abilities: Abilities;
  /** How often the context has been restored. Textures and programs of earlier times are gone. @internal */ generation = 0;
  protected isLost = false;
  protected isDisposed = false;
  protected boundFramebuffer: WebGLFramebuffer | null | undefined = undefined;
  protected boundTextures: (WebGLTexture | null)[] = [];
  private boundFilters: (string | null)[] = [];
  private readonly filters = new Map<string, WebGLSampler>();
  private readonly viewport = [-1, -1, -1, -1];

  /** `ownsContext`: nobody else draws with it. `hasHiddenCanvas`: nobody else sees its canvas. */
  protected constructor(
    context: WebGL2RenderingContext, readonly canvas: Canvas, abilities: Abilities, protected readonly ownsContext: boolean,
    /** @internal */ readonly hasHiddenCanvas: boolean,
  ) {
    this.context = context;
    this.abilities = abilities;
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

  /** Throws SkError if the context is lost. @internal */
  check(): void {
    if (this.isLost) throw this.lostError();
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

  protected forgetState(): void {
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

  /** @internal */
  bindTexture(unit: number, texture: WebGLTexture): void {
    if (this.boundTextures[unit] === texture) return;
    const gl = this.context;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    this.boundTextures[unit] = texture;
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

  /** The samplers of filters went with the context. */
  protected forgetFilters(): void {
    this.filters.clear();
  }

  protected deleteFilters(): void {
    for (const sampler of this.filters.values()) this.context.deleteSampler(sampler);
    this.filters.clear();
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
}
