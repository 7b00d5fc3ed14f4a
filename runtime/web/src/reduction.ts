// SPDX-License-Identifier: MIT
//
// Calls of reduces: runtime/src/gl_device/pass/reduce_passes.cpp for values, and the sums of runtime/src/api/reduce.cpp.
import { checkArguments, deviceOf, fail, isSameShape, iterationOf, type Checked } from './arguments.js';
import type { Device, Plane } from './device.js';
import { newArrays, planeArray, takeChannels, valueOf } from './elements.js';
import type { HostArray } from './format.js';
import { isNeeded, type GeneratedFile, type KernelData, type Reduction } from './generated.js';
import { shapeText, type Layout } from './layout.js';
import { bindOperands, ProgramSource } from './kernel.js';
import type { Program } from './program.js';
import { identities, isOfPartials, leastKnownRuns, planReduction, type ReducePass } from './reduce_plan.js';
import type { CallOptions } from './types.js';
import { accessKey, type Lie } from './variant.js';

/** Planes that a pass of a reduction writes: more are written in parts, as WebGL2 guarantees four draw buffers. */
const mostPlanes = 4;

const valueRects = [{ x: 0, y: 0, width: 1, height: 1 }];

/** One variant of a reduction, plain or compensated. */
class Fold {
  private readonly source: ProgramSource;

  constructor(readonly reduction: Reduction, file: GeneratedFile, texts: readonly string[]) {
    this.source = new ProgramSource(reduction.name, file, texts, reduction.programs);
  }

  private get elements() {
    return this.source.file.elements;
  }

  start(device: Device): Program[] {
    return this.source.start(device, (key) => (key.startsWith('partial') ? this.reduction.combine : this.reduction.fold));
  }

  /** The formats of all accumulators' planes, in order. */
  private formats(device: Device) {
    const { parameters } = this.reduction.fold;
    return parameters
      .filter(({ role }) => role === 'accumulator')
      .flatMap(({ element }) => this.elements[element]!.fields.map((field) => device.formatOf(field.scalar, field.width)));
  }

  /** Draws all passes, and returns the planes that hold the value, which the caller releases. */
  run(device: Device, call: Checked, shape: readonly number[]): Plane[] {
    const inputs = this.reduction.fold.parameters.flatMap(({ role }, i) => (role === 'input' && call.streams[i] ? [i] : []));
    const layouts = () => inputs.map((i) => call.streams[i]!.layout);
    const areAlike = () => layouts().every((layout) => layout === layouts()[0]);
    const isEmpty = shape.includes(0);
    const byTexel = !isEmpty && !this.reduction.byIndex && areAlike() && layouts()[0]!.packed;
    if (!byTexel) inputs.forEach((i) => call.streams[i]!.unpack());
    const elements = layouts()[0]!;
    const byIndex = this.reduction.byIndex || !areAlike();
    const division = { byIndex, byTexel, inAnyOrder: this.reduction.commutative };
    let passes = isEmpty ? [identities] : this.planned(device, elements, division, leastKnownRuns);
    const keys = passes.map((pass) => this.keyOf(pass, call, elements, shape, device));
    if (!keys.every((key) => this.source.has(key))) passes = this.planned(device, elements, division, Infinity);

    let partials: Plane[] = [];
    for (const pass of passes) {
      const targets = this.formats(device).map((format) => device.acquire(format, pass.width, pass.height, 'partial results'));
      this.draw(device, pass, call, elements, shape, partials, targets);
      device.release(partials);
      partials = targets;
    }
    return partials;
  }

  private planned(device: Device, elements: Layout, division: { byIndex: boolean; byTexel: boolean; inAnyOrder: boolean }, knownRuns: number): ReducePass[] {
    return planReduction(elements, { textureSize: device.limits.textureSize, knownRuns }, division);
  }

