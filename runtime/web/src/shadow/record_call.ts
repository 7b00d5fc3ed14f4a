// SPDX-License-Identifier: MIT
//
// Records how far the outputs of a call are from the reference: errors, whose they are, exceptional values, decisions
// (runtime/src/shadow/call_record.cpp).
import { isSameElement, numbersOf } from '../elements.js';
import type { Element, Parameter } from '../generated.js';
import { viewOf } from '../stream.js';
import { componentNames, indexIn, indexOf, inputNumber, isReal, readColumns, readElement, sampleOf, scalarsOf, type AnyStream, type Elements } from './columns.js';
import { noErrors, type Counterpart, type StreamErrors } from './counterpart.js';
import { compare, isJump, type Columns, type Found, type OutputErrors } from './errors.js';
import type { ElementRecord, ExceptionRecord, Records, Value } from './records.js';
import { notCompared, Shares, writtenByHost } from './shares.js';

export interface ReadOfCall {
  /** Of the parameter. */
  readonly index: number;
  readonly name: string;
  readonly isGather: boolean;
  readonly of: Elements;
  /** Null if a stream holds a value, which the reference takes from the device. */
  readonly counterpart: Counterpart | null;
  /** The whole stream of the elements before the call, in doubles. */
  readonly device: AnyStream | null;
  /** Of the device's elements before the call: sampleOf(). Null unless an output is of the same shape and type. */
  readonly sample: Promise<Float64Array> | null;
}

export interface WrittenByCall {
  /** Of the parameter. */
  readonly index: number;
  readonly parameter: Parameter;
  readonly element: Element;
  /** Null if it is a value. */
  readonly of: Elements | null;
  readonly counterpart: Counterpart | null;
  /** The device's elements, and those of the reference with the device's and with its own inputs. */
  readonly arrays: Promise<readonly [Columns, Columns, Columns]>;
  /**
   * For inputs, by their numbers, what the reference computes with their own elements and the device's other inputs. Empty for most
   * calls.
   */
  readonly changed: Promise<readonly (readonly [input: number, elements: Columns])[]>;
}

/** Whether elements are of the same shape and type, so that a call may have computed some from the others, one by one. */
export function isAlike(a: Elements, b: Elements): boolean {
  return isSameElement(viewOf(a).stream.element, viewOf(b).stream.element) && a.shape.length === b.shape.length && a.shape.every((extent, d) => extent === b.shape[d]);
}

/** Whether numbers have mostly other signs than others have. */
export function haveOtherSigns(a: Float64Array, b: Float64Array): boolean {
  return a.reduce((sum, x, i) => sum + x * b[i]!, 0) < 0;
}

/** The errors of a stream after some of its elements were written: the others have those that they had. */
function withRest(written: StreamErrors, of: Elements | null, counterpart: Counterpart | null): StreamErrors {
  const whole = of === null ? 1 : viewOf(of).stream.size;
  if (of === null || counterpart === null || of.size >= whole) {
    written.shares.normalize();
    return written;
  }
  const before = counterpart.errors;
  const part = of.size / whole;
  const [here, there] = [written.relative ** 2 * part, before.relative ** 2 * (1 - part)];
  const shares = new Shares();
  shares.addAll(written.shares, here);
  shares.addAll(before.shares, there);
  shares.normalize();
  const isOfBoth = written.isEstimated && before.isEstimated && written.unseen !== before.unseen;
  const unseen = isOfBoth ? notCompared : written.isEstimated ? written.unseen : before.unseen;
  return {
    ...written, unseen, shares, relative: Math.sqrt(here + there), hasNan: written.hasNan || before.hasNan, hasInfinity: written.hasInfinity || before.hasInfinity,
    isEstimated: written.isEstimated || before.isEstimated,
  };
}

const mostRecords = 256;
const longestPath = 32;

export class CallRecorder {
  /** What was known of the inputs when the call was made. */
  private inputErrors: readonly StreamErrors[] = [];
  /** The record of the NaN or infinity that the output that was recorded last has; -1 if there is none. */
  private exception = -1;

  /** `promised`: how many values the call promises. */
  constructor(
    private readonly records: Records, private readonly number: number, private readonly kernel: number, private readonly reads: readonly ReadOfCall[],
    private readonly values: readonly { name: string; element: Element; value: unknown }[], private readonly promised: number,
  ) {}

