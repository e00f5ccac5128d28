/**
 * One level of detail takes the place of another bit by bit: what comes is drawn where a 4 × 4 pattern of the screen is below its share,
 * what goes where the pattern is above. Both move on together, so there is no hole. It counts time from when a tile comes or goes, as
 * pictures are only drawn when something changes; the renderer's own plugin counts from the last picture.
 */
import { Vector2 } from 'three';

/** @import { Material, Object3D } from 'three' */
/** @import { Tile } from '3d-tiles-renderer' */

const DURATION_MS = 250;

/** Gives the materials of a tile what fading needs. @param {Object3D} scene */
export function fadable(scene) {
  for (const material of materialsOf(scene)) {
    if (material.userData.fade) continue;
    const fade = (material.userData.fade = { value: new Vector2(1, 0) });
    const before = material.onBeforeCompile;
    material.onBeforeCompile = (shader, renderer) => {
      before.call(material, shader, renderer);
      shader.uniforms.fade = fade;
      shader.fragmentShader = shader.fragmentShader.replace('void main() {', /* glsl */ `
        uniform vec2 fade; // how much has come, how much has gone
        float pattern(ivec2 at) {
          ivec2 coarse = (at >> 1) & 1, fine = at & 1;
          return (float(4 * (3 * fine.y + 2 * fine.x & 3) + (3 * coarse.y + 2 * coarse.x & 3)) + 0.5) / 16.0;
        }
        void main() {
          if (fade != vec2(1.0, 0.0)) {
            float share = pattern(ivec2(gl_FragCoord.xy));
            if (share >= fade.x || share < fade.y) discard;
          }`);
    };
  }
}

/** @param {Object3D} scene @returns {Set<Material>} */
function materialsOf(scene) {
  const found = new Set();
  scene.traverse((object) => [/** @type {import('three').Mesh} */ (object).material ?? []].flat().forEach((material) => found.add(material)));
  return found;
}

/** A plugin of the renderer: what is to be hidden stays until it has faded. */
export class Fades {
  name = 'POINTWEAVE_FADES';
  #tiles = /** @type {any} */ (null);
  #duration;
  /** @type {Map<Tile, { out: boolean, start: number }>} */
  #under = new Map();

  /** @param {boolean} calm nothing fades */
  constructor(calm) {
    this.#duration = calm ? 0 : DURATION_MS;
  }

  /** The renderer hands itself over. @param {any} tiles */
  init(tiles) {
    this.#tiles = tiles;
    tiles.addEventListener('dispose-model', (/** @type {{ tile: Tile }} */ { tile }) => this.#end(tile));
  }

  get running() {
    return this.#under.size > 0;
  }

  /** The renderer shows or hides a tile; says whether that is taken care of. @param {any} tile @param {boolean} visible */
  setTileVisible(tile, visible) {
    const under = this.#under.get(tile);
    this.#under.delete(tile);
    set(tile, 1, 0);
    if (visible && under?.out) return true; // it is there still
    // What the camera turns to or away from has nothing that it takes the place of.
    const exchanged = tile.traversal.wasInFrustum && (visible ? tile.internal.depthFromRenderedParent > 1 || this.#tiles.visibleTiles.size : tile.traversal.inFrustum);
    if (!this.#duration || !exchanged || under) return false;
    this.#under.set(tile, { out: !visible, start: performance.now() });
    set(tile, visible ? 0 : 1, 0);
    return !visible;
  }

  /** Moves on; once a picture. */
  step() {
    const now = performance.now();
    for (const [tile, { out, start }] of this.#under) {
      const share = (now - start) / this.#duration;
      this.#tiles.markTileUsed(tile);
      if (share >= 1) this.#end(tile);
      else set(tile, out ? 1 : share, out ? share : 0);
    }
  }

  /** All at once: too many are drawn. */
  hurry() {
    for (const tile of this.#under.keys()) this.#end(tile);
  }

  /** @param {Tile} tile */
  #end(tile) {
    const under = this.#under.get(tile);
    if (!under) return;
    this.#under.delete(tile);
    set(tile, 1, 0);
    if (under.out) this.#tiles.setTileVisible(tile, false);
  }
}

/** @param {any} tile @param {number} come @param {number} gone */
function set({ engineData: { scene } }, come, gone) {
  if (scene) for (const material of materialsOf(scene)) material.userData.fade?.value.set(come, gone);
}
