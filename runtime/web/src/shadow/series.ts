// SPDX-License-Identifier: MIT
//
// Errors over the calls of a page: their extremes, and points for charts (Spread and Series of runtime/src/shadow/report.hpp).

/** The largest of several errors, and the geometric mean of those above 0. */
export class Spread {
  largest = 0;
  count = 0;
  private logarithms = 0;
  private positive = 0;

  add(error: number): void {
    ++this.count;
    if (error > this.largest) this.largest = error;
    if (!(error > 0) || !Number.isFinite(error)) return;
    this.logarithms += Math.log(error);
    ++this.positive;
  }

  get typical(): number {
    return this.positive === 0 ? 0 : Math.exp(this.logarithms / this.positive);
  }
}

export interface Point {
  readonly call: number;
  readonly own: number;
  readonly inherited: number;
  readonly total: number;
  /** The root mean square of the total error. */
  readonly absolute: number;
  /** The call has mostly changed the signs of what it read. */
  readonly isTurned: boolean;
}

/** The larger errors of two calls, of which the second comes later. */
function largest(a: Point, b: Point): Point {
  return {
    call: b.call, own: Math.max(a.own, b.own), inherited: Math.max(a.inherited, b.inherited), total: Math.max(a.total, b.total),
    absolute: Math.max(a.absolute, b.absolute), isTurned: a.isTurned || b.isTurned,
  };
}

const mostPoints = 1024;

/** Points are thinned out, so that a page may run for long: each stands for the largest errors of consecutive calls. */
export class Series {
  points: Point[] = [];
  /** Values for each point, and in the last one. */
  private step = 1;
  private inLast = 0;

  add(point: Point): void {
    const last = this.points.length - 1;
    if (this.inLast > 0 && this.inLast < this.step) {
      this.points[last] = largest(this.points[last]!, point);
      ++this.inLast;
      return;
    }
    if (this.points.length === mostPoints) {
      this.points = Array.from({ length: mostPoints / 2 }, (_, i) => largest(this.points[2 * i]!, this.points[2 * i + 1]!));
      this.step *= 2;
    }
    this.points.push(point);
    this.inLast = 1;
  }
}
