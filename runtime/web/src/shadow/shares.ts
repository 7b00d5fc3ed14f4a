// SPDX-License-Identifier: MIT
//
// Whose errors the error of a stream consists of: a share for each kernel (runtime/src/shadow/shares.hpp). A call passes on the
// shares of what it inherited, and adds its own.

/** The number of what the page wrote, among those of kernels in the report. */
export const writtenByHost = -1;
/** The number of what calls added that were not compared. */
export const notCompared = -2;

type List = Map<number, number>;

function addTo(list: List, kernel: number, share: number): void {
  if (share > 0) list.set(kernel, (list.get(kernel) ?? 0) + share);
}

export class Shares {
  private readonly all: List = new Map();
  private readonly through: List = new Map();

  add(kernel: number, share: number): void {
    addTo(this.all, kernel, share);
  }

  addAll(others: Shares, factor: number): void {
    for (const [kernel, share] of others.all) this.add(kernel, share * factor);
    this.addPath(others, factor);
  }

  /** Nobody knows whose errors a share is: they arose in a kernel of which no call was compared, or that kernel has magnified them. */
  addThrough(kernel: number, share: number): void {
    this.add(notCompared, share);
    addTo(this.through, kernel, share);
  }

  /** The errors have passed through the same kernels as those of `others`, of which no call was compared. */
  addPath(others: Shares, factor: number): void {
    for (const [kernel, share] of others.through) addTo(this.through, kernel, share * factor);
  }

  sum(): number {
    let sum = 0;
    for (const share of this.all.values()) sum += share;
    return sum;
  }

  /** Makes them add up to 1, without those that are next to nothing. */
  normalize(): void {
    const whole = this.sum();
    for (const list of [this.all, this.through]) {
      for (const [kernel, share] of [...list]) {
        if (whole > 0 && share / whole >= 1e-9) list.set(kernel, Math.min(1, share / whole));
        else list.delete(kernel);
      }
    }
  }

  entries(): readonly (readonly [kernel: number, share: number])[] {
    return [...this.all];
  }

  /** Kernels of which no call was compared, and which part of the errors has passed through each of them. */
  path(): readonly (readonly [kernel: number, share: number])[] {
    return [...this.through];
  }

  copied(): Shares {
    const copy = new Shares();
    copy.addAll(this, 1);
    return copy;
  }
}
