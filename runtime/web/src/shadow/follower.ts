// SPDX-License-Identifier: MIT
//
// Sees what happens on a device, and has everything compared: calls, and what the page reads. Comparisons wait for transfers, and come
// in the order of the calls. No method throws an error of its own.
import type { Device } from '../device.js';
import type { LoadedFile } from '../features.js';
import type { CallableKernel, CallableReduction } from '../generated.js';
import { shapeText } from '../layout.js';
import type { Called, Observer } from '../observer.js';
import type { GivenDomain } from '../over.js';
import { viewOf } from '../stream.js';
import type { KernelOptions, ScanOptions } from '../types.js';
import { bytesOf, isReal, readColumns, scalarsOf, type AnyStream, type Elements } from './columns.js';
import { Counterpart, measured, noErrors, placedOn } from './counterpart.js';
import { compare } from './errors.js';
import { FollowedCall, formCaller, type FormCaller } from './followed_call.js';
import { Records } from './records.js';

type Callable = CallableKernel | CallableReduction;

/** Arrays on the host that wait to be compared: while there are more, calls are not compared. */
const mostBytes = 2 ** 28;

export class Follower implements Observer {
  readonly records = new Records();
  /** Why the reference has failed to run a kernel. */
  readonly givenUp = new Map<Callable, string>();
  private readonly counterparts = new Map<AnyStream, Counterpart>();
  private readonly names = new WeakMap<AnyStream, string>();
  private readonly callers = new Map<Callable, FormCaller>();
  private made = 0;
  private comparisons: Promise<void> = Promise.resolve();
  private waitingBytes = 0;
  private hasStopped = false;

  constructor(readonly device: Device, private readonly every: number, private readonly isChosen: (kernel: string) => boolean) {
    device.observer = this;
  }

  // ---- what the page does -------------------------------------------------------------------------

  call<T>(called: Called, options: ScanOptions & KernelOptions, given: readonly unknown[], over: GivenDomain | null, run: () => T): T {
    return this.unseen(() => {
      const call = new FollowedCall(this, called, options, given, over);
      call.prepare();
      const start = performance.now();
      let result: T;
      try {
        result = run();
      } catch (error) {
        call.abandon();
        throw error;
      }
      const seconds = (performance.now() - start) / 1000;
      this.records.deviceSeconds += seconds;
      this.records.kernels[call.kernel]!.seconds += seconds;
      call.finish(result);
      return result;
    });
  }

  read(of: Elements): void {
    this.orNote(`what the page read of ${this.nameOf(of)} was not compared`, () => {
      const counterpart = this.counterparts.get(viewOf(of).stream);
      const held = counterpart?.elements();
      if (counterpart === undefined || of.size === 0) return;
      if (!held) {
        if (!counterpart.isWrittenByPage) this.records.note(`what the page read of ${counterpart.record.name} was not compared: the call that wrote it is not followed`);
        return;
      }
      const arrays = Promise.all([readColumns(of), readColumns(placedOn(of, held))]);
      arrays.catch(() => undefined); // which the comparison sees
      const areReal = scalarsOf(viewOf(of).stream.element).map(isReal);
      const { writer } = counterpart;
      this.compareLater(2 * bytesOf(of), async () => {
        const [device, reference] = await arrays;
        const errors = compare(areReal, device, null, reference);
        const result = this.records.result(counterpart.record.name, false);
        ++result.reads;
        result.elements = of.size;
        result.numbers = of.size * areReal.filter(Boolean).length;
        result.last = Math.max(errors.reportedTotal(), errors.relativeIntegers());
        this.records.addError(result, measured(counterpart.errors, errors.relativeAll()).shares.copied());
        result.differs += errors.decisions.count;
        result.notFinite = errors.newNans.count + errors.newInfinities.count;
        result.withoutValue = Math.max(result.withoutValue, errors.nans.count + errors.infinities.count);
        result.exception = counterpart.errors.exception;
        if (result.last > 0 && result.shares.sum() === 0) result.shares.add(writer, 1); // a call that was not compared
      });
    });
  }

  written(of: Elements): void {
    this.orNote(`what the page wrote to ${this.nameOf(of)} was not taken over`, () => {
      const view = viewOf(of);
      const counterpart = this.counterparts.get(view.stream);
      if (counterpart === undefined) return;
      if (view.size < view.stream.size) return counterpart.takePart(view);
      this.leave(counterpart, true);
    });
  }

