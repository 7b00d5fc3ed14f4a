// SPDX-License-Identifier: MIT
//
// Tests a device's arithmetic on floats, as runtime/src/probe does: what compensated, exact and extended sums rest on.
import type { Arithmetic } from './abilities.js';
import type { Context } from './context.js';
import { formatOf } from './format.js';

const pairs: readonly (readonly [number, number])[] = [
  [1, 2 ** -24], [1, -(2 ** -25)], [2 ** 24, 3], [2 ** 25, 3], [0, 1234.5], [1234.5, -1234.5], [2 - 2 ** -23, 2 ** -24], [2 ** 63, -(2 ** 62)],
  [2 / 3, 3], [0.1, 10], [Math.PI, Math.E], [2 - 2 ** -23, 2 - 2 ** -23], [16777215, 16777215], [-16777215, 16777213],
].map(([x, y]) => [Math.fround(x!), Math.fround(y!)]);
const smallest = 2 ** -149;

// keep() hides a value from optimisers, as in the programs that skc writes.
const text = `#version 300 es
precision highp float;
precision highp int;
uniform vec2 x;
uniform uint zero;
out vec4 r;
float keep(float v) { return uintBitsToFloat(floatBitsToUint(v) ^ zero); }
void main() {
  float s = keep(x.x + x.y), t = keep(s - x.x), u = keep(s - t), e = keep(x.x - u), f = keep(x.y - t);
  float p = keep(x.x * x.y);
  vec2 h = uintBitsToFloat(floatBitsToUint(x) & 0xfffff000u), l = vec2(keep(x.x - h.x), keep(x.y - h.y));
  float g = keep(h.x * h.y - p);
  g = keep(g + h.x * l.y);
  g = keep(g + l.x * h.y);
  r = vec4(s, keep(e + f), p, keep(g + l.x * l.y));
}
`;

function isExact([x, y]: readonly [number, number], [sum, lostOfSum, product, lostOfProduct]: readonly number[]): boolean {
  const [s, p] = [Math.fround(x + y), Math.fround(x * y)]; // a double represents every product of two floats
  const back = Math.fround(s - x);
  const lost = Math.fround(Math.fround(x - Math.fround(s - back)) + Math.fround(y - back));
  return sum === s && lostOfSum === lost && product === p && lostOfProduct === Math.fround(x * y - p);
}

/** Waits for the device. Streams of halves hold no rounding errors. */
export function arithmeticOf(device: Context): Arithmetic {
  if (device.abilities.floats === 'half') return { exactSums: false, keepsSubnormals: false };
  device.begin();
  const gl = device.context;
  const target = device.acquire(formatOf('float', 4), pairs.length + 1, 1, 'a test of arithmetic');
  const program = device.program(arithmeticOf, '', 'a test of arithmetic', () => text, [], [], () => true);
  device.useProgram(program);
  const location = gl.getUniformLocation(program.handle, 'x');
  device.framebufferOf([target]);
  [...pairs, [smallest, 0] as const].forEach(([a, b], i) => {
    gl.uniform2f(location, a, b);
    device.drawRects([{ x: i, y: 0, width: 1, height: 1 }]);
  });
  const found = new Float32Array(4 * (pairs.length + 1));
  gl.readPixels(0, 0, pairs.length + 1, 1, gl.RGBA, gl.FLOAT, found);
  device.release([target]);
  return {
    exactSums: pairs.every((pair, i) => isExact(pair, [...found.subarray(4 * i, 4 * i + 4)])),
    keepsSubnormals: found[4 * pairs.length] === smallest,
  };
}
