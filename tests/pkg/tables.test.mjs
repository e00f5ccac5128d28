// Tables of text, sentinels and archives, as JavaScript gets them. What is told from what is tested natively.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import { read } from 'pointweave';
import { merged } from '../../pkg/files/merging.js';
import { engineFor, rejection } from './support.mjs';

const bytes = (text) => new TextEncoder().encode(text);

test('a table says what its columns were taken for', async () => {
  const cloud = await read(bytes('Northing [m];Easting [m];Elevation [m];Code\n1,5;2,5;3,5;7\n4,5;5,5;6,5;8\n'));
  assert.deepEqual(cloud.columns, ['y', 'x', 'z', 'Code']);
  assert.deepEqual([...cloud.positions], [2.5, 1.5, 3.5, 5.5, 4.5, 6.5]);
  assert.deepEqual([...cloud.attributes.Code], [7, 8]);
  assert.deepEqual(cloud.skipped, {});
  const { table } = cloud.file;
  assert.deepEqual([table.delimiter, table.decimal, table.weak], [';', ',', false]);
  assert.deepEqual(table.names, ['Northing [m]', 'Easting [m]', 'Elevation [m]', 'Code']);
  assert.deepEqual(table.rows[0], ['1,5', '2,5', '3,5', '7']);
});

test('a table that is refused shows its first rows', async (t) => {
  const text = bytes('right;up;deep;what\n1,5;2,5;3,5;a\n4,5;5,5;6,5;b\n');
  const refused = await rejection(read(text, { name: 'scan.csv' }));
  assert.equal(refused.code, 'bad-file');
  const { rows, names, delimiter, decimal } = refused.table;
  assert.deepEqual([rows[0], names, delimiter, decimal], [['1,5', '2,5', '3,5', 'a'], ['right', 'up', 'deep', 'what'], ';', ',']);
  const cloud = await read(text, { columns: ['x', 'z', 'y', '-'] });
  assert.deepEqual([...cloud.positions], [1.5, 3.5, 2.5, 4.5, 6.5, 5.5]);
  assert.equal((await rejection(read(bytes('ply\nformat x\n')))).table, undefined);
  // Behind a worker's border, too.
  const engine = await engineFor(t, { threads: 1, worker: true });
  assert.deepEqual((await rejection(engine.read(text, { name: 'scan.csv' }))).table.rows, rows);
});

test('the caller says what the columns are', async () => {
  const table = bytes('# made by hand\na:b:c:d\n9:1:2:3\n8:4:5:6\n');
  const cloud = await read(table, { columns: ['weight', 'x', 'y', 'z'], delimiter: ':', skip: 1 });
  assert.deepEqual([...cloud.positions], [1, 2, 3, 4, 5, 6]);
  assert.deepEqual([...cloud.attributes.weight], [9, 8]);
  const commas = await read(bytes('1,5 2,5 3,5\n'), { delimiter: ' ', decimal: ',' });
  assert.deepEqual([...commas.positions], [1.5, 2.5, 3.5]);
  for (const options of [{ columns: 'x,y,z' }, { columns: ['x', 'y'] }, { delimiter: ', ' }, { decimal: ';' }, { skip: -1 }, { sentinels: 'no' }]) {
    assert.equal((await rejection(read(table, options))).code, 'bad-option', JSON.stringify(options));
  }
});

test('points that are none leave every array, in slices too', async (t) => {
  const rows = Array.from({ length: 400_000 }, (_, i) => {
    const height = i % 1000 === 7 ? -9999 : 100 + (i % 77) / 8;
    return `${500_000 + (i % 700)}.25 ${5_600_000 + Math.floor(i / 700)} ${height} ${i % 256} 0 9 ${i}`;
  });
  const table = bytes(`x y z red green blue number\n${rows.join('\n')}\n`);
  for (const options of [{ threads: 1 }, { threads: 2 }]) {
    const engine = await engineFor(t, options);
    const cloud = await engine.read(table);
    assert.equal(cloud.positions.length / 3, 399_600);
    assert.deepEqual(cloud.skipped, { 'no-data': 400 });
    assert.equal(cloud.colors.length / 3, 399_600);
    const number = cloud.attributes.number;
    assert.deepEqual([number[6], number[7], number.at(-1)], [6, 8, 399_999]);
    assert.equal(cloud.colors[3 * 7], 8);
    const kept = await engine.read(table, { sentinels: 'keep' });
    assert.equal(kept.positions.length / 3, 400_000);
    assert.deepEqual(kept.skipped, {});
  }
});

test('an attribute that comes late was 0 before', async () => {
  // Point format 1: 28 bytes a point, the user data at 17.
  const count = 200_000;
  const file = new Uint8Array(227 + 28 * count);
  const view = new DataView(file.buffer);
  file.set(bytes('LASF'));
  file.set([1, 2], 24);
  view.setUint16(94, 227, true);
  view.setUint32(96, 227, true);
  file[104] = 1;
  view.setUint16(105, 28, true);
  view.setUint32(107, count, true);
  [131, 139, 147].forEach((at) => view.setFloat64(at, 0.01, true));
  for (let i = 0; i < count; i++) {
    view.setInt32(227 + 28 * i, i, true);
    file[227 + 28 * i + 17] = i >= 199_990 ? 3 : 0;
  }
  const { attributes } = await read(file);
  assert.deepEqual(Object.keys(attributes), ['intensity', 'classification', 'user_data']);
  assert.deepEqual([attributes.user_data[0], attributes.user_data.at(-1), attributes.user_data.length], [0, 3, count]);
});

