// Whether a folder is a tileset that any program can show: OGC 3D Tiles 1.1, section 7 (tileset.json), explicit trees of GLBs. No registry
// ships Cesium's validator, so the rules are written down here; each GLB is checked by the Khronos group's.

import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readFile, readdir } from 'node:fs/promises';
import { join } from 'node:path';
import { WebIO } from '@gltf-transform/core';
import { EXTMeshoptCompression, KHRMeshQuantization } from '@gltf-transform/extensions';
import { validateBytes } from 'gltf-validator';
import { MeshoptDecoder } from 'meshoptimizer';

/** Vertices may be out of their box by this share of its size: 16-bit places are rounded. */
const SLACK = 1e-4;
const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

const multiplied = (a, b) => Array.from({ length: 16 }, (_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + (i % 4)] * b[4 * Math.floor(i / 4) + k], 0));
const moved = (m, [x, y, z]) => [0, 1, 2].map((i) => m[i] * x + m[4 + i] * y + m[8 + i] * z + m[12 + i]);

/**
 * Checks a tileset of boxes; rejects with all that is wrong.
 * @param {string | Map<string, Uint8Array>} from a folder, or its files by path
 * @returns {Promise<{ tiles: number, depth: number, points: number, leafPoints: number, triangles: number, leafTriangles: number, bytes: number, box: number[][] }>}
 *   box: lowest and highest corner of all vertices, in the tileset's coordinates
 */
