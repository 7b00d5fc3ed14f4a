// SPDX-License-Identifier: MIT
//
// Shows a stream in a canvas: one fragment program, and a transfer of the picture between canvases, which stays on the device.
import { colourMaps, type ColourMap } from './colour_maps.js';
import type { Canvas } from './abilities.js';
import type { Context } from './context.js';
import { SkError } from './error.js';
import { formatOf, is64Bit } from './format.js';
import { lanes, shapeText } from './layout.js';
import type { Program } from './program.js';
import { Stream } from './stream.js';

export interface DrawOptions {
  /** Colours of numbers: 'viridis' by default. */
  readonly map?: ColourMap;
  /** The numbers at both ends of the map: 0 and 1 by default. */
  readonly range?: readonly [number, number];
  /**
   * How a field of vectors of two components is shown: 'length', by default, as a number; or 'direction' as a hue, red along x,
   * whose brightness is the length in the range.
   */
  readonly vectors?: 'length' | 'direction';
}

const drawKey = {};

/** Elements are found by their number: row by row from the top, as in a picture. */
function drawProgram(device: Context, kind: 'float' | 'int' | 'uint', map: ColourMap): Program {
  const prefix = kind === 'float' ? '' : kind[0]!;
  const colours = colourMaps[map];
  const text = () => `#version 300 es
precision highp float;
precision highp int;
precision highp ${prefix}sampler2D;
uniform ${prefix}sampler2D data;
uniform ivec4 shape;   // width, height, shift of the texture or -1, components
uniform ivec4 place;   // lanes of a texel, width and height of the picture, 1: hues of directions
uniform vec2 range;
out vec4 colour;
const vec3 map[${colours.length}] = vec3[](${colours.map(glslColour).join(', ')});
void main() {
  ivec2 pixel = ivec2(int(gl_FragCoord.x), place.z - 1 - int(gl_FragCoord.y));
  ivec2 at = min(pixel * shape.xy / place.yz, shape.xy - 1);
  int n = at.y * shape.x + at.x, texel = n / place.x, width = shape.x / place.x;
  ivec2 from = shape.z < 0 ? ivec2(texel % width, texel / width) : ivec2(texel & ((1 << shape.z) - 1), texel >> shape.z);
  vec4 value = vec4(texelFetch(data, from, 0));
  if (shape.w >= 3) { colour = vec4(value.rgb, 1); return; }
  float x = place.x > 1 ? value[n % place.x] : shape.w == 2 ? length(value.xy) : value.x;
  float t = clamp((x - range.x) / (range.y - range.x), 0.0, 1.0);
  if (place.w == 1 && !isnan(x)) {
    float angle = x == 0.0 ? 0.0 : atan(value.y, value.x);
    colour = vec4(t * (0.5 + 0.5 * cos(angle - vec3(0, 2.0943951, 4.1887902))), 1);
    return;
  }
  t *= ${(colours.length - 1).toFixed(1)};
  int i = min(int(t), ${colours.length - 2});
  colour = isnan(x) ? vec4(0.5, 0.5, 0.5, 1) : vec4(mix(map[i], map[i + 1], t - float(i)), 1);
}
`;
  return device.program(drawKey, kind + map, 'draw', text, [], [], () => true);
}

function glslColour(hex: string): string {
  const part = (at: number) => (parseInt(hex.slice(at, at + 2), 16) / 255).toFixed(4);
  return `vec3(${part(0)}, ${part(2)}, ${part(4)})`;
}

export function drawStream(device: Context, stream: Stream<any, number>, canvas: Canvas, options: DrawOptions): void {
  const { map = 'viridis', range = [0, 1], vectors = 'length' } = options;
  if (!(stream instanceof Stream)) throw new SkError('what is drawn is no stream; make one by device.stream()', 'type');
  if (typeof canvas?.getContext !== 'function') throw new SkError('the picture needs a canvas, an HTMLCanvasElement or an OffscreenCanvas', 'type');
  stream.check('the stream');
  if (stream.device !== device) throw new SkError('the stream belongs to another device; draw it with its own', 'device');
  if (!(map in colourMaps)) throw new SkError(`there is no colour map '${String(map)}'; use ${Object.keys(colourMaps).join(', ')}`);
  if (!range.every(Number.isFinite) || range[0] === range[1]) throw new SkError('the range of a picture needs two different, finite numbers');
  const shape = stream.shape as readonly number[];
  const [field] = stream.element.fields;
  if (shape.length > 2 || stream.size === 0) throw new SkError(`a stream of shape ${shapeText(shape)} is no picture: draw one of two dimensions`, 'shape');
  if (stream.element.fields.length > 1 || is64Bit(field!.scalar)) {
    throw new SkError(`elements of ${stream.element.name} are no colours; draw numbers, or vectors of floats`, 'type');
  }
  if (vectors !== 'length' && vectors !== 'direction') throw new SkError(`vectors are shown by 'length' or 'direction', not by '${String(vectors)}'`);
  if (vectors === 'direction' && field!.width !== 2) throw new SkError(`${stream.element.name} has no direction; draw vectors of two components by it`, 'type');
  if (canvas.width === 0 || canvas.height === 0) throw new SkError('the canvas has no pixels', 'shape');

  const isOwn = canvas === device.canvas;
  if (!isOwn && !device.hasHiddenCanvas) {
    throw new SkError('this device draws to the canvas that it was made with; for other canvases, make one without a canvas and a context');
  }
  device.begin();
  const { width, height } = canvas;
  if (!isOwn) resize(device.canvas, width, height);
  const program = drawProgram(device, formatOf(field!.scalar, 1).sampler, map);
  device.useProgram(program);
  device.bindTexture(0, stream.planes[0]!.texture);
  device.bindFilter(0, null);
  const { layout } = stream;
  const gl = device.context;
  program.setInteger('shape', [layout.extent[0], layout.extent[1], layout.linear ? layout.shift : -1, field!.width]);
  program.setInteger('place', [layout.packed ? lanes : 1, width, height, vectors === 'direction' ? 1 : 0]);
  gl.uniform2f(gl.getUniformLocation(program.handle, 'range'), range[0], range[1]);
  device.bindFramebuffer(null);
  device.drawRects([{ x: 0, y: 0, width, height }]);
  if (!isOwn) transfer(device, canvas);
}

/** A canvas is cleared when its size is set, so that this must come before the drawing, and only where it changes. */
function resize(canvas: Canvas, width: number, height: number): void {
  if (canvas.width < width) canvas.width = width;
  if (canvas.height < height) canvas.height = height;
}

/** Hands the picture on to another canvas. The device's canvas may be larger: its lower left corner holds the picture. */
function transfer(device: Context, canvas: Canvas): void {
  const own = device.canvas;
  const { width, height } = canvas;
  const drawing = canvas.getContext('2d') as CanvasRenderingContext2D | null;
  if (drawing === null) {
    throw new SkError("the canvas has a context other than '2d', which takes no pictures; draw to a canvas without one, or make the device of its context");
  }
  drawing.drawImage(own as unknown as CanvasImageSource, 0, own.height - height, width, height, 0, 0, width, height);
}
