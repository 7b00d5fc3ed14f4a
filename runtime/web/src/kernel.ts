// SPDX-License-Identifier: MIT
//
// Calls of kernels: runtime/src/gl_device/pass/run_kernel.cpp for whole streams.
import { AppendCaller } from './append.js';
import { checkArguments, deviceOf, fail, isSameShape, iterationOf, stepsOf, type AnyStream, type Checked } from './arguments.js';
import type { Device, Plane } from './device.js';
import type { Format } from './format.js';
import { isNeeded, specLiteral, type CallableKernel, type Element, type GeneratedFile, type KernelData, type Parameter, type ProgramIndices } from './generated.js';
import { mayPack, shapeText, type Layout } from './layout.js';
import { PlanRunner } from './plan.js';
import type { Program } from './program.js';
import { isFiltered, kernelKey, type Lie } from './variant.js';

/** The programs of one kernel or reduction. */
export class ProgramSource {
  constructor(
    readonly name: string, readonly file: GeneratedFile, private readonly texts: readonly string[], private readonly indices: ProgramIndices,
  ) {}

  has(key: string): boolean {
    return key in this.indices;
  }

  /** The program with this key, for these values of spec parameters. Throws SkError if skc has not assembled it. */
  program(device: Device, key: string, kernel: KernelData, specs: readonly number[]): Program {
    const { parameters } = kernel;
    const words = specs.length === 0 ? '' : ` ${specs.join()}`;
    const isUsed = (parameter: Parameter) => isNeeded(parameter, specs);
    // Calls whose programs have one text share it.
    return device.program(this, `${this.indices[key] ?? key}${words}`, this.name, () => this.text(key, parameters, specs), parameters, this.file.elements, isUsed);
  }

  private text(key: string, parameters: readonly Parameter[], specs: readonly number[]): string {
    const index = this.indices[key];
    if (index === undefined) {
      fail(
        this.name,
        `${this.file.name}.js has no program for this call, '${key}'; it has those for whole streams whose inputs have the shape of the output ` +
          'and whose gathers are at least as large, and skc assembles no others: give such streams',
        'compile',
      );
    }
    let number = 0;
    let text = this.texts[index]!;
    for (const parameter of parameters) {
      if (parameter.role !== 'spec') continue;
      const literal = specLiteral(this.file.elements[parameter.element]!.fields[0]!.scalar, specs[number++]!);
      text = text.replace(new RegExp(`( sk_spec_${parameter.symbol} = )[^;]*;`), `$1${literal};`);
    }
    return text;
  }

  /** Starts to compile all programs. */
  start(device: Device, kernelFor: (key: string) => KernelData): Program[] {
    return Object.keys(this.indices).flatMap((key) => {
      const kernel = kernelFor(key);
      const hasSpecs = kernel.parameters.some((parameter) => parameter.role === 'spec');
      return hasSpecs ? [] : [this.program(device, key, kernel, [])]; // which values will come is not known
    });
  }
}

/** Binds the planes that a program reads, and sets the uniforms of its parameters. The program must be current. */
export function bindOperands(
  device: Device, program: Program, call: Checked, planes: readonly (readonly Plane[])[], lies: readonly Lie[], elements: readonly Element[], domain: readonly number[],
): void {
  let unit = 0;
  for (const read of program.reads) {
    const layout = lies[read.index] as Layout;
    read.layout!.set(layout);
    const isFilteredHere = read.parameter.filter === true && isFiltered(read.parameter, layout, elements, device.filtersFloats);
    const boundary = read.parameter.boundary === 'border' ? 'clamp' : read.parameter.boundary ?? 'clamp';
    for (const plane of planes[read.index]!) {
      device.bindTexture(unit, plane.texture);
      device.bindFilter(unit++, isFilteredHere ? boundary : null);
    }
  }
  for (const bound of program.values) {
    const numbers = call.values[bound.index]!;
    if (bound.step === undefined) {
      bound.value!.set(numbers);
      continue;
    }
    const element = elements[bound.parameter.element]!;
    const { begin, step } = stepsOf('', bound.parameter, element, numbers, domain);
    bound.value!.set(begin);
    bound.step.set(step);
    bound.layout!.set(strides(device, domain));
  }
}

