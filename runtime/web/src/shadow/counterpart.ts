// SPDX-License-Identifier: MIT
//
// The counterparts of a page's streams: their elements as the reference has computed them, doubles for floats.
import { isSameElement } from '../elements.js';
import type { Element } from '../generated.js';
import { Stream, View, viewOf } from '../stream.js';
import type { AnyStream, Elements } from './columns.js';
import type { StreamRecord } from './records.js';
import { Series } from './series.js';
import { notCompared, Shares, writtenByHost } from './shares.js';
import { widened } from './widen.js';

/** What is known of the device's elements. */
export interface StreamErrors {
  /** Relative to the root mean square of the reference's. */
  readonly relative: number;
  /** Whose error it is. */
  readonly shares: Shares;
  readonly hasNan: boolean;
  readonly hasInfinity: boolean;
  /** The record of the NaN or infinity that they come from; -1 if there is none. */
  readonly exception: number;
  /** Calls that were not compared have written some: `relative` is expected. */
  readonly isEstimated: boolean;
  /** The kernel of these calls, if it is one. */
  readonly unseen: number;
}

export function noErrors(): StreamErrors {
  return { relative: 0, shares: new Shares(), hasNan: false, hasInfinity: false, exception: -1, isEstimated: false, unseen: notCompared };
}

/** Estimated errors that have been measured: what the estimate does not explain is of calls that were not compared. */
export function measured(errors: StreamErrors, relative: number): StreamErrors {
  if (!errors.isEstimated) return errors;
  const slack = 2; // errors of one kernel differ as much from call to call
  const part = relative > slack * errors.relative ? (slack * errors.relative) / relative : 1;
  const shares = new Shares();
  shares.addAll(errors.shares, part);
  shares.add(errors.unseen, 1 - part);
  shares.addPath(errors.shares, 1 - part);
  shares.normalize();
  return { ...errors, shares, relative, isEstimated: false };
}

export class Counterpart {
  /** Those of the calls that have been compared: comparisons come later than calls, and in their order. */
  errors = noErrors();
  /** Of the device's elements, if a comparison has asked for them since they were written: sampleOf(). */
  sample: Promise<Float64Array> | null = null;
  /** The kernel that has written the device's elements last. */
  writer = writtenByHost;
  /** A call that was not compared has written them. */
  isEstimated = false;
  readonly record: StreamRecord;
  private held: AnyStream | null = null;
  private isFresh = false;
  /** Whether the page has written the device's elements itself: taking those over is no resync. */
  private isOfPage = true;

  constructor(readonly stream: AnyStream, name: string) {
    this.record = { name, type: stream.element.name, shape: [...(stream.shape as readonly number[])], resyncs: 0, points: new Series() };
  }

  /** The reference's elements, as `element`; null if it has none. */
  elements(): AnyStream | null {
    return this.isFresh && this.held?.isReady(true) ? this.held : null;
  }

  /** Why there are none: whether the page has written other ones, or a call that is not followed. */
  get isWrittenByPage(): boolean {
    return this.isOfPage;
  }

  /** The reference's elements. It takes the device's over if it has none. */
  taken(element: Element): AnyStream {
    const held = this.elements();
    if (held !== null && isSameElement(held.element, element)) return held;
    if (held !== null || !this.isOfPage) ++this.record.resyncs;
    this.replace(widened(this.stream, element));
    return this.held!;
  }

  /** A stream for all elements, which the reference is about to compute. */
  room(element: Element): AnyStream {
    const fits = this.held !== null && this.held.isReady(false) && isSameElement(this.held.element, element) && this.held.size === this.stream.size;
    if (!fits) this.replace(new Stream<any, number>(this.stream.device, element, this.stream.shape));
    this.isFresh = true;
    return this.held!;
  }

  /** A kernel, or the page, has written some of the device's elements. */
  change(writer: number): void {
    this.writer = writer;
    this.sample = null;
    this.isEstimated = false;
  }

  /** The device's elements are others now, which the reference has not. */
  leave(isOfPage: boolean): void {
    this.change(writtenByHost);
    this.isOfPage = isOfPage;
    this.isFresh = false;
  }

  /** Takes over the device's elements of a view, if the reference has the others. */
  takePart(of: View<any, number>): void {
    this.change(writtenByHost);
    const held = this.elements();
    if (held === null) return;
    const whole = widened(this.stream, held.element);
    (placedOn(of, whole) as View<any, number>).copyTo(placedOn(of, held) as View<any, number>);
    whole.dispose();
  }

  dispose(): void {
    this.held?.dispose();
    this.held = null;
    this.isFresh = false;
  }

  private replace(held: AnyStream): void {
    this.held?.dispose();
    this.held = held;
    this.record.shape = [...(held.shape as readonly number[])];
    this.isFresh = true;
    this.isOfPage = false;
  }
}

/** The elements of another stream of the same shape that are where these are in theirs. */
export function placedOn(of: Elements, stream: AnyStream): Elements {
  if (of instanceof Stream || of.size === of.stream.size) return stream;
  const { shape, begin, steps } = viewOf(of);
  return new View<any, number>(stream, shape, begin, steps);
}
