// SPDX-License-Identifier: MIT
//
// Calls of reduces, scans and kernels with folded outputs: the checks of runtime/src/call/check_reduction.cpp, and the sums of
// runtime/src/api/reduce.cpp. All results are drawn to new planes, so that a call may write what it reads.
import { checkArguments, deviceOf, fail, isSameShape, type Checked } from './arguments.js';
import { blockGrids } from './block_grid.js';
import type { Device } from './device.js';
import { newArrays, planeArray, takeChannels, valueOf } from './elements.js';
import { Fold, type Goal } from './fold.js';
import type { Format } from './format.js';
import type { Features, FoldCaller, LoadedFile } from './features.js';
import { isNeeded, type CallableReduction, type Parameter, type SumVariant } from './generated.js';
import { KernelCaller } from './kernel.js';
import { shapeText } from './layout.js';
import type { Plane } from './memory.js';
import { checkOver, failWithoutDomain, type GivenDomain } from './over.js';
import { alignedProgram, drawAligned, ProgramSource } from './pass.js';
import type { Program } from './program.js';
import { valueLayout } from './reduce_plan.js';
import { checkDisjoint } from './shapes.js';
import { Fitted, Stream, View, viewOf } from './stream.js';
import type { ScanOptions } from './types.js';

const valueRects = [{ x: 0, y: 0, width: 1, height: 1 }];
const accumulations = ['tree', 'compensated', 'extended', 'exact'];

/** A variant, and the kernel that computes results from its accumulators. */
class Sum {
  readonly fold: Fold;
  readonly finish: ProgramSource;

  constructor(readonly data: SumVariant, file: LoadedFile) {
    this.fold = new Fold(data.reduction, file);
    this.finish = new ProgramSource(data.reduction.name, file, data.finish.programs);
  }
}

/** What a call runs: variants, one after the other, which start from the plain results, from planes of any content, or from nothing. */
interface Chosen {
  readonly sums: readonly Sum[];
  readonly start: 'plain' | 'any' | 'none';
}

class ReductionCaller implements FoldCaller {
  private readonly plain: Fold;
  private readonly map: KernelCaller | null;
  private readonly sums: ReadonlyMap<string, string | readonly Sum[]>;
  /** The parameters that are results. */
  private readonly results: readonly number[];

  constructor(private readonly reduction: CallableReduction, private readonly file: LoadedFile) {
    this.plain = new Fold(reduction, file);
    this.map = reduction.map === undefined ? null : new KernelCaller(reduction.map, file);
    const made = Object.entries(reduction.variants).map(
      ([name, list]) => [name, typeof list === 'string' ? list : list.map((data) => new Sum(data, file))] as const,
    );
    this.sums = new Map(made);
    this.results = reduction.fold.parameters.flatMap(({ role }, i) => (role === 'accumulator' ? [i] : []));
  }

  private get fold() {
    return this.reduction.fold;
  }

  private fail(message: string, kind: 'misuse' | 'shape' | 'compile' = 'misuse'): never {
    fail(this.reduction.name, message, kind);
  }

  startPrograms(device: Device, options: ScanOptions): Program[] {
    const { sums, start } = this.chosen(options);
    const map = this.map?.startPrograms(device) ?? [];
    const plain = start === 'plain' ? this.plain.startPrograms(device) : [];
    return [...map, ...plain, ...sums.flatMap(({ fold, finish, data }) => [...fold.startPrograms(device), ...finish.startPrograms(device, () => data.finish)])];
  }

  /** Throws SkError if these are no arguments of the reduce, with streams for the results or without. */
  check(given: readonly unknown[]): Checked {
    const { parameters } = this.fold;
    const taken = parameters.length - (this.reduction.scans ? 0 : this.results.length);
    if (given.length === parameters.length) {
      const call = checkArguments(this.fold, this.file.elements, given);
      const missing = this.results.find((i) => call.streams[i] === null);
      if (missing !== undefined) this.fail(`'${parameters[missing]!.name}' is null; give a stream, or leave all results out`);
      return call;
    }
    if (given.length !== taken) {
      const more = taken < parameters.length ? `, or ${parameters.length} with streams for the results` : '';
      this.fail(`${given.length} arguments are given, but ${taken} are taken${more}`);
    }
    return checkArguments(this.fold, this.file.elements, this.withResults(given));
  }

  /** The arguments of a call for values, with null for each result. */
  private withResults(given: readonly unknown[]): unknown[] {
    let next = 0;
    return this.fold.parameters.map(({ role }) => (role === 'accumulator' ? null : given[next++]));
  }

