// SPDX-License-Identifier: MIT
//
// Calls that are like an earlier one take a short way (runtime/web/src/repeat.ts): it must compute the same, and must not be
// taken where a check would fail.
import { Device } from 'streamkernel';
import * as k from './calls.sk.js';
import { folds } from './reductions.sk.js';

export const repeatCases = ({ refused, filled, expect }) => ({
  async repeats(device) {
    const ofOnes = (shape, value = 1) => filled(device, 'float', shape, new Float32Array(shape.reduce((a, b) => a * b)).fill(value));
    const holds = async (what, stream, value) => expect(what, (await stream.read()).every((one) => one === value), String(await stream.read()));
    const [x, y, r] = [ofOnes([8, 8], 2), ofOnes([8, 8], 3), ofOnes([8, 8], 0)];
    expect('the first call is no repeat', !k.saxpy.repeat([2, x, y, ofOnes([24, 24])]));
    k.saxpy(2, x, y, r);
    expect('the second one is', k.saxpy.repeat([3, x, y, r]));
    await holds('a repeat takes its own values', r, 9);
    expect('a repeat in place is', k.saxpy.repeat([2, r, y, r]));
    await holds('a repeat reads what it writes', r, 21);
    expect('so are other streams that lie alike', k.saxpy.repeat([1, r, r, x]));
    await holds('a repeat writes no stream that it reads', r, 21);
    await holds('a repeat writes its output', x, 42);
    k.saxpy(1, y, y, y);
    const reading = y.read();
    k.saxpy(1, y, y, y);
    expect('a transfer has the elements of its time', (await reading).every((one) => one === 6) && (await y.read())[63] === 12);
    // Calls of several shapes in turn.
    const small = ofOnes([4, 4]);
    k.saxpy(1, small, small, small);
    expect('several shapes are repeated', k.saxpy.repeat([1, small, small, small]) && k.saxpy.repeat([1, y, y, y]));
    await holds('each as it lies', small, 4);
    // A call that leaves a stream in another layout than it has read.
    const [wind, heat] = [filled(device, 'float2', [12, 12], new Float32Array(288)), ofOnes([12, 12], 7)];
    for (let i = 0; i < 3; ++i) k.carried(wind, heat, wind, heat);
    await holds('in place, where the layout changes', heat, 7);
    expect('and once it does not', k.carried.repeat([wind, heat, wind, heat]));
    await holds('in place, where it has changed', heat, 7);
    // What differs.
    expect('a stream of another shape is no repeat', !k.saxpy.repeat([1, small, y, y]));
    expect('a view is none', !k.saxpy.repeat([1, y.domain([0, 0], [8, 8]), y, y]));
    expect('a stream for a value is none', !k.saxpy.repeat([ofOnes([1]), y, y, y]));
    expect('too few arguments are none', !k.saxpy.repeat([1, y, y]));
    const line = ofOnes([64]);
    const chosen = device.stream('float', [64]);
    k.choose(1, false, line, null, chosen);
    expect('spec parameters with the same values are', k.choose.repeat([1, false, line, null, chosen]) && (await chosen.read())[5] === 3);
    expect('those with others are none', !k.choose.repeat([2, false, line, null, chosen]) && !k.choose.repeat([1, true, line, null, chosen]));
    expect('a stream that was omitted is none', !k.choose.repeat([1, false, line, line, chosen]));
    k.ramp({ begin: [0, 0], end: [8, 8] }, { begin: 0, end: 64 }, r);
    k.ramp({ begin: [0, 0], end: [16, 16] }, { begin: 0, end: 128 }, r);
    expect('iterators have ends of their own', (await r.read())[9] === 2 * 100 + 2 + 18, String((await r.read())[9]));
    // Errors are those of a first call.
    const gone = ofOnes([8, 8]);
    k.saxpy(1, gone, y, r);
    gone.dispose();
    await refused('lost', "the stream of 'x' has been disposed of", () => k.saxpy(1, gone, y, r));
    await refused('type', "'a' is declared as float", () => k.saxpy('1', x, y, r));
    await refused('shape', 'which are not whole', () => k.ramp({ begin: [0, 0], end: [8, 8] }, { begin: 0, end: 65 }, r));
    const [p, q, s] = [ofOnes([64]), ofOnes([64]), ofOnes([64])];
    await folds.descend(1, p, q, line, s, line, s);
    await refused('misuse', "the outputs 'xn' and 'rn' are one stream", () => folds.descend(1, p, q, line, s, line, line));
    const own = await Device.create();
    const theirs = own.stream('float', [8, 8]);
    k.saxpy(1, theirs, theirs, theirs);
    await refused('device', 'are streams of two devices', () => k.saxpy(1, theirs, theirs, r));
    own.dispose();
    await refused('lost', 'the device has been disposed of', () => k.saxpy(1, theirs, theirs, theirs));
    // Textures that have been deleted.
    for (const stream of [x, small, gone, p, q]) stream.dispose();
    device.trim();
    k.saxpy(1, y, y, r);
    await holds('deleted textures are not drawn to', r, 48);
  },
});
