// SPDX-License-Identifier: MIT
//
// Passes of kernels: their programs, what they read and where they draw: runtime/src/gl_device/pass/pass.cpp.
import { fail, isRead, iterationOf, stepsOf, type AnyStream, type Checked } from './arguments.js';
import type { Device } from './device.js';
import type { LoadedFile } from './features.js';
import type { Format } from './format.js';
import { isNeeded, specLiteral, type Element, type KernelData, type Parameter, type ProgramIndices } from './generated.js';
import { type Layout } from './layout.js';
import type { Plane } from './memory.js';
import type { Program } from './program.js';
import { texelOf } from './stream.js';
import { isFiltered, kernelKey, type Lie } from './variant.js';

/** Why a call with whole streams needs the program for views. */
export const smallGather = 'where a gather is smaller than the output, or nearly';

/** The programs of one kernel or reduction. */
export class ProgramSource {
  constructor(readonly name: string, readonly file: LoadedFile, private readonly indices: ProgramIndices) {}

  has(key: string): boolean {
    return key in this.indices;
  }

  /**
   * The program with this key, for these values of spec parameters; `isHeld`: a stream holds the value of a uniform. Throws
   * SkError if skc has not assembled it.
   */
  program(device: Device, key: string, kernel: KernelData, specs: readonly number[], isHeld: (index: number) => boolean = () => false): Program {
    const { parameters } = kernel;
    const areHeld = parameters.map(({ role }, i) => role === 'uniform' && isHeld(i)); // the program outlives the call
    const held = parameters.filter((_, i) => areHeld[i]);
    if (held.length > 0) this.checkUnits(device, kernel, held, specs);
    const words = [this.indices[key] ?? key, ...specs, ...held.map(({ symbol }) => symbol)].join(' ');
    const isUsed = (parameter: Parameter) => isNeeded(parameter, specs);
    return device.program(this, words, this.name, () => this.text(key, parameters, specs, held), parameters, this.file.elements, isUsed, undefined, (i) => areHeld[i]!);
  }

  private text(key: string, parameters: readonly Parameter[], specs: readonly number[], held: readonly Parameter[]): string {
    const index = this.indices[key];
    if (index === undefined) this.refuse(`'${key}'`, parameters, specs);
    let number = 0;
    let text = this.file.texts[index]!;
    for (const parameter of parameters) {
      if (parameter.role !== 'spec') continue;
      const literal = specLiteral(this.file.elements[parameter.element]!.fields[0]!.scalar, specs[number++]!);
      text = text.replace(new RegExp(`( sk_spec_${parameter.symbol} = )[^;]*;`), `$1${literal};`);
    }
    const main = 'void main() {\n';
    for (const { symbol, element, fromStream } of held) {
      let fetch = '';
      text = text.replace(new RegExp(`uniform ([^;]*) sk_arg_${symbol};\n`), (_, type: string) => {
        const { scalar, width } = this.file.elements[element]!.fields[0]!;
        const sampler = `${scalar === 'float' ? '' : scalar[0]}sampler2D`;
        const plain = [
          `uniform ${sampler} sk_tex_${symbol};\nuniform ivec4 sk_origin_${symbol};\n`,
          `  ${type} sk_arg_${symbol} = texelFetch(sk_tex_${symbol}, sk_origin_${symbol}.xy, 0)${'.xyzw'.slice(0, width + 1)};\n`,
        ];
        const [uniforms, statements] = fromStream ?? plain;
        fetch = statements!;
        return uniforms!;
      });
      const at = text.lastIndexOf(main) + main.length;
      text = text.slice(0, at) + fetch + text.slice(at);
    }
    return text;
  }

  /** Throws SkError: no program fits the call, or none fits any call with these values of spec parameters. */
  refuse(which: string, parameters: readonly Parameter[] = [], specs: readonly number[] = []): never {
    const { name } = this.file;
    const unneeded = parameters.flatMap((parameter) => (isNeeded(parameter, specs) ? [] : [`no ${parameter.name}`])).join();
    const isKnown = (key: string) => key.split('; ').filter((part) => part.startsWith('no ')).join() === unneeded;
    if (parameters.length > 0 && !Object.keys(this.indices).some(isKnown)) {
      fail(this.name, `${name}.js has no program for the streams that it needs with these values of its specialisation constants; compare them with numbers in ${name}, as in 'n == 9'`, 'compile');
    }
    fail(this.name, `${name}.js has no program for this call, ${which}; write [[variants(views)]] before '${this.name}' in ${name}, or give whole streams that have the shape of the output, and gathers at least as large`, 'compile');
  }

  private checkUnits(device: Device, { parameters }: KernelData, held: readonly Parameter[], specs: readonly number[]): void {
    const isBound = (parameter: Parameter) => parameter.role === 'input' || parameter.role === 'gather' || held.includes(parameter);
    const planes = parameters
      .filter((parameter) => isBound(parameter) && isNeeded(parameter, specs))
      .flatMap(({ element, held: own, layers }) => this.file.elements[own ?? element]!.fields.map((_, plane) => layers?.[plane]?.[0] ?? -1));
    const units = planes.filter((stack) => stack < 0).length + new Set(planes.filter((stack) => stack >= 0)).size;
    if (units <= device.limits.textureUnits) return;
    fail(this.name, `a pass reads ${units} planes, with those of streams that stand for values, but this device reads ${device.limits.textureUnits}; give values`, 'device');
  }