  private keyOf(pass: ReducePass, call: Checked, elements: Layout, shape: readonly number[], device: Device, firstPlane = 0): string {
    const parts = this.formats(device).length > mostPlanes ? ` planes${firstPlane}` : '';
    if (pass.walk === 'nothing') return pass.key + parts;
    const isPartial = isOfPartials(pass.walk);
    const kernel = isPartial ? this.reduction.combine : this.reduction.fold;
    const lies = this.lies(kernel, call, isPartial, pass.walk === 'index', shape);
    return pass.key + parts + accessKey(kernel.parameters, this.elements, lies, elements, call.specs, device.filtersFloats, pass.walk === 'index');
  }

  /** The parameter of the fold whose argument a parameter of the pass's kernel gets. */
  private foldParameter(i: number, isPartial: boolean): number {
    return isPartial ? this.reduction.combineOperands[i]! : i;
  }

  private lies(kernel: KernelData, call: Checked, isPartial: boolean, isByIndex: boolean, shape: readonly number[]): Lie[] {
    return kernel.parameters.map(({ role, element }, i) => {
      if (role === 'input' && (isPartial || !isByIndex)) return 'aligned';
      if (role === 'iterator') return iterationOf(this.elements[element]!, shape);
      return role === 'input' || role === 'gather' ? call.streams[this.foldParameter(i, isPartial)]?.layout ?? null : null;
    });
  }

  private draw(
    device: Device, pass: ReducePass, call: Checked, elements: Layout, shape: readonly number[], partials: readonly Plane[], targets: readonly Plane[],
  ): void {
    const isPartial = isOfPartials(pass.walk);
    const kernel = isPartial ? this.reduction.combine : this.reduction.fold;
    const operands = this.operands(kernel, call, isPartial, partials);
    const own: Checked = { streams: call.streams, specs: call.specs, values: kernel.parameters.map((_, i) => call.values[this.foldParameter(i, isPartial)] ?? null) };
    const lies = this.lies(kernel, call, isPartial, pass.walk === 'index', shape).map((lie) => (lie === 'aligned' ? elements : lie));
    const used: KernelData = pass.walk === 'nothing' ? { name: kernel.name, parameters: kernel.parameters.filter(({ role }) => role === 'spec') } : kernel;
    for (let first = 0; first < targets.length; first += mostPlanes) {
      const key = this.keyOf(pass, call, elements, shape, device, first);
      const program = this.source.program(device, key, used, call.specs);
      device.useProgram(program);
      bindOperands(device, program, own, operands, lies, this.elements, shape);
      for (const [name, value] of pass.uniforms) program.setInteger(name, value);
      device.framebufferOf(targets.slice(first, first + mostPlanes));
      device.drawRects(pass.draws);
    }
  }

  /** The planes of each parameter's stream; of the combining kernel's inputs, those of partial results. */
  private operands(kernel: KernelData, call: Checked, isPartial: boolean, partials: readonly Plane[]): (readonly Plane[])[] {
    let next = 0;
    return kernel.parameters.map(({ role, element }, i) => {
      if (!isPartial || role !== 'input') return call.streams[this.foldParameter(i, isPartial)]?.planes ?? [];
      const count = this.elements[element]!.fields.length;
      return partials.slice(next, (next += count));
    });
  }

  /** The arrays of one element of each accumulator, from the planes of run(). */
  async read(device: Device, planes: readonly Plane[]): Promise<unknown[]> {
    const transfers = planes.map((plane) => device.readTexels(plane, valueRects));
    device.release(planes); // later passes that draw to them come after the transfers
    const channels = await Promise.all(transfers);
    let next = 0;
    return this.reduction.fold.parameters
      .filter(({ role }) => role === 'accumulator')
      .map((parameter) => {
        const element = this.elements[parameter.element]!;
        const arrays = newArrays(element, 1);
        element.fields.forEach((field, plane) => takeChannels(field, channels[next++]!, planeArray(element, plane, arrays, 1), 1));
        return arrays;
      });
  }
}

export class ReductionCaller {
  private readonly plain: Fold;
  private readonly compensated: Fold | null;

  constructor(private readonly reduction: Reduction, private readonly file: GeneratedFile, texts: readonly string[]) {
    this.plain = new Fold(reduction, file, texts);
    this.compensated = reduction.compensated === undefined ? null : new Fold(reduction.compensated, file, texts);
  }

