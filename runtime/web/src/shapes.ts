// SPDX-License-Identifier: MIT
//
// Checks of how the shapes of a call's streams and views fit together.
import { fail, shapeAt, type Checked } from './arguments.js';
import type { KernelData, Parameter } from './generated.js';
import { shapeText } from './layout.js';
import { type Fitted, type View, viewOf } from './stream.js';

/** How an input of this shape is read over a domain, in each dimension (Layout.ratio); 0 where it does not fit. */
export function ratioOf(shape: readonly number[], domain: readonly number[], fit: Fitted<any> | null): number[] {
  return domain.map((extent, d) => {
    const own = shape[d]!;
    if (own === extent) return 1;
    if (fit === null) return own === 1 ? Math.max(extent, 1) : 0;
    if (domain.includes(0)) return 1;
    if (fit.stretches && extent % own === 0) return extent / own;
    return fit.strides && own > 0 && own % extent === 0 ? -own / extent : 0;
  });
}

/** Throws SkError unless an input fits the domain. Returns whether it has the domain's own shape. */
export function checkInput(kernel: KernelData, i: number, call: Checked, domain: readonly number[], output: Parameter): boolean {
  const { name } = kernel.parameters[i]!;
  const shape = shapeAt(call, i);
  const fit = call.fits[i]!;
  const isOfRank = shape.length === domain.length;
  if (isOfRank && shape.every((extent, d) => extent === domain[d])) return true;
  if (isOfRank && !ratioOf(shape, domain, fit).includes(0)) return false;
  const need = `'${name}' has shape ${shapeText(shape)}, and the domain ${shapeText(domain)}; to`;
  if (fit?.stretches && fit.strides) return fail(kernel.name, `${need} stretch and stride it, each of its extents must divide the domain's or be a multiple of it`, 'shape');
  if (fit?.stretches) return fail(kernel.name, `${need} stretch it, each of its extents must divide the domain's`, 'shape');
  if (fit?.strides) return fail(kernel.name, `${need} stride through it, each of its extents must be a multiple of the domain's`, 'shape');
  return fail(
    kernel.name,
    `'${name}' has shape ${shapeText(shape)}, but the output '${output.name}' has ${shapeText(domain)}; give them the same shape, or extent 1 where '${name}' repeats`,
    'shape',
  );
}

type Written = Pick<Checked, 'streams' | 'views'>;

/** Throws SkError if two outputs write one element. */
export function checkDisjoint(kernel: KernelData, call: Written, outputs: readonly number[]): void {
  for (const i of outputs) {
    for (const k of outputs) {
      if (k >= i || call.streams[i] !== call.streams[k] || !overlap(viewAt(call, k), viewAt(call, i))) continue;
      const nameOf = (n: number) => kernel.parameters[n]!.name;
      const wholes = call.views[i] || call.views[k] ? 'overlap: both write elements of one stream; give them different streams, or views that have no element in common' : 'are one stream; give them different streams';
      fail(kernel.name, `the outputs '${nameOf(k)}' and '${nameOf(i)}' ${wholes}`);
    }
  }
}

export function viewAt(call: Written, i: number): View<any, number> {
  return call.views[i] ?? viewOf(call.streams[i]!);
}

/** Whether views of one stream may have an element in common: in each dimension, their indices meet. */
function overlap(a: View<any, number>, b: View<any, number>): boolean {
  return a.size > 0 && b.size > 0 && a.begin.every((first, d) => {
    const [other, m, n] = [b.begin[d]!, a.shape[d]!, b.shape[d]!] as [number, number, number];
    const [s, t] = [a.steps[d]!, b.steps[d]!];
    if (first + (m - 1) * s < other || other + (n - 1) * t < first) return false;
    return s !== t || (first - other) % s === 0;
  });
}