/** The layout whose strides are those of a domain's element numbers. */
function strides(device: Device, domain: readonly number[]): Layout {
  const layout = device.layoutOf(domain, false);
  if (layout.linear) return layout;
  const [x, y, z] = layout.extent;
  return { ...layout, stride: [1, x, x * y, x * y * z] };
}

/** Runs a kernel over planes that lie as its domain does, those of each input, and returns new ones of these formats, for each output. */
export function drawAligned(
  device: Device, source: ProgramSource, kernel: KernelData, inputs: readonly (readonly Plane[])[], domain: Layout, formats: readonly (readonly Format[])[],
): Plane[][] {
  const { parameters } = kernel;
  const { elements } = source.file;
  let next = 0;
  const planes = parameters.map(({ role }) => (role === 'input' ? inputs[next++]! : []));
  const lies = parameters.map(({ role }) => (role === 'input' ? domain : null));
  const program = source.program(device, kernelKey(parameters, elements, lies, domain, [], device.filtersFloats), kernel, []);
  const targets = formats.map((list) => list.map((format) => device.acquire(format, domain.width, domain.height, 'the results of a reduction')));
  device.useProgram(program);
  bindOperands(device, program, { streams: [], values: [], specs: [] }, planes, lies, elements, []);
  program.domain.set(domain);
  device.framebufferOf(targets.flat());
  device.drawRects(domain.draws);
  return targets;
}

export function isRead(kernel: KernelData, i: number, call: Checked): boolean {
  const { role } = kernel.parameters[i]!;
  return (role === 'input' || role === 'gather') && isNeeded(kernel.parameters[i]!, call.specs);
}

/** How each argument lies. */
export function liesOf(kernel: KernelData, call: Checked, shape: readonly number[], elements: readonly Element[]): Lie[] {
  return kernel.parameters.map(({ role, element }, i) => {
    if (role === 'iterator') return iterationOf(elements[element]!, shape);
    return role === 'input' || role === 'gather' ? call.streams[i]?.layout ?? null : null;
  });
}

/** The planes to draw an output to: its own, or new ones if the call reads it, or if it lies in another way. */
export function targetOf(kernel: KernelData, i: number, call: Checked, domain: Layout): { stream: AnyStream; planes: Plane[] } {
  const stream = call.streams[i]!;
  const isAlsoRead = call.streams.some((other, k) => other === stream && isRead(kernel, k, call));
  stream.isGone = false;
  return { stream, planes: stream.layout === domain && !isAlsoRead && !stream.isHeld() ? stream.planes : stream.newPlanes(domain) };
}

interface Choices {
  readonly device: Device;
  readonly domain: Layout;
  readonly lies: readonly Lie[];
  readonly specs: readonly number[];
  readonly program: Program;
}

export class KernelCaller {
  readonly source: ProgramSource;
  private readonly outputs: readonly number[];
  private readonly hasConditions: boolean;
  private readonly plan: PlanRunner | null;
  private readonly append: AppendCaller | null;
  /** The last call's choices: a loop makes the same call again. */
  private last: Choices | null = null;

  constructor(private readonly kernel: CallableKernel, file: GeneratedFile, texts: readonly string[]) {
    this.source = new ProgramSource(kernel.name, file, texts, kernel.programs);
    this.outputs = kernel.parameters.flatMap((parameter, i) => (parameter.role === 'output' ? [i] : []));
    this.plan = kernel.plan === undefined ? null : new PlanRunner(kernel, kernel.plan, file, texts);
    this.append = kernel.lists === undefined ? null : new AppendCaller(kernel, file, texts);
    this.hasConditions = kernel.parameters.some((parameter) => parameter.neededIf !== undefined);
  }

  startPrograms(device: Device): Program[] {
    return this.append?.start(device) ?? this.plan?.start(device) ?? this.source.start(device, () => this.kernel);
  }

  /** Throws SkError if these are no arguments of the kernel. */
  check(given: readonly unknown[]): void {
    checkArguments(this.kernel, this.source.file.elements, given);
  }

