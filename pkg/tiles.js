/**
 * `pointweave/tiles`: lets a bundler see 3d-tiles-renderer, an optional peer dependency that streams tilesets. It becomes a part that is
 * loaded when the first tileset is shown. Without a bundler nobody needs this: an import map says where the package is.
 */
import { provideTiles } from './viewer/tiles-package.js';

provideTiles(() => import('3d-tiles-renderer'));
