// SPDX-License-Identifier: MIT
//
// What only some kernels need. FILE.sk.js imports what its kernels need, and hands it over (fileOf in index.ts), so that
// bundlers leave out the rest: nothing else of this package may import these modules.
import type { Checked } from './arguments.js';
import type { Device } from './device.js';
import type { CallableKernel, CallableReduction, GeneratedFile, KernelData, Plan } from './generated.js';
import type { Layout } from './layout.js';
import type { Plane } from './memory.js';
import type { GivenDomain } from './over.js';
import type { Program } from './program.js';
import type { planScan } from './scan_plan.js';
import type { ScanOptions } from './types.js';
import type { Lie } from './variant.js';

export interface Features {
  /** Kernels with variable and scatter outputs (append.ts). */
  readonly lists?: (kernel: CallableKernel, file: LoadedFile) => ListCaller;
  /** Kernels of several passes (plan.ts). */
  readonly plans?: (kernel: KernelData, plan: Plan, file: LoadedFile) => PassRunner;
  /** Reduces, scans and folded outputs (reduction.ts). */
  readonly folds?: (reduction: CallableReduction, file: LoadedFile) => FoldCaller;
  /** Scans, beside folds (scan_plan.ts). */
  readonly scans?: typeof planScan;
  /** Programs for views (placed.ts). */
  readonly views?: typeof import('./placed.js').placed;
}

/** What FILE.sk.js hands over. */
export interface LoadedFile extends GeneratedFile {
  /** The programs. */
  readonly texts: readonly string[];
  readonly features: Features;
}

/** What knows its programs. */
export interface Starter {
  startPrograms(device: Device): Program[];
}

export interface ListCaller extends Starter {
  call(given: Checked, over: GivenDomain | null): void | Promise<void>;
}

export interface PassRunner extends Starter {
  /** `reason`: why the call needs the programs for views, if it does. */
  run(device: Device, call: Checked, outputs: readonly number[], shape: readonly number[], reason: string | null): void;
}

export interface FoldCaller {
  check(given: readonly unknown[]): void;
  call(given: readonly unknown[], options: ScanOptions, over: GivenDomain | null): Promise<unknown> | void;
  startPrograms(device: Device, options: ScanOptions): Program[];
}

/** The streams of a call with views. */
export interface Placed {
  readonly domain: Layout;
  readonly lies: readonly Lie[];
  /** For each output, the planes to draw to. */
  begin(): readonly Plane[][];
  /** Puts what was drawn to them where the outputs are. */
  finish(drawn: readonly Plane[][]): void;
}
