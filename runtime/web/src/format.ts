// SPDX-License-Identifier: MIT
//
// The texture format of each type of component: the table of runtime/src/gl/format.cpp, and the arrays that hold such
// components on the host.

export type Scalar =
  | 'bool' | 'int' | 'uint' | 'float' | 'double' | 'long' | 'ulong' | 'half' | 'char' | 'uchar' | 'short' | 'ushort'
  | 'unorm8' | 'snorm8' | 'unorm16' | 'snorm16';

export type HostArray =
  | Int8Array | Uint8Array | Int16Array | Uint16Array | Int32Array | Uint32Array | Float32Array | Float64Array
  | BigInt64Array | BigUint64Array;
type HostArrayType = { readonly BYTES_PER_ELEMENT: number; new (length: number): HostArray; new (buffer: ArrayBufferLike, offset?: number, length?: number): HostArray };

export type SamplerKind = 'float' | 'int' | 'uint';

export interface Format {
  readonly internal: number;
  readonly format: number;
  readonly type: number;
  /** Channels of a texel: 1, 2 or 4. */
  readonly channels: number;
  /** An array of channels as textures take them. */
  readonly channel: HostArrayType;
  readonly sampler: SamplerKind;
}

const gl = WebGL2Constants();

/** GL's numbers, which Node has no context to ask for. */
function WebGL2Constants() {
  return {
    UNSIGNED_BYTE: 0x1401, BYTE: 0x1400, SHORT: 0x1402, UNSIGNED_SHORT: 0x1403, INT: 0x1404, UNSIGNED_INT: 0x1405, FLOAT: 0x1406,
    RED: 0x1903, RG: 0x8227, RGBA: 0x1908, RED_INTEGER: 0x8d94, RG_INTEGER: 0x8228, RGBA_INTEGER: 0x8d99,
  } as const;
}

interface Family {
  /** For 1, 2 and 4 channels. */
  readonly internal: readonly [number, number, number];
  readonly type: number;
  readonly isInteger: boolean;
  readonly channel: HostArrayType;
  readonly sampler: SamplerKind;
}

const bytes: Family = { internal: [0x8232, 0x8238, 0x8d7c], type: gl.UNSIGNED_BYTE, isInteger: true, channel: Uint8Array, sampler: 'uint' };
const ints: Family = { internal: [0x8235, 0x823b, 0x8d82], type: gl.INT, isInteger: true, channel: Int32Array, sampler: 'int' };
const uints: Family = { internal: [0x8236, 0x823c, 0x8d70], type: gl.UNSIGNED_INT, isInteger: true, channel: Uint32Array, sampler: 'uint' };
const floats: Family = { internal: [0x822e, 0x8230, 0x8814], type: gl.FLOAT, isInteger: false, channel: Float32Array, sampler: 'float' };
const halves: Family = { internal: [0x822d, 0x822f, 0x881a], type: gl.FLOAT, isInteger: false, channel: Float32Array, sampler: 'float' };
const chars: Family = { internal: [0x8231, 0x8237, 0x8d8e], type: gl.BYTE, isInteger: true, channel: Int8Array, sampler: 'int' };
const shorts: Family = { internal: [0x8233, 0x8239, 0x8d88], type: gl.SHORT, isInteger: true, channel: Int16Array, sampler: 'int' };
const ushorts: Family = { internal: [0x8234, 0x823a, 0x8d76], type: gl.UNSIGNED_SHORT, isInteger: true, channel: Uint16Array, sampler: 'uint' };
const unorms: Family = { internal: [0x8229, 0x822b, 0x8058], type: gl.UNSIGNED_BYTE, isInteger: false, channel: Uint8Array, sampler: 'float' };

const families: Readonly<Record<Scalar, Family>> = {
  bool: bytes, uchar: bytes, int: ints, uint: uints, double: uints, long: uints, ulong: uints, float: floats, half: halves, char: chars, snorm8: chars,
  short: shorts, snorm16: shorts, ushort: ushorts, unorm16: ushorts, unorm8: unorms,
};

const formats = new Map<string, Format>();

/** Whether a component has 64 bits: two channels of a texel. */
export function is64Bit(scalar: Scalar): boolean {
  return scalar === 'double' || scalar === 'long' || scalar === 'ulong';
}

/** The format of a plane of `width` components, 1 to 4. */
export function formatOf(scalar: Scalar, width: number): Format {
  const key = scalar + width;
  let format = formats.get(key);
  if (format === undefined) {
    const family = families[scalar];
    const components = is64Bit(scalar) ? 2 * width : width;
    const row = components === 1 ? 0 : components === 2 ? 1 : 2;
    const layouts = family.isInteger ? [gl.RED_INTEGER, gl.RG_INTEGER, gl.RGBA_INTEGER] : [gl.RED, gl.RG, gl.RGBA];
    format = {
      internal: family.internal[row]!,
      format: layouts[row]!,
      type: family.type,
      channels: [1, 2, 4][row]!,
      channel: family.channel,
      sampler: family.sampler,
    };
    formats.set(key, format);
  }
  return format;
}

/** The format and type in which every device reads such textures back: four channels of 32 bits, or bytes. */
export function wideOf(format: Format): { format: number; type: number; array: HostArrayType } {
  if (format.sampler === 'int') return { format: gl.RGBA_INTEGER, type: gl.INT, array: Int32Array };
  if (format.sampler === 'uint') return { format: gl.RGBA_INTEGER, type: gl.UNSIGNED_INT, array: Uint32Array };
  if (format.type === gl.FLOAT) return { format: gl.RGBA, type: gl.FLOAT, array: Float32Array };
  return { format: gl.RGBA, type: gl.UNSIGNED_BYTE, array: Uint8Array };
}

/** The type of the host's arrays of components. */
export function hostArrayOf(scalar: Scalar): HostArrayType {
  if (scalar === 'long') return BigInt64Array;
  if (scalar === 'ulong') return BigUint64Array;
  return scalar === 'double' ? Float64Array : families[scalar].channel;
}
