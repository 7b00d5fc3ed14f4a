// SPDX-License-Identifier: MIT
//
// Replays decisions of the C++ runtime (runtime/tests/web_decisions.cpp).
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

const folder = process.env.SK_WEB;
const { layoutOf } = await import(`${folder}/streamkernel/layout.js`);
const { planReduction, leastKnownRuns } = await import(`${folder}/streamkernel/reduce_plan.js`);
const { planPyramid } = await import(`${folder}/streamkernel/pyramid.js`);
const { planScan } = await import(`${folder}/streamkernel/scan_plan.js`);
const { blockGrids } = await import(`${folder}/streamkernel/block_grid.js`);
const { xFirst } = await import(`${folder}/streamkernel/layout.js`);
const { kernelKey } = await import(`${folder}/streamkernel/variant.js`);
const { drawsOf } = await import(`${folder}/streamkernel/copy.js`);
const { regionOf, strided, View } = await import(`${folder}/streamkernel/stream.js`);
const corpus = JSON.parse(readFileSync(`${folder}/decisions.json`));

const rects = (list) => list.map(({ x, y, width, height }) => [x, y, width, height]);

test('streams lie in the same texels', () => {
  assert.ok(corpus.layouts.some(({ layout }) => layout === null), 'no stream is too large');
  for (const { stream, textureSize, layout } of corpus.layouts) {
    const place = () => layoutOf(stream.shape, textureSize, stream.packed);
    if (layout === null) {
      assert.throws(place, { name: 'SkError', kind: 'shape' });
      continue;
    }
    const found = place();
    assert.deepEqual({ ...found, draws: rects(found.draws) }, layout, JSON.stringify(stream));
  }
});

/**
 * The key that skc gives a pass's program. Programs by index, and those of scans, take any number of runs and blocks, and
 * decode an index as that of a plane, one component, or all four.
 */
function keyOf({ walk, axes, run, column, packed, scan }, elements, isGeneral) {
  const decoded = !elements.linear ? 2 : axes === 1 ? 1 : 4;
  const index = walk === 'index' && decoded > 1 ? ` axes${decoded}` : '';
  const choices = [isGeneral && ' split to plane', index, run > 0 && ` run${run}`, column && ' column', packed && ' packed', scan, / .*clusive/.test(scan) && ' carried'];
  return walk + choices.filter(Boolean).join('');
}

function samePasses(found, passes, elements, isGeneral, where) {
  assert.equal(found.length, passes.length, where);
  found.forEach((pass, i) => {
    const wanted = passes[i];
    assert.equal(pass.key, keyOf(wanted, elements, isGeneral), where);
    assert.equal(pass.toResult, wanted.toResult, where);
    if (!wanted.toResult) assert.deepEqual([pass.width, pass.height], [wanted.width, wanted.height], where);
    assert.deepEqual(rects(pass.draws), wanted.draws, where);
    const own = Object.fromEntries(pass.uniforms);
    for (const [name, value] of Object.entries(wanted.uniforms)) {
      // Rows are stored from sk_target on, and the origins of whole streams are 0, which uniforms are anyway.
      const isUnused = name.endsWith('_origin') || (name.startsWith('sk_domain_') && pass.walk.endsWith('ows'));
      const isTexture = isGeneral && name === 'sk_domain_shape';
      if (!isUnused || name in own) assert.deepEqual(own[name], isTexture ? [pass.width, pass.height, 1, 1] : value, `${name} ${where}`);
    }
    assert.ok(Object.keys(own).every((name) => name in wanted.uniforms || (name === 'sk_carry_shift' && own[name] === 0)), where);
  });
}

test('reductions have the same passes and uniforms', () => {
  for (const { stream, byIndex, inAnyOrder, knownRuns, passes } of corpus.reductions) {
    const elements = layoutOf(stream.shape, 8192, stream.packed);
    const limits = { textureSize: 8192, knownRuns: knownRuns ? leastKnownRuns : Infinity };
    const found = planReduction(elements, limits, { byIndex, byTexel: stream.packed, inAnyOrder });
    samePasses(found, passes, elements, byIndex, JSON.stringify(stream));
  }
});