  copied(from: Elements, to: Elements): void {
    this.orNote(`the copy to ${this.nameOf(to)} was not followed`, () => {
      const [source, target] = [viewOf(from), viewOf(to)];
      const counterpart = this.counterparts.get(source.stream);
      const held = counterpart?.elements() ?? null;
      const isWhole = target.size === target.stream.size;
      if (counterpart === undefined || held === null) {
        if (!isWhole || !counterpart || counterpart.isWrittenByPage) this.written(to);
        else this.lose(target.stream);
        return;
      }
      const other = this.counterpartOf(target.stream);
      other.change(counterpart.writer);
      const room = isWhole && target.stream !== source.stream ? other.room(held.element) : other.taken(held.element);
      (placedOn(from, held) as AnyStream).copyTo(placedOn(to, room) as AnyStream);
      if (isWhole) this.compareLater(0, () => void (other.errors = { ...counterpart.errors, shares: counterpart.errors.shares.copied() }));
    });
  }

  disposed(stream: AnyStream): void {
    this.orNote('a counterpart was not disposed of', () => {
      this.counterparts.get(stream)?.dispose();
      this.counterparts.delete(stream);
    });
  }

  // ---- what calls need ----------------------------------------------------------------------------

  counterpartOf(stream: AnyStream): Counterpart {
    let counterpart = this.counterparts.get(stream);
    if (counterpart !== undefined) return counterpart;
    const { element, shape } = stream;
    const name = this.names.get(stream) ?? `${element.name} ${shapeText(shape as readonly number[])} #${++this.made}`;
    counterpart = new Counterpart(stream, name);
    this.counterparts.set(stream, counterpart);
    this.records.streams.push(counterpart.record);
    return counterpart;
  }

  /** The device has elements that the reference has not computed. */
  lose(stream: AnyStream): void {
    this.leave(this.counterpartOf(stream), false);
  }

  private leave(counterpart: Counterpart, isOfPage: boolean): void {
    counterpart.leave(isOfPage);
    this.compareLater(0, () => void (counterpart.errors = noErrors()));
  }

  /** Measures errors that are only estimated, of the elements as they are now. */
  measureLater(counterpart: Counterpart): void {
    const held = counterpart.elements();
    if (!counterpart.isEstimated || held === null) return;
    counterpart.isEstimated = false;
    const { stream } = counterpart;
    const arrays = Promise.all([readColumns(stream), readColumns(held)]);
    arrays.catch(() => undefined); // which the comparison sees
    this.compareLater(2 * bytesOf(stream), async () => {
      const [device, reference] = await arrays;
      const errors = compare(scalarsOf(stream.element).map(isReal), device, null, reference);
      counterpart.errors = { ...measured(counterpart.errors, errors.relativeAll()), hasNan: errors.nans.count > 0, hasInfinity: errors.infinities.count > 0 };
    });
  }

  callerOf(form: Callable, file: LoadedFile): FormCaller {
    let caller = this.callers.get(form);
    if (caller === undefined) this.callers.set(form, (caller = formCaller(form, file)));
    return caller;
  }

  /** Whether the n-th call of a kernel is compared. */
  isMeasured(kernel: string, n: number): boolean {
    if (!this.isChosen(kernel) || n % this.every !== 0) return false;
    if (this.waitingBytes <= mostBytes) return true;
    this.records.note(`calls were left out of the comparison, since ${mostBytes / 2 ** 20} MiB waited to be compared; await a read now and then, or compare fewer by 'every'`);
    return false;
  }

  /** Compares when everything before has been compared; `end` comes then in any case. */
  compareLater(bytes: number, job: () => void | Promise<void>, end: () => void = () => undefined): void {
    this.waitingBytes += bytes;
    this.comparisons = this.comparisons.then(job).catch((error) => this.records.note(`a comparison has failed: ${messageOf(error)}`)).then(() => {
      this.waitingBytes -= bytes;
      end();
    });
  }

  // ---- what the shadow asks -----------------------------------------------------------------------

  /** Resolves when everything until now has been compared. */
  async settled(): Promise<void> {
    await this.comparisons;
  }

  name(stream: AnyStream, name: string): void {
    this.names.set(stream, name);
    const record = this.counterparts.get(stream)?.record;
    if (record !== undefined) record.name = name;
  }

  stop(): void {
    if (this.hasStopped) return;
    this.hasStopped = true;
    if (this.device.observer === this) this.device.observer = null;
    for (const counterpart of this.counterparts.values()) counterpart.dispose();
    this.counterparts.clear();
  }

  private nameOf(of: Elements): string {
    const { stream } = viewOf(of);
    return this.counterparts.get(stream)?.record.name ?? stream.element.name;
  }

  /** Runs something on the device that the shadow does not see. */
  private unseen<T>(run: () => T): T {
    this.device.observer = null;
    try {
      return run();
    } finally {
      if (!this.hasStopped) this.device.observer = this;
    }
  }

  private orNote(what: string, run: () => void): void {
    try {
      this.unseen(run);
    } catch (error) {
      this.records.note(`${what}: ${messageOf(error)}`);
    }
  }
}

function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

