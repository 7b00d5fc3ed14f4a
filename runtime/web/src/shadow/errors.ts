// SPDX-License-Identifier: MIT
//
// How far an output of a call is from the reference: runtime/src/shadow/errors.cpp. Three arrays of each component are compared: what
// the device computed (d), what the reference computes with the device's inputs (o), and what it computes with its own (r). Then
// d - o is the own error of the call, o - r the inherited one, and d - r the total. No GL: Node tests it.

/** Elements with a property, and the first one. */
export interface Found {
  count: number;
  first: number;
  component: number;
}

/** The largest difference, and its element; -1 if there is none. */
export interface Worst {
  error: number;
  element: number;
  component: number;
}

/** The smallest normal float: below it, floats have fewer digits. */
const leastNormal = 2 ** -126;

const nothing = (): Found => ({ count: 0, first: -1, component: 0 });
const noWorst = (): Worst => ({ error: 0, element: -1, component: 0 });

function note(found: Found, element: number, component: number): void {
  if (found.count++ > 0 && element >= found.first) return;
  found.first = element;
  found.component = component;
}

function raise(worst: Worst, error: number, element: number, component: number): void {
  if (error > worst.error) Object.assign(worst, { error, element, component });
}

/** Sums over the components of real numbers that are finite in all three arrays, and counts of others. */
export class OutputErrors {
  reals = 0;
  reference2 = 0;
  own2 = 0;
  inherited2 = 0;
  total2 = 0;
  /** The sum of (d - o)(d - r): what the own error contributes to the total. */
  ownInTotal = 0;
  readonly own = noWorst();
  readonly total = noWorst();
  /** Of the device. */
  readonly nans = nothing();
  readonly infinities = nothing();
  /** Of the device, where the reference is finite with the device's inputs. */
  readonly newNans = nothing();
  readonly newInfinities = nothing();
  /** Components that are not finite on the device where the reference's are. */
  lost = 0;
  integers = 0;
  /** Integers that differ from o, and from r. */
  readonly ownDecisions = nothing();
  readonly decisions = nothing();
  integerReference2 = 0;
  integerTotal2 = 0;

  /** Errors relative to the root mean square of the reference's components; 0 if there is no error. */
  relativeOwn(): number {
    return this.relative(this.own2);
  }
  relativeInherited(): number {
    return this.relative(this.inherited2);
  }
  relativeTotal(): number {
    return this.relative(this.total2);
  }

  /** Likewise, but infinite if components are not finite where the reference's are: no digit of them is right. */
  reportedOwn(): number {
    return this.hasNewExceptions() ? Infinity : this.relativeOwn();
  }
  reportedTotal(): number {
    return this.lost > 0 ? Infinity : this.relativeTotal();
  }

  /** The relative error of integers, but at most the share that differs: an integer may be a number or a name. */
  relativeIntegers(): number {
    if (this.decisions.count === 0) return 0;
    const asNumbers = this.integerReference2 > 0 ? this.integerTotal2 / this.integerReference2 : 1;
    return Math.sqrt(Math.min(this.decisions.count / this.integers, asNumbers));
  }

  /** The share of the total error that the call added itself, by projection on the total: 0 to 1. */
  ownShare(): number {
    if (this.hasNewExceptions()) return 1;
    return this.total2 > 0 ? Math.min(1, Math.max(0, this.ownInTotal / this.total2)) : 0;
  }

  /** The root mean square of the reference's components. */
  scale(): number {
    return this.reals > 0 ? Math.sqrt(this.reference2 / this.reals) : 0;
  }

  /** The root mean square of the total error; 0 if no components are finite. */
  absoluteTotal(): number {
    return this.reals > 0 ? Math.sqrt(this.total2 / this.reals) : 0;
  }

  private hasNewExceptions(): boolean {
    return this.newNans.count > 0 || this.newInfinities.count > 0;
  }

  /** Of real numbers and of integers. */
  relativeAll(): number {
    return Math.max(this.relativeTotal(), this.relativeIntegers());
  }