/** A ZIP file of files that are stored. @param {Record<string, string>} files */
function zip(files) {
  const parts = [];
  const directory = [];
  let at = 0;
  const entries = Object.entries(files);
  for (const [name, text] of entries) {
    const [path, content] = [bytes(name), bytes(text)];
    const common = Buffer.alloc(26);
    common.writeUInt16LE(20, 0);
    common.writeUInt32LE(content.length, 14);
    common.writeUInt32LE(content.length, 18);
    common.writeUInt16LE(path.length, 22);
    const place = Buffer.alloc(14);
    place.writeUInt32LE(at, 10);
    directory.push(Buffer.from('PK\x01\x02\x14\x00', 'latin1'), common, place, path);
    parts.push(Buffer.from('PK\x03\x04', 'latin1'), common, path, content);
    at += 30 + path.length + content.length;
  }
  const list = Buffer.concat(directory);
  const end = Buffer.alloc(22);
  end.write('PK\x05\x06', 'latin1');
  end.writeUInt16LE(entries.length, 8);
  end.writeUInt16LE(entries.length, 10);
  end.writeUInt32LE(list.length, 12);
  end.writeUInt32LE(at, 16);
  return Buffer.concat([...parts, list, end]);
}

const PLY = 'ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n1 2 3 9 8 7\n4 5 6 9 8 7\n';

test('the scans of an archive are one cloud', async (t) => {
  const archive = zip({ 'readme.txt': 'hello', 'a/one.ply': PLY, 'two.xyz': 'x y z a\n7 8 9 5\n', '__MACOSX/._one.ply': 'no' });
  for (const options of [{ threads: 1 }, { threads: 2 }]) {
    const engine = await engineFor(t, options);
    /** @type {number[]} */
    const told = [];
    const cloud = await engine.read(archive, { name: 'scans.zip', onProgress: ({ overall }) => told.push(overall) });
    assert.deepEqual([...cloud.positions], [1, 2, 3, 4, 5, 6, 7, 8, 9]);
    assert.deepEqual([...cloud.colors], [9, 8, 7, 9, 8, 7, 255, 255, 255]);
    assert.deepEqual([...cloud.attributes.a], [0, 0, 5]);
    assert.deepEqual(cloud.file.notes, ['The points are those of 2 files: a/one.ply, two.xyz.']);
    assert.deepEqual([cloud.columns, cloud.file.table], [undefined, undefined]);
    assert.ok(told.every((share, i) => i === 0 || share >= told[i - 1]) && told.at(-1) === 1, String(told));
  }
  assert.equal((await read(zip({ 'notes.txt': '1 2 3\n' }))).positions.length, 3);
  assert.equal((await read(gzipSync(PLY), { name: 'scan.ply.gz' })).positions.length, 6);
  const members = Buffer.concat(['1 2 3\n4 5 6\n', '7 8 9\n'].map((part) => gzipSync(part)));
  assert.deepEqual([...(await read(members, { name: 'scan.xyz.gz' })).positions], [1, 2, 3, 4, 5, 6, 7, 8, 9]);
  const none = await rejection(read(zip({ 'a.doc': 'x', 'b.doc': 'y' })));
  assert.deepEqual([none.code, none.found], ['unsupported-file', 'a.doc, b.doc']);
});

test('scans of one reference system keep it', () => {
  const scan = (/** @type {number[]} */ ...keys) => ({
    positions: Float64Array.of(1, 2, 3),
    crs: { keys: Uint16Array.from(keys) },
    file: { format: 'las', dropped: 0, replaced: 0, faces: 0, notes: [] },
  });
  const names = ['a.las', 'b.las'];
  assert.deepEqual(merged([scan(1, 2), scan(1, 2)], names).crs, { keys: Uint16Array.of(1, 2) });
  assert.ok(!('crs' in merged([scan(1, 2), scan(1, 3)], names)));
});

test('the command line says what the columns are, and what was left out', () => {
  const folder = mkdtempSync(join(tmpdir(), 'pointweave-tables-'));
  const file = join(folder, 'scan.txt');
  const rows = Array.from({ length: 400 }, (_, i) => `${i % 9 === 0 ? -9999 : 5 + Math.sin(i)};${i % 20}.5;${Math.floor(i / 20)}`);
  writeFileSync(file, `a;b;c\n${rows.join('\n')}\n`);
  const cli = fileURLToPath(new URL('../../pkg/cli.js', import.meta.url));
  const run = (...flags) => execFileSync(process.execPath, [cli, 'inspect', file, ...flags], { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
  const told = run('--columns', 'z,x,y');
  assert.match(told, /columns +z x y\n/);
  assert.match(told, /left out +45 without data \(such as -9999\)\n/);
  const { count, skipped } = JSON.parse(run('--columns', 'z,x,y', '--delimiter', 'semicolon', '--skip', '1', '--sentinels', 'keep', '--json'));
  assert.deepEqual([count, skipped], [400, {}]);
  for (const flags of [[], ['--columns', 'a,b,c'], ['--columns', 'x,y,z', '--decimal', 'x']]) assert.throws(() => run(...flags));
});
