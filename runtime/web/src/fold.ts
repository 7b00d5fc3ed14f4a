// SPDX-License-Identifier: MIT
//
// Draws the passes of a reduction or a scan: runtime/src/gl_device/pass/reduce_passes.cpp.
import { iterationOf, type Checked } from './arguments.js';
import type { Device } from './device.js';
import type { Format } from './format.js';
import type { LoadedFile } from './features.js';
import type { KernelData, Parameter, Reduction } from './generated.js';
import { sizeOf, xFirst, type Layout } from './layout.js';
import type { Plane } from './memory.js';
import { bindOperands, ProgramSource } from './pass.js';
import type { Program } from './program.js';
import { isOfPartials, leastKnownRuns, planIdentities, planReduction, valueLayout, type ReducePass } from './reduce_plan.js';
import type { ScanPlan } from './scan_plan.js';
import { accessKey, type Lie } from './variant.js';

/** Planes that a pass of a reduction writes: more are written in parts, as WebGL2 guarantees four draw buffers. */
const mostPlanes = 4;

/** What a call computes of its elements. */
export interface Goal {
  /** The shape of the elements, rows first. */
  readonly shape: readonly number[];
  /** The number of blocks in each dimension, of which there are elements; one of a value. */
  readonly blocks: readonly number[];
  /** One result for each element, over all elements or along a dimension. */
  readonly scan?: { readonly along: number | undefined; readonly isExclusive: boolean };
  /** Where results lie. */
  readonly layout: Layout;
}

/** The planes that a pass reads beside the inputs: results of the pass before, and those of the runs before. */
interface Source {
  readonly partials: readonly Plane[];
  readonly carries: readonly Plane[];
}

/** One variant of a reduction: plain, compensated, exact. */
export class Fold {
  private readonly source: ProgramSource;
  readonly accumulators: readonly Parameter[];

  constructor(readonly reduction: Reduction, file: LoadedFile) {
    this.source = new ProgramSource(reduction.name, file, reduction.programs);
    this.accumulators = reduction.fold.parameters.filter(({ role }) => role === 'accumulator');
  }

  private get elements() {
    return this.source.file.elements;
  }

  startPrograms(device: Device): Program[] {
    return this.source.startPrograms(device, (key) => kernelOf(this.reduction, key.startsWith('partial'), key.includes(' carried')));
  }

  /** The formats of an accumulator's planes. */
  formatsOf(device: Device, { element }: Parameter): Format[] {
    return this.elements[element]!.fields.map((field) => device.formatOf(field.scalar, field.width));
  }

  private formats(device: Device): Format[] {
    return this.accumulators.flatMap((accumulator) => this.formatsOf(device, accumulator));
  }

  /** Divides planes among the accumulators. */
  byAccumulator(planes: readonly Plane[]): Plane[][] {
    let next = 0;
    return this.accumulators.map(({ element }) => planes.slice(next, (next += this.elements[element]!.fields.length)));
  }

  /** The arguments of a call of the plain reduction that this variant takes. */
  argumentsOf(plain: KernelData, call: Checked): Checked {
    const isResult = ({ role }: Parameter) => role === 'accumulator' || role === 'output';
    const taken = plain.parameters.flatMap((parameter, i) => (isResult(parameter) ? [] : [i]));
    let next = 0;
    const from = this.reduction.fold.parameters.map((parameter) => (isResult(parameter) ? -1 : taken[next++]!));
    return { streams: from.map((i) => call.streams[i] ?? null), views: from.map(() => null), fits: from.map(() => null), values: from.map((i) => call.values[i] ?? null), specs: call.specs };
  }

  /** Draws all passes, and returns the planes of the results, of these formats, which are the caller's. */
  run(device: Device, call: Checked, goal: Goal, formats: readonly Format[] = this.formats(device)): Plane[] {
    const inputs = this.reduction.fold.parameters.flatMap(({ role }, i) => (role === 'input' && call.streams[i] ? [i] : []));
    const layouts = () => inputs.map((i) => call.streams[i]!.layout);
    const areAlike = () => layouts().every((layout) => layout === layouts()[0]);
    const isEmpty = goal.shape.includes(0);
    const isOne = !goal.scan && sizeOf(goal.blocks) === 1;
    const byTexel = isOne && !isEmpty && !this.reduction.byIndex && areAlike() && layouts()[0]!.packed;
    if (!byTexel) inputs.forEach((i) => call.streams[i]!.unpack());
    const elements = layouts()[0] ?? device.layoutOf(goal.shape, false);
    const run = new FoldRun(device, this.source, this.reduction, call, goal, elements, this.formats(device), formats);
    if (isEmpty) return run.chain([planIdentities(goal.layout)]);
    const { textureSize } = device.limits;
    if (goal.scan) {
      const { along, isExclusive } = goal.scan;
      return run.scan(this.source.file.features.scans!(elements, goal.layout, textureSize, along, this.reduction.byIndex, isExclusive));
    }
    const division = { byIndex: this.reduction.byIndex || !isOne || !areAlike(), byTexel, inAnyOrder: this.reduction.commutative, blocks: xFirst(goal.blocks) };
    const planned = (knownRuns: number) => planReduction(elements, { textureSize, knownRuns }, division, isOne ? valueLayout : goal.layout);
    const passes = planned(leastKnownRuns);
    return run.chain(passes.every((pass) => run.hasProgram(pass)) ? passes : planned(Infinity));
  }
}

function kernelOf({ fold, combine }: Reduction, isPartial: boolean, isCarried: boolean): KernelData {
  const { name, parameters } = isPartial ? combine : fold;
  const carries = parameters.flatMap((parameter): Parameter[] => (isCarried && parameter.role === 'accumulator' ? [{ ...parameter, role: 'input' }] : []));
  return { name, parameters: [...parameters, ...carries] };
}

