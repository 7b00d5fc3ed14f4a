// SPDX-License-Identifier: MIT
//
// Compiles programs ahead of the calls that need them, while the page goes on.
import type { Context } from './context.js';
import { SkError } from './error.js';
import type { Program } from './program.js';

/** What knows all its programs: kernels and reduces of FILE.sk.js. */
export interface Compilable {
  /** @internal */
  startPrograms(device: Context): Program[];
}

export async function compileAll(device: Context, callables: readonly Compilable[], progress?: (done: number) => void): Promise<void> {
  if (!callables.every((callable) => typeof callable?.startPrograms === 'function')) {
    throw new SkError('only kernels and reduces of .sk.js files are compiled', 'type');
  }
  const programs = [...new Set(callables.flatMap((callable) => callable.startPrograms(device)))];
  const isLinked = (program: Program) => program.isLinked(device.parallel);
  for (;;) {
    const done = programs.filter(isLinked).length;
    progress?.(programs.length === 0 ? 1 : done / programs.length);
    if (done === programs.length) break;
    await new Promise((resolve) => setTimeout(resolve, 4));
    device.check();
  }
  for (const program of programs) device.useProgram(program);
}
