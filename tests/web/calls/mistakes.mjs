// SPDX-License-Identifier: MIT
//
// Bad input of every kind: each is an SkError that says what is wrong, none is another exception, and nothing hangs.
import { Device } from 'streamkernel';
import * as k from './calls.sk.js';

export const mistakeCases = ({ refused, filled, expect }) => ({
  async mistakes(device) {
    const make = (type, shape) => device.stream(type, shape);
    const [u, v, ints, line] = [make('float', [8, 8]), make('float', [8, 12]), make('int', [8, 8]), make('float', [64])];
    const [bodies, pairs] = [make(k.Body, [4]), make('float2', [8, 8])];
    const disposed = make('float', [8, 8]);
    disposed.dispose();
    disposed.dispose();
    const other = await Device.create();
    const foreign = other.stream('float', [8, 8]);
    const arrays = () => ({ spot: { at: new Float32Array(8), heat: new Float32Array(4) }, kind: new Int32Array(4), color: new Float32Array(12) });
    const view = (offset) => new DataView(new ArrayBuffer(256), offset);

    const table = [
      // Shapes.
      ...[NaN, Infinity, -1, 0.5, 2 ** 30, '8', null, undefined].map((extent) => ['shape', 'is no shape', () => make('float', [8, extent])]),
      ...[8, 'float', null, undefined, {}, NaN].map((shape) => ['shape', 'is no shape', () => make('float', shape)]),
      ...[[], [1, 2, 3, 4, 5]].map((shape) => ['shape', 'is no shape', () => make('float', shape)]),
      ['shape', 'divide it into several streams', () => make('float2', [100000, 100000])],
      // Types of elements.
      ...['flaot', 'float5', 'Float', '', 'toString', null, undefined, 4, {}].map((type) => ['type', 'is no type of elements', () => make(type, [4])]),
      // Arrays.
      ...[63, 65, 0].map((count) => ['shape', `but the array has ${count}`, () => u.write(new Float32Array(count))]),
      ...[new Int32Array(64), new Float64Array(64), [1, 2], null, undefined, 'x', 64, view(0)].map((array) => ['type', 'written from a Float32Array', () => u.write(array)]),
      ['shape', '64 element(s) of float2 are 128 number(s)', () => pairs.write(new Float32Array(64))],
      ['type', 'written from an Int32Array', () => ints.write(new Float32Array(64))],
      ['type', 'in spot.at, but nothing is given', () => bodies.write(new Float32Array(24))],
      ['type', 'in spot.at, but nothing is given', () => bodies.write(undefined)],
      ['type', 'in kind, but a Float32Array is given', () => bodies.write({ ...arrays(), kind: new Float32Array(4) })],
      ['shape', '12 number(s) in color, but the array has 4', () => bodies.write({ ...arrays(), color: new Float32Array(4) })],
      // Values.
      ...['1', null, undefined, [1, 2], [], {}, () => 1, ['1']].map((a) => ['type', "'a' is declared as float, 1 number(s)", () => k.saxpy(a, u, u, u)]),
      ...[NaN, Infinity, 0.5].map((key) => ['type', 'is no whole number', () => k.mix_bits(key, ints, ints, ints)]),
      ['type', "'axis' is declared as float3, 3 number(s)", () => k.turn([1, 2], true, u, u, u)],
      ['type', "'axis' is declared as float3, 3 number(s)", () => k.turn(1, true, u, u, u)],
      ['type', "'wind' is declared as Spot, 3 number(s)", () => k.move({ at: [1, 2] }, bodies, bodies)],
      ...[NaN, 1.5, '2', null].map((radius) => ['type', "'radius' is a spec int", () => k.choose(radius, false, line, null, line)]),
      ...[5, null, [0, 8], { begin: [0, 0] }].map((p) => ['type', "'p' is an iterator", () => k.ramp(p, { begin: 0, end: 64 }, u)]),
      ['shape', 'which are not whole', () => k.ramp({ begin: [0, 0], end: [8, 8] }, { begin: 0, end: 65 }, u)],
      ['type', 'is no whole number', () => k.ramp({ begin: [0, 0], end: [8, 8] }, { begin: 0, end: NaN }, u)],
      ['shape', "'a' is one value for all elements", () => k.saxpy(u, u, u, u)],
      // Streams.
      ...[new Float32Array(64), 5, undefined, {}, 'u'].map((x) => ['type', "'x' is a stream", () => k.saxpy(1, x, u, u)]),
      ['misuse', "'x' is null, but the kernel needs it", () => k.saxpy(1, null, u, u)],
      ['misuse', "'r' is null, but the kernel needs it", () => k.saxpy(1, u, u, null)],
      ['type', 'its stream holds int', () => k.saxpy(1, ints, u, u)],
      ['type', 'its stream holds float2', () => k.saxpy(1, u, u, pairs)],
      ['shape', 'give them the same shape', () => k.saxpy(1, v, v, u)],
      ['shape', "'u' is declared with 2 dimension(s)", () => k.diffuse(0.2, line, u)],
      ['shape', 'there is no element to read', () => k.diffuse(0.2, make('float', [0, 8]), u)],
      ['misuse', '3 arguments are given, but 4 are declared', () => k.saxpy(1, u, u)],
      ['misuse', '0 arguments are given', () => k.sum()],
      ['misuse', 'are one stream; give them different streams', () => k.sieve(1, ints, ints, ints, make(k.Spot, [4]))],
      ['lost', "the stream of 'x' has been disposed of", () => k.saxpy(1, disposed, u, u)],
      ['lost', "the stream of 'r' has been disposed of", () => k.saxpy(1, u, u, disposed)],
      ['lost', 'has been disposed of', () => k.sum(disposed)],
      ['lost', 'has been disposed of', () => disposed.read()],
      ['lost', 'has been disposed of', () => disposed.keep()],
      ['lost', 'has been disposed of', () => disposed.write(new Float32Array(64))],
      ['lost', 'has been disposed of', () => device.draw(disposed, document.getElementById('picture'))],
      ['device', "'x' and 'r' are streams of two devices", () => k.saxpy(1, u, u, foreign)],
      ['device', "'x' and 'y' are streams of two devices", () => k.dot(u, foreign)],
      ['device', 'belongs to another device', () => device.draw(foreign, document.getElementById('picture'))],
      // Programs that skc has not assembled.
      ['compile', "no program for this call, where a gather is smaller", () => k.edges(make('float', [1, 8]), u, u, make('float', [8]), u)],
      ['compile', "squared: calls.sk.js has no program for the streams that it needs with these values", () => k.squared(9, u, line, u)],
      ['type', 'only kernels and reduces', () => device.compile([k.saxpy, {}])],
      ['type', 'only kernels and reduces', () => device.compile([undefined])],
      // Pictures and devices.
      ['type', 'is no stream', () => device.draw(new Float32Array(64), document.getElementById('picture'))],
      ['type', 'needs a canvas', () => device.draw(u, null)],
      ['type', 'needs a canvas', () => device.draw(u, {})],
      ['misuse', 'two different, finite numbers', () => device.draw(u, document.getElementById('picture'), { range: [NaN, 1] })],
      ['device', 'options.canvas is no canvas', () => Device.create({ canvas: {} })],
      ['device', 'options.context is no WebGL2 context', () => Device.create({ context: document.createElement('canvas').getContext('2d') })],
      ['device', 'options.context is no WebGL2 context', () => Device.create({ context: document.createElement('canvas').getContext('webgl') })],
      ['device', 'options.context is no WebGL2 context', () => Device.create({ context: {} })],
    ];
    // Calls of the same kernels that are right come first: what is like them is checked less (repeats.mjs).
    k.saxpy(1, u, u, u);
    k.diffuse(0.2, u, u);
    k.choose(1, false, line, null, line);
    k.ramp({ begin: [0, 0], end: [8, 8] }, { begin: 0, end: 64 }, make('float', [8, 8]));
    for (const [kind, message, call] of table) await refused(kind, message, call);
    // None of them has changed anything.
    expect('the streams are as before', (await u.read()).every((value) => value === 0) && (await k.sum(u)) === 0);
    other.dispose();
  },

  async traces(device) {
    performance.clearMeasures();
    const u = filled(device, 'float', [64], new Float32Array(64));
    k.saxpy(1, u, u, u);
    expect('nothing is traced unasked', performance.getEntriesByType('measure').length === 0);
    const own = await Device.create({ trace: true });
    const x = filled(own, 'float', [64], new Float32Array(64).fill(1));
    k.saxpy(1, x, x, x);
    await k.sum(x);
    await k.positive(x, own.stream('float', [0]));
    await refused('misuse', 'arguments are given', () => k.saxpy(x));
    const entries = () => performance.getEntriesByType('measure').map(({ name, detail }) => ({ name, ...detail.devtools }));
    const count = (track, name) => entries().filter((entry) => entry.track === track && entry.name.includes(name)).length;
    // Where the browser has a timer of the device, passes come late.
    for (let i = 0; i < 500 && count('passes', 'positive') < 2; ++i) await new Promise((resolve) => setTimeout(resolve, 10));
    const counts = [count('calls', 'saxpy'), count('results', 'sum'), count('compilations', 'saxpy'), count('transfers', 'read'), count('passes', 'saxpy')];
    expect('each call, result, compilation, transfer and pass has an entry', String(counts) === '2,1,1,2,1', `${counts} ${JSON.stringify(entries())}`);
    const pushed = [count('passes', 'positive'), count('passes', 'sums of counts')];
    expect('a kernel that pushes has several passes', String(pushed) === '2,3', String(pushed));
    own.trace = false;
    performance.clearMeasures();
    k.saxpy(1, x, x, x);
    expect('tracing ends', performance.getEntriesByType('measure').length === 0);
    own.dispose();

    // With a timer of the device, as far as a browser without one can play it.
    const context = document.createElement('canvas').getContext('webgl2');
    const asked = [];
    const plays = {
      getExtension: (get) => (name) => (name === 'EXT_disjoint_timer_query_webgl2' ? { TIME_ELAPSED_EXT: 1, GPU_DISJOINT_EXT: 2 } : get(name)),
      getParameter: (get) => (name) => (name === 2 ? false : get(name)),
      beginQuery: () => () => asked.push(0),
      endQuery: () => () => asked.push(1),
      getQueryParameter: () => (_, name) => (name === context.QUERY_RESULT ? 7e6 : true),
    };
    for (const [name, play] of Object.entries(plays)) context[name] = play(context[name].bind(context));
    const timed = await Device.create({ context, trace: true });
    const y = timed.stream('float', [64]);
    k.saxpy(1, y, y, y);
    k.saxpy(1, y, y, y);
    await new Promise((resolve) => setTimeout(resolve, 50));
    const passes = performance.getEntriesByType('measure').filter(({ detail }) => detail?.devtools?.track === 'passes');
    const [first, second] = passes;
    expect('queries enclose passes', String(asked) === '0,1,0,1', String(asked));
    const follows = Math.abs(second?.startTime - first?.startTime - first?.duration) < 0.01 || second?.startTime > first?.startTime + 7;
    expect('passes take the time of the device, one after the other', Math.abs(first?.duration - 7) < 1e-6 && follows, JSON.stringify(passes));
    performance.clearMeasures();
  },
});
