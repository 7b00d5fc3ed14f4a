// SPDX-License-Identifier: MIT
//
// Concludes from the records of a page which kernel is to blame for what: runtime/src/shadow/report.cpp. No GL: Node tests it.
import type { DecisionRecord, ExceptionRecord, KernelRecord, Records, ResultRecord } from './records.js';
import type { Point, Series } from './series.js';
import { notCompared } from './shares.js';

export interface Verdict {
  readonly kind: 'nan' | 'infinity' | 'decision' | 'unstable' | 'growth' | 'error' | 'fine' | 'nothing';
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
  const weightOf = ({ largest }: ResultRecord) => Math.min(1, largest);
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

/**
 * Whether errors of results may follow from a decision: its kernel has some share in them. A pixel of a picture that nothing reads has
 * none.
 */
function mayCauseErrors(shares: readonly number[], { kernel }: DecisionRecord): boolean {
  const some = 0.1;
  return !shares.some((share) => share > 0) || shares[kernel]! >= some;
}

/** Whether the results are worse than rounding explains. */
function isGrave(result: ResultRecord | undefined, limit: number): boolean {
  return result !== undefined && (result.largest > limit || result.differs > 0);
}

/** How the error of an output grows from call to call, if it does so exponentially and not as rounding errors add up. */
export interface Growth {
  /** With each call of the page; 1 if it does not. */
  readonly factor: number;
  /** Of the page, over which it grew so. */
  readonly calls: number;
  /** What is computed grows as fast, and keeps its sign. */
  readonly isOfSolution: boolean;
}

const noGrowth: Growth = { factor: 1, calls: 0, isOfSolution: false };

/**
 * The points of a series until nothing is right any more. Absolute errors say how errors grow: where a step is unstable, the exact values
 * may grow, too.
 */
function beforeLoss({ points }: Series): Point[] {
  const lost = 0.05;
  const end = points.findIndex(({ total, absolute }) => total > lost || !Number.isFinite(absolute));
  return points.slice(0, end < 0 ? undefined : end).filter(({ absolute }) => absolute > 0);
}

/** A step that is too long overshoots: the largest waves change their signs with each call. A model that grows so is a rarity. */
function overshoots(points: readonly Point[]): boolean {
  return 2 * points.filter(({ isTurned }) => isTurned).length > points.length;
}

function growthOver(points: readonly Point[]): Growth {
  const [from, to] = [points[0]!, points[points.length - 1]!];
  const error = Math.log(to.absolute / from.absolute);
  const relative = from.total > 0 && to.total > 0 ? Math.log(to.total / from.total) : error;
  const calls = to.call - from.call;
  const most = 0.7;
  return { factor: Math.exp(error / calls), calls, isOfSolution: error - relative > most * error && !overshoots(points) };
}

/** Many points: each quarter of them adds as many digits to the error as the one before. */
function longGrowth(points: readonly Point[]): Growth {
  const [much, steady, quarters] = [100, 0.75, 4];
  const at = (q: number) => Math.floor(((points.length - 1) * q) / quarters);
  const [, second, third, fourth] = [1, 2, 3, 4].map((q) => Math.log(points[at(q)]!.absolute) - Math.log(points[at(q - 1)]!.absolute)) as [number, number, number, number];
  // Sums of rounding errors grow by a factor of 2 or less from the second quarter to the fourth.
  if (second + third + fourth < Math.log(much) || third < steady * second || fourth < steady * third) return noGrowth;
  return growthOver(points.slice(at(1)));
}

/** Few points, since nothing is right after them: each has a larger error than the one before, by far, and other signs. */
function shortGrowth(points: readonly Point[]): Growth {
  const [much, far] = [100, 1.4];
  const last = points.slice(Math.floor(points.length / 4));
  if (last.some(({ absolute }, i) => i > 0 && absolute < far * last[i - 1]!.absolute)) return noGrowth;
  if (last[last.length - 1]!.absolute < much * last[0]!.absolute) return noGrowth;
  return overshoots(last) ? growthOver(last) : noGrowth;
}

export function growthOf(series: Series): Growth {
  const [many, few] = [24, 4];
  const points = beforeLoss(series);
  if (points.length >= many) return longGrowth(points);
  return points.length >= few ? shortGrowth(points) : noGrowth;
}

/**
 * Whether a kernel's outputs reach its own inputs, directly or through other kernels: errors grow in such a cycle, and what only looks at
 * them, as a total does, shows it.
 */
function readsItself(records: Records, kernel: number): boolean {
  const reached = new Set<number>();
  const open = [kernel];
  for (let from = open.pop(); from !== undefined; from = open.pop()) {
    for (const source of records.kernels[from]?.readFrom ?? []) {
      if (source === kernel) return true;
      if (reached.has(source)) continue;
      reached.add(source);
      open.push(source);
    }
  }
  return false;
}

/**
 * The kernel with the fastest growth among kernels, if errors grow in most of what these compute over and over again: an instability shows
 * in most of it.
 */
function fastestAmong(records: Records, counts: (kernel: number) => boolean): { kernel: KernelRecord | null; growth: Growth } {
  const often = 4;
  let [growing, steady] = [0, 0];
  let fastest: { kernel: KernelRecord | null; growth: Growth } = { kernel: null, growth: noGrowth };
  for (const [i, kernel] of records.kernels.entries()) {
    if (kernel.amplification.count < often || !counts(i)) continue;
    for (const { points } of kernel.outputs) {
      if (points.points.length === 0) continue;
      const growth = growthOf(points);
      if (growth.factor > 1) ++growing;
      else ++steady;
      if (growth.factor > fastest.growth.factor) fastest = { kernel, growth };
    }
  }
  return growing < steady ? { kernel: null, growth: noGrowth } : fastest;
}

/** Feedback may pass through the page, which nobody sees: then all kernels count. */
function unstableVerdict(records: Records): Verdict | null {
  let found = fastestAmong(records, (kernel) => readsItself(records, kernel));
  if (found.kernel === null) found = fastestAmong(records, () => true);
  const { kernel: worst, growth: fastest } = found;
  if (worst === null) return null;
  const others = records.calls / worst.calls;
  const text = `the error grows by a factor of ${short(fastest.factor ** others, 4)} with each call of ${worst.name}, for ${(fastest.calls / others).toFixed(0)} calls`;
  const verdict = { kernel: worst.name, call: 0 };
  if (!fastest.isOfSolution) return { kind: 'unstable', ...verdict, text: `unstable time step: ${text}; or the model is chaotic` };
  return { kind: 'growth', ...verdict, text: `${text}, and so does what it computes: an unstable time step, or a model that grows` };
}

/** Whether the first value that is not finite is an infinity, which growth may have led to. */
function overflowsFirst({ exceptions }: Records): boolean {
  const first = exceptions.reduce<ExceptionRecord | undefined>((earliest, each) => (earliest === undefined || each.first.call < earliest.first.call ? each : earliest), undefined);
  return first?.kind === 'infinity';
}

/** Whose errors nobody knows: those of kernels of which no call was compared, and what has passed through them. */
function unknownText(records: Records, result: ResultRecord, unknown: number): string {
  const [some, most] = [0.1, 4];
  const names = result.shares.path().filter(([, part]) => part >= some).slice(0, most).map(([kernel]) => records.nameOf(kernel));
  const [percent, survivors] = [(100 * unknown).toFixed(0), `${digitsOf(result.largest)} of '${result.name}' survive`];
  if (names.length === 0) return `calls that were not compared (every, kernels) add ${percent} % of the error of what the page reads: ${survivors}`;
  const [are, them] = names.length === 1 ? ['is', 'it'] : ['are', 'them'];
  return `${percent} % of the error of what the page reads arises in, or is magnified by, ${names.join(' or ')}, which ${are} not compared: ${survivors}; name ${them} in kernels, too`;
}

function shareVerdicts(records: Records, result: ResultRecord): Verdict[] {
  const shares = sharesOf(records);
  const most = shares.reduce((best, share, i) => (share > (shares[best] ?? 0) ? i : best), -1);
  const worst = records.kernels[most];
  if (!(result.largest > 0)) return [];
  const unknown = result.shares.entries().find(([kernel]) => kernel === notCompared)?.[1] ?? 0;
  if (unknown > (shares[most] ?? 0)) {
    return [{ kind: 'error', kernel: '', call: 0, text: unknownText(records, result, unknown) }];
  }
  if (worst === undefined) return [];
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
  const hasDecided = isGrave(result, 1e-4);
  const shares = sharesOf(records);
  const decisionsThat = (comeFirst: boolean) => records.decisions
    .filter((decision) => !decision.isInherited && (hasDecided && mayCauseErrors(shares, decision)) === comeFirst)
    .map((decision) => decisionVerdict(records, decision));
  const growth = unstableVerdict(records);
  const isHarmless = growth?.kind === 'growth' && !isGrave(result, 1e-5);
  const isCause = growth?.kind === 'unstable' && overflowsFirst(records);
  const growths = growth === null ? [] : [growth];
  const verdicts = [
    ...(isCause ? growths : []),
    ...exceptionVerdicts(records, false),
    ...decisionsThat(true),
    ...(isHarmless || isCause ? [] : growths),
    ...exceptionVerdicts(records, true),
    ...(result !== undefined && isGrave(result, 2e-7) ? shareVerdicts(records, result) : []),
    ...decisionsThat(false),
  ];
  return [...verdicts, ...restOf(records, result, verdicts.length), ...(isHarmless ? growths : [])];
}
