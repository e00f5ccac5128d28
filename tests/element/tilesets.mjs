// Tilesets for tests, made in memory: a hilly field as points or as a mesh, in a quadtree of tiles, as `pointweave tiles` would lay it out.

import { glb } from './files.mjs';

/** How high the hills are at a place of the unit square. */
export const height = (x, y) => 0.06 * Math.sin(9 * x) * Math.cos(7 * y) + 0.02 * Math.sin(31 * x + 17 * y);

/** From red to green along x, and darker along y; bytes of sRGB. */
export const color = (x, y) => [220 - 180 * x, 40 + 160 * x, 60 + 120 * y].map(Math.round);

const linear = (byte) => Math.round(255 * (byte / 255 <= 0.04045 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4));

/**
 * The files of a tileset by path. The field is `size` wide and deep, its lowest corner in `origin`; each level has 4 times the tiles.
 * @param {{ kind?: 'points' | 'mesh', levels?: number, side?: number, size?: number, origin?: number[], own?: boolean, meshopt?: boolean, step?: number }} [options]
 *   side: steps of a tile's grid; own: says that it is of `pointweave tiles`; step: points are whole numbers of it
 */
export async function tileset({ kind = 'points', levels = 3, side = 32, size = 100, origin = [0, 0, 0], own = true, meshopt = false, step } = {}) {
  const files = new Map();
  const spacing = (level) => size / side / 2 ** level;
  const low = -0.1 * size;
  const tile = async (level, i, j) => {
    const steps = side * 2 ** level;
    const [x0, y0] = [i * side, j * side];
    const at = (a, b) => [a / steps, b / steps];
    const vertices = [];
    const colors = [];
    // Points of a tile are its own; vertices on a border belong to both.
    const last = kind === 'points' ? side - 1 : side;
    for (let b = 0; b <= last; b++) {
      for (let a = 0; a <= last; a++) {
        const [x, y] = at(x0 + a + (kind === 'points' ? 0.5 : 0), y0 + b + (kind === 'points' ? 0.5 : 0));
        vertices.push(size * x, size * height(x, y), -size * y);
        colors.push(...color(x, y).map(linear));
      }
    }
    const indices = [];
    for (let b = 0; kind === 'mesh' && b < side; b++) {
      for (let a = 0; a < side; a++) {
        const k = a + (side + 1) * b;
        indices.push(k, k + 1, k + side + 2, k, k + side + 2, k + side + 1);
      }
    }
    const uri = `${kind}/${level}-${i}-${j}-0.glb`;
    const corner = step && [0, 1, 2].map((axis) => step * Math.floor(Math.min(...vertices.filter((_, i) => i % 3 === axis)) / step));
    const positions = Float32Array.from(step ? vertices.map((value, i) => Math.round((value - corner[i % 3]) / step)) : vertices);
    files.set(uri, await glb([{ positions, colors, ...(indices.length && { indices: Uint32Array.from(indices) }) }], { meshopt, step, at: corner }));
    const edge = size / 2 ** level;
    const children = [];
    for (let k = 0; level + 1 < levels && k < 4; k++) children.push(await tile(level + 1, 2 * i + (k & 1), 2 * j + (k >> 1)));
    return {
      boundingVolume: { box: [(i + 0.5) * edge, (j + 0.5) * edge, 0, edge / 2, 0, 0, 0, edge / 2, 0, 0, 0, -low] },
      geometricError: children.length ? spacing(level) : 0,
      content: { uri },
      ...(children.length && { children }),
    };
  };
  const root = { transform: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...origin, 1], refine: 'REPLACE', ...(await tile(0, 0, 0)) };
  const points = (side * 2 ** (levels - 1)) ** 2;
  const asset = { version: '1.1', ...(own && { extras: { pointweave: { origin, unit: 'm', points, spacing: spacing(levels - 1) } } }) };
  files.set('tileset.json', Buffer.from(JSON.stringify({ asset, geometricError: 2 * spacing(0), root })));
  return files;
}

/** Puts the files of a tileset on a site. @returns the address of its beginning */
export function putTileset(site, folder, files) {
  for (const [path, body] of files) site.put(`${folder}/${path}`, body);
  return `${folder}/tileset.json`;
}
