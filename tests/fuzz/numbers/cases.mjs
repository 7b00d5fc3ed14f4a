// SPDX-License-Identifier: MIT
//
// Runs the cases of cases.json, and posts [number, results] for each: the words of each output, as JSON, or what it throws.
import { Device, stride } from 'streamkernel';
import { adversary } from './adversary.sk.js';

const arrays = { float: Float32Array, float3: Float32Array, double: Float64Array, int: Int32Array, uint: Uint32Array };
const poison = { float: -1.9e30, float3: [-1.9e30, -1.9e30, -1.9e30], double: -1.9e30, int: 123456789, uint: 123456789 };
const fromWords = (type, words) => new arrays[type](Uint32Array.from(words).buffer);
const toWords = (type, values) => Array.from(new Uint32Array(arrays[type].from(values).buffer));

/** A stream, and the elements of it that the call sees. */
function placed(device, type, shape, view) {
  const begin = shape.map((_, d) => 1 + d);
  const end = shape.map((extent, d) => extent + 1 + d);
  const last = shape.length - 1;
  const whole = shape.map((extent, d) => (view === 'box' ? end[d] + 1 : view === 'strided' ? 1 + (d === last ? 2 : 1) * extent : extent));
  const stream = device.stream(type, whole);
  if (view !== 'whole') stream.fill(poison[type]);
  if (view === 'box') return [stream, stream.domain(begin, end)];
  if (view === 'strided') return [stream, stride(stream, shape.map((_, d) => (d === last ? 2 : 1)), shape.map(() => 1))];
  return [stream, stream];
}

async function results(device, one) {
  const streams = [];
  const make = (type, shape, view) => {
    const [stream, region] = placed(device, type, shape, view);
    streams.push(stream);
    return region;
  };
  try {
    const inputs = one.inputs.map(({ type, role, shape, words }) => {
      const values = fromWords(type, words);
      if (role === 'uniform') return values[0];
      const region = make(type, shape, role === 'table' ? 'whole' : one.view);
      region.write(values);
      return region;
    });
    const kernel = adversary[one.operation].with(one.options);
    if (one.isValue) {
      const value = await kernel(...inputs);
      const list = one.outputs.length === 1 ? [value] : value;
      return one.outputs.map(({ type }, k) => toWords(type, typeof list[k] === 'number' ? [list[k]] : list[k]));
    }
    const outputs = one.outputs.map(({ type, shape }) => make(type, shape, one.view));
    kernel(...inputs, ...outputs);
    const words = [];
    for (const [k, { type }] of one.outputs.entries()) words.push(toWords(type, await outputs[k].read()));
    return words;
  } finally {
    for (const stream of streams) stream.dispose();
  }
}

const report = [];
let device = await Device.create();
for (const one of await (await fetch('cases.json')).json()) {
  try {
    report.push([one.number, JSON.stringify(await results(device, one))]);
  } catch (error) {
    report.push([one.number, `throws ${error}`]);
    if (device.lost) device = await Device.create();
  }
  await fetch('progress', { method: 'POST' });
}
await fetch('report', { method: 'POST', body: JSON.stringify(report) });
