// SPDX-License-Identifier: MIT
//
// A report as JSON, version 1: docs/json.md, docs/shadow.schema.json, runtime/src/shadow/report_json.cpp. No GL: Node tests it.
import type { DecisionRecord, ElementRecord, ExceptionRecord, KernelRecord, Records, ResultRecord, StreamRecord, Value } from './records.js';
import type { Spread } from './series.js';
import { sharesOf, verdictsOf, type Verdict } from './verdicts.js';

/** A number; JSON has none that is not finite. */
export type ReportNumber = number | 'nan' | 'inf' | '-inf';

export interface ErrorSize {
  readonly largest: ReportNumber;
  readonly typical: ReportNumber;
}

/** A value in decimal and in hexadecimal. */
export interface Sample {
  readonly value: ReportNumber;
  readonly hex: string;
}

export interface WorstElement {
  readonly call: number;
  readonly output: string;
  /** Rows first. */
  readonly element: readonly number[];
  readonly device: Sample;
  readonly reference: Sample;
  readonly inputs: readonly (Sample & { readonly parameter: string; readonly at?: readonly number[]; readonly reference: Sample | null })[];
  /** What it was computed from, if that is more or less than the inputs say. */
  readonly source?: string;
}

export interface FollowedKernel {
  readonly name: string;
  readonly calls: number;
  readonly followed: number;
  readonly seconds: number;
  readonly choices: string;
  readonly own: ErrorSize;
  readonly storage: ErrorSize | null;
  readonly inherited: ErrorSize;
  readonly total: ErrorSize;
  readonly amplification: ErrorSize | null;
  readonly digits: number;
  readonly share: ReportNumber;
  readonly worst: WorstElement | null;
  readonly nans: number;
  readonly infinities: number;
  readonly flushed: number;
  readonly decisions: number;
  readonly outputs: readonly {
    readonly name: string;
    readonly type: string;
    /** The call, and its own, inherited and total error. */
    readonly points: readonly (readonly [number, ReportNumber, ReportNumber, ReportNumber])[];
  }[];
}

export interface FollowedStream {
  readonly name: string;
  readonly type: string;
  readonly shape: readonly number[];
  readonly resyncs: number;
  readonly points: readonly (readonly [number, ReportNumber])[];
}

export interface ReportedResult {
  readonly name: string;
  readonly kind: 'read' | 'value';
  readonly reads: number;
  readonly elements: number;
  readonly error: { readonly largest: ReportNumber; readonly last: ReportNumber };
  readonly digits: number;
  readonly differs: number;
  /** Real numbers of the last read; 0 if it had none. */
  readonly numbers: number;
  /** Of the last read: NaN or infinite where the reference has numbers. */
  readonly notFinite: number;
  /** NaN or infinite, whatever the reference has: the most of one read. */
  readonly withoutValue: number;
  /** The number, in `exceptions`, of the record that tells where the last read's come from. */
  readonly exception: number | null;
  readonly shares: readonly { readonly kernel: string; readonly share: ReportNumber }[];
}

/** What a shadow has found out: the format of `SK_SHADOW`, which `sk shadow` reads. */
export interface ShadowReport {
  readonly format: 'streamkernel-shadow';
  readonly version: 1;
  readonly program: string;
  readonly device: string;
  readonly reference: string;
  readonly ended: string;
  readonly options: { readonly every: number; readonly kernels: readonly string[]; readonly decisions: 'own'; readonly quad: readonly string[] };
  readonly seconds: { readonly program: number; readonly device: number; readonly reference: number; readonly comparison: number };
  readonly calls: number;
  readonly followed: number;
  readonly ranks: 1;
  /** The gravest first. */
  readonly verdicts: readonly Verdict[];
  readonly kernels: readonly FollowedKernel[];
  readonly streams: readonly FollowedStream[];
  readonly results: readonly ReportedResult[];
  readonly exceptions: readonly (WorstElement & {
    readonly kind: 'nan' | 'infinity';
    readonly kernel: string;
    readonly elements: number;
    readonly isInReference: boolean;
    readonly path: readonly { readonly call: number; readonly kernel: string; readonly output: string; readonly elements: number }[];
  })[];
  readonly decisions: readonly (WorstElement & { readonly kernel: string; readonly elements: number; readonly isInherited: boolean })[];
  readonly account: { readonly unread: readonly never[]; readonly partly: readonly never[]; readonly precision: readonly never[] };
  readonly notes: readonly string[];
}

/** What a report says of the run. */
export interface Run {
  readonly program: string;
  readonly device: string;
  readonly hasEnded: boolean;
  readonly every: number;
  readonly kernels: readonly string[];
  readonly seconds: number;
}

function number(value: number): ReportNumber {
  if (Number.isNaN(value)) return 'nan';
  return Number.isFinite(value) ? value : value > 0 ? 'inf' : '-inf';
}

