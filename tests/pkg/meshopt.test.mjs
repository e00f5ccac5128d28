// Compressed GLB files, by the package as it is installed: with its optional peers, and without them.

import assert from 'node:assert/strict';
import test from 'node:test';
import { WebIO } from '@gltf-transform/core';
import { EXTMeshoptCompression, KHRMeshQuantization } from '@gltf-transform/extensions';
import { validateBytes } from 'gltf-validator';
import { MeshoptDecoder } from 'meshoptimizer';
import { PEERS, engineBeside } from './installed.mjs';
import { rejection, sphere } from './support.mjs';

/** Rows of a file's vertices, sorted; triangles as the rows of their corners, sorted. */
async function contents(bytes) {
  await MeshoptDecoder.ready;
  const io = new WebIO().registerExtensions([EXTMeshoptCompression, KHRMeshQuantization]);
  const document = await io.registerDependencies({ 'meshopt.decoder': MeshoptDecoder }).readBinary(bytes);
  const nodes = document.getRoot().listNodes();
  const [primitive] = document.getRoot().listMeshes()[0].listPrimitives();
  const rows = Array.from({ length: primitive.getAttribute('POSITION').getCount() }, (_, i) =>
    primitive.listAttributes().map((accessor) => accessor.getElement(i, []).join(' ')).join(' | '));
  const corners = primitive.getIndices()?.getArray() ?? [];
  const triangles = Array.from({ length: corners.length / 3 }, (_, i) => {
    const three = [...corners.slice(3 * i, 3 * i + 3)].map((corner) => rows[corner]);
    const first = three.indexOf([...three].sort()[0]);
    return [0, 1, 2].map((k) => three[(first + k) % 3]).join(' / '); // from the same corner, in the same sense
  });
  return {
    names: primitive.listSemantics(),
    places: nodes.map((node) => [node.getTranslation(), node.getScale()]),
    rows: primitive.getIndices() ? [...rows].sort() : rows,
    triangles: triangles.sort(),
  };
}

test('compression loses nothing and makes files much smaller', async (t) => {
  const { engine, home } = await engineBeside(t, PEERS);
  const { compress } = await import(`${home}meshopt.js`);
  const cloud = { ...sphere(4000), origin: [4_512_345.625, -543_210.1, 0.1] };
  for (const [result, most] of [[await engine.reconstruct(cloud), { false: 0.6, true: 0.6 }], [await engine.reduce(cloud), { false: 0.85, true: 0.85 }]]) {
    for (const quantize of [false, true]) {
      const plain = await engine.write(result, { format: 'glb', quantize });
      const small = await engine.write(result, { format: 'glb', quantize, meshopt: true });
      const { issues } = await validateBytes(small, { ignoredIssues: ['UNSUPPORTED_EXTENSION'] });
      assert.deepEqual([issues.numErrors, issues.numWarnings], [0, 0], JSON.stringify(issues.messages));
      t.diagnostic(`${result.indices ? 'mesh' : 'points'}, ${quantize ? 'quantised' : 'exact'}: ${plain.length} → ${small.length} bytes`);
      assert.ok(small.length < most[quantize] * plain.length, `${small.length} of ${plain.length} bytes`);
      assert.deepEqual(await contents(small), await contents(plain));
      assert.deepEqual(await engine.write(result, { format: 'glb', quantize, meshopt: compress }), small);
    }
  }
});

test('without the packages the error names them, and everything else works', async (t) => {
  for (const peers of [[], PEERS.slice(0, 2)]) {
    const { engine } = await engineBeside(t, peers);
    const points = await engine.reduce(sphere(500));
    const error = await rejection(engine.write(points, { format: 'glb', meshopt: true }));
    assert.equal(error.code, 'missing-package');
    assert.match(error.message, /npm install @gltf-transform\/core @gltf-transform\/extensions meshoptimizer/);
    assert.ok((await engine.write(points, { format: 'glb', quantize: true })).length > 1000);
  }
});
