// SPDX-License-Identifier: MIT
//
// What streams and calls need of a device: its context's state and memory, programs, passes, transfers, and layouts.
import type { Abilities, Canvas } from './abilities.js';
import type { HostArray } from './format.js';
import type { Element, Parameter } from './generated.js';
import { layoutOf, mayPack, type Layout, type Rect } from './layout.js';
import { Memory, type Plane } from './memory.js';
import type { Observer } from './observer.js';
import { Program } from './program.js';
import { Trace } from './trace.js';
import { texelsIn, Transfers } from './transfers.js';

export abstract class Context extends Memory {
  /** @internal */ tracer: Trace | null = null;
  /** What sees the calls, reads and writes of the page. @internal */ observer: Observer | null = null;
  protected transfers: Transfers;
  private current: Program | null = null;
  private readonly programs = new Map<unknown, Map<string, Program>>();
  private readonly layouts = new Map<string, WeakRef<Layout>>();
  private mostLayouts = 1024;

  protected constructor(context: WebGL2RenderingContext, canvas: Canvas, abilities: Abilities, ownsContext: boolean, hasHiddenCanvas: boolean) {
    super(context, canvas, abilities, ownsContext, hasHiddenCanvas);
    this.transfers = new Transfers(this);
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
    if (this.current === program) return;
    program.use();
    this.context.useProgram(program.handle);
    this.current = program;
  }

  protected override forgetState(): void {
    super.forgetState();
    this.current = null;
  }

  /** A new context has nothing of the old one: programs are compiled again. */
  protected startAgain(): void {
    ++this.generation;
    this.forgetMemory();
    this.forgetFilters();
    this.transfers = new Transfers(this);
    this.layouts.clear(); // the largest texture may have another size
    this.forgetState();
    if (this.tracer !== null) this.tracer = new Trace(this);
    this.isLost = false;
    for (const programs of this.programs.values()) {
      for (const program of programs.values()) program.start();
    }
  }

  /** Deletes everything that it has made. */
  protected deleteAll(): void {
    this.deleteMemory();
    this.deleteFilters();
    for (const programs of this.programs.values()) {
      for (const program of programs.values()) program.end();
    }
    this.programs.clear();
  }

  /** Draws rectangles with the current program and framebuffer. @internal */
  drawRects(rects: readonly Rect[]): void {
    if (this.tracer === null) return this.drawEach(rects);
    this.tracePass(texelsIn(rects), () => this.drawEach(rects));
  }

  /** Draws a pass of the current program, which the tracer sees if there is one. @internal */
  tracePass(texels: number, draw: () => void): void {
    if (this.tracer === null) draw();
    else this.tracer.pass(this.current!.name, texels, draw);
  }

  private drawEach(rects: readonly Rect[]): void {
    const gl = this.context;
    for (const { x, y, width, height } of rects) {
      this.setViewport(x, y, width, height);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
  }

  /** Reads the texels of rectangles, one after the other: channels of the texture's format. @internal */
  readTexels(plane: Plane, rects: readonly Rect[]): Promise<HostArray> {
    this.framebufferOf([plane]);
    return this.transfers.read(plane.format, rects);
  }
}
