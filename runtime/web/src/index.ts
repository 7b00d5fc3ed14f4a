// SPDX-License-Identifier: MIT
//
// The package streamkernel: devices and streams, and what FILE.sk.js needs.
import { fail } from './arguments.js';
import { flattened } from './bundles.js';
import type { Device } from './device.js';
import type { Features, FoldCaller, LoadedFile } from './features.js';
import { Forms } from './forms.js';
import { checkSchema, type Callable, type GeneratedFile, type Parameter, type WithBundles } from './generated.js';
import { KernelCaller } from './kernel.js';
import type { Called } from './observer.js';
import { givenDomain, type GivenDomain } from './over.js';
import type { Program } from './program.js';
import type { KernelOptions, ScanOptions, Struct } from './types.js';

export { Device } from './device.js';
export type { Arithmetic, Canvas, DeviceInfo, DeviceOptions } from './abilities.js';
export type { DrawOptions } from './draw.js';
export { SkError } from './error.js';
export type { ErrorKind } from './error.js';
export type { Shadow, ShadowOptions } from './shadow/shadow.js';
export type { ShadowReport } from './shadow/report.js';
export { Stream, stretch, stride, type Fitted, type View } from './stream.js';
export type {
  ArrayOf, BuiltIn, CallOptions, CountingKernel, ElementType, Extents, Gather, Held, Input, Iterate, Kernel, KernelOptions, NotOffered, Output, Over, Pushed, Reduce, Scan, ScanOptions,
  Scattered, ShapeOf, Struct, Value, ValueOf,
} from './types.js';

// What FILE.sk.js hands to fileOf() if its kernels need it.
export { lists } from './append.js';
export { placed as views } from './placed.js';
export { plans } from './plan.js';
export { folds } from './reduction.js';
export { planScan as scans } from './scan_plan.js';

/** What FILE.sk.js exports under a name: a function, with what Device.compile() needs. */
interface Exported {
  (...given: unknown[]): unknown;
  /** Makes a call if it is like an earlier one; else it does nothing, and returns false. */
  repeat(given: readonly unknown[]): boolean;
  /** Throws SkError if these are no arguments of it. */
  check(given: readonly unknown[]): void;
  startPrograms(device: Device): Program[];
  with?(options: ScanOptions): Exported;
  over?(...given: readonly unknown[]): Exported;
}

/** Makes a call, which the tracer and the observer of the streams' device see, or of the given one. */
function seen<T>(called: Called, options: ScanOptions & KernelOptions, given: readonly unknown[], over: GivenDomain | null, call: () => T): T {
  for (const argument of [...given, over]) {
    const device = (argument as { device?: Device } | null | undefined)?.device;
    if (!device?.tracer && !device?.observer) continue;
    const { tracer, observer } = device;
    const traced = tracer ? () => tracer.call(called.callable.name, call) : call;
    return observer ? observer.call(called, options, given, over, traced) : traced();
  }
  return call();
}

interface Caller {
  repeat(given: readonly unknown[]): boolean;
  call(given: readonly unknown[], over: GivenDomain | null): unknown;
  check(given: readonly unknown[]): void;
  startPrograms(device: Device): Program[];
}

function reduceFunction(called: Called, caller: FoldCaller, options: ScanOptions, over: GivenDomain | null): Exported {
  const { name } = called.callable;
  const run = (...given: unknown[]) => seen(called, options, given, over, () => caller.call(given, options, over));
  return Object.assign(run, {
    repeat: () => false,
    with: (more: ScanOptions) => reduceFunction(called, caller, { ...options, ...more }, over),
    over: (...given: readonly unknown[]) => reduceFunction(called, caller, options, givenDomain(name, given)),
    check: (given: readonly unknown[]) => caller.check(given),
    startPrograms: (device: Device) => caller.startPrograms(device, options),
  });
}

