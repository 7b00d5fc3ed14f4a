// SPDX-License-Identifier: MIT
//
// `streamkernel init`: what it writes, and what it leaves alone.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

const { SK_WEB, SK_SKC, SK_SOURCE } = process.env;
const program = `${SK_SOURCE}/runtime/web/bin/streamkernel.js`;
const empty = () => mkdtempSync(join(SK_WEB, 'init '));
const run = (folder, ...words) => spawnSync(process.execPath, [program, ...words], { cwd: folder, encoding: 'utf8' });
const manifest = (folder) => JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
const written = ['heat.sk', 'index.html', 'main.js', 'vite.config.js'];

test('an empty folder gets a page', () => {
  const folder = empty();
  const { status, stdout } = run(folder, 'init');
  assert.equal(status, 0);
  assert.match(stdout, /npm install\n {2}npx vite\n$/);
  assert.deepEqual(readdirSync(folder).sort(), [...written, 'package.json'].sort());
  const { type, dependencies, devDependencies, scripts } = manifest(folder);
  assert.equal(type, 'module');
  assert.match(dependencies.streamkernel, /^\^\d/);
  assert.match(devDependencies.vite, /^\^\d/);
  assert.equal(scripts.dev, 'vite');
});

test('its kernels are what skc takes', () => {
  const folder = empty();
  run(folder, 'init');
  const { status, stderr } = spawnSync(SK_SKC, ['--emit=js', '-Werror', '-o', folder, join(folder, 'heat.sk')], { encoding: 'utf8' });
  assert.equal(status, 0, stderr);
});

test('a new folder is made', () => {
  const folder = empty();
  const { status, stdout } = run(folder, 'init', 'a/page');
  assert.equal(status, 0);
  assert.match(stdout, /cd a\/page\n/);
  assert.ok(readdirSync(join(folder, 'a/page')).includes('heat.sk'));
});

test('what package.json has stays', () => {
  const folder = empty();
  const own = { name: 'mine', scripts: { dev: 'other' }, dependencies: { streamkernel: 'file:../x.tgz' }, devDependencies: { vite: '7.0.0' } };
  writeFileSync(join(folder, 'package.json'), JSON.stringify(own));
  assert.equal(run(folder, 'init').status, 0);
  const found = manifest(folder);
  assert.equal(found.name, 'mine');
  assert.equal(found.scripts.dev, 'other');
  assert.deepEqual([found.dependencies.streamkernel, found.devDependencies.vite], ['file:../x.tgz', '7.0.0']);
});

test('nothing is overwritten', () => {
  const folder = empty();
  writeFileSync(join(folder, 'main.js'), 'mine');
  const { status, stderr } = run(folder, 'init');
  assert.equal(status, 1);
  assert.match(stderr, /^streamkernel: '\.' has main\.js already; /);
  assert.deepEqual(readdirSync(folder), ['main.js']);
  assert.equal(readFileSync(join(folder, 'main.js'), 'utf8'), 'mine');
});

test('mistakes are named', () => {
  const folder = empty();
  writeFileSync(join(folder, 'file'), '');
  mkdirSync(join(folder, 'broken'));
  writeFileSync(join(folder, 'broken', 'package.json'), '{');
  const cases = [
    [[], /no command/], [['inti'], /no command 'inti'/], [['init', '--force'], /no option '--force'/], [['init', 'a', 'b'], /one folder, not 2/],
    [['init', 'file'], /'file' is no folder/], [['init', 'broken'], /package\.json' is no JSON/],
  ];
  for (const [words, message] of cases) {
    const { status, stderr } = run(folder, ...words);
    assert.equal(status, 1);
    assert.match(stderr, message);
    assert.doesNotMatch(stderr, /at .*streamkernel\.js/);
  }
  assert.deepEqual(readdirSync(join(folder, 'broken')), ['package.json']);
});
