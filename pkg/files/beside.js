/** The files that a mesh names: its material library, its pictures. */
import { PointweaveError } from '../engine/errors.js';

/** @import { Beside } from '../types.js' */

/**
 * Finds a file by the name that a mesh calls it by, and gives its bytes; `undefined` where there is none.
 * @param {Beside | undefined} beside
 * @returns {(name: string) => Promise<Uint8Array | undefined>}
 */
export function finder(beside) {
  return async (name) => {
    const found = typeof beside === 'function' ? await beside(name) : among(beside ?? [], name);
    return found && bytesOf(found, name);
  };
}

/**
 * The file of a name; of a library that was renamed with its mesh the only one that there is.
 * @template {{ name: string }} F
 * @param {F[]} files
 * @param {string} name
 */
export function among(files, name) {
  const libraries = files.filter((file) => isLibrary(file.name));
  return files.find((file) => lastOf(file.name) === lastOf(name)) ?? (isLibrary(name) && libraries.length === 1 ? libraries[0] : undefined);
}

/** @param {string} name */
function isLibrary(name) {
  return /\.mtl$/i.test(name);
}

/** What is behind the folders of a path, of either system's, in lower case. @param {string} path */
export function lastOf(path) {
  return path.split(/[\\/]/).at(-1)?.toLowerCase();
}

/** @param {unknown} data @param {string} name */
async function bytesOf(data, name) {
  if (typeof Blob !== 'undefined' && data instanceof Blob) return new Uint8Array(await data.arrayBuffer());
  if (data instanceof ArrayBuffer) return new Uint8Array(data.slice(0));
  if (ArrayBuffer.isView(data)) return new Uint8Array(data.buffer, data.byteOffset, data.byteLength).slice();
  const expected = 'a File, Blob, ArrayBuffer or Uint8Array';
  throw new PointweaveError({ code: 'bad-input', message: `beside gave no data for ${name}: expected ${expected}`, expected, found: typeof data });
}
