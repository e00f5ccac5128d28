// Scans that are far from zero, as maps are: nothing is rounded, the origin is shown, and files have it back.

import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';
import { read, splitOrigin } from 'pointweave';
import { PATIENCE, sharedFile, start } from './browser.mjs';
import { spherePoints, toXyz } from './scans.mjs';

/** A ball of 3 m somewhere in the north of Germany, to the tenth of a millimetre. */
const PLACE = [565_802.5, 5_934_117.25, 12];
const ball = spherePoints(4000, (direction) => direction.map((x, axis) => Number((PLACE[axis] + 1.5 * x).toFixed(4))));

/** The bits of a coordinate. */
const bits = (values) => [...new BigUint64Array(Float64Array.from(values).buffer)];

test('an origin of whole numbers is split off without loss, and only where there is something to lose', async (t) => {
  const split = (points) => splitOrigin({ positions: Float64Array.from(points.flat()) });
  const check = (name, cloud, world) => {
    const { positions, origin } = cloud;
    assert.ok(origin?.every(Number.isInteger), `${name}: ${origin}`);
    assert.deepEqual(bits(positions.map((x, i) => x + origin[i % 3])), bits(world), `${name}: the file's bits`);
    t.diagnostic(`${name}: ${origin}`);
  };
  check('ball', split(ball), ball.flat());
  const file = await read(toXyz(ball));
  check('ball, read', splitOrigin(file), ball.flat());
  check('south and west', split(ball.map((p) => p.map((x) => -x))), ball.flat().map((x) => -x));
  check('across zero in z', split(ball.map(([x, y, z]) => [x, y, z - 12])), ball.flatMap(([x, y, z]) => [x, y, z - 12]));
  const random = Array.from({ length: 9999 }, (_, i) => 7e6 + 4e5 * Math.sin(i * i) ** 3 + 1 / (i + 3));
  check('wide', splitOrigin({ positions: Float64Array.from(random) }), random);
  for (const path of ['lidar/autzen_trim.laz', 'lidar/epsg_4326.las', 'lidar/simple.laz', 'hostile/pdal_utm17_1.txt', 'hostile/pyntcloud_has_offsets.las']) {
    const bytes = await sharedFile(path);
    if (bytes) check(path, splitOrigin(await read(bytes, { name: path })), (await read(bytes, { name: path })).positions);
  }

  const near = spherePoints(500);
  assert.equal(split(near).origin, undefined, 'around zero');
  assert.deepEqual(split(near).positions, Float64Array.from(near.flat()));
  assert.equal(split([[700_000, 1, 2], [700_001, 3, 4]]).origin, undefined, 'single precision holds it');
  assert.equal(splitOrigin({ positions: Float32Array.from(ball.flat()) }).origin, undefined, 'the file had no more');
  const own = splitOrigin({ positions: Float64Array.from(ball.flat()), origin: [1, 2, 3] });
  assert.deepEqual([own.origin, own.positions], [[1, 2, 3], Float64Array.from(ball.flat())], 'it has one');
});

test('the page shows the origin, and every file that is saved has it', { timeout: PATIENCE }, async (t) => {
  const server = await start(t);
  const options = { permissions: ['clipboard-read', 'clipboard-write'] };
  const site = await server.open(options, undefined, `?src=${server.serve('ball.xyz', toXyz(ball))}#ratio=1`);
  const { page } = site;
  await site.opened('ball.xyz');
  const origin = await Promise.all(['X', 'Y', 'Z'].map((axis) => site.number(`origin${axis}`)));
  origin.forEach((value, axis) => assert.ok(Number.isInteger(value) && Math.abs(value - PLACE[axis]) <= 1, `${origin}`));
  assert.equal((await page.innerText('#origin > summary')).replace(/\s+/g, ' '), 'Origin x 565,803 y 5,934,117 z 12');
  await page.click('#origin > summary');
  assert.match(await page.innerText('#origin'), /none has to be rounded/);
  assert.equal(await page.innerText('#caption-size'), '3 × 3 × 3');

  await page.click('#made > summary');
  await page.click('#copy-json');
  await page.waitForFunction(() => document.querySelector('#copy-json').textContent === 'Copied');
  assert.deepEqual(JSON.parse(await page.evaluate(() => navigator.clipboard.readText())).scan.origin, origin);

  await page.click('#formats > summary');
  await page.waitForSelector('#save-reduced-xyz');
  const save = async (id) => {
    const saved = page.waitForEvent('download');
    await page.click(`#save-${id}`);
    return readFile(await (await saved).path());
  };
  /** Coordinates in a file are those of the ball: as far from its middle as its radius. */
  const onBall = (name, positions, precision) => {
    assert.ok(positions.length >= 3 * 1000, `${name}: ${positions.length} coordinates`);
    for (let i = 0; i < positions.length; i += 3) {
      const radius = Math.hypot(...PLACE.map((center, axis) => positions[i + axis] - center));
      assert.ok(Math.abs(radius - 1.5) < precision, `${name}: ${positions.slice(i, i + 3)}`);
    }
  };
  const numbers = (text, pattern) => [...text.matchAll(pattern)].flatMap(([, ...xyz]) => xyz.map(Number));
  for (const what of ['mesh', 'reduced']) {
    const ply = await readPly(await save(`${what}-ply`));
    onBall(`${what}.ply`, ply.positions, 0.01);
    const glb = await save(`${what}-glb`);
    const { nodes } = JSON.parse(glb.toString('utf8', 20, 20 + glb.readUInt32LE(12)));
    assert.deepEqual(nodes[0].translation, origin, `${what}.glb: the node stands at the origin`);
    const back = await read(glb);
    onBall(`${what}.glb`, back.positions, 0.01);
  }
  onBall('mesh.obj', numbers((await save('mesh-obj')).toString(), /^v (\S+) (\S+) (\S+)/gm), 0.01);
  onBall('reduced.xyz', numbers((await save('reduced-xyz')).toString(), /^(-?[\d.]+) (-?[\d.]+) (-?[\d.]+)/gm), 0.01);
  assert.match((await save('mesh-stl')).toString('latin1', 0, 80), new RegExp(`^at ${origin.map((x) => `${x}(\\.0)?`).join(' ')} `));

  // A scan at zero has none.
  await site.drop('near.xyz', toXyz(spherePoints(1500)));
  await site.opened('near.xyz');
  assert.equal(await page.isVisible('#origin'), false);
  assert.deepEqual(site.faults, []);
});

/** Coordinates of a binary PLY, which must be doubles. */
async function readPly(bytes) {
  assert.match(bytes.toString('latin1', 0, 2000), /property double x\s+property double y\s+property double z/);
  return read(bytes);
}
