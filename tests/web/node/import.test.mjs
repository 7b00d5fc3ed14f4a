// SPDX-License-Identifier: MIT
//
// The package where there is no browser: servers that render pages import it, too.
import assert from 'node:assert/strict';
import { test } from 'node:test';

const { Device, SkError, fileOf } = await import(`${process.env.SK_WEB}/streamkernel/index.js`);

test('a device needs a browser', async () => {
  await assert.rejects(Device.create(), (error) => error instanceof SkError && error.kind === 'device' && /a browser/.test(error.message));
});

test('a module of another release is refused', () => {
  for (const schema of [1, 99]) {
    const file = { schema, name: 'heat.sk', sources: [], elements: [], structs: [], callables: [] };
    assert.throws(() => fileOf(file, []), new RegExp(`has version ${schema} .*use skc and the package streamkernel of one release`));
  }
});
