// SPDX-License-Identifier: MIT
//
// What FILE.sk.js hands over (compiler/web/js_module.cpp): descriptors of kernels and reductions, and their programs.
import { SkError } from './error.js';
import type { Scalar } from './format.js';

/** The version of this data that this runtime reads. */
export const moduleSchema = 3;

/** One plane of an element. */
export interface Field {
  readonly scalar: Scalar;
  /** Components, 1 to 4. */
  readonly width: number;
  readonly offset: number;
  /** Member path in GLSL; absent if the element is no struct. */
  readonly path?: string;
  /** Which row of a matrix, or which pair of a vector of doubles. */
  readonly part?: number;
}

export interface Element {
  readonly name: string;
  readonly size: number;
  readonly fields: readonly Field[];
}

/** A struct; `planes` are the paths of its fields in the terms of the .sk file. */
export interface StructElement extends Element {
  readonly planes: readonly string[];
}

export type Role =
  | 'uniform' | 'input' | 'output' | 'gather' | 'accumulator' | 'variableOutput' | 'scatter' | 'iterator' | 'spec';

/** One step of a condition over spec parameters, for a stack machine. */
export type ConditionStep = readonly [op: string, scalar: Scalar, value: number];

export interface Parameter {
  readonly name: string;
  readonly symbol: string;
  readonly role: Role;
  /** Index in GeneratedFile.elements. */
  readonly element: number;
  readonly held?: number;
  readonly rank?: number;
  readonly boundary?: 'clamp' | 'wrap' | 'mirror' | 'border';
  readonly reach?: number;
  readonly filter?: boolean;
  /** Outputs of a pass that writes only some planes: the first one, and how many. */
  readonly firstPlane?: number;
  readonly planeCount?: number;
  /** Of planes that share textures with others: a stack or -1, the layer, and the number of planes in the stack. */
  readonly layers?: readonly (readonly [stack: number, layer: number, count: number])[];
  /**
   * Uniforms: what programs have, in place of the value's uniform and at the beginning of main(), if a stream holds it. Absent
   * for floats, ints, uints and their vectors, and if none may.
   */
  readonly fromStream?: readonly [uniforms: string, statements: string];
  readonly neededIf?: readonly ConditionStep[];
  readonly condition?: string;
  /** Accumulators: whether they have a value where there are no elements. */
  readonly hasIdentity?: boolean;
}

export interface KernelData {
  readonly name: string;
  readonly parameters: readonly Parameter[];
}

/** Index of a program in the file, by the key of a variant. */
export type ProgramIndices = Readonly<Record<string, number>>;

/** The passes that apply the list of a scatter output (runtime/src/assemble/append/scatter_programs.hpp). */
export type PointStep =
  | 'store' | 'splitLimbs' | 'addLimbs' | 'joinLimbs' | 'splitUpper' | 'upper' | 'splitLower' | 'lower' | 'joinHalves';

/** The list of a variable or scatter output. */
export interface List {
  readonly parameter: number;
  readonly symbol: string;
  /** Entries per element, if they are not counted. */
  readonly slots?: number;
  readonly programs: ProgramIndices;
  /** Of a scatter output: how values are combined, and the programs of its points. */
  readonly op?: 'store' | 'add' | 'min' | 'max';
  readonly points?: Readonly<Partial<Record<PointStep, number>>>;
}

/** Choices that programs depend on. */
export interface Dials {
  readonly precision?: 'half' | 'single' | 'extended';
  readonly intrinsics?: 'accurate' | 'fast';
}

/** What the file chooses for calls that choose nothing, and other forms by name: "half", "extended fast"; null: no other. */
export interface WithForms<Data> extends Dials {
  readonly name: string;
  readonly forms?: Readonly<Record<string, Data | { readonly whyNot: string } | null>>;
}

/**
 * The form whose streams hold doubles, which a shadow runs beside the plain one, or why there is none; null if that is the plain one
 * itself, since it computes no floats. Absent where skc was not asked for it (--shadow).
 */
export type Beside<Data> = Data | { readonly whyNot: string } | null;

export interface CallableKernel extends KernelData, WithForms<CallableKernel> {
  /** Whether it may write four elements of a packed texel. */
  readonly packs: boolean;
  readonly programs: ProgramIndices;
  /** If one pass is too little. */
  readonly plan?: Plan;
  /** Of variable and scatter outputs, in order. `programs` then count pushes and write the other outputs. */
  readonly lists?: readonly List[];
  /** Programs of the pyramid over counts, and the vertex program of points. */
  readonly sums?: readonly [ofCounts: number, ofNodes: number];
  readonly vertices?: number;
  readonly shadow?: Beside<CallableKernel>;
}

/** A kernel that is split into passes: each runs over the kernel's domain, and hands on temporaries. */
export interface Plan {
  /** Elements, by index. */
  readonly temporaries: readonly number[];
  /** Planes of arguments that are copied to the layers of a texture before the passes run. */
  readonly stacks?: readonly (readonly [scalar: Scalar, width: number, layers: readonly (readonly [argument: number, plane: number])[]])[];
  readonly passes: readonly Pass[];
}

export interface Pass {
  readonly kernel: KernelData & { readonly programs: ProgramIndices };
  /** For each of its parameters: one of the temporaries, or a parameter of the whole kernel. */
  readonly operands: readonly (readonly [isTemporary: boolean, index: number])[];
}