function kernelFunction(called: Called, callers: { of(options: KernelOptions): Caller }, options: KernelOptions, over: GivenDomain | null): Exported {
  const { name } = called.callable;
  let chosen: Caller | null = null; // when it is called: other overloads may have forms that this one lacks
  const caller = () => (chosen ??= callers.of(options));
  const repeat = (given: readonly unknown[]) => over === null && chosen !== null && chosen.repeat(given);
  const run = (...given: unknown[]) => (repeat(given) ? undefined : seen(called, options, given, over, () => caller().call(given, over)));
  return Object.assign(run, {
    repeat,
    with: (more: object) => kernelFunction(called, callers, { ...options, ...more }, over),
    over: (...given: readonly unknown[]) => kernelFunction(called, callers, options, givenDomain(name, given)),
    check: (given: readonly unknown[]) => caller().check(given),
    startPrograms: (device: Device) => caller().startPrograms(device),
  });
}

function functionOf(callable: Callable, file: LoadedFile): Exported {
  if ('whyNot' in callable) {
    const refuse = () => fail(callable.name, callable.whyNot, 'compile');
    return Object.assign(() => refuse(), { repeat: () => false, with: refuse, over: refuse, check: refuse, startPrograms: refuse });
  }
  if ('fold' in callable) return withBundles(callable, callable.fold.parameters, reduceFunction({ callable, file }, file.features.folds!(callable, file), {}, null));
  return withBundles(callable, callable.parameters, kernelFunction({ callable, file }, new Forms(callable, file, (form) => new KernelCaller(form, file)), {}, null));
}

/** A function whose arguments may be bundles, from one that takes their members. */
function withBundles(callable: WithBundles & { readonly name: string }, parameters: readonly Parameter[], flat: Exported): Exported {
  const { name, bundles } = callable;
  if (bundles === undefined) return flat;
  const results = parameters.filter(({ role }) => role === 'accumulator').length;
  const flatten = (given: readonly unknown[]) => flattened(name, bundles, results, parameters.length, given);
  return Object.assign((...given: unknown[]) => flat(...flatten(given)), {
    repeat: (given: readonly unknown[]) => flat.repeat(flatten(given)),
    with: (options: ScanOptions) => withBundles(callable, parameters, flat.with?.(options) ?? flat),
    over: (...given: readonly unknown[]) => withBundles(callable, parameters, flat.over?.(...given) ?? flat),
    check: (given: readonly unknown[]) => flat.check(flatten(given)),
    startPrograms: (device: Device) => flat.startPrograms(device),
  });
}

/** Calls the first of several overloads that takes the arguments; if none does, the first says why. */
function overloaded(functions: readonly Exported[]): Exported {
  const [first] = functions;
  if (functions.length === 1) return first!;
  const takes = (one: Exported, given: readonly unknown[]) => {
    try {
      one.check(given);
      return true;
    } catch {
      return false;
    }
  };
  const chosen = (given: readonly unknown[]) => functions.find((one) => takes(one, given)) ?? first!;
  const repeat = (given: readonly unknown[]) => functions.some((one) => one.repeat(given));
  return Object.assign((...given: unknown[]) => (repeat(given) ? undefined : chosen(given)(...given)), {
    repeat,
    with: (options: ScanOptions) => overloaded(functions.map((one) => one.with?.(options) ?? one)),
    over: (...given: readonly unknown[]) => overloaded(functions.map((one) => one.over?.(...given) ?? one)),
    check: (given: readonly unknown[]) => chosen(given).check(given),
    startPrograms: (device: Device) => functions.flatMap((one) => one.startPrograms(device)),
  });
}

/** What FILE.sk.js calls; it is not for other programs. `texts` are the programs that `data` refers to. */
export function fileOf(data: GeneratedFile, texts: readonly string[], features: Features = {}) {
  checkSchema(data);
  const structs = new Map(data.structs.map((struct) => [struct.name, struct]));
  const file: LoadedFile = { ...data, texts, features, elements: data.elements.map((element) => structs.get(element.name) ?? element) };
  return {
    struct: (name: string) => file.structs.find((struct) => struct.name === name) as unknown as Struct<string, unknown, unknown>,
    callable: (...units: number[]): Exported => {
      const callables = units.map((unit) => file.callables[unit]!);
      return overloaded(callables.map((callable) => functionOf(callable, file)));
    },
  };
}