test('reductions to streams have the same blocks, passes and uniforms', () => {
  const counts = [0, 0, 0];
  for (const { stream, result, grids, passes } of corpus.blocks) {
    const where = JSON.stringify([stream, result]);
    const found = blockGrids(stream.shape, result.shape);
    assert.deepEqual(found, grids, where);
    ++counts[Math.min(found.length, 2)];
    if (passes === null) continue;
    const [elements, target] = [stream, result].map(({ shape }) => layoutOf(shape, 8192, false));
    const division = { byIndex: true, byTexel: false, inAnyOrder: false, blocks: xFirst(found[0]) };
    samePasses(planReduction(elements, { textureSize: 8192, knownRuns: Infinity }, division, target), passes, elements, true, where);
  }
  assert.ok(counts.every((count) => count > 9), `${counts} results mean no division into blocks, one, and several`);
});

test('scans have the same passes and uniforms', () => {
  for (const { stream, byIndex, exclusive, along, folds, scans } of corpus.scans) {
    const elements = layoutOf(stream.shape, 8192, false);
    const dimension = along < 0 ? undefined : stream.shape.length - 1 - along;
    const found = planScan(elements, elements, 8192, dimension, byIndex, exclusive);
    const where = JSON.stringify([stream, byIndex, exclusive, along]);
    samePasses(found.folds, folds, elements, true, where);
    samePasses(found.scans, scans, elements, true, where);
  }
});

test('pushes are summed in the same pyramids', () => {
  for (const { count, levels, ...wanted } of corpus.pyramids) {
    const { levels: found, ...textures } = planPyramid(count, 8192);
    assert.deepEqual(textures, wanted, `${count}`);
    assert.deepEqual(found.map((level) => ({ ...level, draws: rects(level.draws) })), levels, `${count}`);
  }
  assert.throws(() => planPyramid(2 ** 27, 64), { name: 'SkError', kind: 'shape' });
});

test('kernels need the same programs', () => {
  const elements = [{ name: 'float', size: 4, fields: [{ scalar: 'float', width: 1, offset: 0 }] }];
  const names = ['x', 'a', 'b', 'c', 'r'];
  for (const { streams, reaches, linear, rank, packed, access } of corpus.variants) {
    const shared = new Map();
    const place = ({ shape, packed: isPacked }) => {
      const layout = layoutOf(shape, 8192, isPacked);
      const text = JSON.stringify(layout);
      if (!shared.has(text)) shared.set(text, layout); // as a device shares them
      return shared.get(text);
    };
    const lies = streams.map(place);
    const parameters = names.map((name, i) => {
      const role = i === 0 ? 'input' : i < 4 ? 'gather' : 'output';
      return { name, symbol: name, role, element: 0, rank: i, ...(reaches[i] >= 0 && i > 0 && i < 4 ? { reach: reaches[i] } : {}) };
    });
    const domain = lies[4];
    const key = kernelKey(parameters, elements, [...lies.slice(0, 4), null], domain, [], false);
    // Programs for linearised domains decode one dimension, or all.
    const kind = linear ? (rank === 1 ? 'linear1' : 'linear4') : 'plane';
    const wanted = kind + (packed ? ' packed' : '') + access.map((one, i) => `; ${names[i]}:${one}`).join('');
    assert.equal(key, wanted, JSON.stringify(streams));
  }
});

test('views have the same elements', () => {
  for (const { stream: whole, begin, shape, steps, texels, draws } of corpus.views) {
    const layout = layoutOf(whole.shape, 8192, false);
    const view = new View({ shape: whole.shape, layout, planes: [] }, shape, begin, steps);
    const where = JSON.stringify({ whole, begin, shape, steps });
    const { linear, origin, stride, shift } = strided(view, [1, 1, 1, 1]);
    const region = regionOf(view);
    const { length } = texels;
    assert.ok(length > 0);
    for (const [index, texel] of texels) {
      const sum = (of) => index.reduce((all, i, d) => all + i * of[d], 0);
      const number = origin[0] + sum(stride);
      const found = linear ? [number & ((1 << shift) - 1), number >> shift] : [origin[0] + index[0] * stride[0], origin[1] + index[1] * stride[1]];
      assert.deepEqual(found, texel, where);
      const copied = region.first + sum(region.strides);
      assert.deepEqual([copied % region.width, Math.floor(copied / region.width)], texel, where);
    }
    const xFirst = [0, 1, 2, 3].map((d) => shape[shape.length - 1 - d] ?? 1);
    if (draws !== null) assert.deepEqual(rects(drawsOf(xFirst, region)), draws, where);
  }
});