export interface Reduction {
  readonly name: string;
  readonly fold: KernelData;
  readonly combine: KernelData;
  readonly combineOperands: readonly number[];
  readonly commutative: boolean;
  /** Whether elements are always found by their index. */
  readonly byIndex: boolean;
  readonly programs: ProgramIndices;
}

/** A variant of a reduction, and the kernel that runs over its results. */
export interface SumVariant {
  readonly reduction: Reduction;
  readonly finish: KernelData & { readonly programs: ProgramIndices };
  /** For each input of `finish`: an accumulator of the variant if `isOwn`, else of the plain reduction. */
  readonly inputs: readonly (readonly [isOwn: boolean, index: number])[];
  /** The accumulators of the plain reduction that `finish` computes. */
  readonly results: readonly number[];
}

/** A reduce, a scan, or a kernel with folded outputs. */
export interface CallableReduction extends Reduction {
  readonly accumulate?: string;
  readonly scans?: boolean;
  /** The ways to add floats, by name: one variant after the other, or why no browser runs them. */
  readonly variants: { readonly [accumulate: string]: readonly SumVariant[] | string };
  /** Whether the variants of 'exact' compute all that the plain reduction does. */
  readonly sumsAll?: boolean;
  /** Computes the other outputs of a kernel with folded outputs: for each parameter, the one of the whole kernel. */
  readonly map?: CallableKernel;
  readonly mapOperands?: readonly number[];
  readonly shadow?: Beside<CallableReduction>;
}

/** A bundle among the arguments of a call: an object whose members are arguments for parameters of the kernel. */
export interface BundleArgument {
  readonly name: string;
  /** Its index among the arguments, and how many of those before it are results, which reduces to values do not take. */
  readonly at: number;
  readonly results: number;
  /** The members that the kernel reads, in the order of its parameters: "view.eye"; and those that it does not read. */
  readonly reads: readonly string[];
  readonly others: readonly string[];
}

export interface WithBundles {
  readonly bundles?: readonly BundleArgument[];
}

export interface LeftOut {
  readonly name: string;
  readonly whyNot: string;
}

export type Callable = (CallableKernel & WithBundles) | (CallableReduction & WithBundles) | LeftOut;

export interface GeneratedFile {
  readonly schema: number;
  readonly name: string;
  readonly sources: readonly string[];
  readonly elements: readonly Element[];
  readonly structs: readonly StructElement[];
  readonly callables: readonly Callable[];
}

export function checkSchema(file: GeneratedFile): void {
  if (file.schema === moduleSchema) return;
  throw new SkError(
    `${file.name}.js has version ${file.schema} of what skc writes, and this package reads version ${moduleSchema}; ` +
      'use skc and the package streamkernel of one release',
    'compile',
  );
}

// ---- spec parameters ------------------------------------------------------------------------------

const bits = new DataView(new ArrayBuffer(4));

/** The 32 bits of a spec parameter's value. */
export function specBits(scalar: Scalar, value: number | boolean): number {
  if (scalar === 'float') bits.setFloat32(0, Number(value));
  else bits.setUint32(0, Number(value) >>> 0);
  return bits.getUint32(0);
}

/** The value as a constant expression in GLSL, exactly. */
export function specLiteral(scalar: Scalar, word: number): string {
  if (scalar === 'bool') return word !== 0 ? 'true' : 'false';
  if (scalar === 'uint') return `${word}u`;
  if (scalar === 'float') return `uintBitsToFloat(${word}u)`;
  return word === 0x80000000 ? '(-2147483647 - 1)' : `${word | 0}`;
}

function ordered(scalar: Scalar, word: number): number {
  bits.setUint32(0, word);
  return scalar === 'float' ? bits.getFloat32(0) : scalar === 'int' ? bits.getInt32(0) : word;
}

/** Whether a condition over the words of spec parameters holds. */
export function holds(steps: readonly ConditionStep[], specs: readonly number[]): boolean {
  const stack: number[] = [];
  for (const [op, scalar, value] of steps) {
    if (op === 'spec') stack.push(specs[value]!);
    else if (op === 'literal') stack.push(value);
    else if (op === 'not') stack.push(stack.pop() === 0 ? 1 : 0);
    else {
      const b = stack.pop()!;
      const a = stack.pop()!;
      stack.push(combined(op, scalar, a, b) >>> 0);
    }
  }
  return stack[0] !== 0;
}

function combined(op: string, scalar: Scalar, a: number, b: number): number {
  const x = ordered(scalar, a);
  const y = ordered(scalar, b);
  switch (op) {
    case 'and': return Number(a !== 0 && b !== 0);
    case 'or': return Number(a !== 0 || b !== 0);
    case 'bitAnd': return a & b;
    case 'bitOr': return a | b;
    case 'bitXor': return a ^ b;
    case 'add': return a + b;
    case 'sub': return a - b;
    case 'mul': return Math.imul(a, b);
    case 'less': return Number(x < y);
    case 'lessEqual': return Number(x <= y);
    case 'greater': return Number(x > y);
    case 'greaterEqual': return Number(x >= y);
    case 'equal': return Number(x === y);
    default: return Number(x !== y);
  }
}

export function isNeeded(parameter: Parameter, specs: readonly number[]): boolean {
  return parameter.neededIf === undefined || holds(parameter.neededIf, specs);
}
