// SPDX-License-Identifier: MIT
//
// One call of the page, made three times: by the device, as ever; in pairs of floats with the device's inputs; and in pairs of floats with
// the reference's: runtime/src/shadow/shadow_call.cpp. Never throws an error of its own.
import { numbersOf } from '../elements.js';
import type { FoldCaller, LoadedFile } from '../features.js';
import type { CallableKernel, CallableReduction, Element, Parameter } from '../generated.js';
import { KernelCaller } from '../kernel.js';
import type { Called } from '../observer.js';
import type { GivenDomain } from '../over.js';
import { Fitted, Stream, View, viewOf } from '../stream.js';
import type { KernelOptions, ScanOptions } from '../types.js';
import { bytesOf, readColumns, sampleOf, type AnyStream, type Elements } from './columns.js';
import { placedOn, type Counterpart } from './counterpart.js';
import type { Columns } from './errors.js';
import type { Follower } from './follower.js';
import { CallRecorder, isAlike, type ReadOfCall, type WrittenByCall } from './record_call.js';
import { widened } from './widen.js';

type Callable = CallableKernel | CallableReduction;

/** Runs a form of a kernel or reduce; one for each form. */
export interface FormCaller {
  call(given: readonly unknown[], over: GivenDomain | null): unknown;
}

export function formCaller(form: Callable, file: LoadedFile): FormCaller {
  if (!('fold' in form)) return new KernelCaller(form, file);
  const caller: FoldCaller = file.features.folds!(form, file);
  return { call: (given, over) => caller.call(given, {}, over) };
}

function parametersOf(callable: Callable): readonly Parameter[] {
  return 'fold' in callable ? callable.fold.parameters : callable.parameters;
}

function viewIn(argument: unknown): Elements | null {
  if (argument instanceof Fitted) return argument.view;
  return argument instanceof Stream || argument instanceof View ? argument : null;
}

const isWritten = ({ role }: Parameter) => role === 'output' || role === 'accumulator' || role === 'variableOutput' || role === 'scatter';

/** What of a call is read: elements that the reference has, or a value in a stream, which it takes from the device. */
interface Read extends ReadOfCall {
  readonly isValue: boolean;
}

/** What the reference computes with its own elements for one input. */
interface Changed {
  readonly input: number;
  readonly outputs: readonly AnyStream[];
}

export class FollowedCall {
  readonly kernel: number;
  private readonly number: number;
  private readonly parameters: readonly Parameter[];
  private readonly isToValues: boolean;
  /** One for each parameter; null for results that are values. */
  private readonly arguments: readonly unknown[];
  private readonly outputs: readonly { index: number; of: Elements | null }[];
  private form: Callable | null = null;
  /** What has kept the reference from reading the inputs. */
  private obstacle: unknown = null;
  private isMeasured = false;
  private reads: Read[] = [];
  /** The device's inputs before the call, in doubles; and streams that stand for values. */
  private readonly inputs = new Map<AnyStream, AnyStream>();
  private readonly values = new Map<AnyStream, AnyStream>();
  private readonly temporaries: AnyStream[] = [];

  constructor(private readonly follower: Follower, private readonly called: Called, options: ScanOptions & KernelOptions, given: readonly unknown[], private readonly over: GivenDomain | null) {
    const { callable } = called;
    const { records } = follower;
    this.parameters = parametersOf(callable);
    const results = this.parameters.filter(({ role }) => role === 'accumulator').length;
    this.isToValues = results > 0 && given.length === this.parameters.length - results;
    let next = 0;
    this.arguments = this.parameters.map(({ role }) => (this.isToValues && role === 'accumulator' ? null : given[next++]));
    this.outputs = this.parameters.flatMap((parameter, index) => {
      const of = viewIn(this.arguments[index]);
      return isWritten(parameter) && (of !== null || (this.isToValues && parameter.role === 'accumulator')) ? [{ index, of }] : [];
    });
    this.number = ++records.calls;
    this.kernel = records.kernel(callable.name);
    const record = records.kernels[this.kernel]!;
    this.isMeasured = follower.isMeasured(callable.name, record.calls++);
    record.choices ||= Object.entries({ ...chosenOf(callable), ...options }).filter(([, value]) => value !== 'single' && value !== undefined).map(([name, value]) => `${name} ${value}`).join(', ');
  }

