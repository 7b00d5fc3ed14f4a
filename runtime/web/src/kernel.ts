// SPDX-License-Identifier: MIT
//
// Calls of kernels: runtime/src/gl_device/pass/run_kernel.cpp.
import { checkArguments, deviceOf, fail, isRead, isSameShape, shapeAt, stepsOf, type Checked } from './arguments.js';
import type { Device } from './device.js';
import type { ListCaller, LoadedFile, PassRunner } from './features.js';
import { isNeeded, type CallableKernel } from './generated.js';
import { mayPack, shapeText, type Layout } from './layout.js';
import type { Plane } from './memory.js';
import { checkOver, type GivenDomain } from './over.js';
import { ProgramSource, drawDomain, isAlsoRead, liesOf, smallGather, targetOf } from './pass.js';
import type { Program } from './program.js';
import { Repeat, type Choices } from './repeat.js';
import { checkDisjoint, checkInput } from './shapes.js';
import { Fitted, Stream, View } from './stream.js';
import { kernelKey, viewsKey, type Lie } from './variant.js';

/** Calls that differ in how their streams lie, as those of a multigrid solver do, and are remembered. */
const mostRepeats = 8;

export class KernelCaller {
  readonly source: ProgramSource;
  private readonly outputs: readonly number[];
  private readonly hasConditions: boolean;
  private readonly plan: PassRunner | null;
  private readonly lists: ListCaller | null;
  /** Earlier calls, the latest first: a loop makes the same calls again. */
  private repeats: Repeat[] = [];

  constructor(private readonly kernel: CallableKernel, file: LoadedFile) {
    const { lists, plans } = file.features;
    this.source = new ProgramSource(kernel.name, file, kernel.programs);
    this.outputs = kernel.parameters.flatMap((parameter, i) => (parameter.role === 'output' ? [i] : []));
    this.plan = kernel.plan === undefined ? null : plans!(kernel, kernel.plan, file);
    this.lists = kernel.lists === undefined ? null : lists!(kernel, file);
    this.hasConditions = kernel.parameters.some((parameter) => parameter.neededIf !== undefined);
  }

  startPrograms(device: Device): Program[] {
    return this.lists?.startPrograms(device) ?? this.plan?.startPrograms(device) ?? this.source.startPrograms(device, () => this.kernel);
  }

  /** Throws SkError if these are no arguments of the kernel. */
  check(given: readonly unknown[]): void {
    checkArguments(this.kernel, this.source.file.elements, given);
  }

  /** Makes a call if it is like an earlier one; else it does nothing, and returns false. */
  repeat(given: readonly unknown[]): boolean {
    for (const earlier of this.repeats) if (earlier.run(given)) return true;
    return false;
  }

  call(given: readonly unknown[], over: GivenDomain | null = null): void | Promise<void> {
    const { kernel } = this;
    const { elements } = this.source.file;
    const call = checkArguments(kernel, elements, given);
    if (this.lists !== null) return this.lists.call(call, over);
    const outputs = this.hasConditions ? this.outputs.filter((i) => isNeeded(kernel.parameters[i]!, call.specs)) : this.outputs;
    if (outputs.length === 0) return; // the spec parameters leave nothing to write
    const device = deviceOf(kernel, call.streams, over);
    const { shape, reason } = this.checkShapes(call, outputs);
    checkOver(kernel, over, outputs[0]!, shape);
    device.begin();
    if (shape.includes(0)) return;

    if (this.plan !== null) return this.plan.run(device, call, outputs, shape, reason);
    const choices = reason === null ? this.chosen(device, call, outputs, shape) : null;
    if (choices === null) return this.runWithViews(device, call, outputs, shape, reason ?? smallGather);
    const { domain, lies, program } = choices;
    const drawn = outputs.map((i) => targetOf(call.streams[i]!, isAlsoRead(kernel, i, call), domain));
    this.draw(device, program, call, domain, lies, shape, drawn);
    // A stream that the call reads and leaves in another layout is not what the program reads a second time.
    const isSettled = outputs.every((i) => call.streams[i]!.layout === domain || !isAlsoRead(kernel, i, call));
    outputs.forEach((i, n) => call.streams[i]!.exchange(drawn[n]!, domain));
    if (isSettled && this.mayRepeat(given, choices)) this.remember(call, choices);
  }

  /** Repeats take streams as they are, and no streams for values. */
  private mayRepeat(given: readonly unknown[], { device }: Choices): boolean {
    const isOther = (argument: unknown, i: number) =>
      argument instanceof View || argument instanceof Fitted || (argument instanceof Stream && this.kernel.parameters[i]!.role === 'uniform');
    return device.tracer === null && !given.some(isOther);
  }