  /** Promises the values of the accumulators, or, if they are given, writes to streams. */
  call(given: readonly unknown[], options: ScanOptions, over: GivenDomain | null): Promise<unknown> | void {
    const { whole, copies, written } = this.withoutViews(given);
    const finish = () => written.forEach(([drawn, view]) => drawn.copyTo(view));
    const isToStreams = this.reduction.scans || given.length === this.fold.parameters.length;
    const done = isToStreams ? this.toStreams(whole, options, over, finish) : this.toValues(whole, options, over, finish);
    for (const copy of copies) copy.dispose(); // all passes have been drawn
    return done;
  }

  /**
   * Copies the views that a call reads: reductions have programs for whole streams alone. Those that it writes stand for streams of
   * their shape, `written`, which are copied to them when all passes have been drawn.
   */
  private withoutViews(given: readonly unknown[]) {
    const all = this.fold.parameters;
    const parameters = given.length === all.length ? all : all.filter(({ role }) => role !== 'accumulator');
    const copies: Stream<any, number>[] = [];
    const written: [Stream<any, number>, View<any, number>][] = [];
    if (given.length !== parameters.length) return { whole: given, copies, written };
    const whole = given.map((argument, i) => {
      const { name, role } = parameters[i]!;
      const isHere = argument instanceof Stream || argument instanceof View || argument instanceof Fitted;
      if (isHere && role === 'uniform') fail(this.reduction.name, `'${name}' is one value for all elements, and streams do not stand for values of reduces in browsers; read the stream, and give its value`, 'type');
      if (argument instanceof Fitted) fail(this.reduction.name, `'${name}' is fitted, but only outputs say to what; give a stream or a view`, 'type');
      if (!(argument instanceof View)) return argument;
      argument.check(`${this.reduction.name}: the stream of '${name}'`);
      const isRead = role === 'input' || role === 'gather';
      const copy = isRead ? argument.copied() : new Stream<any, number>(argument.device, argument.element, argument.shape);
      copies.push(copy);
      if (!isRead) written.push([copy, argument]);
      return copy;
    });
    if (written.length > 0) this.checkWritten(parameters, given);
    return { whole, copies, written };
  }

  /** Throws SkError if two results, of which some are views, have an element in common. */
  private checkWritten(parameters: readonly Parameter[], given: readonly unknown[]): void {
    const isWritten = ({ role }: Parameter, i: number) => (role === 'output' || role === 'accumulator') && (given[i] instanceof Stream || given[i] instanceof View);
    const views = parameters.map((parameter, i) => (isWritten(parameter, i) ? viewOf(given[i] as View<any, number>) : null));
    const outputs = views.flatMap((view, i) => (view === null ? [] : [i]));
    checkDisjoint({ name: this.reduction.name, parameters }, { streams: views.map((view) => view?.stream ?? null), views }, outputs);
  }

  /** If there are several accumulators, a list. */
  private async toValues(given: readonly unknown[], options: ScanOptions, over: GivenDomain | null, finish: () => void): Promise<unknown> {
    const call = this.check(given);
    const shape = this.domainOf(call, over);
    const goal: Goal = { shape, blocks: shape.map(() => 1), layout: valueLayout };
    this.checkIdentities(shape);
    const device = deviceOf(this.fold, call.streams, over);
    const sums = this.chosen(options);
    device.begin();
    const planes = this.compute(device, call, goal, this.plain.accumulators.map((accumulator) => this.plain.formatsOf(device, accumulator)), sums);
    this.runMap(device, this.withResults(given), planes);
    finish();
    const values = await this.read(device, planes);
    return values.length === 1 ? values[0] : values;
  }

  private toStreams(given: readonly unknown[], options: ScanOptions, over: GivenDomain | null, finish: () => void): void {
    const call = this.check(given);
    const shape = this.domainOf(call, over);
    const device = deviceOf(this.fold, call.streams, over);
    const sums = this.chosen(options);
    const goal = this.goalOf(device, call, shape, options);
    device.begin();
    if (goal.blocks.includes(0)) return this.runMap(device, given, []);
    const formats = this.results.map((i) => call.streams[i]!.element.fields.map((field) => device.formatOf(field.scalar, field.width)));
    const planes = this.compute(device, call, goal, formats, sums);
    this.runMap(device, given, planes);
    this.results.forEach((i, k) => {
      const stream = call.streams[i]!;
      stream.exchange(planes[k]!, goal.layout);
      stream.isGone = false;
    });
    finish();
  }

  /** Computes the outputs of a kernel with folded outputs, whose elements have been folded to these planes. */
  private runMap(device: Device, given: readonly unknown[], planes: readonly Plane[][]): void {
    const { map } = this;
    if (map === null) return;
    try {
      const own = this.reduction.mapOperands!.map((i) => given[i]);
      if (!map.repeat(own)) map.call(own);
    } catch (error) {
      device.release(planes.flat());
      throw error;
    }
  }