  call(given: readonly unknown[]): void | Promise<void> {
    const { kernel } = this;
    const { elements } = this.source.file;
    const call = checkArguments(kernel, elements, given);
    if (this.append !== null) return this.append.call(call);
    const outputs = this.hasConditions ? this.outputs.filter((i) => isNeeded(kernel.parameters[i]!, call.specs)) : this.outputs;
    if (outputs.length === 0) return; // the spec parameters leave nothing to write
    const device = deviceOf(kernel, call.streams);
    const shape = this.checkShapes(call, outputs);
    device.begin();
    if (call.streams[outputs[0]!]!.size === 0) return;

    if (this.plan !== null) return this.plan.run(device, call, outputs, shape);
    const { domain, lies, program } = this.chosen(device, call, outputs, shape);
    device.useProgram(program);

    const targets = outputs.map((i) => targetOf(kernel, i, call, domain));
    bindOperands(device, program, call, call.streams.map((stream) => stream?.planes ?? []), lies, elements, shape);
    program.domain.set(domain);
    device.framebufferOf(targets.length === 1 ? targets[0]!.planes : targets.flatMap((target) => target.planes));
    device.drawRects(domain.draws);
    for (const { stream, planes } of targets) {
      if (planes !== stream.planes) stream.exchange(planes, domain);
    }
  }

  /** The layout of the outputs after the call, and the program. Unpacks what the call reads where no program takes it packed. */
  private chosen(device: Device, call: Checked, outputs: readonly number[], shape: readonly number[]): Choices {
    const { kernel } = this;
    const first = call.streams[outputs[0]!]!;
    const packs = kernel.packs && mayPack(shape) && outputs.every((i) => call.streams[i]!.mayPack());
    let domain = first.layoutIf(packs);
    let lies = this.lies(call, shape);
    const { last } = this;
    const isSame = (a: readonly unknown[], b: readonly unknown[]) => a.every((one, i) => one === b[i]);
    if (last?.device === device && last.domain === domain && isSame(last.lies, lies) && isSame(last.specs, call.specs)) return last;
    let key = this.keyOf(call, lies, domain, device);
    if (!this.source.has(key)) {
      kernel.parameters.forEach((_, i) => isRead(kernel, i, call) && call.streams[i]!.unpack());
      domain = first.layoutIf(false);
      lies = this.lies(call, shape);
      key = this.keyOf(call, lies, domain, device);
    }
    const program = this.source.program(device, key, kernel, call.specs);
    this.last = { device, domain, lies, specs: call.specs, program };
    return this.last;
  }

  private lies(call: Checked, shape: readonly number[]): Lie[] {
    return liesOf(this.kernel, call, shape, this.source.file.elements);
  }

  private keyOf(call: Checked, lies: readonly Lie[], domain: Layout, device: Device): string {
    return kernelKey(this.kernel.parameters, this.source.file.elements, lies, domain, call.specs, device.filtersFloats);
  }

  /** The shape of the domain. */
  private checkShapes(call: Checked, outputs: readonly number[]): readonly number[] {
    const { kernel } = this;
    const first = outputs[0]!;
    const shape = call.streams[first]!.shape as readonly number[];
    const nameOf = (i: number) => kernel.parameters[i]!.name;
    for (const i of outputs) {
      const stream = call.streams[i]!;
      if (!isSameShape(stream.shape, shape)) {
        fail(kernel.name, `the outputs '${nameOf(first)}' and '${nameOf(i)}' have shapes ${shapeText(shape)} and ${shapeText(stream.shape)}; give them the same shape`, 'shape');
      }
      const other = outputs.find((k) => k < i && call.streams[k] === stream);
      if (other !== undefined) fail(kernel.name, `the outputs '${nameOf(other)}' and '${nameOf(i)}' are one stream; give them different streams`);
    }
    kernel.parameters.forEach(({ name, role }, i) => {
      const stream = call.streams[i];
      if (role !== 'input' || !stream || isSameShape(stream.shape, shape)) return;
      fail(kernel.name, `'${name}' has shape ${shapeText(stream.shape)}, but the output '${nameOf(first)}' has ${shapeText(shape)}; give them the same shape`, 'shape');
    });
    kernel.parameters.forEach((parameter, i) => {
      if (parameter.role === 'iterator') stepsOf(kernel.name, parameter, this.source.file.elements[parameter.element]!, call.values[i]!, shape);
    });
    return shape;
  }
}
