/** Pictures on meshes of the package. */
import { BufferAttribute, LinearSRGBColorSpace, SRGBColorSpace, Texture } from 'three';

/** @import { Mesh } from 'three' */
/** @import { Drawable } from '../viewer.js' */

/** By which of its maps a material takes a picture, and what its numbers are. */
const MAPS = /** @type {const} */ ({ color: ['map', SRGBColorSpace], normal: ['normalMap', LinearSRGBColorSpace], occlusion: ['aoMap', LinearSRGBColorSpace] });

/**
 * Puts the pictures of a mesh on it, as soon as the browser has decoded them; one that cannot be decoded is left out.
 * @param {Mesh} mesh
 * @param {Drawable} source
 * @param {() => void} changed
 */
export function wear({ geometry, material }, { uvs, tangents, textures = {} }, changed) {
  geometry.setAttribute('uv', new BufferAttribute(/** @type {Float32Array} */ (uvs), 2));
  if (tangents) geometry.setAttribute('tangent', new BufferAttribute(tangents, 4));
  const worn = /** @type {import('three').MeshMatcapMaterial & { aoMap: Texture | null }} */ (material);
  for (const [name, [map, space]] of Object.entries(MAPS)) {
    const picture = textures[/** @type {keyof typeof MAPS} */ (name)];
    if (!picture || (map === 'normalMap' && !tangents)) continue;
    decoded(picture).then((image) => {
      const texture = new Texture(image);
      // As glTF has it: the first row is at 0.
      texture.flipY = false;
      texture.colorSpace = space;
      texture.anisotropy = 4;
      texture.needsUpdate = true;
      worn[map] = texture;
      worn.needsUpdate = true;
      changed();
    }, nothing);
  }
}

/** @param {{ data: Uint8Array, type: string }} picture */
function decoded({ data, type }) {
  const blob = new Blob([/** @type {Uint8Array<ArrayBuffer>} */ (data)], { type });
  return createImageBitmap(blob, { premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
}

function nothing() {}