  // ---- sums of floats -----------------------------------------------------------------------------

  private chosen({ accumulate, scan, along }: ScanOptions): Chosen {
    if (!this.reduction.scans && scan !== undefined) this.fail("it is not a scan; call it without 'scan', or declare it 'scan void'");
    if (!this.reduction.scans && along !== undefined) this.fail("it is not a scan, so it goes along no dimension; call it without 'along'");
    if (scan !== undefined && scan !== 'inclusive' && scan !== 'exclusive') this.fail(`'${scan}' is no kind of scan; choose 'inclusive' or 'exclusive'`);
    const wanted = accumulate ?? this.reduction.accumulate;
    if (wanted !== undefined && !accumulations.includes(wanted)) {
      this.fail(`'${wanted}' is no way to accumulate; choose one of '${accumulations.join("', '")}'`);
    }
    const found = this.sums.get(wanted ?? 'compensated');
    if (found === undefined && accumulate === 'compensated') {
      this.fail("it has no sum of floats to compensate, one that elements and partial results are added to and no more; call it without 'compensated'");
    }
    if (found === undefined && accumulate === 'exact') this.fail("it has no sum of floats to add exactly; call it without 'exact'");
    if (typeof found === 'string' && wanted !== undefined) this.fail(`${found}; call it without '${wanted}'`, 'compile');
    const sums = found === undefined || typeof found === 'string' ? [] : found;
    const start = sums.length === 0 || (wanted === 'exact' && !this.reduction.sumsAll) ? 'plain' : wanted === 'exact' ? 'any' : 'none';
    return { sums, start };
  }

  /** Draws the results, of these formats. The planes of each are the caller's. */
  private compute(
    device: Device, call: Checked, goal: Goal, formats: readonly Format[][], { sums, start }: Chosen,
  ): Plane[][] {
    const { plain } = this;
    const runPlain = () => plain.byAccumulator(plain.run(device, call, goal, formats.flat()));
    if (sums.length === 0 || goal.shape.includes(0)) return runPlain();
    for (const { data, finish } of sums) alignedProgram(device, finish, data.finish, goal.layout); // starts to compile it
    const anyPlanes = () => formats.map((list) => list.map((format) => device.acquire(format, goal.layout.width, goal.layout.height, 'sums')));
    let results = start === 'plain' ? runPlain() : start === 'any' ? anyPlanes() : null;
    for (const { data, fold, finish } of sums) {
      // What is not finished is a result.
      const isResult = (i: number) => results === null && i < formats.length && !data.results.includes(i);
      const own = fold.byAccumulator(
        fold.run(device, fold.argumentsOf(this.fold, call), goal, fold.accumulators.flatMap((one, i) => (isResult(i) ? formats[i]! : fold.formatsOf(device, one)))),
      );
      const before: readonly Plane[][] = results ?? own;
      const inputs = data.inputs.map(([isOwn, i]) => (isOwn ? own : before)[i]!);
      const finished = drawAligned(device, finish, data.finish, inputs, goal.layout, data.results.map((i) => formats[i]!));
      const after = formats.map((_, i) => (data.results.includes(i) ? finished[data.results.indexOf(i)]! : before[i]!));
      const kept = new Set(after.flat());
      device.release([...new Set([...own.flat(), ...before.flat()])].filter((plane) => !kept.has(plane)));
      results = after;
    }
    return results!;
  }

  private async read(device: Device, planes: readonly Plane[][]): Promise<unknown[]> {
    const transfers = planes.map((list) => Promise.all(list.map((plane) => device.readTexels(plane, valueRects))));
    device.release(planes.flat()); // later passes that draw to them come after the transfers
    const channels = await Promise.all(transfers);
    return this.plain.accumulators.map((parameter, k) => {
      const element = this.file.elements[parameter.element]!;
      const arrays = newArrays(element, 1);
      element.fields.forEach((field, plane) => takeChannels(field, channels[k]![plane]!, planeArray(element, plane, arrays, 1), 1));
      return valueOf(element, arrays);
    });
  }

  // ---- shapes -------------------------------------------------------------------------------------

  /** The common shape of the outputs and inputs; if there are none, the given one. */
  private domainOf(call: Checked, over: GivenDomain | null): readonly number[] {
    const { parameters } = this.fold;
    const ofRole = (wanted: string) => parameters.flatMap((parameter, i) => (parameter.role === wanted && isNeeded(parameter, call.specs) ? [i] : []));
    const [first, ...others] = [...ofRole('output'), ...ofRole('input')];
    if (first === undefined) return (over ?? failWithoutDomain(this.reduction.name)).shape;
    const shape = call.streams[first]!.shape as readonly number[];
    checkOver(this.fold, over, first, shape);
    for (const i of others) {
      const other = call.streams[i]!.shape;
      if (isSameShape(shape, other)) continue;
      this.fail(`'${parameters[first]!.name}' has shape ${shapeText(shape)}, and '${parameters[i]!.name}' ${shapeText(other)}; give them the same shape`, 'shape');
    }
    return shape;
  }