  /** What must happen before the device makes the call. */
  prepare(): void {
    const why = this.whyNot();
    if (why !== null) {
      this.follower.records.note(`${this.called.callable.name} is not followed: ${why}; the reference takes over what it writes`);
      return;
    }
    this.form = this.called.callable.shadow as Callable | null ?? this.called.callable;
    try {
      if (this.isEmpty()) this.form = null;
      else this.prepareReads();
    } catch (error) {
      this.obstacle = error; // perhaps a mistake of the page, which the device refuses, too
    }
  }

  /** The device has refused the call: what it has written is not known. */
  abandon(): void {
    this.loseOutputs();
    this.end();
  }

  /** What follows the device's call, which has returned `result`. */
  finish(result: unknown): void {
    if (this.obstacle !== null) this.giveUp(this.obstacle, result);
    if (this.form === null) {
      this.loseOutputs();
      if (result instanceof Promise) result.then(() => this.loseOutputs(), () => undefined); // which has pushed by then
      return this.end();
    }
    const { records } = this.follower;
    for (const { of } of this.outputs) if (of !== null) this.follower.counterpartOf(viewOf(of).stream).change(this.kernel);
    const start = performance.now();
    try {
      // Before the reference replaces elements that it reads.
      const own = this.isMeasured ? this.runWith(({ device }) => device!) : [];
      const changed = this.isMeasured ? this.runInfluences() : [];
      const outputs = this.runOnReference();
      records.referenceSeconds += (performance.now() - start) / 1000;
      if (this.isMeasured) this.compare(result, own, changed, outputs);
      else this.estimate();
    } catch (error) {
      this.giveUp(error, result);
      this.loseOutputs();
      this.end();
    }
  }

  /** Why the reference has nothing that computes the same; null if it has. */
  private whyNot(): string | null {
    const { callable, file } = this.called;
    if ('fold' in callable && callable.scans) return 'it is a scan';
    if (!('fold' in callable) && callable.lists !== undefined) return 'it pushes or scatters';
    if (callable.shadow === undefined) return `${file.name}.js has no programs for it; give skc the option --shadow`;
    if (callable.shadow !== null && 'whyNot' in callable.shadow) return callable.shadow.whyNot;
    const isDouble = ({ element }: Parameter) => file.elements[element]!.fields.some(({ scalar }) => scalar === 'double');
    if (this.parameters.some(isDouble)) this.follower.records.note(`${callable.name} has doubles, which are pairs of floats here: the reference computes them alike`);
    return this.follower.givenUp.get(callable) ?? null;
  }

  private isEmpty(): boolean {
    return this.arguments.some((argument) => viewIn(argument)?.size === 0) || (this.over?.shape.includes(0) ?? false);
  }

  private elementOf(index: number): Element {
    return this.called.file.elements[parametersOf(this.form!)[index]!.element]!;
  }

  private temporary(stream: AnyStream): AnyStream {
    this.temporaries.push(stream);
    return stream;
  }

  private prepareReads(): void {
    this.parameters.forEach(({ name, role }, index) => {
      const of = viewIn(this.arguments[index]);
      if (of === null || isWritten(this.parameters[index]!)) return;
      const { stream } = viewOf(of);
      const isValue = role === 'uniform';
      if (isValue) this.follower.records.note(`'${name}' of ${this.called.callable.name} is a value in a stream: the reference takes it from the device`);
      const element = isValue ? stream.element : this.elementOf(index);
      const counterpart = isValue ? null : this.follower.counterpartOf(stream);
      counterpart?.taken(element);
      const kept = isValue ? this.values : this.inputs;
      if ((isValue || this.isMeasured) && !kept.has(stream)) kept.set(stream, this.temporary(widened(stream, element)));
      const mayTurn = this.isMeasured && counterpart !== null && this.outputs.some((output) => output.of !== null && isAlike(of, output.of));
      const sample = mayTurn ? sampleNow(of, counterpart) : null;
      if (counterpart !== null && counterpart.writer >= 0) this.follower.records.kernels[this.kernel]!.readFrom.add(counterpart.writer);
      if (counterpart !== null && this.isMeasured) this.follower.measureLater(counterpart);
      this.reads.push({ index, isValue, name, isGather: role === 'gather', of, counterpart, device: kept.get(stream) ?? null, sample });
    });
    for (const { index, of } of this.outputs) {
      if (of !== null && of.size < viewOf(of).stream.size) this.follower.counterpartOf(viewOf(of).stream).taken(this.elementOf(index));
    }
  }

