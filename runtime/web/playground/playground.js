// SPDX-License-Identifier: MIT
//
// The page: compiles what the editor has, a moment after each change, and shows messages, GLSL and picture.
import { rolesOf } from './roles.js';
import { fragmentOf, stateOf } from './share.js';

const element = (id) => document.getElementById(id);
const milliseconds = 300; // of rest before a changed text is compiled
const choices = ['size', 'steps', 'map'];

const start = await (await fetch('/start')).json();
const { createEditor } = await import(start.hasEditor ? '/editor/editor.js' : './plain_editor.js');
const editor = createEditor(element('source'), 'Program', changed);
const picture = await createPicture();
let timer = null;
let compiling = null;

/** The picture, or null where the npm package is not built. */
async function createPicture() {
  if (!start.hasPackage) return null;
  const { Picture } = await import('./picture.js');
  return new Picture(element('picture'), {
    failed: (error) => say(error.message, true),
    told: ({ frames, steps }) => (element('speed').value = `${frames.toFixed(0)} frames, ${steps.toFixed(0)} steps a second`),
  });
}

function say(text, isWrong = false) {
  element('state').textContent = text;
  element('state').style.color = isWrong ? 'var(--error)' : '';
}

function changed() {
  clearTimeout(timer);
  timer = setTimeout(compile, milliseconds);
}

/** A column of UTF-16, from 1, of a column in bytes. */
function columnOf(line, bytes) {
  return new TextDecoder().decode(new TextEncoder().encode(line).slice(0, Math.max(bytes - 1, 0))).length + 1;
}

function showMessages(messages, text) {
  const lines = text.split('\n');
  const placed = messages.map((message) => ({ ...message, column: columnOf(lines[message.line - 1] ?? '', message.column) }));
  editor.showMessages(placed);
  element('messages').replaceChildren(...placed.map(({ line, column, severity, text: message }) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.className = severity;
    button.textContent = `${line > 0 ? `${line}:${column}: ` : ''}${severity}: ${message}`;
    button.addEventListener('click', () => editor.goTo(line, column));
    const item = document.createElement('li');
    item.append(button);
    return item;
  }));
}

/** The exports of a module by its text. */
async function imported(text) {
  const address = URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));
  try {
    return await import(address);
  } finally {
    URL.revokeObjectURL(address);
  }
}

async function answerOf(text, signal) {
  const response = await fetch('/compile', { method: 'POST', headers: { 'Content-Type': 'text/x-streamkernel' }, body: text, signal });
  if (!response.ok) throw new Error((await response.text()).trim());
  return response.json();
}

async function compile() {
  compiling?.abort();
  compiling = new AbortController();
  const { signal } = compiling;
  const text = editor.text();
  say('compiling');
  try {
    const answer = await answerOf(text, signal);
    if (signal.aborted) return;
    showMessages(answer.messages, text);
    if (answer.module === undefined) {
      const count = answer.messages.filter(({ severity }) => severity === 'error').length;
      return say(count === 1 ? '1 error' : `${count} errors`, true);
    }
    element('glsl').textContent = answer.glsl;
    await show(answer);
  } catch (error) {
    if (signal.aborted) return;
    picture?.stop();
    say(error instanceof TypeError ? 'the server is gone; start it again: sk serve' : error.message, true);
  }
}

async function show(answer) {
  if (picture === null) return say('compiled; pictures need the npm package, as sk serve says in its terminal');
  const roles = rolesOf(answer.kernels);
  await picture.show(await imported(answer.module), roles);
  const parts = ['start', 'step', 'view'].filter((part) => roles[part] !== null).map((part) => (roles[part].name === part ? part : `${roles[part].name} as ${part}`));
  say(`running ${parts.join(', ')}`);
}

// ---- what surrounds the editor --------------------------------------------------------------------

function chosen() {
  return { size: Number(element('size').value), steps: Number(element('steps').value), map: element('map').value };
}

function choose(state) {
  for (const name of choices) {
    const select = element(name);
    if ([...select.options].some(({ value }) => value === String(state[name]))) select.value = state[name];
  }
  picture?.choose(chosen());
}

function fillPrograms() {
  const own = start.file === null ? [] : [start.file];
  const programs = [...own, ...start.programs];
  element('programs').replaceChildren(...programs.map(({ name }) => new Option(name.replace(/\.sk$/, '').replace(/_/g, ' '))));
  element('programs').addEventListener('change', ({ target }) => {
    history.replaceState(null, '', '/');
    editor.setText(programs[target.selectedIndex].text);
    picture?.restartAll();
  });
  return programs;
}

async function share() {
  const { href } = Object.assign(new URL('/', location.href), { hash: await fragmentOf({ text: editor.text(), ...chosen() }) });
  history.replaceState(null, '', href);
  element('shared').value = `the address of this page holds the program (${href.length} characters)`;
  try {
    await navigator.clipboard.writeText(href);
    element('shared').value += ', and is copied';
  } catch {
    // without leave to write to the clipboard, the address bar has it
  }
}

/** The program of the address, or the user's file, or the first one. */
async function load(programs) {
  let state = null;
  let mistake = null;
  try {
    state = await stateOf(location.hash);
  } catch (error) {
    mistake = error.message;
  }
  if (state !== null) {
    programs.unshift({ name: 'shared', text: state.text });
    element('programs').prepend(new Option('shared'));
    element('programs').selectedIndex = 0;
  }
  choose(state ?? {});
  editor.setText((state ?? programs[0]).text);
  clearTimeout(timer);
  await compile();
  if (mistake !== null) say(mistake, true);
}

const programs = fillPrograms();
for (const name of choices) element(name).addEventListener('change', () => picture?.choose(chosen()));
element('share').addEventListener('click', share);
element('choices').addEventListener('submit', (event) => event.preventDefault());
element('restart').addEventListener('click', () => compile().then(() => picture?.restartAll()));
element('pause').addEventListener('click', ({ target }) => {
  if (picture === null) return;
  picture.paused = !picture.paused;
  target.setAttribute('aria-pressed', String(picture.paused));
  target.textContent = picture.paused ? 'Go on' : 'Pause';
});
addEventListener('hashchange', () => load(programs));
await load(programs);
