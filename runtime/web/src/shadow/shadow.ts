// SPDX-License-Identifier: MIT
//
// What device.shadow() gives: a shadow computes beside the device in pairs of floats, and says which kernel is to blame for what, as
// SK_SHADOW does in C++ (docs/accuracy.md).
import type { Device } from '../device.js';
import { SkError } from '../error.js';
import { Stream } from '../stream.js';
import { Follower } from './follower.js';
import { reportOf, type ShadowReport } from './report.js';
import { tableOf } from './table.js';

export interface ShadowOptions {
  /** Compares every n-th call of a kernel; the reference runs all of them. 1 by default. */
  readonly every?: number;
  /** Compares these kernels alone, by patterns in which `*` stands for any characters: `heat*`. All by default. */
  readonly kernels?: readonly string[];
}

function fail(message: string): never {
  throw new SkError(`shadow: ${message}`);
}

/** The options. Throws SkError for others. */
export function checkedOptions(options: ShadowOptions): Required<ShadowOptions> {
  if (typeof options !== 'object' || options === null) fail(`${String(options)} is no object of options; give { every, kernels }`);
  const { every = 1, kernels = ['*'], ...others } = options;
  const [unknown] = Object.keys(others);
  if (unknown !== undefined) fail(`there is no option '${unknown}'; there are 'every' and 'kernels'`);
  if (!Number.isInteger(every) || every < 1) fail(`every: ${String(every)} is no number of calls; give a whole number from 1 on`);
  const areNames = Array.isArray(kernels) && kernels.length > 0 && kernels.every((name) => typeof name === 'string' && name !== '');
  if (!areNames) fail("kernels: give an array of names or patterns, such as ['heat*']");
  return { every, kernels: [...kernels] };
}

/** Whether a name matches one of several patterns, in which `*` stands for any characters. */
export function matchesAny(patterns: readonly string[], name: string): boolean {
  const escaped = (text: string) => text.replace(/[\\^$.*+?()[\]{}|]/g, '\\$&');
  return patterns.some((pattern) => new RegExp(`^${pattern.split('*').map(escaped).join('.*')}$`).test(name));
}

export class Shadow {
  private readonly start = performance.now();
  private end: number | null = null;
  private readonly follower: Follower;

  private constructor(private readonly device: Device, private readonly options: Required<ShadowOptions>) {
    this.follower = new Follower(device, options.every, (kernel) => matchesAny(options.kernels, kernel));
  }

  /** @internal */
  static of(device: Device, options: ShadowOptions): Shadow {
    const checked = checkedOptions(options);
    if (device.observer !== null) fail('the device has one; stop() that first');
    return new Shadow(device, checked);
  }

  /** What it has found out of everything until now: the format of SK_SHADOW, version 1, which `sk shadow` reads (docs/json.md). */
  async report(): Promise<ShadowReport> {
    await this.follower.settled();
    const program = (globalThis as { location?: Location }).location?.pathname ?? 'page';
    const seconds = ((this.end ?? performance.now()) - this.start) / 1000;
    return reportOf(this.follower.records, { program, device: this.device.info().renderer, hasEnded: this.end !== null, ...this.options, seconds });
  }

  /** The report as text, for the console. */
  async table(): Promise<string> {
    return tableOf(await this.report());
  }

  /** The report as a page of HTML, which needs nothing else: for a file, or a window of its own. */
  async html(): Promise<string> {
    const { page } = await import('./page.js');
    const json = JSON.stringify(await this.report()).replace(/</g, '\\u003c'); // "</script>" means something even within a text
    return page.replace('/*REPORT*/null', () => json);
  }

  /** Gives a stream a name, by which the report calls it. */
  name(stream: Stream<any, number>, name: string): void {
    if (!(stream instanceof Stream) || typeof name !== 'string' || name === '') fail('name() takes a stream and its name');
    this.follower.name(stream, name);
  }

  /** Ends it: later calls are not followed, and the report stays as it is. */
  stop(): void {
    this.end ??= performance.now();
    this.follower.stop();
  }
}
