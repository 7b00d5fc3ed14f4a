// SPDX-License-Identifier: MIT
//
// One linked program: where its uniforms are, and what was last given to them.
import type { Layout } from './layout.js';
import type { Trace } from './trace.js';
import type { Component } from './elements.js';
import { is64Bit } from './format.js';
import type { Element, Field, Parameter } from './generated.js';
import { SkError } from './error.js';

export const vertexText = `#version 300 es
void main() { gl_Position = vec4(float(gl_VertexID & 1) * 2.0 - 1.0, float(gl_VertexID & 2) - 1.0, 0.0, 1.0); }
`;

type Location = WebGLUniformLocation | null;

/** The uniforms that hold the layout of a stream or of the domain. */
class LayoutUniforms {
  private readonly shape: Location;
  private readonly stride: Location;
  private readonly shift: Location;
  private readonly origin: Location;
  private readonly ratio: Location;
  private last: Layout | null = null;

  constructor(private readonly gl: WebGL2RenderingContext, program: WebGLProgram, pattern: string) {
    const at = (part: string) => gl.getUniformLocation(program, pattern.replace('*', part));
    this.shape = at('shape');
    this.stride = at('stride');
    this.shift = at('shift');
    this.origin = at('origin');
    this.ratio = at('ratio');
  }

  set(layout: Layout): void {
    if (layout === this.last) return;
    this.last = layout;
    if (this.shape !== null) this.gl.uniform4iv(this.shape, layout.extent as unknown as number[]);
    if (this.stride !== null) this.gl.uniform4iv(this.stride, layout.stride as unknown as number[]);
    if (this.shift !== null) this.gl.uniform1i(this.shift, layout.shift);
    if (this.origin !== null) this.gl.uniform4iv(this.origin, (layout.origin ?? [0, 0, 0, 0]) as number[]);
    if (this.ratio !== null) this.gl.uniform4iv(this.ratio, (layout.ratio ?? [1, 1, 1, 1]) as number[]);
  }
}

/** The uniform of one field of a value, and how to set it. */
type Setter = (numbers: readonly number[]) => void;

function setterOf(gl: WebGL2RenderingContext, location: WebGLUniformLocation, field: Field, rows: number): Setter {
  if (rows > 1) {
    const set = [gl.uniformMatrix2fv, gl.uniformMatrix3fv, gl.uniformMatrix4fv][rows - 2]!;
    return (numbers) => set.call(gl, location, false, numbers as number[]);
  }
  const w = field.width - 1;
  switch (field.scalar) {
    case 'bool': case 'int': case 'char': case 'uchar': case 'short': case 'ushort': {
      if (w === 0) return (numbers) => gl.uniform1i(location, numbers[0]!);
      const set = [gl.uniform1iv, gl.uniform2iv, gl.uniform3iv, gl.uniform4iv][w]!;
      return (numbers) => set.call(gl, location, numbers as number[]);
    }
    case 'uint': {
      const set = [gl.uniform1uiv, gl.uniform2uiv, gl.uniform3uiv, gl.uniform4uiv][w]!;
      return (numbers) => set.call(gl, location, numbers as number[]);
    }
    default: {
      if (w === 0) return (numbers) => gl.uniform1f(location, numbers[0]!);
      const set = [gl.uniform1fv, gl.uniform2fv, gl.uniform3fv, gl.uniform4fv][w]!;
      return (numbers) => set.call(gl, location, numbers as number[]);
    }
  }
}

/** A uniform of any type: its components in order are divided among the uniforms of its fields. */
class ValueUniform {
  private readonly setters: { readonly set: Setter; readonly first: number; readonly count: number }[] = [];

  constructor(gl: WebGL2RenderingContext, program: WebGLProgram, name: string, element: Element) {
    let first = 0;
    for (let i = 0; i < element.fields.length; ) {
      const field = element.fields[i]!;
      let rows = 1;
      while ((element.fields[i + rows]?.part ?? 0) > 0) ++rows;
      let count = 0;
      for (let r = 0; r < rows; ++r) count += element.fields[i + r]!.width;
      const path = field.path ?? '';
      const full = path === '' || path.startsWith('[') ? name + path : `${name}.${path}`;
      if (field.scalar === 'double') this.addDoubles(gl, program, full, first, count);
      else if (is64Bit(field.scalar)) this.addLongs(gl, program, full, first, count);
      else this.add(gl, program, full, field, first, count, rows);
      first += count;
      i += rows;
    }
  }

