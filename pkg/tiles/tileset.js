/** The tileset as 3D Tiles 1.1 (OGC 22-025r4) has it: an explicit tree in which what is nearer takes the place of what is coarser. */
import { parentOf } from './plan.js';

/** @typedef {{ tile: string, level: number, points: number, uri: string, triangles?: number, low: number[], high: number[], bytes: number, sha256: string }} Facts */

/**
 * The root's cube is where the tileset begins: a transform puts it to its place in the world, in double precision. The error of a tile
 * is the spacing of its points, in the scan's unit; a leaf has none.
 * @param {import('./plan.js').Plan} plan
 * @param {Facts[]} facts parents before children
 * @param {{ target: number }} measures
 */
export function tilesetOf({ made, octree: { corner, size }, unit, inputs, finest = 0 }, facts, { target }) {
  const spacing = (/** @type {number} */ level) => target * 2 ** level;
  const points = inputs.reduce((sum, input) => sum + input.points, 0);
  const deepest = Math.max(...facts.map(({ level }) => level));
  /** @type {Map<string, any>} */
  const nodes = new Map();
  /** @type {any} */
  let root;
  const parents = new Set(facts.map(({ tile }) => parentOf(tile)));
  for (const { tile, level, uri, low, high, points: shown, triangles } of facts) {
    const node = {
      boundingVolume: { box: boxOf(low, high) },
      geometricError: parents.has(tile) ? spacing(level) : 0,
      content: { uri },
      extras: triangles === undefined ? { points: shown } : { triangles },
    };
    nodes.set(tile, node);
    const above = nodes.get(parentOf(tile) ?? '');
    if (above) (above.children ??= []).push(node);
    else root = { transform: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...corner, 1], ...node, refine: 'REPLACE' };
    if (!above) nodes.set(tile, root);
  }
  // A parent's box holds its children's.
  for (const { tile } of facts.toReversed()) {
    const node = nodes.get(tile);
    const boxes = [node, ...(node.children ?? [])].map(({ boundingVolume: { box } }) => box);
    if (boxes.length > 1) node.boundingVolume = { box: around(boxes) };
  }
  const shown = facts.filter(({ tile }) => !parents.has(tile)).reduce((sum, fact) => sum + fact.points, 0);
  return {
    asset: { version: '1.1', extras: { pointweave: { made, points, reduced: shown, spacing: target * 2 ** finest, origin: corner, size, ...(unit && { unit }) } } },
    geometricError: spacing(deepest + 1),
    root,
  };
}

/** Centre and half axes. @param {number[]} low @param {number[]} high */
function boxOf(low, high) {
  // A box has a size, whatever is in it.
  const least = Math.max(...high.map((x, axis) => x - low[axis]), 1e-9) * 1e-6;
  const [x, y, z] = low.map((from, axis) => Math.max(high[axis] - from, least) / 2);
  return [...low.map((from, axis) => (from + high[axis]) / 2), x, 0, 0, 0, y, 0, 0, 0, z];
}

/** @param {number[][]} boxes */
function around(boxes) {
  const low = [0, 1, 2].map((axis) => Math.min(...boxes.map((box) => box[axis] - box[3 + 4 * axis])));
  const high = [0, 1, 2].map((axis) => Math.max(...boxes.map((box) => box[axis] + box[3 + 4 * axis])));
  return boxOf(low, high);
}
