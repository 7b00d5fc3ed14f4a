// SPDX-License-Identifier: MIT
//
// Calls of kernels with variable and scatter outputs: runtime/src/gl_device/append/append_call.cpp for whole streams.
// The kernel runs once to count the pushes of each element, and once for each list, whose entries find their elements. How
// long a list is must be read back, without blocking: until then, the call holds the planes that it reads, so that later
// calls which write those streams draw to others.
import { deviceOf, fail, isRead, isSameShape, stepsOf, withoutViews, type Checked } from './arguments.js';
import type { Device } from './device.js';
import type { Features, LoadedFile, ListCaller } from './features.js';
import { isNeeded, type CallableKernel, type List, type PointStep } from './generated.js';
import { shapeText, sizeOf, stridesOf, type Layout } from './layout.js';
import type { Plane } from './memory.js';
import { checkOver, failWithoutDomain, type GivenDomain } from './over.js';
import { bindOperands, isAlsoRead, liesOf, ProgramSource, targetOf } from './pass.js';
import type { Program } from './program.js';
import { mostPushes, Pyramid } from './pyramid.js';
import { Scatterer } from './scatter.js';
import { kernelKey, listKey, type Lie } from './variant.js';

/** A call whose lists are yet to be drawn. */
interface Begun {
  readonly device: Device;
  readonly call: Checked;
  readonly shape: readonly number[];
  readonly domain: Layout;
  readonly lies: readonly Lie[];
  /** The planes of each stream when the call was made. */
  readonly planes: readonly (readonly Plane[])[];
  readonly held: Plane[];
  readonly pyramids: ReadonlyMap<List, Pyramid>;
}

interface DrawnList {
  readonly list: List;
  readonly planes: Plane[];
  readonly layout: Layout;
  readonly length: number;
}

class AppendCaller implements ListCaller {
  /** Counts, and writes the other outputs. */
  private readonly counting: ProgramSource;
  private readonly sources: ReadonlyMap<List, ProgramSource>;
  private readonly lists: readonly List[];
  private readonly isCounted: boolean;

  constructor(private readonly kernel: CallableKernel, private readonly file: LoadedFile) {
    this.lists = kernel.lists!;
    this.counting = new ProgramSource(kernel.name, file, kernel.programs);
    this.sources = new Map(this.lists.map((list) => [list, new ProgramSource(kernel.name, file, list.programs)]));
    this.isCounted = this.lists.some(({ slots }) => slots === undefined);
  }

  startPrograms(device: Device): Program[] {
    const { kernel } = this;
    const sources = [this.counting, ...this.sources.values()].flatMap((source) => source.startPrograms(device, () => kernel));
    const steps = this.lists.flatMap((list) => Object.keys(list.points ?? {}).map((step) => this.pointProgram(device, list, step as PointStep)));
    return [...sources, ...steps, ...(kernel.sums ?? []).map((_, i) => this.sumProgram(device, i))];
  }

  /** Runs the kernel; promises that the streams have their elements if the number of pushes must be counted. */
  call(given: Checked, over: GivenDomain | null): void | Promise<void> {
    const { name, parameters } = this.kernel;
    parameters.forEach((parameter, i) => {
      const isRead = parameter.role === 'input' || parameter.role === 'gather';
      if (given.fits[i] || (given.views[i] && !isRead)) fail(name, `'${parameter.name}' of a kernel that pushes or scatters is no view, and fitted to nothing; give a stream`, 'type');
      if (parameter.role === 'uniform' && given.streams[i]) fail(name, `'${parameter.name}' of a kernel that pushes or scatters is a value; read the stream, and give its value`, 'type');
    });
    const { call, copies } = withoutViews(given); // lists have no programs for views
    const done = this.callWhole(call, over);
    for (const copy of copies) copy.dispose(); // the call holds their planes as long as it reads them
    return done;
  }

  private callWhole(call: Checked, over: GivenDomain | null): void | Promise<void> {
    if (this.isCounted) return this.callCounted(call, over);
    const begun = this.begin(call, over);
    if (begun === null) return;
    try {
      this.finish(begun, new Map());
    } finally {
      begun.device.letGo(begun.held);
    }
  }

