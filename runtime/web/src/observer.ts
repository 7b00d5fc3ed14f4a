// SPDX-License-Identifier: MIT
//
// What may stand beside a device and see what happens on it: a shadow (shadow/), which nothing else of this package knows.
import type { LoadedFile } from './features.js';
import type { CallableKernel, CallableReduction } from './generated.js';
import type { GivenDomain } from './over.js';
import type { Stream, View } from './stream.js';
import type { KernelOptions, ScanOptions } from './types.js';

type Elements = Stream<any, number> | View<any, number>;

/** What is called: a kernel, reduce or scan of a file. */
export interface Called {
  readonly callable: CallableKernel | CallableReduction;
  readonly file: LoadedFile;
}

/** No method throws an error of its own. */
export interface Observer {
  /** Makes a call by `run`, and returns what that returns, or throws what that throws. */
  call<T>(called: Called, options: ScanOptions & KernelOptions, given: readonly unknown[], over: GivenDomain | null, run: () => T): T;
  /** The page reads these elements, or draws them. */
  read(of: Elements): void;
  /** The page has written or filled these elements. */
  written(of: Elements): void;
  /** The page has copied the elements of `from` to `to`. */
  copied(from: Elements, to: Elements): void;
  disposed(stream: Stream<any, number>): void;
}
