// SPDX-License-Identifier: MIT
//
// Measures calls in one page, in turn with WebGL2 by hand, and posts milliseconds. Results are checked. Times of saxpy and of the heat step are
// those of many calls and one transfer to the host, divided by the number of calls.
import { Device } from 'streamkernel';
import { diffuse, saxpy, sum } from './calls.sk.js';
import { gpuJs } from './gpu_js.mjs';

const median = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];
const figures = {};
const mistakes = [];

/** The README's example to a number: programs, one step, the sum. Milliseconds with the context's creation, and after it. */
async function firstResult() {
  const start = performance.now();
  const device = await Device.create();
  const created = performance.now();
  const u = device.stream('float', [512, 512]);
  u.write(new Float32Array(512 * 512).fill(0.5));
  diffuse(0.2, u, u);
  const total = await sum(u);
  const end = performance.now();
  if (Math.abs(total - 131072) > 1) mistakes.push(`the first sum is ${total}`);
  device.dispose();
  return { whole: end - start, after: end - created };
}

/** Microseconds of the host for a call, whose elements take next to no time. */
function hostCost(call, after) {
  const rounds = [];
  for (let i = 0; i < 2000; ++i) call(); // as in a loop: by then the browser has compiled what runs often
  after();
  for (let round = 0; round < 9; ++round) {
    const start = performance.now();
    for (let i = 0; i < 200; ++i) call();
    rounds.push(((performance.now() - start) * 1000) / 200);
    after();
  }
  return median(rounds);
}

/** The milliseconds of work that ends with a transfer to the host. */
async function timed(work) {
  const start = performance.now();
  await work();
  return performance.now() - start;
}

function near(what, value, expected, bound = 1e-3) {
  if (!(Math.abs(value - expected) <= bound)) mistakes.push(`${what} is ${value}, not ${expected}`);
}

/** The work in gpu.js, where npm has fetched it. */
async function rivalOf(n, host) {
  const script = document.createElement('script');
  script.src = 'gpu-browser.min.js';
  const loaded = await new Promise((done) => {
    script.onload = () => done(true);
    script.onerror = () => done(false);
    document.head.append(script);
  });
  return loaded ? gpuJs(globalThis.GPU, n, host, host) : null;
}

/** saxpy in WebGL2 by hand, over texels of four numbers: the same work as ours. */
function byHand(gl, width, height, x, y) {
  const shader = (stage, text) => {
    const made = gl.createShader(stage);
    gl.shaderSource(made, text);
    gl.compileShader(made);
    return made;
  };
  gl.getExtension('EXT_color_buffer_float');
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, '#version 300 es\nvoid main() { gl_Position = vec4(float(gl_VertexID & 1) * 2.0 - 1.0, float(gl_VertexID & 2) - 1.0, 0, 1); }'));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, '#version 300 es\nprecision highp float; precision highp sampler2D; uniform float a; uniform sampler2D x, y; out vec4 r; void main() { ivec2 p = ivec2(gl_FragCoord.xy); r = a * texelFetch(x, p, 0) + texelFetch(y, p, 0); }'));
  gl.linkProgram(program);
  const texture = (data) => {
    const made = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, made);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
    if (data) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl.RGBA, gl.FLOAT, data);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST); // else it reads as 0
    return made;
  };
  const [tx, ty, tr] = [texture(x), texture(y), texture(null)];
  const framebuffer = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, tr, 0);
  const a = gl.getUniformLocation(program, 'a');
  gl.useProgram(program);
  gl.uniform1i(gl.getUniformLocation(program, 'y'), 1);
  gl.viewport(0, 0, width, height);
  const pixel = new Float32Array(4);
  return () => {
    gl.useProgram(program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, tx);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, ty);
    gl.uniform1f(a, 2);
    gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    return { wait: () => (gl.readPixels(1, 0, 1, 1, gl.RGBA, gl.FLOAT, pixel), pixel[0]) };
  };
}

