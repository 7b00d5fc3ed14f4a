// SPDX-License-Identifier: MIT
//
// The text of kernels and of the programs that the driver has been given, in tabs.

const keywords = 'kernel|reduce|spec|out|iter|vout|struct|enum|template|class|namespace|const|constexpr|if|else|for|while|do|return|break|continue|true|false|uniform|in|inout|' +
  'layout|precision|highp|switch|case';
const types = '(?:float|double|half|int|uint|bool|uchar|char|short|ushort)(?:[234](?:x[234])?)?|[iu]?vec[234]|bvec[234]|mat[234]|[iu]?sampler2D|void';
const pattern = new RegExp(
  `(?<c>//[^\\n]*|/\\*[^]*?\\*/)|(?<a>\\[\\[[^\\]]*\\]\\]|^[ \\t]*#[^\\n]*)|(?<k>\\b(?:${keywords})\\b)|(?<t>\\b(?:${types})\\b)|` +
    '(?<n>\\b0x[\\da-fA-F.]+(?:p[-+]?\\d+)?u?\\b|\\b\\d[\\d.]*(?:e[-+]?\\d+)?[uf]?\\b)',
  'gm',
);

/** Nodes that show the text, with colours. */
function highlighted(text) {
  const nodes = [];
  let from = 0;
  for (const match of text.matchAll(pattern)) {
    const [kind] = Object.entries(match.groups).find(([, found]) => found !== undefined);
    const span = document.createElement('span');
    span.className = kind;
    span.textContent = match[0];
    nodes.push(text.slice(from, match.index), span);
    from = match.index + match[0].length;
  }
  return [...nodes, text.slice(from)];
}

/** The kernel that a program runs: the first function of the .sk file that main() calls; where it is written into main(), its output. */
function nameOf(text) {
  if (/uniform ivec4 place;/.test(text)) return 'draw';
  const isKernel = (name) => !name.startsWith('sk_') && new RegExp(`^\\w+ ${name}\\(`, 'm').test(text);
  const called = [...text.slice(text.indexOf('void main()') + 11).matchAll(/\b([A-Za-z]\w*)\(/g)].map(([, name]) => name);
  return called.find(isKernel) ?? /sk_out_(\w+)/.exec(text)?.[1] ?? 'program';
}

/** Calls `found` with each fragment program that the context is given from now on: { name, text }. */
export function watchPrograms(context, found) {
  const give = context.shaderSource.bind(context);
  context.shaderSource = (shader, text) => {
    give(shader, text);
    if (!text.includes('gl_VertexID')) found({ name: nameOf(text), text });
  };
}

export class CodeView {
  /** `sources`: addresses of .sk files. */
  constructor(tabs, text, sources) {
    Object.assign(this, { tabs, text });
    this.entries = [];
    for (const source of sources) this.add(source.replace(/^sk\//, ''), async () => (await fetch(source)).text());
    this.programsFrom = this.entries.length;
    tabs.onkeydown = (event) => this.moveBy(event, { ArrowLeft: -1, ArrowRight: 1 }[event.key]);
    this.choose(0);
  }

  add(name, load) {
    const button = document.createElement('button');
    button.type = 'button';
    button.setAttribute('role', 'tab');
    button.setAttribute('aria-controls', this.text.id);
    button.textContent = name;
    const entry = { button, load };
    button.onclick = () => this.choose(this.entries.indexOf(entry));
    this.entries.push(entry);
    this.tabs.append(button);
    this.mark();
  }

  /** The first variant of a program is enough for a page. */
  addProgram({ name, text }) {
    const title = `${name} (GLSL)`;
    if (!this.entries.some(({ button }) => button.textContent === title)) this.add(title, async () => text.replace(/^#line.*\n/gm, ''));
  }

  /** A new device makes all programs anew. */
  forgetPrograms() {
    for (const { button } of this.entries.splice(this.programsFrom)) button.remove();
    if (this.chosen >= this.entries.length) this.choose(0);
  }

  async choose(index) {
    this.chosen = index;
    this.mark();
    const text = await this.entries[index].load().catch((error) => `The file cannot be read: ${error.message}`);
    if (this.chosen !== index) return;
    this.text.firstElementChild.replaceChildren(...highlighted(text.replace(/^\/\/ SPDX.*\n(\/\/\n)?/, '').trimEnd()));
    this.text.scrollTop = 0;
  }

  mark() {
    this.entries.forEach(({ button }, i) => {
      button.setAttribute('aria-selected', String(i === this.chosen));
      button.tabIndex = i === this.chosen ? 0 : -1;
    });
  }

  moveBy(event, by) {
    if (by === undefined) return;
    event.preventDefault();
    const next = (this.chosen + by + this.entries.length) % this.entries.length;
    this.choose(next);
    this.entries[next].button.focus();
  }
}
