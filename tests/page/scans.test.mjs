// Real scans through the built page: the numbers and the drawn picture are those of the file.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { sample } from 'pointweave';
import { PATIENCE, sharedFile, start } from './browser.mjs';
import { difference, expectedSilhouette, overlap, silhouette } from './pictures.mjs';
import { mergedBunny, parseOni, parsePcd, parseXyz, toPly } from './scans.mjs';

/** Overlap of two silhouettes that show the same object. */
const SAME_SHAPE = 0.8;
/** The same for a scan so sparse that its outline is open between the points: the neck of the mask is one ring. */
const SAME_SPARSE_SHAPE = 0.7;

/** What the page keeps of its own accord: a third, but at least 2,000 and at most 60,000 points. */
function keptAtFirst(count) {
  return Math.round(Math.min(count, 60_000, Math.max(2_000, count / 3)));
}

/** What must hold after any scan was opened: numbers that fit, three different pictures of the same object. */
async function checkResult(t, site, name, points, sameShape = SAME_SHAPE) {
  assert.equal(await site.number('inputPoints'), points.length);
  assert.equal(await site.number('outputPoints'), keptAtFirst(points.length));
  assert.ok((await site.number('triangles')) > points.length / 20, 'the mesh has triangles');
  assert.ok((await site.number('errorMeanShare')) < 0.01, 'the mesh is near the points');

  const pictures = {};
  for (const view of ['points', 'reduced', 'mesh']) pictures[view] = await site.pictureOf(view, name);
  assert.ok(difference(pictures.points, pictures.reduced) > 0.01, 'scan and reduced points look different');
  assert.ok(difference(pictures.reduced, pictures.mesh) > 0.01, 'reduced points and mesh look different');

  const dots = silhouette(pictures.points);
  const { width, height } = dots.box;
  const gap = Math.ceil(1.5 * Math.sqrt((2 * width * height) / points.length)); // pixels between two points
  const scan = dots.closed(Math.max(4, gap));
  const mesh = silhouette(pictures.mesh).closed(4);
  assert.ok(mesh.area > 0.05 * mesh.width * mesh.height, 'the mesh fills a good part of the picture');
  const drawn = overlap(scan, mesh);
  const expected = overlap(expectedSilhouette(points).closed(Math.max(4, gap)).normalized(), mesh.normalized());
  t.diagnostic(`${name}: overlap of the mesh with the scan ${drawn.toFixed(3)}, with the projected points ${expected.toFixed(3)}`);
  assert.ok(drawn > sameShape, `scan and mesh cover the same pixels: ${drawn.toFixed(3)}`);
  assert.ok(expected > sameShape, `the mesh looks like the projected points: ${expected.toFixed(3)}`);
}

test('real scans', { timeout: 4 * PATIENCE }, async (t) => {
  const browser = await start(t);
  const site = await browser.open();
  await site.made();

  await t.test('kitten.xyz, dropped', async (t) => {
    const file = await sharedFile('scans/kitten.xyz');
    if (!file) return;
    await site.drop('kitten.xyz', file);
    await site.opened('kitten.xyz');
    await checkResult(t, site, 'kitten', parseXyz(file.toString()));
  });

  await t.test('oni.ply, chosen with the button', async (t) => {
    const file = await sharedFile('scans/oni.ply');
    if (!file) return;
    await site.choose('oni.ply', file);
    await site.opened('oni.ply');
    await checkResult(t, site, 'oni', parseOni(file), SAME_SPARSE_SHAPE);
  });

  await t.test('Zaghetto, converted to PLY', async (t) => {
    const file = await sharedFile('scans/Zaghetto.pcd');
    if (!file) return;
    const points = parsePcd(file);
    await site.drop('zaghetto.ply', toPly(points));
    await site.opened('zaghetto.ply');
    await checkResult(t, site, 'zaghetto', points);
  });

  await t.test('the ten raw scans of the bunny, merged', async (t) => {
    const points = await mergedBunny();
    if (!points) return;
    assert.equal(points.length, 362_272);
    await site.drop('bunny.ply', toPly(points));
    await site.opened('bunny.ply');
    await checkResult(t, site, 'bunny', points);
  });

  await t.test('the generated pig, at the size of the paper', async (t) => {
    const { positions } = await sample('pig');
    assert.equal(positions.length, 3 * 171_875);
    await site.page.click('[data-sample="pig"]');
    await site.opened('Toy pig');
    await checkResult(t, site, 'pig', Array.from({ length: 171_875 }, (_, i) => positions.subarray(3 * i, 3 * i + 3)));
    assert.equal(await site.number('boundaryEdges'), 0);
    assert.equal(await site.number('components'), 1);
  });

  assert.deepEqual(site.faults, []);
});
