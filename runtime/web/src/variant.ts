// SPDX-License-Identifier: MIT
//
// Which program a call needs: the decisions of runtime/src/gl_device/program/variant.cpp for whole streams, as the key that
// skc gives the program (compiler/web/kernel_programs.cpp).
import { isNeeded, type Element, type Parameter } from './generated.js';
import { decodedRank, type Index4, type Layout } from './layout.js';
import { mayPackElement } from './elements.js';
import { formatOf } from './format.js';

/** How an argument lies: the layout of a stream, or how an iterator is addressed; null for values and outputs. */
export type Lie = Layout | 'linear' | 'aligned' | null;

/** Whether no index of a neighbour is out of bounds by more than the extent. */
function isNearby(gather: Parameter, extent: Index4, domain: Index4): boolean {
  if (gather.reach === undefined) return false;
  for (let d = 0; d < gather.rank!; ++d) {
    if (gather.reach >= extent[d]! || domain[d]! > extent[d]!) return false;
  }
  return true;
}

/** Whether the device's filter interpolates a gather. */
export function isFiltered(parameter: Parameter, layout: Layout, elements: readonly Element[], filtersFloats: boolean): boolean {
  if (!parameter.filter || layout.linear || layout.packed || layout.origin !== undefined) return false;
  const { scalar, width } = elements[parameter.element]!.fields[0]!;
  return filtersFloats || formatOf(scalar, width).internal !== formatOf('float', width).internal;
}

/**
 * "; u:plane packed nearby" for each stream and iterator, "; no u" for a stream that is not needed. `isByIndex`: inputs are not
 * aligned, even if they lie as the domain does.
 */
export function accessKey(
  parameters: readonly Parameter[], elements: readonly Element[], lies: readonly Lie[], domain: Layout, specs: readonly number[],
  filtersFloats: boolean, isByIndex = false,
): string {
  let key = '';
  for (let i = 0; i < parameters.length; ++i) {
    const parameter = parameters[i]!;
    if (parameter.neededIf !== undefined && !isNeeded(parameter, specs)) {
      key += `; no ${parameter.name}`;
      continue;
    }
    const lie = lies[i]!;
    if (lie === null || parameter.role === 'uniform') continue;
    if (typeof lie === 'string') {
      key += `; ${parameter.name}:${lie}`;
    } else if (parameter.role === 'input' && lie === domain && !isByIndex) {
      key += `; ${parameter.name}:aligned`;
    } else {
      const packed = lie.packed ? ' packed' : '';
      const isGather = parameter.role === 'gather';
      const nearby = isGather && isNearby(parameter, lie.extent, domain.extent) ? ' nearby' : '';
      const filtered = isGather && isFiltered(parameter, lie, elements, filtersFloats) ? ' filtered' : '';
      key += `; ${parameter.name}:${lie.linear ? 'linear' : 'plane'}${packed}${nearby}${filtered}`;
    }
  }
  return key;
}

/**
 * The key of a kernel's program. Programs for linearised domains decode one dimension or all four, which gives the same
 * indices as the rank of the domain.
 */
export function kernelKey(
  parameters: readonly Parameter[], elements: readonly Element[], lies: readonly Lie[], domain: Layout, specs: readonly number[],
  filtersFloats: boolean,
): string {
  const kind = !domain.linear ? 'plane' : decodedRank(domain.extent) === 1 ? 'linear1' : 'linear4';
  return kind + (domain.packed ? ' packed' : '') + accessKey(parameters, elements, lies, domain, specs, filtersFloats);
}

/** The key of the program of a list, whose entries find their elements by number (compiler/web/kernel_programs.cpp). */
export function listKey(
  parameters: readonly Parameter[], elements: readonly Element[], lies: readonly Lie[], domain: Layout, specs: readonly number[],
  filtersFloats: boolean,
): string {
  const kind = domain.linear && decodedRank(domain.extent) === 1 ? 'entry1' : 'entry4';
  return kind + accessKey(parameters, elements, lies, domain, specs, filtersFloats, true);
}

/**
 * The key of the program that [[variants(views)]] adds: it takes all streams as views. Scalar iterators always count the
 * elements.
 */
export function viewsKey(parameters: readonly Parameter[], elements: readonly Element[], lies: readonly Lie[], domain: Layout, specs: readonly number[]): string {
  let key = domain.linear ? 'views box' : 'views plane';
  parameters.forEach((parameter, i) => {
    if (!isNeeded(parameter, specs)) key += `; no ${parameter.name}`;
    else if (parameter.role === 'iterator') key += `; ${parameter.name}:${elements[parameter.element]!.fields[0]!.width === 1 ? 'linear' : lies[i]}`;
  });
  return key;
}

/** Whether a kernel with these outputs writes packed texels. */
export function packsOutputs(outputs: readonly Element[]): boolean {
  return outputs.every(mayPackElement);
}