  /** The arguments with other streams in place of those that are read and written. */
  private argumentsWith(read: (read: Read) => AnyStream, written: (index: number, of: Elements | null) => Elements): unknown[] {
    const replaced = [...this.arguments];
    for (const each of this.reads) {
      const argument = this.arguments[each.index];
      const placed = placedOn(each.of, each.isValue ? each.device! : read(each));
      replaced[each.index] = argument instanceof Fitted ? new Fitted(viewOf(placed), argument.stretches, argument.strides) : placed;
    }
    for (const { index, of } of this.outputs) replaced[index] = written(index, of);
    return replaced;
  }

  private get caller(): FormCaller {
    return this.follower.callerOf(this.form!, this.called.file);
  }

  /** A stream for a value, of as many dimensions as the domain has. */
  private valueStream(index: number): AnyStream {
    const input = this.reads.find((read) => this.parameters[read.index]!.role === 'input');
    const output = this.outputs.find(({ of }) => of !== null);
    const domain = (input?.of ?? output?.of ?? this.over)?.shape as readonly number[] | undefined;
    return this.temporary(new Stream<any, number>(this.follower.device, this.elementOf(index), (domain ?? [1]).map(() => 1)));
  }

  /** Returns the reference's outputs. */
  private runOnReference(): Elements[] {
    const outputs: Elements[] = [];
    const written = (index: number, of: Elements | null) => {
      const element = this.elementOf(index);
      if (of === null) outputs.push(this.valueStream(index));
      else {
        const { stream } = viewOf(of);
        const counterpart = this.follower.counterpartOf(stream);
        outputs.push(placedOn(of, of.size === stream.size ? counterpart.room(element) : counterpart.taken(element)));
      }
      return outputs[outputs.length - 1]!;
    };
    this.caller.call(this.argumentsWith(({ counterpart, index }) => counterpart!.taken(this.elementOf(index)), written), this.over);
    return outputs;
  }

  /**
   * For some calls with several inputs that may be wrong, makes the call with the reference's elements for one of them, and the device's for
   * the others. Whether they are wrong is not known yet: comparisons come later.
   */
  private runInfluences(): Changed[] {
    const followed = this.reads.filter(({ counterpart }) => counterpart !== null);
    if (followed.length < 2 || !this.follower.records.influences.isDue(this.kernel)) return [];
    const own = (read: Read) => read.counterpart!.taken(this.elementOf(read.index));
    return followed.map((right) => ({ input: right.index, outputs: this.runWith((read) => (read === right ? own(read) : read.device!)) }));
  }

  /** Returns what the reference computes with other inputs than its own. */
  private runWith(read: (read: Read) => AnyStream): AnyStream[] {
    const outputs: AnyStream[] = [];
    const written = (index: number, of: Elements | null) => {
      outputs.push(of === null ? this.valueStream(index) : this.temporary(new Stream<any, number>(this.follower.device, this.elementOf(index), of.shape)));
      return outputs[outputs.length - 1]!;
    };
    this.caller.call(this.argumentsWith(read, written), this.over);
    return outputs;
  }

