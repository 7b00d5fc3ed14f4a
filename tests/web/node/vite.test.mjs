// SPDX-License-Identifier: MIT
//
// The plugin's hooks, as Vite calls them.
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

const { SK_WEB, SK_SKC, SK_SOURCE } = process.env;
const { streamkernel } = await import(`${SK_SOURCE}/runtime/web/vite/index.js`);
const folder = mkdtempSync(join(SK_WEB, 'a project '));
mkdirSync(join(folder, 'include'));
writeFileSync(join(folder, 'include', 'twice.sk'), 'float twice(float x) { return 2 * x; }\n');
writeFileSync(join(folder, 'scale.sk'), '#include "twice.sk"\nkernel void scale(float x<>, out float r<>) { r = twice(x); }\n');
writeFileSync(join(folder, 'wrong.sk'), 'kernel void wrong(float x<>, out float r<>) {\n  r = y;\n}\n');

/** What Vite gives to hooks as `this`. */
function context() {
  const watched = [];
  return { watched, addWatchFile: (file) => watched.push(file), error: (what) => { throw Object.assign(new Error(what.message), what); } };
}
const plugin = streamkernel({ skc: SK_SKC, options: [`-I${join(folder, 'include')}`] });

test('a .sk file is a module, and its types are beside it', async () => {
  const vite = context();
  const { code } = await plugin.load.call(vite, join(folder, 'scale.sk'));
  assert.match(code, /export const scale = \$file\.callable\(0\);/);
  assert.match(readFileSync(join(folder, 'scale.sk.d.ts'), 'utf8'), /scale: sk\.Kernel/);
  assert.ok(vite.watched.includes(join(folder, 'include', 'twice.sk')), `${vite.watched}`);
});

test('other files are left alone', async () => {
  assert.equal(await plugin.load.call(context(), join(folder, 'main.ts')), null);
});

test('messages of skc have their place', async () => {
  const file = join(folder, 'wrong.sk');
  await assert.rejects(plugin.load.call(context(), file), (error) => {
    assert.match(error.message, /undeclared identifier 'y'/);
    assert.deepEqual(error.loc, { file, line: 2, column: 6 });
    return true;
  });
});

test('a compiler that is missing is named', async () => {
  const without = streamkernel({ skc: join(folder, 'no-skc') });
  await assert.rejects(without.load.call(context(), join(folder, 'scale.sk')), /skc is not found as/);
});