  async record(written: readonly WrittenByCall[]): Promise<void> {
    this.takeInputErrors();
    const record = this.records.kernels[this.kernel]!;
    let amplification = 0;
    for (const each of written) await this.recordInfluences(each);
    for (const each of written) {
      const arrays = await each.arrays;
      const start = performance.now();
      const errors = compare(scalarsOf(each.element).map(isReal), ...arrays);
      this.records.comparisonSeconds += (performance.now() - start) / 1000;
      amplification = Math.max(amplification, this.amplificationOf(errors));
      await this.recordOutput(each, errors, arrays);
    }
    if (amplification > 0) record.amplification.add(amplification);
    ++record.followed;
    ++this.records.followed;
  }

  private takeInputErrors(): void {
    this.inputErrors = this.reads.map(({ counterpart }) => counterpart?.errors ?? noErrors());
  }

  /**
   * What a call that is not compared is taken to leave: what the last compared call of the kernel has added, and what its inputs have, as
   * that call has magnified it. What exceeds it, when the elements are compared, is of calls that were not compared.
   */
  estimate(written: readonly { readonly index: number; readonly name: string; readonly of: Elements; readonly counterpart: Counterpart }[]): void {
    this.takeInputErrors();
    const inputs = Math.max(0, ...this.inputErrors.map(({ relative }) => relative));
    for (const { index, name, of, counterpart } of written) {
      const record = this.records.kernels[this.kernel]!;
      const isKnown = record.followed > 0;
      const known = record.compared.get(name) ?? { own: 0, amplification: 1 };
      const relative = known.own + known.amplification * inputs;
      const has = (what: 'hasNan' | 'hasInfinity') => this.inputErrors.some((errors) => errors[what]);
      const isOfOthers = this.inputErrors.some((errors) => errors.isEstimated && errors.unseen !== this.kernel);
      const exception = Math.max(-1, ...this.inputErrors.map((errors) => errors.exception));
      const shares = !isKnown ? this.sharesThrough(index) : relative > 0 ? this.sharesOf(index, known.own / relative) : new Shares();
      const unseen = isOfOthers || !isKnown ? notCompared : this.kernel;
      const after = { relative, shares, hasNan: has('hasNan'), hasInfinity: has('hasInfinity'), exception, isEstimated: true, unseen };
      counterpart.errors = withRest(after, of, counterpart);
    }
  }

  /** Notes how far an output changes where one input is right. */
  private async recordInfluences({ index, element, arrays, changed }: WrittenByCall): Promise<void> {
    const errorOf = (input: number) => this.inputErrors[this.reads.findIndex((read) => read.index === input)]!.relative;
    const isWrong = ([input]: readonly [number, Columns]) => errorOf(input) > 0;
    const wrong = (await changed).filter(isWrong);
    if (wrong.length < 2) return;
    const [, own] = await arrays;
    for (const [input, elements] of wrong) {
      const change = compare(scalarsOf(element).map(isReal), elements, null, own);
      const factor = Math.max(change.relativeTotal(), change.relativeIntegers()) / errorOf(input);
      this.records.influences.set(this.kernel, index, input, factor);
    }
  }

  private amplificationOf(errors: OutputErrors): number {
    const inputs = Math.max(0, ...this.inputErrors.map(({ relative }) => relative));
    return errors.reals > 0 && inputs > 0 && Number.isFinite(inputs) ? errors.relativeInherited() / inputs : 0;
  }

  private async recordOutput(written: WrittenByCall, errors: OutputErrors, arrays: readonly [Columns, Columns, Columns]): Promise<void> {
    const { records, number } = this;
    const record = records.kernels[this.kernel]!;
    const { name } = written.parameter;
    const after = this.errorsAfter(written, errors);
    const output = record.output(name, written.element.name);
    if (errors.reals > 0 || errors.lost > 0) {
      const [own, inherited, isTurned] = [errors.relativeOwn(), errors.relativeInherited(), await this.turns(written, arrays[0])];
      record.own.add(errors.reportedOwn());
      record.inherited.add(inherited);
      record.total.add(errors.reportedTotal());
      record.compared.set(name, { own, amplification: this.amplificationOf(errors) || 1 });
      output.points.add({ call: number, own, inherited, total: after.relative, absolute: errors.absoluteTotal(), isTurned });
      const worst = errors.own.error / (errors.scale() || 1);
      if (errors.own.element >= 0 && worst > record.worstError) {
        record.worstError = worst;
        record.worst = await this.elementOf(written, errors.own.element, errors.own.component, arrays);
      }
    }
    if (written.counterpart !== null) {
      written.counterpart.errors = after;
      written.counterpart.record.points.add({ call: number, own: 0, inherited: 0, total: after.relative, absolute: 0, isTurned: false });
    }
    this.exception = -1;
    await this.recordExceptions(written, 'nan', errors.nans, errors.newNans, arrays);
    await this.recordExceptions(written, 'infinity', errors.infinities, errors.newInfinities, arrays);
    await this.recordDecisions(written, errors, arrays);
    if (written.of === null) this.recordValue(written, errors, after);
  }