  private remember(call: Checked, choices: Choices): void {
    const others = this.repeats.filter(({ device }) => !device.lost).slice(0, mostRepeats - 1);
    this.repeats = [new Repeat(this.kernel, this.source.file.elements, call, choices), ...others];
  }

  private runWithViews(device: Device, call: Checked, outputs: readonly number[], shape: readonly number[], reason: string): void {
    const { kernel, source } = this;
    const { elements } = source.file;
    const { views } = source.file.features;
    if (views === undefined) return source.refuse(reason, kernel.parameters, call.specs);
    const { domain, lies, begin, finish } = views(device, kernel, call, outputs, shape, elements, true);
    const key = viewsKey(kernel.parameters, elements, lies, domain, call.specs);
    if (!source.has(key)) source.refuse(reason, kernel.parameters, call.specs);
    const program = source.program(device, key, kernel, call.specs, (i) => call.streams[i] !== null);
    const drawn = begin();
    this.draw(device, program, call, domain, lies, shape, drawn);
    finish(drawn);
  }

  private draw(
    device: Device, program: Program, call: Checked, domain: Layout, lies: readonly Lie[], shape: readonly number[],
    drawn: readonly (readonly Plane[])[],
  ): void {
    const planes = call.streams.map((stream) => stream?.planes ?? []);
    drawDomain(device, program, call.values, planes, lies, this.source.file.elements, shape, domain, drawn);
  }

  /**
   * The layout of the outputs after the call, and the program. Unpacks what the call reads where no program takes it packed;
   * null if none takes it then.
   */
  private chosen(device: Device, call: Checked, outputs: readonly number[], shape: readonly number[]): Choices | null {
    const { kernel } = this;
    const first = call.streams[outputs[0]!]!;
    const packs = kernel.packs && mayPack(shape) && outputs.every((i) => call.streams[i]!.mayPack());
    let domain = first.layoutIf(packs);
    let lies = this.lies(call, shape);
    let key = this.keyOf(call, lies, domain, device);
    if (!this.source.has(key)) {
      kernel.parameters.forEach((_, i) => isRead(kernel, i, call) && call.streams[i]!.unpack());
      domain = first.layoutIf(false);
      lies = this.lies(call, shape);
      key = this.keyOf(call, lies, domain, device);
    }
    if (!this.source.has(key)) return null;
    const program = this.source.program(device, key, kernel, call.specs, (i) => call.streams[i] !== null);
    return { device, outputs, shape, domain, lies, program };
  }

  private lies(call: Checked, shape: readonly number[]): Lie[] {
    return liesOf(this.kernel, call, shape, this.source.file.elements);
  }

  private keyOf(call: Checked, lies: readonly Lie[], domain: Layout, device: Device): string {
    return kernelKey(this.kernel.parameters, this.source.file.elements, lies, domain, call.specs, device.filtersFloats);
  }

  /** The shape of the domain, and why the call needs the program for views, if it does. */
  private checkShapes(call: Checked, outputs: readonly number[]): { shape: readonly number[]; reason: string | null } {
    const { kernel } = this;
    const first = outputs[0]!;
    const shape = shapeAt(call, first);
    const nameOf = (i: number) => kernel.parameters[i]!.name;
    for (const i of outputs) {
      const own = shapeAt(call, i);
      if (isSameShape(own, shape)) continue;
      fail(kernel.name, `the outputs '${nameOf(first)}' and '${nameOf(i)}' have shapes ${shapeText(shape)} and ${shapeText(own)}; give them the same shape`, 'shape');
    }
    if (outputs.length > 1) checkDisjoint(kernel, call, outputs);
    let reason: string | null = null;
    kernel.parameters.forEach((parameter, i) => {
      const { name, role } = parameter;
      if (role === 'iterator') stepsOf(kernel.name, parameter, this.source.file.elements[parameter.element]!, call.values[i]!, shape);
      if (role === 'uniform' || role === 'spec' || role === 'iterator' || !call.streams[i]) return;
      const isOfShape = role !== 'input' || checkInput(kernel, i, call, shape, kernel.parameters[first]!);
      const why = !isOfShape ? (call.fits[i] ? 'is fitted to the output' : 'repeats') : call.views[i] ? 'is a view' : null;
      if (why !== null && isNeeded(parameter, call.specs)) reason ??= `where '${name}' ${why}`;
    });
    return { shape, reason };
  }
}