export async function validateTileset(from) {
  const wrong = [];
  const check = (right, where, what) => right || wrong.push(`${where}: ${what}`);
  const read = async (path) => (typeof from === 'string' ? readFile(join(from, path)).catch(() => null) : from.get(path));
  await MeshoptDecoder.ready;
  const io = new WebIO().registerExtensions([EXTMeshoptCompression, KHRMeshQuantization]).registerDependencies({ 'meshopt.decoder': MeshoptDecoder });
  const found = { tiles: 0, depth: 0, points: 0, leafPoints: 0, triangles: 0, leafTriangles: 0, bytes: 0, box: [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]] };
  const named = new Set(['tileset.json']);

  const text = await read('tileset.json');
  assert.ok(text, 'there is no tileset.json');
  const { asset, geometricError, root, extensionsUsed = [], extensionsRequired = [], ...others } = JSON.parse(String(text));
  check(['1.0', '1.1'].includes(asset?.version), 'asset', `version is ${asset?.version}`);
  check(Number.isFinite(geometricError) && geometricError >= 0, 'tileset', `geometricError is ${geometricError}`);
  check(extensionsRequired.every((name) => extensionsUsed.includes(name)), 'tileset', 'extensionsRequired names what extensionsUsed does not');
  for (const name of Object.keys(others)) check(['properties', 'schema', 'schemaUri', 'statistics', 'groups', 'metadata', 'extensions', 'extras'].includes(name), 'tileset', `has a ${name}`);
  check(['ADD', 'REPLACE'].includes(root?.refine), 'root', `refine is ${root?.refine}`);
  check(root?.geometricError <= geometricError, 'root', 'its error is larger than that of the tileset');

  /** Corners of a tile's box in the tileset's coordinates, and whether something is inside of it. */
  const boxOf = (tile, matrix, where) => {
    const { box, ...rest } = tile.boundingVolume ?? {};
    const right = Array.isArray(box) && box.length === 12 && box.every(Number.isFinite) && Object.keys(rest).every((name) => ['extensions', 'extras'].includes(name));
    check(right, where, `boundingVolume is ${JSON.stringify(tile.boundingVolume)}: expected a box`);
    if (!right) return null;
    const center = moved(matrix, box.slice(0, 3));
    const axes = [3, 6, 9].map((i) => moved(matrix, box.slice(i, i + 3)).map((value, k) => value - matrix[12 + k]));
    const lengths = axes.map((axis) => Math.hypot(...axis));
    for (const [i, j] of [[0, 1], [0, 2], [1, 2]]) {
      check(Math.abs(axes[i].reduce((sum, x, k) => sum + x * axes[j][k], 0)) <= 1e-6 * lengths[i] * lengths[j], where, 'the axes of its box are not at right angles');
    }
    const slack = SLACK * Math.max(...lengths, 1e-9);
    const holds = (point) => axes.every((axis, i) => {
      const along = lengths[i] ? axis.reduce((sum, x, k) => sum + (x / lengths[i]) * (point[k] - center[k]), 0) : 0;
      return Math.abs(along) <= lengths[i] + slack;
    });
    const corners = Array.from({ length: 8 }, (_, c) => center.map((value, k) => value + axes.reduce((sum, axis, i) => sum + ((c >> i) & 1 ? axis[k] : -axis[k]), 0)));
    return { holds, corners };
  };

  const content = async (uri, matrix, box, leaf, where) => {
    const bytes = await read(decodeURIComponent(uri));
    named.add(decodeURIComponent(uri));
    check(bytes, where, `${uri} is not there`);
    if (!bytes) return;
    found.bytes += bytes.length;
    const { issues } = await validateBytes(new Uint8Array(bytes), { ignoredIssues: ['UNSUPPORTED_EXTENSION', 'BUFFER_VIEW_TARGET_MISSING', 'UNUSED_OBJECT'] });
    for (const { code, message, pointer, severity } of issues.messages) check(severity > 1, `${where} ${uri}${pointer}`, `${code}: ${message}`);
    const document = await io.readBinary(new Uint8Array(bytes));
    let out = 0;
    for (const node of document.getRoot().listNodes()) {
      // y is up in a GLB: a renderer turns it to z.
      const place = multiplied(matrix, multiplied([1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1], node.getWorldMatrix()));
      for (const primitive of node.getMesh()?.listPrimitives() ?? []) {
        const position = primitive.getAttribute('POSITION');
        const [points, triangles] = primitive.getMode() === 0 ? [position.getCount(), 0] : [0, (primitive.getIndices() ?? position).getCount() / 3];
        found.points += points;
        found.triangles += triangles;
        if (leaf) [found.leafPoints, found.leafTriangles] = [found.leafPoints + points, found.leafTriangles + triangles];
        for (let i = 0; i < position.getCount(); i++) {
          const point = moved(place, position.getElement(i, []));
          if (box && !box.holds(point)) out++;
          point.forEach((value, k) => {
            found.box[0][k] = Math.min(found.box[0][k], value);
            found.box[1][k] = Math.max(found.box[1][k], value);
          });
        }
      }
    }
    check(out === 0, `${where} ${uri}`, `${out} vertices are outside of the tile's box`);
  };

  const visit = async (tile, matrix, parent, depth, where) => {
    found.tiles++;
    found.depth = Math.max(found.depth, depth);
    const { transform = IDENTITY, children = [], refine = 'REPLACE' } = tile;
    check(transform.length === 16 && transform.every(Number.isFinite) && [3, 7, 11].every((i) => transform[i] === 0) && transform[15] === 1, where, 'transform is no affine map');
    check(!('children' in tile) || children.length > 0, where, 'children is empty');
    check(['ADD', 'REPLACE'].includes(refine), where, `refine is ${refine}`);
    check(Number.isFinite(tile.geometricError) && tile.geometricError >= 0, where, `geometricError is ${tile.geometricError}`);
    check(!parent || tile.geometricError <= parent.tile.geometricError, where, 'its error is larger than that of the tile above');
    check(!('contents' in tile), where, 'has contents: most programs show a single content');
    const here = multiplied(matrix, transform);
    const box = boxOf(tile, here, where);
    if (parent?.box && box) check(box.corners.every(parent.box.holds), where, 'its box is not inside of that above');
    const { uri } = tile.content ?? {};
    if (tile.content) {
      check(typeof uri === 'string' && !/^(\/|\w+:)/.test(uri), where, `content.uri is ${uri}: expected a relative address`);
      if (typeof uri === 'string') await content(uri, here, box, children.length === 0, where);
    }
    for (const [i, child] of children.entries()) await visit(child, here, { tile, box }, depth + 1, `${where}/${i}`);
  };
  await visit(root, IDENTITY, null, 0, 'root');

  const manifest = await read('manifest.json');
  if (manifest) {
    const { files } = JSON.parse(String(manifest));
    for (const [path, { bytes, sha256 }] of Object.entries(files)) {
      const body = await read(path);
      check(body?.length === bytes, 'manifest', `${path} has ${body?.length} bytes: expected ${bytes}`);
      named.add(path);
      check(body && createHash('sha256').update(body).digest('hex') === sha256, 'manifest', `${path} has another sha256`);
    }
    for (const path of named) check(path in files || path === 'manifest.json', 'manifest', `${path} is not in it`);
    named.add('manifest.json');
  }
  const there = typeof from === 'string' ? (await readdir(from, { recursive: true, withFileTypes: true })).filter((entry) => entry.isFile()).map((entry) => join(entry.parentPath, entry.name).slice(from.replace(/\/$/, '').length + 1)) : [...from.keys()];
  for (const path of there) check(named.has(path) || path.startsWith('work/'), path, 'nobody names it');
  assert.deepEqual(wrong.slice(0, 20), [], `${wrong.length} things are wrong`);
  return found;
}

if (import.meta.filename === process.argv[1]) console.log(await validateTileset(process.argv[2]));