  /** Whether the output has mostly the other sign than an input of its shape, by some of their elements. */
  private async turns({ of, element }: WrittenByCall, device: Columns): Promise<boolean> {
    if (of === null) return false;
    const samples = await Promise.all(this.reads.filter((read) => read.sample !== null && isAlike(read.of, of)).map(({ sample }) => sample!));
    return samples.some((sample) => haveOtherSigns(sample, sampleOf(element, device)));
  }

  /** A value that a reduce has promised is read by that. */
  private recordValue({ parameter: { name }, element }: WrittenByCall, errors: OutputErrors, after: StreamErrors): void {
    const { records } = this;
    const kernel = records.kernels[this.kernel]!;
    const result = records.result(this.promised === 1 ? kernel.name : `${name} of ${kernel.name}`, true);
    ++result.reads;
    result.elements = 1;
    result.numbers = scalarsOf(element).filter(isReal).length;
    result.exception = this.exception;
    result.scale = Math.max(result.scale, errors.scale());
    result.last = result.scale > 0 && errors.reals > 0 ? Math.max(errors.absoluteTotal() / result.scale, errors.relativeIntegers()) : after.relative;
    if (errors.lost > 0) result.last = Infinity;
    records.addError(result, after.shares);
    result.differs += errors.decisions.count;
    result.notFinite = errors.newNans.count + errors.newInfinities.count;
    result.withoutValue = Math.max(result.withoutValue, errors.nans.count + errors.infinities.count);
  }

  /** What is known of the elements of an output now. The error consists of what the call has added, and of what its inputs had. */
  private errorsAfter(written: WrittenByCall, errors: OutputErrors): StreamErrors {
    let own = errors.ownShare();
    let relative = errors.lost > 0 ? Math.max(errors.relativeTotal(), 1) : errors.relativeTotal();
    if (errors.relativeIntegers() > relative) {
      relative = errors.relativeIntegers();
      own = Math.min(1, errors.ownDecisions.count / errors.decisions.count);
    }
    const shares = relative > 0 ? this.sharesOf(written.index, own) : new Shares();
    const after = { relative, shares, hasNan: errors.nans.count > 0, hasInfinity: errors.infinities.count > 0, exception: -1, isEstimated: false, unseen: notCompared };
    return withRest(after, written.of, written.counterpart);
  }

  private weightsOf(output: number): readonly number[] {
    return this.records.influences.weights(this.kernel, output, this.reads.map(({ index }, i) => [index, this.inputErrors[i]!.relative]));
  }

  /** The kernel may add anything, and may magnify errors of its inputs or drop them: no other kernel gets a share through it. */
  private sharesThrough(output: number): Shares {
    const shares = new Shares();
    shares.addThrough(this.kernel, 1);
    const weights = this.weightsOf(output);
    const inputs = weights.reduce((sum, weight) => sum + weight, 0);
    this.inputErrors.forEach(({ shares: before }, i) => shares.addPath(before, inputs > 0 ? weights[i]! / inputs : 1));
    return shares;
  }

  private sharesOf(output: number, own: number): Shares {
    const shares = new Shares();
    shares.add(this.kernel, own);
    const weights = this.weightsOf(output);
    const inputs = weights.reduce((sum, weight) => sum + weight, 0);
    this.inputErrors.forEach(({ shares: before }, i) => {
      if (inputs > 0) shares.addAll(before, ((1 - own) * weights[i]!) / inputs);
    });
    const missing = 1 - shares.sum();
    if (missing > 1e-6 && own < 1 - 1e-6) shares.add(writtenByHost, missing);
    return shares;
  }

