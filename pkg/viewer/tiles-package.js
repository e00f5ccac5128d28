/** Finds what streams tilesets, where one is asked for: most pages neither have nor need it. */
import { PointweaveError } from '../engine/errors.js';

/** @typedef {typeof import('3d-tiles-renderer')} Package */

/** No bundler is to follow it: the package need not be there. */
const PACKAGE = '3d-tiles-renderer';

/** @type {() => Promise<Package>} */
let load = () => import(/* webpackIgnore: true */ /* turbopackIgnore: true */ /* @vite-ignore */ PACKAGE);

/** Says how it is loaded, as `pointweave/tiles` does where a bundler has to see it. @param {() => Promise<Package>} loader */
export function provideTiles(loader) {
  load = loader;
}

export async function tilesPackage() {
  try {
    return await load();
  } catch (error) {
    const why = error instanceof Error ? error.message : String(error);
    throw new PointweaveError({
      code: 'missing-package',
      message: `tilesets need a package that did not load (${why}): npm install ${PACKAGE}; with a bundler, import pointweave/tiles, too`,
      expected: [PACKAGE],
    });
  }
}
