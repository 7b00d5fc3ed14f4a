// SPDX-License-Identifier: MIT
//
// Runs the kernels of samples.json, compares, and posts [number of the program, what differs] for each program that differs.
import { Device } from 'streamkernel';

const samples = await (await fetch('samples.json')).json();
const size = samples.a.length;
const report = [];

function stream(device, type, values) {
  const made = device.stream(type, [size]);
  if (values) made.write(values);
  return made;
}

async function difference(device, program) {
  const module = await import(`./${program.number}.sk.js`);
  const inputs = [
    stream(device, 'int', Int32Array.from(samples.a)),
    stream(device, 'uint', Uint32Array.from(samples.b)),
    stream(device, 'float', Float32Array.from(samples.c)),
  ];
  const outputs = [stream(device, 'int'), stream(device, 'uint'), stream(device, 'float')];
  try {
    for (const kernel of program.kernels) {
      module[kernel.name](...inputs, ...outputs);
      for (const [o, name] of ['r0', 'r1', 'r2'].entries()) {
        const got = await outputs[o].read();
        const bad = kernel[name].findIndex((wanted, i) => wanted !== got[i] && !(wanted === 0 && got[i] === 0));
        if (bad < 0) continue;
        const { a, b, c } = samples;
        return `${kernel.name} of a = ${a[bad]}, b = ${b[bad]}u, c = ${c[bad]}: ${name} is ${got[bad]}, in C++ ${kernel[name][bad]}`;
      }
    }
    return '';
  } finally {
    for (const one of [...inputs, ...outputs]) one.dispose();
  }
}

let device = await Device.create();
for (const program of samples.programs) {
  let wrong;
  try {
    wrong = await difference(device, program);
  } catch (error) {
    wrong = `throws ${error}`;
    device = await Device.create();
  }
  if (wrong) report.push([program.number, wrong]);
  await fetch('progress', { method: 'POST' });
}
await fetch('report', { method: 'POST', body: JSON.stringify(report) });
