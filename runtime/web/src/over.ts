// SPDX-License-Identifier: MIT
//
// The domain that a call is given because it follows from no stream: kernel.over([n, m])(...).
import { fail, isSameShape } from './arguments.js';
import { Device } from './device.js';
import type { KernelData } from './generated.js';
import { checkShape, shapeText } from './layout.js';

export interface GivenDomain {
  readonly shape: readonly number[];
  /** The device of a call without streams; null: that of the streams. */
  readonly device: Device | null;
}

/** What over(shape) or over(device, shape) gives. Throws SkError for other arguments. */
export function givenDomain(kernel: string, given: readonly unknown[]): GivenDomain {
  const device = given[0] instanceof Device ? given[0] : null;
  const rest = device === null ? given : given.slice(1);
  if (rest.length !== 1 || !Array.isArray(rest[0])) fail(kernel, 'over() takes a shape, an array of 1 to 4 extents, rows first, and may take a device before it', 'type');
  const shape: readonly number[] = [...rest[0]];
  checkShape(shape);
  return { shape, device };
}

/** Throws SkError if a call is given another domain than that of the parameter `first`. */
export function checkOver({ name, parameters }: KernelData, over: GivenDomain | null, first: number, shape: readonly number[]): void {
  if (over === null || isSameShape(over.shape, shape)) return;
  fail(name, `over() gives the domain the shape ${shapeText(over.shape)}, but '${parameters[first]!.name}' has ${shapeText(shape)}; give both the same, or call it without over()`, 'shape');
}

/** Throws SkError: nothing says what the domain of a call is. */
export function failWithoutDomain(kernel: string): never {
  fail(kernel, `no input and no output says how many elements there are; give one, or call it over a shape, ${kernel}.over([...])(...)`, 'shape');
}