  /** Asks for the outputs of all three, and records their errors when the calls before have been recorded. */
  private compare(result: unknown, own: readonly AnyStream[], changed: readonly Changed[], reference: readonly Elements[]): void {
    const values = this.isToValues ? this.valuesOf(result as Promise<unknown>) : [];
    let next = 0;
    const written = this.outputs.map(({ index, of }, k): WrittenByCall => {
      const device = of === null ? values[next++]! : readColumns(of);
      const counterpart = of === null ? null : this.follower.counterpartOf(viewOf(of).stream);
      if (counterpart !== null && of!.size === counterpart.stream.size) counterpart.sample = seen(device.then((columns) => sampleOf(counterpart.stream.element, columns)));
      return {
        index, parameter: this.parameters[index]!, element: this.called.file.elements[this.parameters[index]!.element]!, of, counterpart,
        arrays: Promise.all([device, readColumns(own[k]!), readColumns(reference[k]!)]),
        changed: seen(Promise.all(changed.map(async ({ input, outputs }) => [input, await readColumns(outputs[k]!)] as const))),
      };
    });
    const bytes = this.outputs.reduce((sum, { of }) => sum + (of === null ? 0 : (3 + changed.length) * bytesOf(of)), 0);
    for (const { arrays } of written) arrays.catch(() => undefined); // which the comparison sees
    const recorder = new CallRecorder(this.follower.records, this.number, this.kernel, this.reads, this.valuesGiven(), values.length);
    this.follower.compareLater(bytes, () => recorder.record(written), () => this.end());
  }

  /** The call is not compared. What its outputs have is expected, in its turn among the comparisons. */
  private estimate(): void {
    const written = this.outputs.flatMap(({ index, of }) => (of === null ? [] : [{ index, name: this.parameters[index]!.name, of, counterpart: this.follower.counterpartOf(viewOf(of).stream) }]));
    for (const { counterpart } of written) counterpart.isEstimated = true;
    const recorder = new CallRecorder(this.follower.records, this.number, this.kernel, this.reads, [], 0);
    this.follower.compareLater(0, () => recorder.estimate(written), () => this.end());
  }

  /** The components of each value that a reduce promises. */
  private valuesOf(result: Promise<unknown>): Promise<Columns>[] {
    const accumulators = this.parameters.filter(({ role }) => role === 'accumulator');
    return accumulators.map(({ element }, i) => result.then((all) => {
      const value = accumulators.length === 1 ? all : (all as readonly unknown[])[i];
      return numbersOf(this.called.file.elements[element]!, value).map((component) => Float64Array.of(Number(component)));
    }));
  }

  /** Uniforms and spec parameters that are no streams. */
  private valuesGiven(): { name: string; element: Element; value: unknown }[] {
    return this.parameters.flatMap(({ name, role, element }, i) => {
      const isValue = (role === 'uniform' || role === 'spec') && viewIn(this.arguments[i]) === null;
      return isValue ? [{ name, element: this.called.file.elements[element]!, value: this.arguments[i] }] : [];
    });
  }

  /** The reference cannot make the call, unless the device has refused it, too: reduces reject what they promise then. */
  private giveUp(error: unknown, result: unknown): void {
    this.form = null;
    const { givenUp, records, device } = this.follower;
    const { callable } = this.called;
    const why = error instanceof Error ? error.message : String(error);
    const record = () => {
      if (device.lost) return;
      givenUp.set(callable, why);
      records.note(`${callable.name} is not followed: ${why}`);
    };
    if (result instanceof Promise) result.then(record, () => undefined);
    else record();
  }

  /** The device has written elements that the reference has not. */
  private loseOutputs(): void {
    for (const { of } of this.outputs) if (of !== null) this.follower.lose(viewOf(of).stream);
  }

  private end(): void {
    for (const stream of this.temporaries.splice(0)) stream.dispose();
  }
}

/** A promise whose failure a comparison sees, if there is one. */
function seen<T>(promise: Promise<T>): Promise<T> {
  promise.catch(() => undefined);
  return promise;
}

/** Some of the device's elements as they are now, which are often what the call before has written. */
function sampleNow(of: Elements, { sample, stream }: Counterpart): Promise<Float64Array> {
  const isWhole = of.size === stream.size;
  return (isWhole ? sample : null) ?? seen(readColumns(of).then((columns) => sampleOf(stream.element, columns)));
}

/** What a declaration chooses. */
function chosenOf(callable: Callable): object {
  if ('fold' in callable) return { accumulate: callable.accumulate };
  return { precision: callable.precision, intrinsics: callable.intrinsics === 'accurate' ? undefined : callable.intrinsics };
}

