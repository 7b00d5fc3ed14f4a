// SPDX-License-Identifier: MIT
//
// Stores the list of a scatter output to its stream, entry by entry, as points: the steps of
// runtime/src/gl_device/append/scatter_lists.cpp. Devices blend floats only; integers are taken apart into floats that
// stay exact.
import type { Device } from './device.js';
import type { List, PointStep } from './generated.js';
import type { Layout } from './layout.js';
import type { Plane } from './memory.js';
import type { Program } from './program.js';
import type { AnyStream } from './arguments.js';

/** How points are combined with stored texels. */
type Blend = 'add' | 'min' | 'max';

/** The most points in one draw of limbs of 8 bits, whose sums are exact in floats. */
const mostLimbPoints = 2 ** 16 - 1;

export class Scatterer {
  private readonly width: number;

  /** `planes` are those of the list: the target texels, then the values. */
  constructor(
    private readonly device: Device, private readonly list: List, private readonly program: (step: PointStep) => Program,
    private readonly planes: readonly Plane[], private readonly layout: Layout, private readonly length: number,
    private readonly stream: AnyStream,
  ) {
    this.width = stream.element.fields[0]!.width;
  }

  run(): void {
    this.stream.own();
    const { op, points } = this.list;
    if ('store' in points!) this.points('store', op === 'store' ? null : op!, this.stream.planes, 0, this.length);
    else if (op === 'add') this.addIntegers();
    else this.extremeIntegers();
  }

  private floats(width: number, count: number): Plane[] {
    const { width: w, height: h } = this.stream.planes[0]!;
    return Array.from({ length: count }, () => this.device.acquire(this.device.formatOf('float', width), w, h, 'a scatter output of integers'));
  }

  private addIntegers(): void {
    const limbs = this.floats(4, this.width);
    for (let first = 0; first < this.length; first += mostLimbPoints) {
      this.region('splitLimbs', limbs);
      this.points('addLimbs', 'add', limbs, first, Math.min(mostLimbPoints, this.length - first));
      this.region('joinLimbs', this.stream.planes, limbs);
    }
    this.device.release(limbs);
  }

  /** The upper halves of the words first, then the lower halves of those whose upper half is the result. */
  private extremeIntegers(): void {
    const [upper, lower] = [this.floats(this.width, 1), this.floats(this.width, 1)];
    this.region('splitUpper', upper);
    this.points('upper', 'max', upper, 0, this.length);
    this.region('splitLower', lower, upper);
    this.points('lower', 'max', lower, 0, this.length, upper);
    this.region('joinHalves', this.stream.planes, [...upper, ...lower]);
    this.device.release([...upper, ...lower]);
  }

  /** Binds the list or the elements, and the results of earlier steps behind them. The step does not read what it draws to. */
  private use(step: PointStep, values: readonly Plane[], earlier: readonly Plane[]): Program {
    const { device, stream } = this;
    const program = this.program(step);
    device.useProgram(program);
    device.bindPlane(0, this.planes[0]!);
    program.setInteger('sk_targets', 0);
    const { symbol } = this.list;
    const { fields } = stream.element;
    let unit = 1;
    values.forEach((plane, i) => {
      program.setInteger(fields.length === 1 ? `sk_tex_${symbol}` : `sk_tex${i}_${symbol}`, unit);
      device.bindPlane(unit++, plane);
    });
    earlier.forEach((plane, i) => {
      program.setInteger(step === 'joinLimbs' ? `sk_limbs${i}` : i === 0 ? 'sk_upper' : 'sk_lower', unit);
      device.bindPlane(unit++, plane);
    });
    return program;
  }

  private points(step: PointStep, blend: Blend | null, targets: readonly Plane[], first: number, count: number, earlier: readonly Plane[] = []): void {
    const program = this.use(step, this.planes.slice(1), earlier);
    const { width, height } = targets[0]!;
    program.setInteger('sk_list_shift', this.layout.shift);
    program.setInteger('sk_first', first);
    program.setInteger('sk_size', [width, height, 0, 0]);
    this.device.framebufferOf(targets);
    drawPoints(this.device, count, width, height, blend);
  }

  private region(step: PointStep, targets: readonly Plane[], earlier: readonly Plane[] = []): void {
    const isLast = targets === this.stream.planes;
    this.use(step, isLast ? [] : this.stream.planes, earlier);
    this.device.framebufferOf(targets);
    this.device.drawRects(this.stream.layout.draws);
  }
}

/** Draws points of one texel, in order, to textures of this size; they blend with what is there. */
function drawPoints(device: Device, count: number, width: number, height: number, blend: Blend | null): void {
  const gl = device.context;
  device.setViewport(0, 0, width, height);
  if (blend !== null) {
    gl.enable(gl.BLEND);
    gl.blendEquation({ add: gl.FUNC_ADD, min: gl.MIN, max: gl.MAX }[blend]);
    gl.blendFunc(gl.ONE, gl.ONE);
  }
  device.tracePass(count, () => gl.drawArrays(gl.POINTS, 0, count));
  if (blend !== null) gl.disable(gl.BLEND);
}