try {
  const firsts = [];
  for (let i = 0; i < 5; ++i) firsts.push(await firstResult());
  figures['first result after the context, cold (ms)'] = firsts[0].after;
  figures['first result after the context (ms)'] = median(firsts.slice(1).map(({ after }) => after));
  figures['first result with the context (ms)'] = median(firsts.slice(1).map(({ whole }) => whole));

  const device = await Device.create();
  const [s, t] = [device.stream('float', [8, 8]), device.stream('float', [8, 8])];
  const flush = () => device.context.finish();
  figures['host cost of saxpy (us)'] = hostCost(() => saxpy(2, s, s, t), flush);
  figures['host cost of diffuse in place (us)'] = hostCost(() => diffuse(0.2, s, s), flush);

  const n = 1024;
  const calls = 16; // of saxpy and of heat steps, before one transfer to the host
  const host = Float32Array.from({ length: n * n }, (_, i) => (1 + (i % 1000)) / 1000);
  const [x, y, r, one] = [device.stream('float', [n, n]), device.stream('float', [n, n]), device.stream('float', [n, n]), device.stream('float', [4])];
  x.write(host);
  y.write(host);
  const wanted = host.reduce((a, b) => a + b, 0);
  r.write(host);
  for (let i = 0; i < calls; ++i) diffuse(0.2, r, r);
  const heated = (await r.read())[0];
  const tree = sum.with({ accumulate: 'tree' });
  const hand = byHand(document.createElement('canvas').getContext('webgl2'), n / 4, n, host, host);
  const rival = await rivalOf(n, host);
  const rounds = { ours: [], hand: [], heat: [], sum: [], tree: [], nothing: [], rivalSaxpy: [], rivalHeat: [], rivalSum: [], rivalRead: [] };
  for (let round = 0; round < 7; ++round) {
    rounds.ours.push(await timed(async () => {
      for (let i = 0; i < calls; ++i) saxpy(2, x, y, r);
      saxpy(1, one, one, one);
      await one.read();
    }));
    rounds.hand.push(await timed(async () => {
      let last;
      for (let i = 0; i < calls; ++i) last = hand();
      const value = last.wait();
      near('saxpy by hand', value, 3 * host[4], 1e-6);
    }));
    rounds.heat.push(await timed(async () => {
      for (let i = 0; i < calls; ++i) diffuse(0.2, r, r);
      saxpy(1, one, one, one);
      await one.read();
    }));
    rounds.sum.push(await timed(() => sum(x)));
    rounds.tree.push(await timed(() => tree(x)));
    rounds.nothing.push(await timed(async () => {
      saxpy(1, one, one, one);
      await one.read();
    }));
    if (rival === null) continue;
    rounds.rivalSaxpy.push(await timed(() => near('saxpy of gpu.js', rival.saxpy(calls)(), 3 * host[0])));
    rounds.rivalHeat.push(await timed(() => near('heat of gpu.js', rival.heat(calls)(), heated)));
    rounds.rivalSum.push(await timed(() => near('sum of gpu.js', rival.sum(), wanted, 10)));
    rounds.rivalRead.push(await timed(() => near('sum on the host', rival.sumOnHost(), wanted, 10)));
  }
  figures['saxpy 1024 x 1024 (ms)'] = median(rounds.ours) / calls;
  figures['saxpy 1024 x 1024, WebGL2 by hand (ms)'] = median(rounds.hand) / calls;
  figures['heat step 1024 x 1024 (ms)'] = median(rounds.heat) / calls;
  figures['sum 1024 x 1024 to a value, compensated (ms)'] = median(rounds.sum);
  figures['sum 1024 x 1024 to a value, plain (ms)'] = median(rounds.tree);
  figures['a number to the host (ms)'] = median(rounds.nothing);
  if (rival !== null) {
    const compare = (what, theirs, ours, count) => {
      figures[`${what}, gpu.js (ms)`] = median(theirs) / count;
      figures[`${what}, times gpu.js`] = median(theirs.map((time, i) => time / ours[i]));
    };
    compare('saxpy 1024 x 1024', rounds.rivalSaxpy, rounds.ours, calls);
    compare('heat step 1024 x 1024', rounds.rivalHeat, rounds.heat, calls);
    compare('compensated sum 1024 x 1024', rounds.rivalSum, rounds.sum, 1);
    compare('sum 1024 x 1024 to a value', rounds.rivalSum, rounds.tree, 1); // gpu.js adds plainly, too
    compare('sum 1024 x 1024 on the host', rounds.rivalRead, rounds.tree, 1);
    rival.dispose();
  }
  near('sum', await sum(x), wanted, 0.1);
  figures.renderer = device.info().renderer;
} catch (error) {
  mistakes.push(error.stack);
}
await fetch('/', { method: 'POST', body: JSON.stringify({ figures, mistakes }) });
