// SPDX-License-Identifier: MIT
//
// Kernels of several passes: runtime/src/gl_device/pass/multipass_plan.cpp for whole streams, which are not packed.
import type { Checked } from './arguments.js';
import type { Device, Plane } from './device.js';
import type { GeneratedFile, KernelData, Pass, Plan } from './generated.js';
import { bindOperands, isRead, liesOf, ProgramSource, targetOf } from './kernel.js';
import type { Program } from './program.js';
import { kernelKey } from './variant.js';

export class PlanRunner {
  private readonly sources: readonly ProgramSource[];
  /** The number of each parameter among spec parameters. */
  private readonly specNumbers: readonly number[];

  constructor(private readonly kernel: KernelData, private readonly plan: Plan, private readonly file: GeneratedFile, texts: readonly string[]) {
    this.sources = plan.passes.map((pass) => new ProgramSource(pass.kernel.name, file, texts, pass.kernel.programs));
    let number = 0;
    this.specNumbers = kernel.parameters.map(({ role }) => (role === 'spec' ? number++ : -1));
  }

  start(device: Device): Program[] {
    return this.sources.flatMap((source, i) => source.start(device, () => this.plan.passes[i]!.kernel));
  }

  run(device: Device, call: Checked, outputs: readonly number[], shape: readonly number[]): void {
    const { kernel, plan } = this;
    const { elements } = this.file;
    kernel.parameters.forEach((_, i) => isRead(kernel, i, call) && call.streams[i]!.unpack());
    const domain = call.streams[outputs[0]!]!.layoutIf(false);
    const lies = liesOf(kernel, call, shape, elements);
    const targets = new Map(outputs.map((i) => [i, targetOf(kernel, i, call, domain)]));
    const temporaries = plan.temporaries.map((element) =>
      elements[element]!.fields.map((field) => device.acquire(device.formatOf(field.scalar, field.width), domain.width, domain.height, 'a value saved between passes')),
    );
    plan.passes.forEach((pass, number) => {
      const drawn = this.drawnBy(pass, temporaries, new Map([...targets].map(([i, { planes }]) => [i, planes])));
      if (drawn.length === 0) return; // all of its outputs are omitted
      const own: Checked = {
        streams: [],
        values: pass.operands.map(([isTemporary, i]) => (isTemporary ? null : call.values[i]!)),
        specs: pass.operands.flatMap(([isTemporary, i]) => (isTemporary || this.specNumbers[i]! < 0 ? [] : [call.specs[this.specNumbers[i]!]!])),
      };
      const ownLies = pass.operands.map(([isTemporary, i], p) => {
        if (isTemporary) return pass.kernel.parameters[p]!.role === 'output' ? null : domain;
        return lies[i]!;
      });
      const planes = pass.operands.map(([isTemporary, i]) => (isTemporary ? temporaries[i]! : call.streams[i]?.planes ?? []));
      const key = kernelKey(pass.kernel.parameters, elements, ownLies, domain, own.specs, device.filtersFloats);
      const program = this.sources[number]!.program(device, key, pass.kernel, own.specs);
      device.useProgram(program);
      bindOperands(device, program, own, planes, ownLies, elements, shape);
      program.domain.set(domain);
      device.framebufferOf(drawn);
      device.drawRects(domain.draws);
    });
    for (const { stream, planes } of targets.values()) {
      if (planes !== stream.planes) stream.exchange(planes, domain);
    }
    temporaries.forEach((planes) => device.release(planes));
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