  private add(
    gl: WebGL2RenderingContext, program: WebGLProgram, name: string, field: Field, first: number, count: number, rows: number,
  ): void {
    const location = gl.getUniformLocation(program, name);
    if (location !== null) this.setters.push({ set: setterOf(gl, location, field, rows), first, count });
  }

  /** A double is a struct of two floats. */
  private addDoubles(gl: WebGL2RenderingContext, program: WebGLProgram, name: string, first: number, count: number): void {
    for (let c = 0; c < count; ++c) {
      const one = count === 1 ? name : `${name}.${'xyzw'[c]}`;
      const hi = gl.getUniformLocation(program, `${one}.hi`);
      const lo = gl.getUniformLocation(program, `${one}.lo`);
      const set: Setter = ([value]) => {
        const high = Math.fround(value!);
        gl.uniform1f(hi, high);
        gl.uniform1f(lo, Number.isFinite(high) ? value! - high : 0);
      };
      this.setters.push({ set, first: first + c, count: 1 });
    }
  }

  /** An integer of 64 bits is a struct of its words. */
  private addLongs(gl: WebGL2RenderingContext, program: WebGLProgram, name: string, first: number, count: number): void {
    for (let c = 0; c < count; ++c) {
      const bits = gl.getUniformLocation(program, `${count === 1 ? name : `${name}.${'xyzw'[c]}`}.bits`);
      const set: Setter = ([value]) => {
        const whole = BigInt(value!);
        gl.uniform2ui(bits, Number(BigInt.asUintN(32, whole)), Number(BigInt.asUintN(32, whole >> 32n)));
      };
      this.setters.push({ set, first: first + c, count: 1 });
    }
  }

  set(numbers: readonly Component[]): void {
    for (const { set, first, count } of this.setters) {
      set((count === numbers.length ? numbers : numbers.slice(first, first + count)) as readonly number[]);
    }
  }
}

/** A parameter of a program: a stream that it reads, or a value. */
export interface Bound {
  readonly index: number;
  readonly parameter: Parameter;
  readonly layout?: LayoutUniforms;
  readonly value?: ValueUniform;
  readonly step?: ValueUniform;
  /** Of streams: the texture unit of each plane; negative: of a plan's stack, ~unit. */
  readonly units?: readonly number[];
}

/** Whose program it is. */
interface Owner {
  readonly context: WebGL2RenderingContext;
  readonly generation: number;
  readonly tracer: Trace | null;
}

/** A program that is being compiled, or has been. */
export class Program {
  private shaders: WebGLShader[] = [];
  private generation = -1;
  private started = 0;
  handle!: WebGLProgram;
  /** Set when it is first used. */
  reads: Bound[] = [];
  values: Bound[] = [];
  /** Scatter outputs. */
  targets: Bound[] = [];
  /** The texture unit of each of a plan's stacks. */
  readonly stacks = new Map<number, number>();
  domain!: LayoutUniforms;
  /** Texture units that its streams take. */
  units = 0;
  private isReady = false;
  private readonly integers = new Map<string, Location>();

  private readonly gl: WebGL2RenderingContext;

  constructor(
    private readonly device: Owner,
    readonly name: string,
    private readonly text: string,
    private readonly parameters: readonly Parameter[],
    private readonly elements: readonly Element[],
    private readonly isUsed: (parameter: Parameter) => boolean,
    private readonly vertices = vertexText,
    /** Whether a stream holds the value of a uniform. */
    private readonly isHeld: (index: number) => boolean = () => false,
  ) {
    this.gl = device.context;
    this.start();
  }

  /** Hands the program to the driver; again in a context that has been restored. */
  start(): void {
    const { gl } = this;
    this.generation = this.device.generation;
    this.started = performance.now();
    this.isReady = false;
    this.reads = [];
    this.values = [];
    this.targets = [];
    this.stacks.clear();
    this.units = 0;
    this.integers.clear();
    const handle = gl.createProgram();
    const shaders = [gl.createShader(gl.VERTEX_SHADER), gl.createShader(gl.FRAGMENT_SHADER)];
    if (handle === null || shaders.includes(null)) throw this.lostError();
    this.handle = handle;
    this.shaders = shaders as WebGLShader[];
    this.shaders.forEach((shader, stage) => {
      gl.shaderSource(shader, stage === 0 ? this.vertices : this.text);
      gl.compileShader(shader);
      gl.attachShader(handle, shader);
    });
    gl.linkProgram(handle);
  }