/** As C prints it by "%a": -0x1.8p+0. */
export function hexOf(value: number): string {
  if (!Number.isFinite(value)) return String(number(value));
  const words = new DataView(new ArrayBuffer(8));
  words.setFloat64(0, value);
  const high = words.getUint32(0);
  const sign = high >>> 31 === 0 ? '' : '-';
  if (value === 0) return `${sign}0x0p+0`;
  const field = (high >>> 20) & 0x7ff;
  const digits = ((high & 0xfffff).toString(16).padStart(5, '0') + words.getUint32(4).toString(16).padStart(8, '0')).replace(/0+$/, '');
  const power = field === 0 ? -1022 : field - 1023;
  return `${sign}0x${field === 0 ? 0 : 1}${digits === '' ? '' : `.${digits}`}p${power < 0 ? '' : '+'}${power}`;
}

function sample({ value, isReal }: Value): Sample {
  return { value: number(value), hex: isReal ? hexOf(value) : String(value) };
}

function element(record: ElementRecord): WorstElement {
  const inputs = record.inputs.map(({ parameter, at, ...input }) => ({ parameter, ...(at === undefined ? {} : { at }), ...sample(input), reference: null }));
  const source = record.source === undefined ? {} : { source: record.source };
  return { call: record.call, output: record.output, element: record.index, device: sample(record.device), reference: sample(record.reference), inputs, ...source };
}

function spread({ largest, typical }: Spread): ErrorSize {
  return { largest: number(largest), typical: number(typical) };
}

/** Decimal digits that survive an error. */
function digits(error: number): number {
  return error > 0 ? Number(Math.min(16, Math.max(0, -Math.log10(error))).toFixed(2)) : 16;
}

function kernel(record: KernelRecord, share: number): FollowedKernel {
  const { name, calls, followed, seconds, choices, nans, infinities, decisions } = record;
  const outputs = record.outputs.map((output) => ({
    name: output.name,
    type: output.type,
    points: output.points.points.map(({ call, own, inherited, total }) => [call, number(own), number(inherited), number(total)] as const),
  }));
  return {
    name, calls, followed, seconds, choices, own: spread(record.own), storage: null, inherited: spread(record.inherited), total: spread(record.total),
    amplification: record.amplification.count === 0 ? null : spread(record.amplification), digits: digits(record.total.largest), share: number(share),
    worst: record.worst === null ? null : element(record.worst), nans, infinities, flushed: 0, decisions, outputs,
  };
}

function stream({ name, type, shape, resyncs, points }: StreamRecord): FollowedStream {
  return { name, type, shape, resyncs, points: points.points.map(({ call, total }) => [call, number(total)] as const) };
}

function result(records: Records, record: ResultRecord): ReportedResult {
  const { name, isValue, reads, elements, largest, last, differs, numbers, notFinite, withoutValue, exception, shares } = record;
  return {
    name, kind: isValue ? 'value' : 'read', reads, elements, error: { largest: number(largest), last: number(last) }, digits: digits(largest), differs,
    numbers, notFinite, withoutValue, exception: exception < 0 ? null : exception,
    shares: shares.entries().map(([kernel, share]) => ({ kernel: records.nameOf(kernel), share: number(share) })),
  };
}

function exception(records: Records, { kind, kernel, elements, isInReference, first, path }: ExceptionRecord): ShadowReport['exceptions'][number] {
  return { kind, kernel: records.nameOf(kernel), elements, isInReference, ...element(first), path: path.map((step) => ({ ...step, kernel: records.nameOf(step.kernel) })) };
}

function decision(records: Records, { kernel, elements, isInherited, first }: DecisionRecord): ShadowReport['decisions'][number] {
  return { kernel: records.nameOf(kernel), elements, isInherited, ...element(first) };
}

export function reportOf(records: Records, run: Run): ShadowReport {
  const shares = sharesOf(records);
  const { calls, followed, deviceSeconds: device, referenceSeconds: reference, comparisonSeconds: comparison } = records;
  return {
    format: 'streamkernel-shadow',
    version: 1,
    program: run.program,
    device: run.device,
    reference: 'pairs of floats',
    ended: run.hasEnded ? 'normally' : `early: the page had not ended after ${calls} calls`,
    options: { every: run.every, kernels: run.kernels, decisions: 'own', quad: [] },
    seconds: { program: run.seconds, device, reference, comparison },
    calls,
    followed,
    ranks: 1,
    verdicts: verdictsOf(records),
    kernels: records.kernels.map((record, i) => kernel(record, shares[i]!)),
    streams: records.streams.map(stream),
    results: records.results.map((record) => result(records, record)),
    exceptions: records.exceptions.map((record) => exception(records, record)),
    decisions: records.decisions.map((record) => decision(records, record)),
    account: { unread: [], partly: [], precision: [] },
    notes: [...records.notes],
  };
}
