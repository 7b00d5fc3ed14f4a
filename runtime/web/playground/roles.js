// SPDX-License-Identifier: MIT
//
// Which kernels of a file a picture is made of, and what each of their parameters is given. Pure: no page, no device.
//
//   start   writes the streams of the picture, once
//   step    reads them and writes them anew; its output number i is what its stream number i reads next
//   view    reads them and writes what is drawn
//
// A file with one kernel needs no name for it: it is a step if it reads streams, else a view.

/** Uniforms that the page gives, by name: their types, and their values for a moment { time, frame, mouse, pressed }. */
export const given = {
  time: { types: ['float'], value: ({ time }) => time },
  frame: { types: ['int', 'uint', 'float'], value: ({ frame }) => frame },
  mouse: { types: ['float2', 'int2'], value: ({ mouse }) => mouse },
  pressed: { types: ['float', 'int', 'uint'], value: ({ pressed }) => Number(pressed) },
};
const pressedAsBool = { types: ['bool'], value: ({ pressed }) => pressed };

/** A mistake of the program in front of the page: it compiles, but makes no picture. */
export class NoPicture extends Error {}

const isRead = ({ role }) => role === 'input' || role === 'gather';

function uniformOf(kernel, { name, type }) {
  const found = name === 'pressed' && type === 'bool' ? pressedAsBool : given[name];
  const known = 'float time, int frame, float2 mouse, float pressed';
  if (found === undefined) throw new NoPicture(`'${name}' of '${kernel.name}': the page gives ${known}; make others constants of the file`);
  if (!found.types.includes(type)) throw new NoPicture(`'${name}' of '${kernel.name}' is of type ${type}; the page gives ${found.types.join(' or ')} ${name}`);
  return found.value;
}

/** What a kernel takes: for each parameter { read: i }, { written: i } or { value: moment => ... }. */
function argumentsOf(kernel) {
  let reads = 0;
  let writes = 0;
  return kernel.parameters.map((parameter) => {
    const { name, role, type, rank } = parameter;
    if (isRead(parameter)) {
      if (role === 'gather' && rank !== 2) throw new NoPicture(`'${name}' of '${kernel.name}' has ${rank} dimensions; the page has streams of two: ${type} ${name}[][]`);
      return { read: reads++, type, name };
    }
    if (role === 'output') return { written: writes++, type, name };
    if (role === 'uniform') return { value: uniformOf(kernel, parameter) };
    throw new NoPicture(`'${name}' of '${kernel.name}' is of a kind that the page does not give; it gives T x<>, T a[][], out T r<> and uniforms`);
  });
}

function typesOf(list, kind) {
  return list.filter((one) => kind in one).map(({ type }) => type);
}

function kernelNamed(kernels, name) {
  const found = kernels.filter((kernel) => kernel.name === name);
  if (found.length > 1) throw new NoPicture(`there are ${found.length} kernels '${name}'; the page takes one`);
  if (found.length === 0) return null;
  if (found[0].kind !== 'kernel') throw new NoPicture(`'${name}' is a ${found[0].kind}; the page takes a kernel`);
  return { name, arguments: argumentsOf(found[0]) };
}

/**
 * The parts of a picture: { start, step, view, types }, each kernel with its name and arguments, or null; `types` are those of
 * the streams. Throws NoPicture, which says what the file lacks.
 */
export function rolesOf(kernels) {
  let [start, step, view] = ['start', 'step', 'view'].map((name) => kernelNamed(kernels, name));
  if (step === null && view === null) {
    const others = kernels.filter(({ kind, name }) => kind === 'kernel' && name !== 'start');
    if (others.length !== 1) {
      throw new NoPicture(`name a kernel 'step', which reads and writes streams, or 'view', which writes colours; the file has ${others.map(({ name }) => name).join(', ') || 'none'}`);
    }
    const [only] = others;
    const part = { name: only.name, arguments: argumentsOf(only) };
    if (only.parameters.some(isRead)) step = part;
    else view = part;
  }
  const types = step !== null ? typesOf(step.arguments, 'written') : start !== null ? typesOf(start.arguments, 'written') : [];
  checkStreams(start, 'written', types);
  checkStreams(step, 'read', types);
  if (view !== null) checkView(view, types);
  if (view === null && types.length === 0) throw new NoPicture(`'${step.name}' writes no stream`);
  return { start, step, view, types };
}

/** A kernel's streams must be the first of the picture's. */
function checkStreams(kernel, kind, types) {
  if (kernel === null) return;
  kernel.arguments.filter((one) => kind in one).forEach(({ type, name }, i) => {
    const which = `'${name}' of '${kernel.name}', its number ${i + 1} of the streams that it ${kind === 'read' ? 'reads' : 'writes'},`;
    if (i >= types.length) throw new NoPicture(`${which} is one too many: the page keeps ${types.length}, the outputs of step`);
    if (type !== types[i]) throw new NoPicture(`${which} is of type ${type}, but that stream is of type ${types[i]}`);
  });
}

function checkView(view, types) {
  const written = typesOf(view.arguments, 'written');
  if (written.length !== 1) throw new NoPicture(`'${view.name}' writes ${written.length} streams; a picture is one`);
  checkStreams(view, 'read', types);
}