  private lostError(): SkError {
    return new SkError(`${this.name}: the browser has taken the context away; wait for device.onrestored, or make a new device`, 'lost');
  }

  /** Deletes it. */
  end(): void {
    for (const shader of this.shaders) this.gl.deleteShader(shader);
    this.gl.deleteProgram(this.handle);
  }

  /** Whether use() would not wait, if the driver can say so. */
  isLinked(parallel: { COMPLETION_STATUS_KHR: number } | null): boolean {
    return this.isReady || parallel === null || Boolean(this.gl.getProgramParameter(this.handle, parallel.COMPLETION_STATUS_KHR));
  }

  /** Waits for the driver, and finds uniforms; the program is current then. Throws SkError if the driver rejects it. */
  use(): void {
    if (this.generation !== this.device.generation) this.start();
    if (this.isReady) return;
    const { gl, handle } = this;
    if (!gl.getProgramParameter(handle, gl.LINK_STATUS)) {
      if (gl.isContextLost()) throw this.lostError();
      const log = this.shaders.map((shader) => gl.getShaderInfoLog(shader) ?? '').join('') + (gl.getProgramInfoLog(handle) ?? '');
      throw new SkError(`${this.name}: the driver refuses the program:\n${log}`, 'compile');
    }
    this.device.tracer?.measure('compilations', this.name, this.started);
    for (const shader of this.shaders) gl.deleteShader(shader);
    gl.useProgram(handle);
    this.domain = new LayoutUniforms(gl, handle, 'sk_domain_*');
    this.parameters.forEach((parameter, index) => {
      if (!this.isUsed(parameter)) return;
      const { role, symbol } = parameter;
      const element = this.elements[parameter.held ?? parameter.element]!;
      const layout = () => new LayoutUniforms(gl, handle, `sk_*_${symbol}`);
      const value = (kind: string) => new ValueUniform(gl, handle, `sk_${kind}_${symbol}`, this.elements[parameter.element]!);
      if (role === 'uniform' && !this.isHeld(index)) {
        this.values.push({ index, parameter, value: value('arg') });
      } else if (role === 'iterator') {
        this.values.push({ index, parameter, value: value('begin'), step: value('step'), layout: layout() });
      } else if (role === 'input' || role === 'gather' || role === 'uniform') {
        const units = element.fields.map((_, plane) => {
          const stack = parameter.layers?.[plane]?.[0] ?? -1;
          const known = this.stacks.get(stack);
          if (known !== undefined) return ~known;
          const name = stack >= 0 ? `sk_stack${stack}` : element.fields.length === 1 ? `sk_tex_${symbol}` : `sk_tex${plane}_${symbol}`;
          const unit = this.units++;
          gl.uniform1i(gl.getUniformLocation(handle, name), unit);
          if (stack < 0) return unit;
          this.stacks.set(stack, unit);
          return ~unit;
        });
        this.reads.push({ index, parameter, layout: layout(), units });
      } else if (role === 'scatter') {
        this.targets.push({ index, parameter, layout: layout() });
      }
    });
    this.isReady = true;
  }

  private locationOf(name: string): Location {
    let location = this.integers.get(name);
    if (location === undefined) {
      location = this.gl.getUniformLocation(this.handle, name);
      this.integers.set(name, location);
    }
    return location;
  }

  /** Sets an array of ints, likewise. */
  setIntegers(name: string, values: readonly number[]): void {
    const location = this.locationOf(name);
    if (location !== null) this.gl.uniform1iv(location, values as number[]);
  }

  /** Sets an int or ivec4 that a plan names; the program must be current. Names that it does not use are skipped. */
  setInteger(name: string, value: number | readonly number[]): void {
    const location = this.locationOf(name);
    if (location === null) return;
    if (typeof value === 'number') this.gl.uniform1i(location, value);
    else this.gl.uniform4iv(location, value as number[]);
  }
}
