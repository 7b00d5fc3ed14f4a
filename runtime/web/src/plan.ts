// SPDX-License-Identifier: MIT
//
// Kernels of several passes: runtime/src/gl_device/pass/run_kernel.cpp. Streams are not packed.
import { isRead, type Checked } from './arguments.js';
import type { Device } from './device.js';
import { SkError } from './error.js';
import type { Format } from './format.js';
import type { Features, LoadedFile, PassRunner, Placed } from './features.js';
import type { KernelData, Pass, Plan } from './generated.js';
import type { Plane } from './memory.js';
import { bindOperands, isAlsoRead, liesOf, ProgramSource, smallGather, targetOf } from './pass.js';
import type { Program } from './program.js';
import { kernelKey, viewsKey, type Lie } from './variant.js';

class PlanRunner implements PassRunner {
  private readonly sources: readonly ProgramSource[];
  /** The number of each parameter among spec parameters. */
  private readonly specNumbers: readonly number[];

  constructor(private readonly kernel: KernelData, private readonly plan: Plan, private readonly file: LoadedFile) {
    this.sources = plan.passes.map((pass) => new ProgramSource(kernel.name, file, pass.kernel.programs));
    let number = 0;
    this.specNumbers = kernel.parameters.map(({ role }) => (role === 'spec' ? number++ : -1));
  }

  startPrograms(device: Device): Program[] {
    return this.sources.flatMap((source, i) => source.startPrograms(device, () => this.plan.passes[i]!.kernel));
  }

  run(device: Device, call: Checked, outputs: readonly number[], shape: readonly number[], reason: string | null): void {
    const { elements, features } = this.file;
    let place = reason === null ? this.wholes(call, outputs, shape) : null;
    const lacksProgram = ({ domain, lies }: Placed) =>
      this.plan.passes.some((pass, number) => {
        const own = this.argumentsOf(pass, call, domain, lies);
        return !this.sources[number]!.has(kernelKey(pass.kernel.parameters, elements, own.lies, domain, own.specs, device.filtersFloats));
      });
    const withViews = place === null || lacksProgram(place);
    if (withViews && features.views === undefined) this.sources[0]!.refuse(reason ?? smallGather);
    if (place === null || withViews) place = features.views!(device, this.kernel, call, outputs, shape, elements, false);
    const { domain, lies, begin, finish } = place;
    const keyOf = (pass: Pass, own: Arguments) =>
      withViews ? viewsKey(pass.kernel.parameters, elements, own.lies, domain, own.specs) : kernelKey(pass.kernel.parameters, elements, own.lies, domain, own.specs, device.filtersFloats);
    const runs = this.plan.passes.map((pass, number) => {
      const own = this.argumentsOf(pass, call, domain, lies);
      const key = keyOf(pass, own);
      if (!this.sources[number]!.has(key)) this.sources[number]!.refuse(reason ?? smallGather);
      return { pass, own, program: () => this.sources[number]!.program(device, key, pass.kernel, own.specs, (p) => own.isHeld[p]!) };
    });

    const targets = begin();
    const planesOf = new Map(outputs.map((i, n) => [i, targets[n]!]));
    const temporaries = this.plan.temporaries.map((element) =>
      elements[element]!.fields.map((field) => device.acquire(device.formatOf(field.scalar, field.width), domain.width, domain.height, 'a value saved between passes')),
    );
    const stacks = (this.plan.stacks ?? []).map(([scalar, width, layers]) => copiedLayers(device, device.formatOf(scalar, width), layers.map(([argument, plane]) => call.streams[argument]?.planes[plane])));
    const started = runs.flatMap(({ pass, own, program }) => {
      const drawn = this.drawnBy(pass, temporaries, planesOf);
      return drawn.length === 0 ? [] : [{ pass, own, drawn, program: program() }]; // a pass whose outputs are all omitted is none
    });
    for (const { pass, own, drawn, program } of started) { // the driver has all programs before it is asked for the first one
      device.useProgram(program);
      const planes = pass.operands.map(([isTemporary, i]) => (isTemporary ? temporaries[i]! : call.streams[i]?.planes ?? []));
      bindOperands(device, program, own.values, planes, own.lies, elements, shape);
      for (const [stack, unit] of program.stacks) bindLayers(device, unit, stacks[stack]!);
      program.domain.set(domain);
      device.framebufferOf(drawn);
      device.drawRects(domain.draws);
    }
    finish(targets);
    temporaries.forEach((planes) => device.release(planes));
    for (const texture of stacks) device.context.deleteTexture(texture);
  }