  private async recordExceptions(written: WrittenByCall, kind: ExceptionRecord['kind'], all: Found, added: Found, arrays: readonly [Columns, Columns, Columns]): Promise<void> {
    if (all.count === 0) return;
    const { records, kernel, number } = this;
    const record = records.kernels[kernel]!;
    const output = written.parameter.name;
    const isNew = added.count > 0;
    if (kind === 'nan') record.nans += added.count;
    else record.infinities += added.count;
    const follow = (exception: number) => {
      this.exception = exception;
      if (written.counterpart !== null) written.counterpart.errors = { ...written.counterpart.errors, exception };
    };
    for (const { exception } of isNew ? [] : this.inputErrors) {
      if (exception < 0) continue;
      const { path } = records.exceptions[exception]!;
      const isKnown = path.some((step) => step.kernel === kernel && step.output === output);
      if (!isKnown && path.length < longestPath) path.push({ call: number, kernel, output, elements: all.count });
      follow(exception);
    }
    if (!isNew && this.inputErrors.some(({ hasNan, hasInfinity }) => (kind === 'nan' ? hasNan : hasInfinity))) return;
    const known = records.exceptions.findIndex((each) => each.kernel === kernel && each.kind === kind && each.isInReference === !isNew);
    if (known >= 0 && (isNew || this.exception < 0)) follow(known);
    if (known >= 0 || records.exceptions.length >= mostRecords || (!isNew && (await this.isRead(kind)))) return;
    const shown = isNew ? added : all;
    const first = await this.elementOf(written, shown.first, shown.component, arrays);
    const last = records.exceptions.push({ kind, kernel, elements: shown.count, isInReference: !isNew, first, path: [] }) - 1;
    if (isNew || this.exception < 0) follow(last); // infinity minus infinity is NaN: it comes from where the infinity does
  }

  /** Whether the call has read such a value, which the page may have written. */
  private async isRead(kind: ExceptionRecord['kind']): Promise<boolean> {
    const isOne = (x: number) => (kind === 'nan' ? Number.isNaN(x) : Math.abs(x) === Infinity);
    for (const { device } of this.reads) {
      if (device !== null && (await readColumns(device)).some((column) => column.some(isOne))) return true;
    }
    return false;
  }

  private async recordDecisions(written: WrittenByCall, errors: OutputErrors, arrays: readonly [Columns, Columns, Columns]): Promise<void> {
    const { records, kernel } = this;
    const add = async (elements: number, first: number, component: number, isInherited: boolean) => {
      records.kernels[kernel]!.decisions += elements;
      const isKnown = records.decisions.some((each) => each.kernel === kernel && each.isInherited === isInherited);
      if (isKnown || records.decisions.length >= mostRecords) return;
      const element = await this.elementOf(written, first, component, arrays);
      // With the same inputs, the reference decides as the device does.
      const reference = isInherited ? { ...element.reference, value: arrays[2][component]![first]! } : element.reference;
      records.decisions.push({ kernel, elements, isInherited, first: { ...element, reference } });
    };
    const { ownDecisions: own, decisions } = errors;
    if (own.count > 0) await add(own.count, own.first, own.component, false);
    else if (decisions.count > 0) await add(decisions.count, decisions.first, decisions.component, true);
    const { element, component } = errors.own;
    if (element >= 0 && isJump(errors, arrays[1][component]![element]!)) await add(1, element, component, false);
  }

  /** Which elements an output's element was computed from, if the roles of the parameters do not say. */
  private sourceOf(of: Elements | null): { source?: string } {
    if (of === null) return { source: `it was computed from several elements: of ${this.reads.map((read) => `${read.of.size} of ${read.name}`).join(' and ')}` };
    return this.reads.some(({ isGather }) => isGather) ? { source: 'of a gather, the element at the same index is shown; the kernel may have read others' } : {};
  }

  private async elementOf(written: WrittenByCall, number: number, component: number, [device, own]: readonly [Columns, Columns, Columns]): Promise<ElementRecord> {
    const { element, of, parameter } = written;
    const scalars = scalarsOf(element);
    const value = (columns: Columns): Value => ({ value: columns[component]![number]!, isReal: isReal(scalars[component]!) });
    const inputs: ElementRecord['inputs'][number][] = this.values.flatMap((given) => {
      const names = componentNames(given.element);
      const areReal = scalarsOf(given.element).map(isReal);
      return numbersOf(given.element, given.value).map((x, c) => ({ parameter: given.name + names[c]!, value: areReal[c] ? Math.fround(Number(x)) : Number(x), isReal: areReal[c]! }));
    });
    for (const read of of === null ? [] : this.reads) {
      const at = read.device === null ? -1 : inputNumber(read.of, of!.shape as readonly number[], number);
      if (at < 0) continue;
      const page = viewOf(read.of).stream.element;
      const names = componentNames(page);
      const areReal = scalarsOf(page).map(isReal);
      const index = read.isGather ? { at: indexIn(read.of.shape as readonly number[], at) } : {};
      (await readElement(read.device!, at)).forEach((x, c) => inputs.push({ parameter: read.name + names[c]!, ...index, value: x, isReal: areReal[c]! }));
    }
    const index = of === null ? [] : indexOf(of, number);
    return { call: this.number, output: parameter.name + componentNames(element)[component]!, index, device: value(device), reference: value(own), inputs, ...this.sourceOf(of) };
  }
}
