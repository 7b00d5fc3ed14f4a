// SPDX-License-Identifier: MIT
//
// The types of what .sk files declare, as FILE.sk.d.ts uses them.
import type { Device } from './device.js';
import type { Fitted, Stream, View } from './stream.js';

/** A scalar and its vectors, whose arrays have one type. */
type Of<S extends string> = S extends `${string}norm${number}` ? S | `${S}x2` | `${S}x3` | `${S}x4` : S | `${S}2` | `${S}3` | `${S}4`;

/** Elements that TypeScript has no need to declare: `float`, `int3`. */
export type BuiltIn =
  | Of<'float'> | Of<'int'> | Of<'uint'> | Of<'bool'> | Of<'double'> | Of<'long'> | Of<'ulong'> | Of<'half'> | Of<'char'> | Of<'uchar'> | Of<'short'> | Of<'ushort'>
  | Of<'unorm8'> | Of<'snorm8'> | Of<'unorm16'> | Of<'snorm16'>
  | 'float2x2' | 'float3x3' | 'float4x4';

/** A struct of a .sk file, which FILE.sk.js exports. `Value` is one element, `Arrays` has one array for each member. */
export interface Struct<Name extends string, Value, Arrays> {
  readonly name: Name;
  /** Only types. */
  readonly value?: Value;
  readonly arrays?: Arrays;
}

export type ElementType = BuiltIn | Struct<string, unknown, unknown>;

/**
 * The array of a stream's elements: components one after the other, rows first. A half is a float that is rounded when it
 * is written; normalized types are integers, as the device stores them; a bool is 0 or 1. A struct has one array for each
 * member.
 */
export type ArrayOf<T extends ElementType> = T extends Struct<string, unknown, infer Arrays>
  ? Arrays
  : T extends Of<'float'> | Of<'half'> | `float${number}x${number}`
  ? Float32Array
  : T extends Of<'int'>
  ? Int32Array
  : T extends Of<'uint'>
  ? Uint32Array
  : T extends Of<'double'>
  ? Float64Array
  : T extends Of<'long'>
  ? BigInt64Array
  : T extends Of<'ulong'>
  ? BigUint64Array
  : T extends Of<'char'> | Of<'snorm8'>
  ? Int8Array
  : T extends Of<'bool'> | Of<'uchar'> | Of<'unorm8'>
  ? Uint8Array
  : T extends Of<'short'> | Of<'snorm16'>
  ? Int16Array
  : Uint16Array;

type One<T> = T extends `bool${string}` ? boolean : T extends Of<'long'> | Of<'ulong'> ? bigint : number;

/** One value: a number, a bigint of 64 bits or a boolean, components of a vector, or all components of a matrix, row by row. */
export type Value<T extends BuiltIn> = T extends `float${number}x${number}`
  ? readonly number[]
  : T extends `${string}2`
  ? readonly [One<T>, One<T>]
  : T extends `${string}3`
  ? readonly [One<T>, One<T>, One<T>]
  : T extends `${string}4`
  ? readonly [One<T>, One<T>, One<T>, One<T>]
  : One<T>;

/** One element of a stream. */
export type ValueOf<T extends ElementType> = T extends Struct<string, infer One, unknown> ? One : T extends BuiltIn ? Value<T> : never;

/** What a kernel reads element by element, `T x<>`: a stream with the shape of the output, or 1 where it repeats. */
export type Input<T extends ElementType> = Stream<T, number> | View<T, number> | Fitted<T>;
/** What a kernel reads at any index, `T a[][]`. */
export type Gather<T extends ElementType, R extends number> = Stream<T, R> | View<T, R>;
/** What a kernel writes, `out T r<>`. */
export type Output<T extends ElementType> = Stream<T, number> | View<T, number>;
/** A stream of one element that stands for a value, `T c`, or a view of one. */
export type Held<T extends ElementType> = Stream<T, number> | View<T, number>;
/** What a kernel pushes to, `vout T r<>`: the call makes its shape the number of elements. */
export type Pushed<T extends ElementType> = Stream<T, 1>;
/** What a kernel writes at any index, `out T r[][]`. */
export type Scattered<T extends ElementType, R extends number> = Stream<T, R>;
/** Values from `begin` towards `end`, evenly over the elements, `iter T i<>`. */
export interface Iterate<T> {
  readonly begin: T;
  readonly end: T;
}

/** Choices of one call, as in `diffuse.with({ precision: 'half' })(0.2, u, u)`. [[variants(...)]] assembles programs for them. */
export interface KernelOptions {
  /** 'half' rounds every result to half; 'extended' computes in pairs of floats. */
  readonly precision?: 'half' | 'single' | 'extended';
  /** 'fast' takes the device's own functions, where others are more accurate. */
  readonly intrinsics?: 'accurate' | 'fast';
}

/** Choices of one call of a reduce, as in `sum.with({ accumulate: 'tree' })(u)`. */
export interface CallOptions {
  /** How a reduction adds floats; by default compensated (docs/accuracy.md). */
  readonly accumulate?: 'tree' | 'compensated' | 'extended' | 'exact';
}

/** Choices of one call of a scan, as in `prefix.with({ scan: 'exclusive' })(x, s)`. */
export interface ScanOptions extends CallOptions {
  /** Whether a result has its own element, too, as it has by default. */
  readonly scan?: 'inclusive' | 'exclusive';
  /** The dimension, 0 being the slowest, whose lines are scanned each by itself; by default, all elements are one line. */
  readonly along?: number;
}

/** 1 to 4 extents, rows first. */
export type Extents = readonly [number] | readonly [number, number] | readonly [number, number, number] | readonly [number, number, number, number];

/** What has a domain that a call may be given: where no stream says it, and on a device, where no stream says that. */
export interface Over<Called> {
  over(shape: Extents): Called;
  over(device: Device, shape: Extents): Called;
}

/** A kernel: a function that writes its outputs. It returns at once; the device computes meanwhile. */
export interface Kernel<Arguments extends readonly unknown[]> extends Over<Kernel<Arguments>> {
  (...given: Arguments): void;
  with(options: KernelOptions): Kernel<Arguments>;
}

/** A kernel that pushes, or that scatters many values: how many is known when the promise resolves. */
export interface CountingKernel<Arguments extends readonly unknown[]> extends Over<CountingKernel<Arguments>> {
  (...given: Arguments): Promise<void>;
}

/**
 * A reduce, or a kernel with folded outputs: a function that promises the value. With streams for the results, `All`, it writes
 * to these instead, and returns at once: a smaller stream has one element for each block of the inputs.
 */
export interface Reduce<Arguments extends readonly unknown[], Result, All extends readonly unknown[]> extends Over<Reduce<Arguments, Result, All>> {
  (...given: Arguments): Promise<Result>;
  (...given: All): void;
  with(options: CallOptions): Reduce<Arguments, Result, All>;
}

/** A scan: a function that writes one result for each element. */
export interface Scan<Arguments extends readonly unknown[]> extends Over<Scan<Arguments>> {
  (...given: Arguments): void;
  with(options: ScanOptions): Scan<Arguments>;
}

/** What browsers do not run, and why: no call of it compiles. */
export interface NotOffered<Why extends string> {
  readonly whyNotOffered: Why;
}

/** The shape of a stream of this rank, rows first. */
export type ShapeOf<R extends number> = R extends 1
  ? readonly [number]
  : R extends 2
  ? readonly [number, number]
  : R extends 3
  ? readonly [number, number, number]
  : R extends 4
  ? readonly [number, number, number, number]
  : readonly number[];
