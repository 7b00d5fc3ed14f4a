// SPDX-License-Identifier: MIT
//
// Concludes from the records of a page which kernel is to blame for what: runtime/src/shadow/report.cpp. No GL: Node tests it.
import type { DecisionRecord, ExceptionRecord, Records, ResultRecord } from './records.js';
import type { Series } from './series.js';

export interface Verdict {
  readonly kind: 'nan' | 'infinity' | 'decision' | 'unstable' | 'error' | 'fine' | 'nothing';
  readonly kernel: string;
  readonly call: number;
  readonly text: string;
}

function digitsOf(error: number): string {
  return error > 0 ? `${Math.min(16, Math.max(0, -Math.log10(error))).toFixed(1)} digits` : 'all digits';
}

/** A number in few digits. */
function short(value: number, digits: number): string {
  return Number.isFinite(value) ? String(Number(value.toPrecision(digits))) : String(value);
}

const where = (index: readonly number[]) => index.map((i) => `[${i}]`).join('');

/** Each kernel's share of the errors of all results: a result counts as much as its error. */
export function sharesOf(records: Records): number[] {
  const shares = records.kernels.map(() => 0);
  const weightOf = ({ last }: ResultRecord) => Math.min(1, last);
  const all = records.results.reduce((sum, result) => sum + weightOf(result), 0);
  if (!(all > 0)) return shares;
  for (const result of records.results) {
    for (const [kernel, share] of result.shares.entries()) {
      if (kernel >= 0) shares[kernel] += (share * weightOf(result)) / all;
    }
  }
  return shares;
}

function exceptionVerdict(records: Records, { kind, kernel, isInReference, first }: ExceptionRecord): Verdict {
  const name = records.nameOf(kernel);
  const end = isInReference ? 'and does so in pairs of floats as well' : `where pairs of floats give ${short(first.reference.value, 6)}`;
  const what = kind === 'nan' ? 'NaN' : 'infinity';
  return { kind, kernel: name, call: first.call, text: `${name} computes the first ${what} in call ${first.call}, at ${first.output}${where(first.index)}, ${end}` };
}

/** An infinity that the reference has, too, is one that the program means, or that is beyond pairs of floats as well. */
function exceptionVerdicts(records: Records, areInReference: boolean): Verdict[] {
  return records.exceptions
    .filter(({ isInReference, kind }) => isInReference === areInReference && !(areInReference && kind === 'infinity'))
    .map((exception) => exceptionVerdict(records, exception));
}

function decisionVerdict(records: Records, { kernel, elements, first }: DecisionRecord): Verdict {
  const name = records.nameOf(kernel);
  const count = elements === 1 ? 'one element' : `${elements} elements`;
  const values = `${first.output}${where(first.index)} is ${short(first.device.value, 9)}, not ${short(first.reference.value, 9)}`;
  return { kind: 'decision', kernel: name, call: first.call, text: `${name} decides differently than in pairs of floats for ${count} in call ${first.call}: ${values}` };
}

/** Whether the results are worse than rounding explains. */
function isGrave(result: ResultRecord | undefined, limit: number): boolean {
  return result !== undefined && (result.largest > limit || result.differs > 0);
}

/**
 * The factor by which an error grows with each call if it grows exponentially, not as rounding errors add up; else 1. It is the absolute
 * error: where a step is unstable, the exact values grow, too. A growth that has ended because nothing is right any more counts up to
 * there.
 */
export function growthOf(series: Series): number {
  const [lost, much, steady, least, quarters] = [0.05, 100, 0.75, 24, 4];
  const end = series.points.findIndex(({ total, absolute }) => total > lost || !Number.isFinite(absolute));
  const points = series.points.slice(0, end < 0 ? undefined : end).filter(({ absolute }) => absolute > 0);
  if (points.length < least) return 1;
  const at = (q: number) => Math.floor(((points.length - 1) * q) / quarters);
  const steps = [1, 2, 3, 4].map((q) => Math.log(points[at(q)]!.absolute) - Math.log(points[at(q - 1)]!.absolute)) as [number, number, number, number];
  // Sums of rounding errors grow by a factor of 2 or less from the second quarter to the fourth.
  const grown = steps[1] + steps[2] + steps[3];
  if (grown < Math.log(much) || steps[2] < steady * steps[1] || steps[3] < steady * steps[2]) return 1;
  return Math.exp(grown / (points[points.length - 1]!.call - points[at(1)]!.call));
}

/** An instability shows in most of what the page computes over and over again. */
function unstableVerdicts(records: Records): Verdict[] {
  const often = 24;
  let [fastest, growing, steady] = [1, 0, 0];
  let worst = null;
  for (const kernel of records.kernels) {
    if (kernel.amplification.count < often) continue;
    for (const { points } of kernel.outputs) {
      if (points.points.length === 0) continue;
      const growth = growthOf(points);
      if (growth > 1) ++growing;
      else ++steady;
      if (growth <= fastest) continue;
      fastest = growth;
      worst = kernel;
    }
  }
  if (worst === null || growing < steady) return [];
  const perCall = short(fastest ** (records.calls / worst.calls), 4);
  const text = `unstable time step: the error grows by a factor of ${perCall} with each call of ${worst.name}, for ${worst.calls} calls; or the model is chaotic`;
  return [{ kind: 'unstable', kernel: worst.name, call: 0, text }];
}

function shareVerdicts(records: Records, result: ResultRecord): Verdict[] {
  const shares = sharesOf(records);
  const most = shares.reduce((best, share, i) => (share > (shares[best] ?? 0) ? i : best), -1);
  const worst = records.kernels[most];
  if (worst === undefined || !(result.largest > 0)) return [];
  const choices = worst.choices === '' ? '' : ` (${worst.choices})`;
  const text = `${worst.name}${choices} adds ${(100 * shares[most]!).toFixed(0)} % of the error of what the page reads: ${digitsOf(result.largest)} of '${result.name}' survive`;
  return [{ kind: 'error', kernel: worst.name, call: worst.worst?.call ?? 0, text }];
}

function restOf(records: Records, result: ResultRecord | undefined, others: number): Verdict[] {
  const rest = (kind: 'fine' | 'nothing', text: string): Verdict[] => [{ kind, kernel: '', call: 0, text }];
  if (records.calls === 0) return rest('nothing', 'the page has called no kernel');
  if (records.followed === 0) return rest('nothing', 'no call was compared; the notes say why');
  if (result === undefined) return rest('nothing', 'the page has read no result');
  if (isGrave(result, 1e-5) || others > 0) return [];
  return rest('fine', `every result is right: at least ${digitsOf(result.largest)} survive`);
}

/** The gravest first. */
export function verdictsOf(records: Records): Verdict[] {
  const result = records.results.reduce<ResultRecord | undefined>((worst, each) => (worst === undefined || each.largest > worst.largest ? each : worst), undefined);
  const decisions = records.decisions.filter(({ isInherited }) => !isInherited).map((decision) => decisionVerdict(records, decision));
  const hasDecided = isGrave(result, 1e-4);
  const verdicts = [
    ...exceptionVerdicts(records, false),
    ...(hasDecided ? decisions : []),
    ...unstableVerdicts(records),
    ...exceptionVerdicts(records, true),
    ...(result !== undefined && isGrave(result, 2e-7) ? shareVerdicts(records, result) : []),
    ...(hasDecided ? [] : decisions),
  ];
  return [...verdicts, ...restOf(records, result, verdicts.length)];
}