  private async callCounted(call: Checked, over: GivenDomain | null): Promise<void> {
    const begun = this.begin(call, over);
    if (begun === null) return;
    const { device, pyramids } = begun;
    const written = this.lists.map(({ parameter }) => call.streams[parameter]!);
    written.forEach((stream) => (stream.isAwaited = true));
    try {
      const totals = await Promise.all([...pyramids].map(async ([list, pyramid]) => [list, await pyramid.total()] as const));
      device.begin();
      this.finish(begun, new Map(totals));
    } finally {
      written.forEach((stream) => (stream.isAwaited = false));
      device.letGo(begun.held);
      pyramids.forEach((pyramid) => pyramid.release());
    }
  }

  /** Draws the other outputs, and the counts. Returns null if there are no elements. */
  private begin(call: Checked, over: GivenDomain | null): Begun | null {
    const { kernel } = this;
    const { elements } = this.file;
    const device = deviceOf(kernel, call.streams, over);
    const outputs = kernel.parameters.flatMap((parameter, i) => (parameter.role === 'output' && isNeeded(parameter, call.specs) ? [i] : []));
    const shape = this.checkShapes(call, device, outputs, over);
    device.begin();
    if (sizeOf(shape) === 0) {
      this.lists.forEach((list) => list.op === undefined && call.streams[list.parameter]!.take([], device.layoutOf([0], false), [0]));
      return null;
    }
    kernel.parameters.forEach(({ role }, i) => (role === 'scatter' || isRead(kernel, i, call)) && call.streams[i]!.unpack());
    const domain = device.layoutOf(shape, false);
    const lies = liesOf(kernel, call, shape, elements);
    const planes = call.streams.map((stream) => stream?.planes ?? []);
    const targets = outputs.map((i) => targetOf(call.streams[i]!, isAlsoRead(kernel, i, call), domain));
    const counted = this.lists.filter(({ slots }) => slots === undefined);
    const counts = counted.map(() => device.acquire(device.formatOf('int', 1), domain.width, domain.height, 'the numbers of what a kernel pushes'));
    const drawn = [...targets.flat(), ...counts];
    if (drawn.length > 0) {
      const key = kernelKey(kernel.parameters, elements, lies, domain, call.specs, device.filtersFloats);
      const program = this.counting.program(device, key, kernel, call.specs);
      device.useProgram(program);
      bindOperands(device, program, call.values, planes, lies, elements, shape);
      setTargets(program, call);
      program.domain.set(domain);
      device.framebufferOf(drawn);
      device.drawRects(domain.draws);
    }
    const pyramids = new Map(counted.map((list, i) => [list, new Pyramid(device, counts[i]!, domain, this.sumProgram(device, 0), this.sumProgram(device, 1))]));
    device.release(counts);
    const held = device.hold(planes.flatMap((own, i) => (isRead(kernel, i, call) ? own : [])));
    outputs.forEach((i, n) => call.streams[i]!.exchange(targets[n]!, domain));
    return { device, call, shape, domain, lies, planes, held, pyramids };
  }

  /** Draws the lists, all of them before any stream changes, and then hands them over to the streams. */
  private finish(begun: Begun, totals: ReadonlyMap<List, number>): void {
    const { device, call, shape } = begun;
    const drawn = this.lists.map((list): DrawnList => {
      const { name } = this.kernel.parameters[list.parameter]!;
      const length = totals.get(list) ?? list.slots! * sizeOf(shape);
      if (length > mostPushes) fail(this.kernel.name, `it pushes or scatters to '${name}' more than ${mostPushes} values in one call; divide the domain`, 'shape');
      return this.drawList(begun, list, length);
    });
    device.letGo(begun.held);
    for (const { list, planes, layout, length } of drawn) {
      const stream = call.streams[list.parameter]!;
      if (list.op === undefined) {
        stream.take(planes, layout, [length]);
        continue;
      }
      if (length > 0 && stream.size > 0) new Scatterer(device, list, (step) => this.pointProgram(device, list, step), planes, layout, length, stream).run();
      device.release(planes);
    }
  }

