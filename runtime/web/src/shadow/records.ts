// SPDX-License-Identifier: MIT
//
// What a shadow has found out about a page, before it is a report: runtime/src/shadow/report.hpp. Errors are relative to the root mean
// square of the reference's components, unless said otherwise.
import { Influences } from './influences.js';
import { Series, Spread } from './series.js';
import { notCompared, Shares, writtenByHost } from './shares.js';

/** A number of the report. */
export interface Value {
  readonly value: number;
  readonly isReal: boolean;
}

/** An element of an output, and what it was computed from. */
export interface ElementRecord {
  readonly call: number;
  readonly output: string;
  /** In the stream, rows first. */
  readonly index: readonly number[];
  readonly device: Value;
  /** The reference computes with the device's inputs. */
  readonly reference: Value;
  readonly inputs: readonly (Value & { readonly parameter: string; readonly at?: readonly number[] })[];
  /** What it was computed from, if that is more or less than the inputs say. */
  readonly source?: string;
}

export interface OutputRecord {
  readonly name: string;
  readonly type: string;
  readonly points: Series;
}

export class KernelRecord {
  calls = 0;
  followed = 0;
  seconds = 0;
  readonly own = new Spread();
  readonly inherited = new Spread();
  readonly total = new Spread();
  readonly amplification = new Spread();
  worst: ElementRecord | null = null;
  /** Relative to the scale of its output. */
  worstError = 0;
  nans = 0;
  infinities = 0;
  decisions = 0;
  /** The options of its calls that are not the default: "precision half". */
  choices = '';
  readonly outputs: OutputRecord[] = [];
  /** The kernels whose outputs it has read. */
  readonly readFrom = new Set<number>();
  /** What the last compared call has shown of each output: the error that it has added, and how it magnifies those of its inputs. */
  readonly compared = new Map<string, { readonly own: number; readonly amplification: number }>();

  constructor(readonly name: string) {}

  output(name: string, type: string): OutputRecord {
    let found = this.outputs.find((output) => output.name === name);
    if (found === undefined) this.outputs.push((found = { name, type, points: new Series() }));
    return found;
  }
}

export interface StreamRecord {
  name: string;
  readonly type: string;
  /** Kernels that push change it. */
  shape: readonly number[];
  resyncs: number;
  readonly points: Series;
}

/** What the page read. */
export interface ResultRecord {
  readonly name: string;
  /** Of a reduce. */
  readonly isValue: boolean;
  reads: number;
  elements: number;
  /** Relative errors of the reads; infinite if nothing is right where the reference has numbers. */
  largest: number;
  last: number;
  /** Of a value: the largest of the reads, since a sum may be 0 by chance. */
  scale: number;
  differs: number;
  /** Real components of the last read; 0 if it has none. */
  numbers: number;
  /** Of the last read: not finite where the reference's are. */
  notFinite: number;
  /** Of a read: NaN or infinite, whatever the reference has; the most of all reads. */
  withoutValue: number;
  /** The number of the record of the NaN or infinity that the last read's come from; -1 if there is none. */
  exception: number;
  /** Of the read with the largest error. */
  shares: Shares;
}

export interface ExceptionRecord {
  readonly kind: 'nan' | 'infinity';
  readonly kernel: number;
  readonly elements: number;
  /** The reference computes it from the same inputs, too. */
  readonly isInReference: boolean;
  readonly first: ElementRecord;
  readonly path: { readonly call: number; readonly kernel: number; readonly output: string; readonly elements: number }[];
}

export interface DecisionRecord {
  readonly kernel: number;
  readonly elements: number;
  readonly isInherited: boolean;
  readonly first: ElementRecord;
}

const mostNotes = 100;

export class Records {
  calls = 0;
  followed = 0;
  deviceSeconds = 0;
  referenceSeconds = 0;
  comparisonSeconds = 0;
  readonly kernels: KernelRecord[] = [];
  readonly streams: StreamRecord[] = [];
  readonly results: ResultRecord[] = [];
  readonly exceptions: ExceptionRecord[] = [];
  readonly decisions: DecisionRecord[] = [];
  readonly notes: string[] = [];
  readonly influences = new Influences();

  /** The number of a kernel, whose record exists then. */
  kernel(name: string): number {
    const found = this.kernels.findIndex((kernel) => kernel.name === name);
    return found >= 0 ? found : this.kernels.push(new KernelRecord(name)) - 1;
  }

  nameOf(kernel: number): string {
    if (kernel === notCompared) return '(calls that were not compared)';
    return kernel === writtenByHost ? '(written by the page)' : this.kernels[kernel]!.name;
  }

  result(name: string, isValue: boolean): ResultRecord {
    let found = this.results.find((result) => result.name === name && result.isValue === isValue);
    if (found === undefined) {
      this.results.push((found = { name, isValue, reads: 0, elements: 0, largest: 0, last: 0, scale: 0, differs: 0, numbers: 0, notFinite: 0, withoutValue: 0, exception: -1, shares: new Shares() }));
    }
    return found;
  }

  /** Adds the error of a read whose `last` is set; `shares`: whose error it is. */
  addError(result: ResultRecord, shares: Shares): void {
    const isWorst = result.last >= result.largest;
    result.largest = Math.max(result.largest, result.last);
    if (isWorst) result.shares = shares;
  }

  /** Adds a note once. */
  note(text: string): void {
    if (this.notes.length >= mostNotes || this.notes.includes(text)) return;
    this.notes.push(this.notes.length + 1 === mostNotes ? 'further notes are left out' : text);
  }
}
