// SPDX-License-Identifier: MIT
//
// Arguments that are bundles: objects whose members are arguments for parameters of a kernel.
import { fail } from './arguments.js';
import type { BundleArgument } from './generated.js';

/** The arguments for the parameters of a kernel: the members of each bundle in its place. Throws SkError for what is no such bundle. */
export function flattened(kernel: string, bundles: readonly BundleArgument[], results: number, parameters: number, given: readonly unknown[]): readonly unknown[] {
  const declared = parameters - bundles.reduce((count, { reads }) => count + reads.length - 1, 0);
  const isToValues = results > 0 && given.length === declared - results;
  if (!isToValues && given.length !== declared) fail(kernel, `${given.length} arguments are given, but ${declared} are declared`);
  const flat: unknown[] = [];
  let next = 0;
  for (const bundle of bundles) {
    const at = bundle.at - (isToValues ? bundle.results : 0);
    flat.push(...given.slice(next, at));
    const value = given[at];
    checkMembers(kernel, bundle.name, [...bundle.reads, ...bundle.others], value);
    flat.push(...bundle.reads.map((path) => memberAt(value, path)));
    next = at + 1;
  }
  flat.push(...given.slice(next));
  return flat;
}

/** A member of a bundle or of one within it; null if it is not given. */
function memberAt(value: unknown, path: string): unknown {
  let member = value as Record<string, unknown> | null | undefined;
  for (const name of path.split('.')) member = member?.[name] as typeof member;
  return member ?? null;
}

function checkMembers(kernel: string, name: string, paths: readonly string[], value: unknown): void {
  if (typeof value !== 'object' || value === null) fail(kernel, `'${name}' is a bundle, but ${String(value)} is given; give an object with its members`, 'type');
  const known = new Set(paths.map((path) => path.split('.')[0]!));
  for (const key of Object.keys(value!)) {
    if (!known.has(key)) fail(kernel, `the bundle '${name}' has no member '${key}'; it has ${[...known].join(', ')}`);
    const inner = paths.filter((path) => path.startsWith(`${key}.`)).map((path) => path.slice(key.length + 1));
    const member = (value as Record<string, unknown>)[key];
    if (inner.length > 0 && member !== undefined && member !== null) checkMembers(kernel, `${name}.${key}`, inner, member);
  }
}
