// SPDX-License-Identifier: MIT
//
// Calls with views, with inputs that repeat or are fitted, and with gathers smaller than the domain: one program takes them
// all, which [[variants(views)]] asks for. It addresses every stream as a view, without packing.
import { fail, isRead, iterationOf, type AnyStream, type Checked } from './arguments.js';
import { copyRegion, drawsOf, type Region } from './copy.js';
import type { Device } from './device.js';
import type { Placed } from './features.js';
import type { Element, KernelData } from './generated.js';
import { stridesOf, xFirst, type Layout } from './layout.js';
import type { Plane } from './memory.js';
import { heldLie } from './pass.js';
import { ratioOf, viewAt } from './shapes.js';
import type { Lie } from './variant.js';
import { regionOf, strided } from './stream.js';

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
