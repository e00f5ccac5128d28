// Tiles read a part of what is there: of large files the chunks that are theirs, of sorted points those near a border.

import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { write } from 'pointweave';
import { CellWriter, readCells } from '../../pkg/tiles/cells.js';
import { joined } from '../../pkg/tiles/columns.js';
import { partsOf } from '../../pkg/tiles/parts.js';
import { readScan, toldTogether } from '../../pkg/tiles/scan.js';

const SIGNAL = new AbortController().signal;

function folder(t) {
  const path = mkdtempSync(join(tmpdir(), 'pointweave-parts-'));
  t.after(() => rmSync(path, { recursive: true }));
  return path;
}

/** A scan whose points are told apart by their intensity. */
async function scan(path, count, format) {
  const positions = new Float64Array(3 * count);
  const intensity = new Float32Array(count);
  for (let i = 0; i < count; i++) {
    positions.set([4e5 + (i % 977) / 10, 5.7e6 + Math.floor(i / 977) / 10, Math.sin(i / 500)], 3 * i);
    intensity[i] = i % 65521;
  }
  const colors = Uint8Array.from({ length: 3 * count }, (_, i) => i % 251);
  writeFileSync(path, await write({ positions, colors, attributes: { intensity } }, { format }));
}

async function all(path, part) {
  const blocks = [];
  const summary = await readScan(path, part, {}, SIGNAL, async ({ positions, colors, names, values }) => void blocks.push({ positions, colors, values: names.map((name, i) => [name, values[i]]) }));
  const flat = (of) => blocks.flatMap((block) => Array.from(of(block)));
  const intensity = flat(({ values }) => values.find(([name]) => name === 'intensity')[1]);
  return { summary, positions: flat(({ positions }) => positions), colors: flat(({ colors }) => colors), intensity };
}

for (const format of ['laz', 'las']) {
  test(`the parts of a ${format} file have its points`, async (t) => {
    const path = join(folder(t), `scan.${format}`);
    await scan(path, 240_000, format);
    const { size } = statSync(path);
    assert.deepEqual(await partsOf(path, SIGNAL), []);
    const parts = await partsOf(path, SIGNAL, Math.ceil(size / 5));
    assert.ok(parts.length >= 3, `${parts.length} parts`);
    assert.equal(parts.reduce((sum, { points }) => sum + points, 0), 240_000);
    const whole = await all(path);
    const read = [];
    for (const part of parts) read.push(await all(path, part));
    for (const what of ['positions', 'colors', 'intensity']) assert.deepEqual(read.flatMap((part) => part[what]), whole[what]);
    read.forEach(({ intensity }, i) => assert.equal(intensity.length, parts[i].points));
  });
}

test('a file that cannot be parted is read whole', async (t) => {
  const path = folder(t);
  await scan(join(path, 'scan.ply'), 5000, 'ply');
  await scan(join(path, 'scan.laz'), 120_000, 'laz');
  const laz = readFileSync(join(path, 'scan.laz'));
  // The place of the table of the chunks is nowhere, and the table says nothing.
  const start = laz.readUInt32LE(96);
  laz.fill(255, start, start + 8).fill(0, laz.length - 8);
  writeFileSync(join(path, 'no-table.laz'), laz);
  for (const name of ['scan.ply', 'no-table.laz']) assert.deepEqual(await partsOf(join(path, name), SIGNAL, 1000), []);
});

test('what parts of a file tell is told of all', () => {
  const leftOut = { huge: false, noData: [[], [], []], noReturns: [] };
  const dark = { format: 'las', colorScale: 1, hasColors: true, attributes: ['intensity'], leftOut };
  const bright = { ...dark, colorScale: 1 / 257, attributes: ['intensity', 'user_data'], leftOut: { ...leftOut, noData: [[], [], [-9999]] } };
  const grey = { ...dark, hasColors: false, colorScale: 0.001 };
  const told = toldTogether([dark, bright, grey]);
  assert.deepEqual([told.colorScale, told.hasColors, told.attributes], [1 / 257, true, ['intensity', 'user_data']]);
  assert.deepEqual(told.leftOut.noData, [[], [], [-9999]]);
});

test('of sorted points those of a range are read, and hardly more', async (t) => {
  const path = folder(t);
  mkdirSync(join(path, 'sorted'));
  const tile = '2-1-2-0';
  const side = 2 ** 30;
  const count = 200_000;
  let seed = 7;
  const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
  const places = new Uint32Array(3 * count);
  for (let i = 0; i < count; i++) places.set([side * (1 + random()), side * (2 + random()), side * 0.4], 3 * i);
  const values = [Float32Array.from({ length: count }, (_, i) => i)];
  const writer = new CellWriter(join(path, 'sorted'), new Map([[tile, count]]));
  for (let from = 0; from < count; from += 30_000) {
    const to = Math.min(from + 30_000, count);
    writer.add(tile, { places: places.subarray(3 * from, 3 * to), names: ['i'], values: [values[0].subarray(from, to)] });
    if (writer.held > 1 << 20) await writer.flush();
  }
  await writer.end();
  const file = join(path, 'sorted', `${tile}.bin`);
  assert.ok(existsSync(file));
  const whole = joined(await readCells(file, tile), ['i']);
  assert.deepEqual(Array.from(whole.values[0]).sort((a, b) => a - b), Array.from(values[0]));
  // A neighbour's halo: a strip along one side.
  const range = [2 * side - side / 40, 0, 0, 3 * side, 4 * side, side];
  const strip = joined(await readCells(file, tile, range), ['i']);
  const expected = Array.from({ length: count }, (_, i) => i).filter((i) => places[3 * i] >= range[0]);
  assert.deepEqual(Array.from(strip.values[0]).sort((a, b) => a - b), expected);
  // All blocks but those of one row of cells may be damaged.
  const bytes = readFileSync(file);
  const { cells, blocks } = JSON.parse(bytes.subarray(-4 - bytes.readUInt32LE(bytes.length - 4), -4));
  assert.equal(cells, 16);
  for (const [cell, from, to] of blocks) if (Math.floor(cell / cells ** 2) < cells - 1) bytes.fill(0, from, to);
  writeFileSync(file, bytes);
  assert.deepEqual(joined(await readCells(file, tile, range), ['i']), strip);
  writeFileSync(file, bytes.subarray(0, 2));
  await assert.rejects(readCells(file, tile), { code: 'bad-file', message: /is damaged/ });
});
