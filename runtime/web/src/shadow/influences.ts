// SPDX-License-Identifier: MIT
//
// How much the errors of each input of a kernel count in its outputs: what a call inherits is divided by them
// (runtime/src/shadow/influences.hpp).

export class Influences {
  private readonly asked = new Map<number, number>();
  private readonly factors = new Map<string, number>();

  /** Whether a call of a kernel is to be examined: the first, second, fourth, eighth ... that asks. */
  isDue(kernel: number): boolean {
    const count = (this.asked.get(kernel) ?? 0) + 1;
    this.asked.set(kernel, count);
    return (count & (count - 1)) === 0;
  }

  /** `factor`: from the relative error of an input to that of an output. Both are numbers of parameters. */
  set(kernel: number, output: number, input: number, factor: number): void {
    this.factors.set(`${kernel} ${output} ${input}`, factor);
  }

  /**
   * How much the error of each input counts in an output: by what calls have shown, or else by the inputs' relative errors. Inputs are
   * numbers of parameters with these errors.
   */
  weights(kernel: number, output: number, inputs: readonly (readonly [input: number, error: number])[]): readonly number[] {
    const known = inputs.map(([input, error]) => (error === 0 ? 0 : (this.factors.get(`${kernel} ${output} ${input}`) ?? NaN) * error));
    const areKnown = !known.some(Number.isNaN) && known.some((weight) => weight > 0);
    return areKnown ? known : inputs.map(([, error]) => error);
  }
}
