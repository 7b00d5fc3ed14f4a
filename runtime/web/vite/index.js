// SPDX-License-Identifier: MIT
//
// A plugin for Vite and Rollup: `import { diffuse } from './heat.sk'` runs skc on heat.sk, whenever it or what it includes has
// changed. Messages of skc become errors of the build, at their place.
import { execFile } from 'node:child_process';
import { copyFile, mkdtemp, readFile, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';

/** The first error of skc: "heat.sk:3:7: error: text", and what follows it. */
function firstError(messages) {
  const found = /^(.*?):(\d+):(\d+): error: (.*)$/m.exec(messages);
  if (found === null) return { message: messages.trim() || 'skc failed without a message' };
  const [, file, line, column, text] = found;
  const frame = messages.slice(found.index).split('\n').slice(1, 4).join('\n');
  return { message: text, id: resolve(file), loc: { file: resolve(file), line: Number(line), column: Number(column) - 1 }, frame };
}

/** The files on the right side of a rule for make, in which '\ ' is a space. */
function filesOf(rule) {
  const names = rule.replace(/\\\n/g, ' ').split(/:\s+/).slice(1).join(': ');
  return names.match(/(?:\\.|[^\s\\])+/g)?.map((name) => name.replace(/\\(.)/g, '$1').replace(/\$\$/g, '$')) ?? [];
}

function run(command, options) {
  return new Promise((done) => {
    execFile(command, options, { maxBuffer: 1 << 26 }, (error, _, messages) => done({ error, messages }));
  });
}

/** Compiles a .sk file. Returns the module's text and the files that it depends on; throws firstError(). */
async function compile(file, { skc, options, types }) {
  const folder = await mkdtemp(join(tmpdir(), 'streamkernel-'));
  try {
    const depfile = join(folder, 'depfile');
    const { error, messages } = await run(skc, ['--emit=js', ...options, '-o', folder, `--depfile=${depfile}`, file]);
    if (error?.code === 'ENOENT') throw { message: `skc is not found as '${skc}'; install StreamKernel, set the variable SKC to the path of skc, or name it: streamkernel({ skc: '/path/to/skc' })` };
    if (error) throw firstError(messages);
    const name = basename(file);
    if (types) await copyFile(join(folder, `${name}.d.ts`), join(dirname(file), `${name}.d.ts`));
    return { code: await readFile(join(folder, `${name}.js`), 'utf8'), files: filesOf(await readFile(depfile, 'utf8')) };
  } finally {
    await rm(folder, { recursive: true, force: true });
  }
}

export function streamkernel({ skc = process.env.SKC || 'skc', options = [], types = true } = {}) {
  return {
    name: 'streamkernel',
    async load(id) {
      const file = id.split('?')[0];
      if (!file.endsWith('.sk')) return null;
      this.addWatchFile(file);
      try {
        const { code, files } = await compile(file, { skc, options, types });
        for (const dependency of files) this.addWatchFile(resolve(dependency));
        return { code, map: null };
      } catch (error) {
        if (error instanceof Error) throw error;
        return this.error(error);
      }
    },
  };
}