  private drawList(begun: Begun, list: List, length: number): DrawnList {
    const { kernel, file } = this;
    const { elements } = file;
    const { device, call, shape, domain, lies } = begun;
    const layout = device.layoutOf([length], false);
    if (length === 0) return { list, planes: [], layout, length };
    const parameter = kernel.parameters[list.parameter]!;
    const formats = elements[parameter.held ?? parameter.element]!.fields.map(({ scalar, width }) => device.formatOf(scalar, width));
    if (list.op !== undefined) formats.unshift(device.formatOf('int', 2));
    const planes = formats.map((format) => device.acquire(format, layout.width, roomFor(layout.height, device), 'what a kernel pushes or scatters'));
    const key = listKey(kernel.parameters, elements, lies, domain, call.specs, device.filtersFloats);
    const program = this.sources.get(list)!.program(device, key, kernel, call.specs);
    device.useProgram(program);
    bindOperands(device, program, call.values, begun.planes, lies, elements, shape);
    setTargets(program, call);
    begun.pyramids.get(list)?.bind(program, program.units);
    program.domain.set({ ...layout, extent: domain.extent, stride: stridesOf(domain.extent) });
    device.framebufferOf(planes);
    device.drawRects(layout.draws);
    return { list, planes, layout, length };
  }

  private pointProgram(device: Device, list: List, step: PointStep): Program {
    const hasPoints = ['store', 'addLimbs', 'upper', 'lower'].includes(step);
    const vertices = hasPoints ? this.file.texts[this.kernel.vertices!] : undefined;
    return device.program(list, step, this.kernel.name, () => this.file.texts[list.points![step]!]!, [], [], () => true, vertices);
  }

  /** The program of the pyramid's first level, or of the others. */
  private sumProgram(device: Device, i: number): Program {
    return device.program(this, `sums ${i}`, 'sums of counts', () => this.file.texts[this.kernel.sums![i]!]!, [], [], () => true);
  }

  /** The shape of the domain. */
  private checkShapes(call: Checked, device: Device, outputs: readonly number[], over: GivenDomain | null): readonly number[] {
    const { kernel } = this;
    const { name, parameters } = kernel;
    const nameOf = (i: number) => parameters[i]!.name;
    const inputs = parameters.flatMap(({ role }, i) => (role === 'input' && isRead(kernel, i, call) ? [i] : []));
    const domains = [...outputs, ...inputs];
    const first = domains[0];
    if (first !== undefined) checkOver(kernel, over, first, call.streams[first]!.shape as readonly number[]);
    const shape = first === undefined ? (over ?? failWithoutDomain(name)).shape : (call.streams[first]!.shape as readonly number[]);
    for (const i of domains) {
      const other = call.streams[i]!.shape as readonly number[];
      if (!isSameShape(other, shape)) fail(name, `'${nameOf(i)}' has shape ${shapeText(other)}, but '${nameOf(first!)}' has ${shapeText(shape)}; give them the same shape`, 'shape');
    }
    const written = [...outputs, ...this.lists.map(({ parameter }) => parameter)];
    written.forEach((i, number) => {
      const earlier = written.slice(0, number).find((k) => call.streams[k] === call.streams[i]);
      if (earlier !== undefined) fail(name, `the outputs '${nameOf(earlier)}' and '${nameOf(i)}' are one stream; give them different streams`);
    });
    for (const { parameter, op } of this.lists) {
      const stream = call.streams[parameter]!.shape as readonly number[];
      if (op === undefined) {
        if (stream.length !== 1) fail(name, `'${nameOf(parameter)}' is a variable output, but its stream has shape ${shapeText(stream)}; give it one of one dimension`, 'shape');
        continue;
      }
      const { rank } = parameters[parameter]!;
      if (stream.length !== rank) fail(name, `'${nameOf(parameter)}' is declared with ${rank} dimension(s), but its stream has shape ${shapeText(stream)}`, 'shape');
      if (op !== 'store' && !device.abilities.combinesScattered) {
        fail(
          name,
          `'${nameOf(parameter)}' combines what is scattered to it, but this device does not blend 32-bit floats (EXT_float_blend); ` +
            'push indices and values to variable outputs, and combine them in a kernel',
          'device',
        );
      }
    }
    parameters.forEach((parameter, i) => {
      if (parameter.role === 'iterator') stepsOf(name, parameter, this.file.elements[parameter.element]!, call.values[i]!, shape);
    });
    return shape;
  }
}

export const lists: Features['lists'] = (kernel, file) => new AppendCaller(kernel, file);

/** Gives a program the layouts of scatter outputs: their shapes are what extentof() says. */
function setTargets(program: Program, call: Checked): void {
  for (const { index, layout } of program.targets) layout!.set(call.streams[index]!.layout);
}

/** Rows of a list's texture. Few heights occur, so that lists of many lengths share textures. */
function roomFor(height: number, device: Device): number {
  const step = 2 ** Math.max(0, Math.floor(Math.log2(height)) - 2);
  return Math.min(Math.ceil(height / step) * step, device.limits.textureSize);
}

