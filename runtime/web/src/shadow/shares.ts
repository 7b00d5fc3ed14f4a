// SPDX-License-Identifier: MIT
//
// Whose errors the error of a stream consists of: a share for each kernel (runtime/src/shadow/shares.hpp). A call passes on the
// shares of what it inherited, and adds its own.

/** The number of what the page wrote, among those of kernels in the report. */
export const writtenByHost = -1;
/** The number of what calls added that were not compared. */
export const notCompared = -2;

export class Shares {
  private readonly all = new Map<number, number>();

  add(kernel: number, share: number): void {
    if (share > 0) this.all.set(kernel, (this.all.get(kernel) ?? 0) + share);
  }

  addAll(others: Shares, factor: number): void {
    for (const [kernel, share] of others.all) this.add(kernel, share * factor);
  }

  sum(): number {
    let sum = 0;
    for (const share of this.all.values()) sum += share;
    return sum;
  }

  /** Makes them add up to 1, without those that are next to nothing. */
  normalize(): void {
    const whole = this.sum();
    for (const [kernel, share] of [...this.all]) {
      if (whole > 0 && share / whole >= 1e-9) this.all.set(kernel, share / whole);
      else this.all.delete(kernel);
    }
  }

  entries(): readonly (readonly [kernel: number, share: number])[] {
    return [...this.all];
  }

  copied(): Shares {
    const copy = new Shares();
    copy.addAll(this, 1);
    return copy;
  }
}