  startPrograms(device: Device): Program[] {
    return (this.compensated ?? this.plain).start(device);
  }

  /** Throws SkError if these are no arguments of the reduce. They have no accumulators. */
  check(given: readonly unknown[]): Checked {
    const { fold, name } = this.reduction;
    const taken = fold.parameters.filter(({ role }) => role !== 'accumulator').length;
    if (given.length > taken && given.length === fold.parameters.length) {
      fail(name, 'reductions to streams do not run in browsers yet; leave the result out, and take the value that the call promises');
    }
    if (given.length !== taken) fail(name, `${given.length} arguments are given, but ${taken} are taken`);
    let next = 0;
    const all = fold.parameters.map(({ role }) => (role === 'accumulator' ? null : given[next++]));
    return checkArguments(fold, this.file.elements, all);
  }

  /** The values of the accumulators, if there are several, as a list. */
  async call(given: readonly unknown[], options: CallOptions): Promise<unknown> {
    const { fold } = this.reduction;
    const call = this.check(given);
    const shape = this.domainOf(call);
    const device = deviceOf(fold, call.streams);
    const chosen = this.variantOf(options);
    device.begin();
    const planes = chosen.run(device, call, shape);
    const arrays = await chosen.read(device, planes);
    const results = fold.parameters.flatMap(({ role, element }, i) => (role === 'accumulator' ? [{ parameter: i, element: this.file.elements[element]! }] : []));
    if (chosen !== this.plain) this.addErrors(results, arrays);
    const values = results.map(({ element }, i) => valueOf(element, arrays[i]));
    return values.length === 1 ? values[0] : values;
  }

  private variantOf({ accumulate }: CallOptions): Fold {
    const { name } = this.reduction;
    const wanted = accumulate ?? this.reduction.accumulate;
    if (wanted === 'exact' || wanted === 'extended') {
      fail(name, `'${wanted}' sums do not run in browsers yet; call it by with({ accumulate: 'compensated' })`);
    }
    if (wanted === 'compensated' && this.compensated === null) {
      fail(name, "it has no sum of floats to compensate, one that elements and partial results are added to and no more; call it without 'compensated'");
    }
    return wanted === 'tree' || this.compensated === null ? this.plain : this.compensated;
  }

  /** Adds each sum's rounding error to it, in floats. */
  private addErrors(results: readonly { parameter: number; element: { fields: readonly { offset: number; width: number }[] } }[], arrays: unknown[]): void {
    this.reduction.sums!.forEach(([accumulator, offset], k) => {
      const [lost] = arrays[results.length + k] as Float32Array;
      if (!Number.isFinite(lost) || lost === 0) return; // the error of a sum that is not finite is NaN
      const i = results.findIndex(({ parameter }) => parameter === accumulator);
      const element = this.file.elements[this.reduction.fold.parameters[accumulator]!.element]!;
      const plane = element.fields.findIndex((field) => offset >= field.offset && offset < field.offset + 4 * field.width);
      const { array, first } = planeArray(element, plane, arrays[i], 1);
      (array as HostArray)[first + (offset - element.fields[plane]!.offset) / 4] += lost!;
    });
  }

  /** The common shape of the inputs. */
  private domainOf(call: Checked): readonly number[] {
    const { fold, name } = this.reduction;
    let first = -1;
    fold.parameters.forEach((parameter, i) => {
      if (parameter.role !== 'input' || !isNeeded(parameter, call.specs)) return;
      if (first < 0) first = i;
      const [a, b] = [call.streams[first]!.shape, call.streams[i]!.shape];
      if (isSameShape(a, b)) return;
      fail(name, `'${fold.parameters[first]!.name}' has shape ${shapeText(a)}, and '${parameter.name}' ${shapeText(b)}; give them the same shape`, 'shape');
    });
    if (first < 0) fail(name, 'no input says how many elements there are; reductions in browsers need one');
    return call.streams[first]!.shape;
  }
}
