// SPDX-License-Identifier: MIT
//
// Calls with views, with inputs that repeat or are fitted, and with gathers smaller than the domain: one program takes them
// all, which [[variants(views)]] asks for. It addresses every stream as a view, without packing.
import { fail, isRead, iterationOf, shapeAt, type AnyStream, type Checked } from './arguments.js';
import { copyRegion, drawsOf, type Region } from './copy.js';
import type { Device, Plane } from './device.js';
import type { Element, KernelData, Parameter } from './generated.js';
import { shapeText, stridesOf, xFirst, type Layout } from './layout.js';
import { heldLie } from './kernel.js';
import type { Lie } from './variant.js';
import { regionOf, strided, viewOf, type Fitted, type View } from './view.js';

/** How an input of this shape is read over a domain, in each dimension (Layout.ratio); 0 where it does not fit. */
function ratioOf(shape: readonly number[], domain: readonly number[], fit: Fitted<any> | null): number[] {
  return domain.map((extent, d) => {
    const own = shape[d]!;
    if (own === extent) return 1;
    if (fit === null) return own === 1 ? Math.max(extent, 1) : 0;
    if (domain.includes(0)) return 1;
    if (fit.stretches && extent % own === 0) return extent / own;
    return fit.strides && own > 0 && own % extent === 0 ? -own / extent : 0;
  });
}

/** Throws SkError unless an input fits the domain. Returns whether it has the domain's own shape. */
export function checkInput(kernel: KernelData, i: number, call: Checked, domain: readonly number[], output: Parameter): boolean {
  const { name } = kernel.parameters[i]!;
  const shape = shapeAt(call, i);
  const fit = call.fits[i]!;
  const isOfRank = shape.length === domain.length;
  if (isOfRank && shape.every((extent, d) => extent === domain[d])) return true;
  if (isOfRank && !ratioOf(shape, domain, fit).includes(0)) return false;
  const need = `'${name}' has shape ${shapeText(shape)}, and the domain ${shapeText(domain)}; to`;
  if (fit?.stretches && fit.strides) return fail(kernel.name, `${need} stretch and stride it, each of its extents must divide the domain's or be a multiple of it`, 'shape');
  if (fit?.stretches) return fail(kernel.name, `${need} stretch it, each of its extents must divide the domain's`, 'shape');
  if (fit?.strides) return fail(kernel.name, `${need} stride through it, each of its extents must be a multiple of the domain's`, 'shape');
  return fail(
    kernel.name,
    `'${name}' has shape ${shapeText(shape)}, but the output '${output.name}' has ${shapeText(domain)}; give them the same shape, or extent 1 where '${name}' repeats`,
    'shape',
  );
}

/** Throws SkError if two outputs write one element. */
export function checkDisjoint(kernel: KernelData, call: Checked, outputs: readonly number[]): void {
  for (const i of outputs) {
    for (const k of outputs) {
      if (k >= i || call.streams[i] !== call.streams[k] || !overlap(viewAt(call, k), viewAt(call, i))) continue;
      const nameOf = (n: number) => kernel.parameters[n]!.name;
      const wholes = call.views[i] || call.views[k] ? 'overlap: both write elements of one stream; give them different streams, or views that have no element in common' : 'are one stream; give them different streams';
      fail(kernel.name, `the outputs '${nameOf(k)}' and '${nameOf(i)}' ${wholes}`);
    }
  }
}

function viewAt(call: Checked, i: number): View<any, number> {
  return call.views[i] ?? viewOf(call.streams[i]!);
}

/** Whether views of one stream may have an element in common: in each dimension, their indices meet. */
function overlap(a: View<any, number>, b: View<any, number>): boolean {
  return a.size > 0 && b.size > 0 && a.begin.every((first, d) => {
    const [other, m, n] = [b.begin[d]!, a.shape[d]!, b.shape[d]!] as [number, number, number];
    const [s, t] = [a.steps[d]!, b.steps[d]!];
    if (first + (m - 1) * s < other || other + (n - 1) * t < first) return false;
    return s !== t || (first - other) % s === 0;
  });
}

