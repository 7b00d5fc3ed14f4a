// SPDX-License-Identifier: MIT
//
// The short way of a call that is like an earlier one: its streams lie as the earlier ones did, and its spec parameters have
// the same values. What was found out then holds again: types and shapes need no check, and program, domain and textures no
// search. It allocates next to nothing. What is not alike, and every mistake, goes the long way (kernel.ts).
import { isRead, isWritten, iteratorOf, specOf, stepsOf, uniformOf, type AnyStream, type Checked } from './arguments.js';
import type { Device } from './device.js';
import type { Component } from './elements.js';
import type { Element, KernelData, Parameter } from './generated.js';
import type { Layout } from './layout.js';
import type { Plane } from './memory.js';
import { drawDomain, targetOf } from './pass.js';
import type { Program } from './program.js';
import { Stream, View } from './stream.js';
import type { Lie } from './variant.js';

/** What an argument must be. Layouts are shared, so that streams with one layout have one shape. */
interface Slot {
  readonly index: number;
  readonly element: Element;
  readonly layout: Layout;
  readonly isWritten: boolean;
}

/** What the long way has chosen. */
export interface Choices {
  readonly device: Device;
  readonly outputs: readonly number[];
  readonly shape: readonly number[];
  readonly domain: Layout;
  readonly lies: readonly Lie[];
  readonly program: Program;
}

export class Repeat {
  readonly device: Device;
  private readonly slots: readonly Slot[];
  private readonly omitted: readonly number[];
  /** Uniforms, iterators and spec parameters. */
  private readonly values: readonly number[];
  private readonly specs: readonly number[];
  /** What the call reads. */
  private readonly reads: readonly number[];

  /** To be made after the call, which has no views: streams lie as it leaves them. */
  constructor(private readonly kernel: KernelData, private readonly elements: readonly Element[], call: Checked, private readonly choices: Choices) {
    const { parameters } = kernel;
    const numbered = parameters.map((_, i) => i);
    this.device = choices.device;
    this.slots = numbered.filter((i) => call.streams[i]).map((index) => {
      const { element, layout } = call.streams[index]!;
      return { index, element, layout, isWritten: isWritten(parameters[index]!) };
    });
    this.values = numbered.filter((i) => parameters[i]!.role === 'spec' || call.values[i]);
    this.omitted = numbered.filter((i) => !call.streams[i] && !this.values.includes(i));
    this.specs = call.specs;
    this.reads = numbered.filter((i) => isRead(kernel, i, call));
  }

  /** Makes a call if it is like the earlier one; else it does nothing, and returns false. */
  run(given: readonly unknown[]): boolean {
    const { device, elements } = this;
    const { outputs, shape, domain, lies, program } = this.choices;
    if (!this.isAlike(given)) return false;
    const values = this.valuesOf(given);
    if (values === null) return false;
    device.begin();
    const planes: (readonly Plane[])[] = [];
    for (const { index } of this.slots) planes[index] = (given[index] as AnyStream).planes;
    const drawn = outputs.map((i) => targetOf(given[i] as AnyStream, this.isAlsoRead(given, i), domain));
    drawDomain(device, program, values, planes, lies, elements, shape, domain, drawn);
    for (let n = 0; n < outputs.length; ++n) (given[outputs[n]!] as AnyStream).exchange(drawn[n]!, domain);
    return true;
  }

  private isAlike(given: readonly unknown[]): boolean {
    const { device, omitted, slots } = this;
    const { outputs } = this.choices;
    if (given.length !== this.kernel.parameters.length || device.lost || device.tracer !== null || device.observer !== null) return false;
    for (const { index, element, layout, isWritten } of slots) {
      const stream = given[index];
      const isLike = stream instanceof Stream && stream.layout === layout && stream.device === device && stream.element === element && stream.isReady(!isWritten);
      if (!isLike) return false;
    }
    for (const i of omitted) if (given[i] !== null) return false;
    for (let n = 1; n < outputs.length; ++n) {
      for (let k = 0; k < n; ++k) if (given[outputs[n]!] === given[outputs[k]!]) return false;
    }
    return true;
  }

  /** The components of uniforms and iterators; null if spec parameters have other values, or if a stream holds one. */
  private valuesOf(given: readonly unknown[]): (readonly Component[] | null)[] | null {
    const { elements, kernel } = this;
    const { shape } = this.choices;
    const values: (readonly Component[] | null)[] = [];
    let spec = 0;
    for (const i of this.values) {
      const parameter: Parameter = kernel.parameters[i]!;
      const element = elements[parameter.element]!;
      const value = given[i];
      if (parameter.role === 'spec') {
        if (specOf(kernel.name, parameter, elements, value) !== this.specs[spec++]) return null;
      } else if (parameter.role === 'iterator') {
        const ends = iteratorOf(kernel.name, parameter, element, value);
        stepsOf(kernel.name, parameter, element, ends, shape);
        values[i] = ends;
      } else {
        if (value instanceof Stream || value instanceof View) return null;
        values[i] = uniformOf(kernel.name, parameter, element, value);
      }
    }
    return values;
  }

  private isAlsoRead(given: readonly unknown[], output: number): boolean {
    for (const i of this.reads) if (given[i] === given[output]) return true;
    return false;
  }
}