  /** Whole streams of the domain's shape. */
  private wholes(call: Checked, outputs: readonly number[], shape: readonly number[]): Placed {
    const { kernel } = this;
    kernel.parameters.forEach((_, i) => isRead(kernel, i, call) && call.streams[i]!.unpack());
    const domain = call.streams[outputs[0]!]!.layoutIf(false);
    const begin = () => outputs.map((i) => targetOf(call.streams[i]!, isAlsoRead(kernel, i, call), domain));
    const finish = (drawn: readonly Plane[][]) => outputs.forEach((i, n) => call.streams[i]!.exchange(drawn[n]!, domain));
    return { domain, lies: liesOf(kernel, call, shape, this.file.elements), begin, finish };
  }

  /** The arguments of a pass. Temporaries lie as the domain does. */
  private argumentsOf(pass: Pass, call: Checked, domain: Placed['domain'], lies: readonly Lie[]): Arguments {
    const { operands, kernel } = pass;
    return {
      streams: [],
      views: [],
      fits: [],
      values: operands.map(([isTemporary, i]) => (isTemporary ? null : call.values[i]!)),
      specs: operands.flatMap(([isTemporary, i]) => (isTemporary || this.specNumbers[i]! < 0 ? [] : [call.specs[this.specNumbers[i]!]!])),
      lies: operands.map(([isTemporary, i], p) => (!isTemporary ? lies[i]! : kernel.parameters[p]!.role === 'output' ? null : domain)),
      isHeld: operands.map(([isTemporary, i], p) => kernel.parameters[p]!.role === 'uniform' && !isTemporary && call.streams[i] !== null),
    };
  }

  /** The planes that a pass draws to, in order. */
  private drawnBy(pass: Pass, temporaries: readonly (readonly Plane[])[], targets: ReadonlyMap<number, readonly Plane[]>): Plane[] {
    return pass.kernel.parameters.flatMap((parameter, p) => {
      if (parameter.role !== 'output') return [];
      const [isTemporary, i] = pass.operands[p]!;
      const planes = (isTemporary ? temporaries[i] : targets.get(i)) ?? [];
      const first = parameter.firstPlane ?? 0;
      return planes.slice(first, first + (parameter.planeCount ?? planes.length));
    });
  }
}

export const plans: Features['plans'] = (kernel, plan, file) => new PlanRunner(kernel, plan, file);

interface Arguments extends Checked {
  readonly lies: readonly Lie[];
  readonly isHeld: readonly boolean[];
}

/** Binds an array texture; a unit may have it beside a texture of the other kind. */
function bindLayers(device: Device, unit: number, texture: WebGLTexture): void {
  const gl = device.context;
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
  device.bindFilter(unit, null);
}

/** An array texture with these planes, which have one format, as layers; those of omitted streams are undefined. */
function copiedLayers(device: Device, format: Format, planes: readonly (Plane | undefined)[]): WebGLTexture {
  const gl = device.context;
  const given = planes.filter((plane): plane is Plane => plane !== undefined);
  const [width, height] = [Math.max(1, ...given.map((plane) => plane.width)), Math.max(1, ...given.map((plane) => plane.height))];
  const texture = gl.createTexture();
  if (texture === null) throw new SkError('there is no memory for inputs that share a texture', 'memory');
  bindLayers(device, 0, texture);
  gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, format.internal, width, height, planes.length);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D_ARRAY, name, gl.NEAREST);
  planes.forEach((plane, layer) => {
    if (plane === undefined) return;
    device.framebufferOf([plane]);
    gl.copyTexSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, layer, 0, 0, plane.width, plane.height);
  });
  return texture;
}
