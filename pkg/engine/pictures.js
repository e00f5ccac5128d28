/** Pictures on meshes, as wasm takes them beside the mesh: the bytes of a file as `colorPicture`, or what is in it as `colorPixels`. */

/** @typedef {{ width: number, height: number, pixels: Uint8Array }} Decoded four bytes a pixel */
/** @typedef {(file: Uint8Array) => Promise<Decoded | undefined>} Decode undefined for a file of no kind that is read */

/** What there are pictures of. */
export const MAPS = ['color', 'normal', 'occlusion'];

/** @param {string} map */
export const fileKey = (map) => `${map}Picture`;

/**
 * With what is in the files in their place; what cannot be read is left out.
 * @param {Record<string, any>} mesh
 * @param {Decode} decode
 */
export async function opened(mesh, decode) {
  const shown = { ...mesh };
  for (const map of MAPS) {
    const file = shown[fileKey(map)];
    delete shown[fileKey(map)];
    if (file) shown[`${map}Pixels`] = await decode(file);
  }
  return shown;
}

/**
 * With other files of the same pictures; what cannot be read stays.
 * @param {Record<string, any>} mesh
 * @param {Decode} decode
 * @param {import('../types.js').PictureEncoder} encode
 */
export async function encoded(mesh, decode, encode) {
  const made = { ...mesh };
  for (const map of MAPS.filter((map) => mesh[fileKey(map)])) {
    const before = mesh[fileKey(map)];
    const picture = await decode(before.slice());
    made[fileKey(map)] = picture ? await encode({ map: /** @type {any} */ (map), ...picture }) : before;
  }
  return made;
}
