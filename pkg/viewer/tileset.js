/** The file that a tileset begins with: OGC 3D Tiles 1.0 or 1.1. */
import { PointweaveError } from '../engine/errors.js';
import { fetchBytes } from './fetching.js';

/**
 * A tile, as far as it is looked at here.
 * @typedef {{ boundingVolume?: object, geometricError?: number, children?: Tile[] }} Tile
 * What `pointweave tiles` says of its own: points of the scan and of the finest level, and how far apart these are.
 * @typedef {{ points?: number, reduced?: number, spacing?: number }} Own
 * @typedef {{ asset: { version: string, extras?: { pointweave?: Own } }, geometricError: number, root: Tile, extensionsRequired?: string[] }} Tileset
 */

/** What says where a tile is. */
const VOLUMES = ['box', 'sphere', 'region'];
/** What tilesets may require that is understood, or that their GLBs say again. */
const KNOWN = /^(3DTILES_content_gltf|3DTILES_metadata|(KHR|EXT)_.+)$/;

/**
 * Fetches and checks it. Rejects with `load-failed`, `bad-file` or `unsupported-file`.
 * @param {string} url
 * @param {{ signal: AbortSignal, onProgress: (share: number) => void }} watch
 * @returns {Promise<Tileset>}
 */
export async function fetchTileset(url, watch) {
  const text = new TextDecoder().decode(await fetchBytes(url, watch));
  let tileset;
  try {
    tileset = JSON.parse(text);
  } catch (error) {
    throw bad(`it is no JSON: ${error instanceof Error ? error.message : error}`);
  }
  const { asset, root, extensionsRequired = [] } = tileset ?? {};
  if (typeof asset?.version !== 'string') throw bad('it has no asset.version, as tilesets have');
  if (!['0.0', '1.0', '1.1'].includes(asset.version)) throw unsupported(`its version is ${asset.version}: expected 1.0 or 1.1`, asset.version);
  const isPlaced = VOLUMES.some((name) => root?.boundingVolume?.[name]?.every?.(Number.isFinite));
  if (!isPlaced) throw bad('it has no root with a boundingVolume');
  const other = extensionsRequired.find((/** @type {string} */ name) => !KNOWN.test(name));
  if (other) throw unsupported(`it needs ${other}, which is not supported`, other);
  if (root.implicitTiling) throw unsupported('its tiles are not named (implicit tiling)', 'implicitTiling');
  return tileset;
}

/** How far apart the finest points are, in the tileset's unit; by its errors, where it does not say. @param {Tileset} tileset */
export function spacingOf({ asset, root }) {
  const said = asset.extras?.pointweave?.spacing;
  return said !== undefined && said > 0 ? said : finest(root);
}

/** The least error above 0 of the tiles that are named here. @param {Tile} tile @returns {number} */
function finest({ geometricError = 0, children = [] }) {
  return children.reduce((least, child) => Math.min(least, finest(child)), geometricError > 0 ? geometricError : Infinity);
}

/** @param {string} why */
function bad(why) {
  return new PointweaveError({ code: 'bad-file', message: `this is no tileset: ${why}` });
}

/** @param {string} why @param {string} found */
function unsupported(why, found) {
  return new PointweaveError({ code: 'unsupported-file', message: `this tileset cannot be shown: ${why}`, found });
}
