// SPDX-License-Identifier: MIT

export interface StreamKernelOptions {
  /** The compiler; by default the one that the variable SKC names, else 'skc' on PATH. */
  skc?: string;
  /** More options of skc: ['-Iinclude', '-DN=4']. */
  options?: readonly string[];
  /** Whether heat.sk.d.ts is written beside heat.sk, for TypeScript: true by default. */
  types?: boolean;
}

/** A plugin for Vite 3 or later, or for Rollup. */
export function streamkernel(options?: StreamKernelOptions): {
  name: string;
  load(id: string): Promise<{ code: string; map: null } | null>;
};