/** The passes of one call. */
class FoldRun {
  constructor(
    private readonly device: Device, private readonly source: ProgramSource, private readonly reduction: Reduction, private readonly call: Checked,
    private readonly goal: Goal, private readonly elements: Layout, private readonly ownFormats: readonly Format[], private readonly formats: readonly Format[],
  ) {}

  hasProgram(pass: ReducePass): boolean {
    return this.source.has(this.keyOf(pass));
  }

  /** Hands the programs of all passes to the driver before the first one is waited for. */
  private start(passes: readonly ReducePass[]): void {
    for (const pass of passes) {
      for (let first = 0; first < this.ownFormats.length; first += mostPlanes) this.program(pass, first);
    }
  }

  private program(pass: ReducePass, firstPlane: number): Program {
    const kernel = this.kernelOf(pass);
    const used: KernelData = pass.walk === 'nothing' ? { name: kernel.name, parameters: kernel.parameters.filter(({ role }) => role === 'spec') } : kernel;
    return this.source.program(this.device, this.keyOf(pass, firstPlane), used, this.call.specs);
  }

  private kernelOf(pass: ReducePass): KernelData {
    return kernelOf(this.reduction, isOfPartials(pass.walk), pass.carried === true);
  }

  /** Each pass reads what the one before has written. */
  chain(passes: readonly ReducePass[]): Plane[] {
    this.start(passes);
    let partials: Plane[] = [];
    for (const pass of passes) {
      const targets = this.draw(pass, { partials, carries: [] });
      this.device.release(partials);
      partials = targets;
    }
    return partials;
  }

  scan({ folds, scans }: ScanPlan): Plane[] {
    this.start([...folds, ...scans]);
    const levels: Plane[][] = [[]];
    for (const pass of folds) levels.push(this.draw(pass, { partials: levels[levels.length - 1]!, carries: [] }));
    let carries = this.acquire(this.ownFormats, 1, 1); // of the only run there is none
    for (const pass of scans) {
      const partials = levels.pop()!;
      const targets = this.draw(pass, { partials, carries });
      this.device.release(partials);
      this.device.release(carries);
      carries = targets;
    }
    return carries;
  }

  private get elementTypes() {
    return this.source.file.elements;
  }

  private keyOf(pass: ReducePass, firstPlane = 0): string {
    const parts = this.ownFormats.length > mostPlanes ? ` planes${firstPlane}` : '';
    if (pass.walk === 'nothing') return pass.key + parts;
    const { parameters } = kernelOf(this.reduction, isOfPartials(pass.walk), false);
    const isByIndex = pass.walk === 'index';
    return pass.key + parts + accessKey(parameters, this.elementTypes, this.lies(pass, parameters), this.elements, this.call.specs, this.device.filtersFloats, isByIndex);
  }

  /** The parameter of the fold whose argument a parameter of the pass's kernel gets. */
  private foldParameter(i: number, isPartial: boolean): number {
    return isPartial ? this.reduction.combineOperands[i] ?? -1 : i;
  }

  private lies(pass: ReducePass, parameters: readonly Parameter[]): Lie[] {
    const isPartial = isOfPartials(pass.walk);
    return parameters.map(({ role, element }, i) => {
      if (role === 'input' && pass.walk !== 'index') return 'aligned';
      if (role === 'iterator') return iterationOf(this.elementTypes[element]!, this.goal.shape);
      return role === 'input' || role === 'gather' ? this.call.streams[this.foldParameter(i, isPartial)]?.layout ?? null : null;
    });
  }

  private acquire(formats: readonly Format[], width: number, height: number): Plane[] {
    return formats.map((format) => this.device.acquire(format, width, height, 'the results of a reduction'));
  }

  /** Draws to new planes. */
  private draw(pass: ReducePass, source: Source): Plane[] {
    const { device, call } = this;
    const targets = this.acquire(pass.toResult ? this.formats : this.ownFormats, pass.width, pass.height);
    const isPartial = isOfPartials(pass.walk);
    const kernel = this.kernelOf(pass);
    const planes = this.planesOf(kernel, isPartial, source);
    const values = kernel.parameters.map((_, i) => call.values[this.foldParameter(i, isPartial)] ?? null);
    const lies = this.lies(pass, kernel.parameters).map((lie) => (lie === 'aligned' ? this.elements : lie));
    for (let first = 0; first < targets.length; first += mostPlanes) {
      const program = this.program(pass, first);
      device.useProgram(program);
      bindOperands(device, program, values, planes, lies, this.elementTypes, this.goal.shape);
      for (const [name, value] of pass.uniforms) program.setInteger(name, value);
      device.framebufferOf(targets.slice(first, first + mostPlanes));
      device.drawRects(pass.draws);
    }
    return targets;
  }

  /** The planes of each parameter's stream; of inputs of the combining kernel, and of carries, those of earlier passes. */
  private planesOf(kernel: KernelData, isPartial: boolean, source: Source): (readonly Plane[])[] {
    const own = (isPartial ? this.reduction.combine : this.reduction.fold).parameters.length;
    let partials = 0;
    let carries = 0;
    return kernel.parameters.map(({ role, element }, i) => {
      const count = this.elementTypes[element]!.fields.length;
      if (i >= own) return source.carries.slice(carries, (carries += count));
      if (isPartial && role === 'input') return source.partials.slice(partials, (partials += count));
      return this.call.streams[this.foldParameter(i, isPartial)]?.planes ?? [];
    });
  }
}
