// SPDX-License-Identifier: MIT
//
// Settings of a page, as labelled form elements. A control is { name, label, ... } with one of `range: [least, most, step]`, `choices`,
// `isOn`, `press` (a button) or `file`.

function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

function range({ name, label, range: [min, max, step], value, show = String }, changed) {
  const output = element('output', { textContent: show(value) });
  const input = element('input', { type: 'range', id: `set-${name}`, min, max, step, value });
  output.htmlFor = input.id;
  input.oninput = () => {
    output.textContent = show(Number(input.value));
    changed(name);
  };
  const words = element('span', { className: 'name' }, element('label', { htmlFor: input.id, textContent: label }), output);
  const put = (next) => {
    input.value = next;
    output.textContent = show(Number(input.value));
  };
  return { made: element('div', { className: 'control' }, words, input), value: () => Number(input.value), put };
}

function choice({ name, label, choices, value }, changed) {
  const select = element('select', { id: `set-${name}` }, ...choices.map(([key, text]) => element('option', { value: key, textContent: text })));
  select.value = value;
  select.onchange = () => changed(name);
  const made = element('div', { className: 'control' }, element('label', { htmlFor: select.id, textContent: label }), select);
  return { made, value: () => select.value, put: (next) => (select.value = next) };
}

function check({ name, label, isOn }, changed) {
  const input = element('input', { type: 'checkbox', id: `set-${name}`, checked: isOn });
  input.onchange = () => changed(name);
  const made = element('div', { className: 'control check' }, input, element('label', { htmlFor: input.id, textContent: label }));
  return { made, value: () => input.checked, put: (next) => (input.checked = next) };
}

function button({ name, label }, changed) {
  const made = element('button', { type: 'button', id: `set-${name}`, textContent: label, onclick: () => changed(name) });
  return { made: element('div', { className: 'control' }, made), value: () => null, put: (text) => (made.textContent = text) };
}

function file({ name, label, accept }, changed) {
  const input = element('input', { type: 'file', id: `set-${name}`, accept, onchange: () => changed(name) });
  const made = element('div', { className: 'control' }, element('label', { htmlFor: input.id, textContent: label }), input);
  return { made, value: () => input.files[0] ?? null, put: () => (input.value = '') };
}

function makerOf(control) {
  if (control.range !== undefined) return range;
  if (control.choices !== undefined) return choice;
  if (control.isOn !== undefined) return check;
  return control.accept !== undefined ? file : button;
}

/** Values by name: get(name) and put(name, value). `changed` gets the name of what the visitor has changed. */
export function makeControls(form, list, changed) {
  form.onsubmit = (event) => event.preventDefault();
  const controls = new Map(list.map((control) => [control.name, makerOf(control)(control, changed)]));
  form.replaceChildren(...[...controls.values()].map(({ made }) => made));
  return { get: (name) => controls.get(name).value(), put: (name, value) => controls.get(name).put(value) };
}