/** The streams of such a call. */
export interface Placed {
  readonly domain: Layout;
  readonly lies: readonly Lie[];
  /** For each output, the planes to draw to. */
  begin(): readonly Plane[][];
  /** Puts what was drawn to them where the outputs are. */
  finish(drawn: readonly Plane[][]): void;
}

/** Unpacks all streams. `mayBePart`: the domain may be a part of its textures, if the outputs are the same box of theirs. */
export function placed(device: Device, kernel: KernelData, call: Checked, outputs: readonly number[], shape: readonly number[], elements: readonly Element[], mayBePart: boolean): Placed {
  const { parameters } = kernel;
  const readStreams = new Set<AnyStream>();
  parameters.forEach((_, i) => {
    if (!isRead(kernel, i, call)) return;
    call.streams[i]!.unpack();
    readStreams.add(call.streams[i]!);
  });
  for (const i of outputs) {
    if (!call.views[i]) continue;
    call.streams[i]!.unpack();
    call.streams[i]!.own();
  }
  const lies = parameters.map((parameter, i): Lie => {
    if (parameter.role === 'iterator') return iterationOf(elements[parameter.element]!, shape);
    if (parameter.role === 'uniform') return heldLie(call, i);
    if (!isRead(kernel, i, call)) return null;
    const view = viewAt(call, i);
    if ((parameter.role === 'gather' ? parameter.rank !== 2 : shape.length !== 2) !== view.stream.layout.linear) {
      fail(kernel.name, `'${parameter.name}' has more than ${device.limits.textureSize} elements in a dimension, where browsers have no programs for views; divide the stream`, 'shape');
    }
    return strided(view, xFirst(parameter.role === 'input' ? ratioOf(view.shape as readonly number[], shape, call.fits[i]!) : []));
  });
  const box = mayBePart ? boxOf(call, outputs, readStreams) : null;
  const domain = box ?? device.layoutOf(shape, false);
  const begin = () =>
    outputs.map((i) => {
      const stream = call.streams[i]!;
      if (!call.views[i]) stream.isGone = false;
      const isInPlace = box !== null || (!call.views[i] && stream.layout === domain && !readStreams.has(stream) && !stream.isHeld());
      return isInPlace ? stream.planes : stream.newPlanes(domain);
    });
  const finish = (drawn: readonly Plane[][]) =>
    outputs.forEach((i, n) => {
      const [stream, view, planes] = [call.streams[i]!, call.views[i], drawn[n]!];
      if (planes === stream.planes) return;
      if (!view) return stream.exchange(planes, domain);
      copyRegion(device, xFirst(shape), wholeRegion(planes, domain), regionOf(view));
      device.release(planes);
    });
  return { domain, lies, begin, finish };
}

function wholeRegion(planes: readonly Plane[], { extent, width, linear }: Layout): Region {
  return { planes, first: 0, strides: stridesOf(extent), width, linear };
}

/** The domain if all outputs are the same box of streams that lie alike, and that the call does not read. */
function boxOf(call: Checked, outputs: readonly number[], readStreams: ReadonlySet<AnyStream>): Layout | null {
  const first = call.views[outputs[0]!];
  if (!first) return null;
  const { layout } = first.stream;
  for (const i of outputs) {
    const view = call.views[i];
    const isAlike = view?.isBox() && view.stream.layout === layout && view.begin.every((start, d) => start === first.begin[d]);
    const isAlone = !readStreams.has(call.streams[i]!) && outputs.every((k) => k === i || call.streams[k] !== call.streams[i]);
    if (!isAlike || !isAlone) return null;
  }
  const extent = xFirst(first.shape as readonly number[]);
  const begin = first.begin;
  const at = (d: number) => begin[begin.length - 1 - d] ?? 0;
  return { ...layout, extent, origin: [at(0), at(1), at(2), at(3)], draws: drawsOf(extent, regionOf(first)) };
}
