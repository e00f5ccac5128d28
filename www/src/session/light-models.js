import { createEngine, write } from 'pointweave';
import { scaled } from '../measure/lengths.js';
import { webAside } from './compressing.js';

/**
 * @import { SurfaceMesh, WriteOptions } from 'pointweave'
 * @import { Outcome } from './session.js'
 * A file of a model: what it is called, what it is good for, and how it is written.
 * @typedef {{ label: string, use: string, options: WriteOptions }} Kind
 * What a model is made for. Without `light`, the mesh is saved as it is. @typedef {{ label: string, light?: { triangles: number, size: number }, kinds: Kind[] }} Preset
 * @typedef {{ signal: AbortSignal, onProgress: (share: number) => void }} Watch
 */

/** @type {Kind} */
const SMALL = { label: 'GLB', use: 'for the web', options: { format: 'glb', quantize: true, meshopt: webAside } };

/** @type {Record<string, Preset>} */
export const PRESETS = {
  thumbnail: { label: 'Thumbnail', light: { triangles: 2_000, size: 512 }, kinds: [SMALL] },
  catalogue: { label: 'Catalogue', light: { triangles: 20_000, size: 2048 }, kinds: [SMALL] },
  'close-up': { label: 'Close-up', light: { triangles: 100_000, size: 4096 }, kinds: [SMALL] },
  ar: {
    label: 'AR', light: { triangles: 20_000, size: 2048 },
    kinds: [{ label: 'USDZ', use: 'for iPhone and iPad', options: { format: 'usdz' } }, { label: 'GLB', use: 'for Android', options: { format: 'glb' } }],
  },
  print: {
    label: 'Print',
    kinds: [{ label: 'STL', use: 'for 3D printing', options: { format: 'stl' } }, { label: '3MF', use: 'for 3D printing, in colour', options: { format: '3mf' } }],
  },
};

/** Light models of what was made: each is made once, when it is asked for. */
export class LightModels {
  /** @type {Outcome | null} */
  #outcome = null;
  /** @type {Map<string, SurfaceMesh>} */
  #made = new Map();

  /** What models are made of from now on. @param {Outcome | null} outcome */
  of(outcome) {
    this.#outcome = outcome;
    this.#made.clear();
  }

  /**
   * The model for a purpose, in an engine of its own, so that nothing else waits.
   * @param {Preset} preset
   * @param {Watch} watch
   * @returns {Promise<SurfaceMesh>}
   */
  async model({ light }, { signal, onProgress }) {
    const { mesh, scan } = /** @type {Outcome & { mesh: SurfaceMesh }} */ (this.#outcome);
    if (!light) return mesh;
    const key = JSON.stringify(light);
    const known = this.#made.get(key);
    if (known) return known;
    const engine = await createEngine({ threads: 1 });
    try {
      const { attributes, colors, distances, ...bare } = mesh;
      const made = await engine.texture(bare, scan.cloud, { ...light, signal, onProgress: ({ overall }) => onProgress(overall) });
      signal.throwIfAborted();
      this.#made.set(key, /** @type {SurfaceMesh} */ (made));
      return /** @type {SurfaceMesh} */ (made);
    } finally {
      await engine.dispose();
    }
  }
}

/** The bytes of a file of a model. @param {SurfaceMesh} model @param {number} scale @param {Kind} kind */
export async function fileOf(model, scale, { options }) {
  const bytes = await write(scaled(model, scale), options);
  return new Blob([/** @type {Uint8Array<ArrayBuffer>} */ (bytes)], { type: 'application/octet-stream' });
}