  /** "'x' has shape" for one input, "the inputs together have" for several. */
  private elementsText(domain: readonly number[]): string {
    const { parameters } = this.fold;
    const inputs = parameters.filter(({ role }) => role === 'input');
    const first = parameters.find(({ role }) => role === 'output') ?? (inputs.length === 1 ? inputs[0] : undefined);
    if (first === undefined && inputs.length === 0) return `over() gives the domain the shape ${shapeText(domain)}`;
    return `${first === undefined ? 'the inputs together have' : `'${first.name}' has`} shape ${shapeText(domain)}`;
  }

  private checkIdentities(domain: readonly number[]): void {
    if (!domain.includes(0)) return;
    const lacking = this.plain.accumulators.find(({ hasIdentity }) => !hasIdentity);
    if (lacking === undefined) return;
    this.fail(`${this.elementsText(domain)}: there is no element to fold, and '${lacking.name}' declares no identity`, 'shape');
  }

  private goalOf(device: Device, call: Checked, shape: readonly number[], options: ScanOptions): Goal {
    const result = this.checkResults(call);
    const layout = device.layoutOf(result, false);
    if (this.reduction.scans) return { shape, blocks: shape, layout, scan: this.checkScan(shape, result, options) };
    const blocks = this.checkBlocks(shape, result);
    if (!blocks.includes(0)) this.checkIdentities(shape);
    return { shape, blocks, layout };
  }

  /** The common shape of the results. */
  private checkResults(call: Checked): readonly number[] {
    const { parameters } = this.fold;
    const [first] = this.results;
    const shape = call.streams[first!]!.shape as readonly number[];
    const nameOf = (i: number) => parameters[i]!.name;
    const written = parameters.flatMap(({ role }, i) => (role === 'output' || role === 'accumulator' ? [i] : []));
    for (const i of this.results) {
      const other = call.streams[i]!.shape as readonly number[];
      if (!isSameShape(other, shape)) {
        this.fail(`the outputs '${nameOf(first!)}' and '${nameOf(i)}' have shapes ${shapeText(shape)} and ${shapeText(other)}; give them the same shape`, 'shape');
      }
      const same = written.find((k) => k !== i && call.streams[k] === call.streams[i]);
      if (same !== undefined) {
        const [a, b] = [Math.min(i, same), Math.max(i, same)];
        this.fail(`the outputs '${nameOf(a)}' and '${nameOf(b)}' are one stream; give them different streams`);
      }
    }
    return shape;
  }

  /** The grid of blocks. */
  private checkBlocks(domain: readonly number[], result: readonly number[]): readonly number[] {
    const grids = blockGrids(domain, result);
    if (grids.length === 1) return grids[0]!;
    const both = `${this.elementsText(domain)}, and the output '${this.fold.parameters[this.results[0]!]!.name}' has ${shapeText(result)}`;
    if (grids.length === 0) {
      this.fail(`${both}; give the output as many dimensions, or fewer, each extent a divisor of the input's`, 'shape');
    }
    this.fail(`${both}, which could mean ${shapeText(grids[0]!)} or ${shapeText(grids[1]!)}; write the one that you mean`, 'shape');
  }

  private checkScan(domain: readonly number[], result: readonly number[], { scan, along }: ScanOptions): NonNullable<Goal['scan']> {
    const isExclusive = scan === 'exclusive';
    if (!isSameShape(domain, result)) {
      const { name } = this.fold.parameters[this.results[0]!]!;
      const both = `${this.elementsText(domain)}, and the output '${name}' has ${shapeText(result)}`;
      this.fail(`${both}; a scan has one result for each element, so give them the same shape`, 'shape');
    }
    const lacking = isExclusive ? this.plain.accumulators.find(({ hasIdentity }) => !hasIdentity) : undefined;
    if (lacking !== undefined) {
      const { name } = lacking;
      this.fail(`an exclusive scan starts with the identity, and '${name}' declares none; write '${name} = ...' in its declaration, or call it without 'exclusive'`);
    }
    if (along !== undefined && !(Number.isInteger(along) && along >= 0 && along < domain.length)) {
      this.fail(`${this.elementsText(domain)}, which has no dimension ${along}; along is 0 to ${domain.length - 1}`, 'shape');
    }
    return { along: along === undefined ? undefined : domain.length - 1 - along, isExclusive };
  }
}

export const folds: Features['folds'] = (reduction, file) => new ReductionCaller(reduction, file);