  private relative(squares: number): number {
    if (squares === 0) return 0;
    if (!(this.reference2 > 0)) return 1; // nothing of the result is right
    return Math.sqrt(squares / Math.max(this.reference2, this.reals * leastNormal ** 2));
  }
}

export type Columns = readonly Float64Array[];

/**
 * Compares components, one array each, of which `areReal` says whether they are real numbers or integers. Without `own`, the own error
 * counts as the total one.
 */
export function compare(areReal: readonly boolean[], device: Columns, own: Columns | null, reference: Columns): OutputErrors {
  const errors = new OutputErrors();
  areReal.forEach((isReal, component) => {
    const [d, r] = [device[component]!, reference[component]!];
    const o = own?.[component] ?? r;
    if (isReal) addReals(errors, component, d, o, r);
    else addIntegers(errors, component, d, o, r);
  });
  return errors;
}

/** One element, whose error is not finite. */
function addExceptional(errors: OutputErrors, component: number, i: number, d: number, o: number, r: number): void {
  if (Number.isFinite(d)) return;
  if (Number.isFinite(r)) ++errors.lost;
  const isNan = Number.isNaN(d);
  note(isNan ? errors.nans : errors.infinities, i, component);
  if (Number.isFinite(o)) note(isNan ? errors.newNans : errors.newInfinities, i, component);
}

/** The sums are variables of the loop, which must not allocate: it runs over all elements that a page computes. */
function addReals(errors: OutputErrors, component: number, ds: Float64Array, os: Float64Array, rs: Float64Array): void {
  let [reals, reference2, own2, inherited2, total2, ownInTotal] = [0, 0, 0, 0, 0, 0];
  let [largestOwn, largestTotal] = [errors.own.error, errors.total.error];
  for (let i = 0; i < ds.length; ++i) {
    const d = ds[i]!;
    const o = os[i]!;
    const r = rs[i]!;
    const own = d - o;
    const total = d - r;
    if (!(Math.abs(own) < Infinity && Math.abs(total) < Infinity)) {
      addExceptional(errors, component, i, d, o, r);
      continue;
    }
    const inherited = o - r;
    ++reals;
    reference2 += r * r;
    own2 += own * own;
    inherited2 += inherited * inherited;
    total2 += total * total;
    ownInTotal += own * total;
    if (own > largestOwn || -own > largestOwn) raise(errors.own, (largestOwn = Math.abs(own)), i, component);
    if (total > largestTotal || -total > largestTotal) raise(errors.total, (largestTotal = Math.abs(total)), i, component);
  }
  errors.reals += reals;
  errors.reference2 += reference2;
  errors.own2 += own2;
  errors.inherited2 += inherited2;
  errors.total2 += total2;
  errors.ownInTotal += ownInTotal;
}

/** Whether integers differ by more than the rounding of a number that is packed in their upper bits. */
function differ(a: number, b: number): boolean {
  return Math.abs(a - b) > 2 ** -20 * Math.max(Math.abs(a), Math.abs(b));
}

function addIntegers(errors: OutputErrors, component: number, ds: Float64Array, os: Float64Array, rs: Float64Array): void {
  errors.integers += ds.length;
  for (let i = 0; i < ds.length; ++i) {
    const d = ds[i]!;
    const o = os[i]!;
    const r = rs[i]!;
    if (differ(d, o)) note(errors.ownDecisions, i, component);
    if (differ(d, r)) note(errors.decisions, i, component);
    errors.integerReference2 += r * r;
    errors.integerTotal2 += (d - r) * (d - r);
  }
}

/** An element that is far off, in an output that is right elsewhere: another branch was taken there. `value` is the reference's. */
export function isJump(errors: OutputErrors, value: number): boolean {
  const [far, share, many] = [1e-3, 0.5, 64];
  return errors.reals >= many && errors.own.error > far * Math.max(errors.scale(), Math.abs(value)) && errors.own.error ** 2 > share * errors.own2;
}