  /** Starts to compile all programs. */
  startPrograms(device: Device, kernelFor: (key: string) => KernelData): Program[] {
    return Object.keys(this.indices).flatMap((key) => {
      const kernel = kernelFor(key);
      const hasSpecs = kernel.parameters.some((parameter) => parameter.role === 'spec');
      return hasSpecs ? [] : [this.program(device, key, kernel, [])]; // which values will come is not known
    });
  }
}

/** Binds the planes that a program reads, and sets the uniforms of its parameters. The program must be current. */
export function bindOperands(
  device: Device, program: Program, values: Checked['values'], planes: readonly (readonly Plane[])[], lies: readonly Lie[], elements: readonly Element[], domain: readonly number[],
): void {
  for (const { index, parameter, layout: uniforms, units } of program.reads) {
    const layout = lies[index] as Layout;
    uniforms!.set(layout);
    const isFilteredHere = parameter.filter === true && isFiltered(parameter, layout, elements, device.filtersFloats);
    const boundary = parameter.boundary === 'border' ? 'clamp' : parameter.boundary ?? 'clamp';
    const own = planes[index]!;
    for (let p = 0; p < own.length; ++p) {
      const unit = units![p]!;
      if (unit < 0) continue; // it shares a texture, which the plan binds
      device.bindTexture(unit, own[p]!.texture);
      device.bindFilter(unit, isFilteredHere ? boundary : null);
    }
  }
  for (const bound of program.values) {
    const numbers = values[bound.index]!;
    if (bound.step === undefined) {
      bound.value!.set(numbers);
      continue;
    }
    const element = elements[bound.parameter.element]!;
    const { begin, step } = stepsOf('', bound.parameter, element, numbers, domain);
    bound.value!.set(begin);
    bound.step.set(step);
    bound.layout!.set(strides(device, domain));
  }
}

/** Draws a domain to these planes, of each output. */
export function drawDomain(
  device: Device, program: Program, values: Checked['values'], planes: readonly (readonly Plane[])[], lies: readonly Lie[], elements: readonly Element[],
  shape: readonly number[], domain: Layout, drawn: readonly (readonly Plane[])[],
): void {
  device.useProgram(program);
  bindOperands(device, program, values, planes, lies, elements, shape);
  program.domain.set(domain);
  device.framebufferOf(drawn.length === 1 ? drawn[0]! : drawn.flat());
  device.drawRects(domain.draws);
}

/** The layout whose strides are those of a domain's element numbers. */
function strides(device: Device, domain: readonly number[]): Layout {
  const layout = device.layoutOf(domain, false);
  if (layout.linear) return layout;
  const [x, y, z] = layout.extent;
  return { ...layout, stride: [1, x, x * y, x * y * z] };
}

/** The program of a kernel whose inputs lie as its domain does. */
export function alignedProgram(device: Device, source: ProgramSource, kernel: KernelData, domain: Layout): Program {
  return source.program(device, kernelKey(kernel.parameters, source.file.elements, alignedLies(kernel, domain), domain, [], device.filtersFloats), kernel, []);
}

function alignedLies({ parameters }: KernelData, domain: Layout): Lie[] {
  return parameters.map(({ role }) => (role === 'input' ? domain : null));
}

/** Runs such a kernel over the planes of each input, and returns new ones of these formats, for each output. */
export function drawAligned(
  device: Device, source: ProgramSource, kernel: KernelData, inputs: readonly (readonly Plane[])[], domain: Layout, formats: readonly (readonly Format[])[],
): Plane[][] {
  const { elements } = source.file;
  let next = 0;
  const planes = kernel.parameters.map(({ role }) => (role === 'input' ? inputs[next++]! : []));
  const program = alignedProgram(device, source, kernel, domain);
  const targets = formats.map((list) => list.map((format) => device.acquire(format, domain.width, domain.height, 'the results of a reduction')));
  drawDomain(device, program, [], planes, alignedLies(kernel, domain), elements, [], domain, targets);
  return targets;
}

/** Where a stream holds the value of a uniform; null if none does. */
export function heldLie(call: Checked, i: number): Lie {
  const view = call.views[i];
  if (!view) return call.streams[i]?.layout ?? null;
  view.stream.unpack();
  return texelOf(view);
}

/** How each argument lies. */
export function liesOf(kernel: KernelData, call: Checked, shape: readonly number[], elements: readonly Element[]): Lie[] {
  return kernel.parameters.map(({ role, element }, i) => {
    if (role === 'iterator') return iterationOf(elements[element]!, shape);
    if (role === 'uniform') return heldLie(call, i);
    return role === 'input' || role === 'gather' ? call.streams[i]?.layout ?? null : null;
  });
}

/** Whether a call reads the stream of an output, too. */
export function isAlsoRead(kernel: KernelData, i: number, call: Checked): boolean {
  return call.streams.some((other, k) => other === call.streams[i] && isRead(kernel, k, call));
}

/** The planes to draw an output to: its own, or new ones if the call reads it, or if it lies in another way. */
export function targetOf(stream: AnyStream, isAlsoRead: boolean, domain: Layout): Plane[] {
  stream.isGone = false;
  return stream.layout === domain && !isAlsoRead && !stream.isHeld() ? stream.planes : stream.newPlanes(domain);
}
