#!/usr/bin/env node
// SPDX-License-Identifier: MIT
//
// The command streamkernel: `streamkernel init [FOLDER]` writes a page with a moving picture, which Vite serves.
import { existsSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const templates = fileURLToPath(new URL('../template/', import.meta.url));
const own = JSON.parse(readFileSync(new URL('../package.json', import.meta.url), 'utf8'));
const usage = `usage: streamkernel init [FOLDER]

Writes index.html, main.js, heat.sk and vite.config.js to FOLDER (default: this one), and adds to its package.json what they need.
No file is overwritten.

  --help      this text
  --version   the version of the package
`;

/** A mistake of the user's: its message is all that is printed. */
class Mistake extends Error {}

/** The newest Vite that runs on this Node. */
function viteFor(version) {
  const [major, minor] = version.split('.').map(Number);
  return major > 22 || (major === 22 && minor >= 12) || (major === 20 && minor >= 19) ? '^8.0.0' : '^6.0.0';
}

/** package.json with what the page needs; what it has stays as it is. */
function packageWith(found) {
  const given = found.dependencies?.[own.name] ?? found.devDependencies?.[own.name];
  const dependencies = { ...found.dependencies };
  if (given === undefined) dependencies[own.name] = `^${own.version}`;
  const devDependencies = { ...found.devDependencies };
  if (found.dependencies?.vite === undefined) devDependencies.vite ??= viteFor(process.versions.node);
  return {
    ...found,
    ...(found.name === undefined && { private: true }),
    type: 'module',
    scripts: { dev: 'vite', build: 'vite build', ...found.scripts },
    dependencies,
    devDependencies,
  };
}

/** The object in FOLDER/package.json; {} if there is none. */
function packageOf(file) {
  if (!existsSync(file)) return {};
  let found;
  try {
    found = JSON.parse(readFileSync(file, 'utf8'));
  } catch (error) {
    throw new Mistake(`'${file}' is no JSON: ${error.message}`);
  }
  if (typeof found !== 'object' || found === null || Array.isArray(found)) throw new Mistake(`'${file}' is no object of JSON`);
  if (found.type === 'commonjs' && Object.keys(found).some((key) => key === 'main' || key === 'exports')) {
    throw new Mistake(`'${file}' is of a package of type 'commonjs'; the page needs type 'module': choose another folder`);
  }
  return found;
}

function init(folder) {
  const names = readdirSync(templates);
  if (existsSync(folder) && !statSync(folder).isDirectory()) throw new Mistake(`'${folder}' is no folder`);
  const there = names.filter((name) => existsSync(join(folder, name)));
  if (there.length > 0) throw new Mistake(`'${folder}' has ${there.join(', ')} already; move them, or choose another folder: streamkernel init FOLDER`);
  const manifest = join(folder, 'package.json');
  const found = packageOf(manifest);
  mkdirSync(folder, { recursive: true });
  for (const name of names) writeFileSync(join(folder, name), readFileSync(join(templates, name)), { flag: 'wx' });
  writeFileSync(manifest, `${JSON.stringify(packageWith(found), null, 2)}\n`);
  const enter = folder === '.' ? '' : `  cd ${folder}\n`;
  console.log(`${names.join(', ')} and package.json are written. Next:\n${enter}  npm install\n  npx vite`);
}

function main([command, ...rest]) {
  if (command === '--help' || command === '-h') return console.log(usage.trimEnd());
  if (command === '--version') return console.log(own.version);
  if (command === undefined) throw new Mistake(`no command\n${usage.trimEnd()}`);
  if (command !== 'init') throw new Mistake(`there is no command '${command}'; see 'streamkernel --help'`);
  const unknown = rest.find((word) => word.startsWith('-'));
  if (unknown !== undefined) throw new Mistake(`there is no option '${unknown}'; see 'streamkernel --help'`);
  if (rest.length > 1) throw new Mistake(`init takes one folder, not ${rest.length}`);
  init(rest[0] ?? '.');
}

try {
  main(process.argv.slice(2));
} catch (error) {
  // an error of the system, such as a folder that may not be written, has a code
  if (!(error instanceof Mistake) && error.code === undefined) throw error;
  console.error(`streamkernel: ${error.message}`);
  process.exitCode = 1;
}
