// `pkg/element.min.js`: `<point-weave>` with three.js in one file, for one script tag. What it does not hold (wasm with its bindings, and
// the worker's script) lies beside it, where the package has it. So does `pkg/element-tiles.min.js`, which is loaded for a tileset: what
// streams it, without three.js and without what the first file has already; it is handed those.

import { readFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const path = (name) => fileURLToPath(new URL(name, import.meta.url));

/** Modules that are in the second file alone. */
const STREAMS = /[\\/]viewer[\\/](tiles|tile-content|tileset|fade|skirts)\.js$/;
const SECOND = './element-tiles.min.js';

const OPTIONS = {
  nodePaths: [path('node_modules')], bundle: true, target: 'es2022', charset: 'utf8', legalComments: 'inline', logLevel: 'warning',
};

/** One file lies where the package's folder is; its parts looked one folder up. */
const beside = {
  name: 'beside',
  setup({ onResolve, onLoad }) {
    onResolve({ filter: /^\.\.\/wasm\/\w+\/pointweave\.js$/ }, ({ path: name }) => ({ path: name.slice(1), external: true }));
    onLoad({ filter: /pkg[\\/]engine[\\/](platform\.web|worker-script)\.js$/ }, async ({ path: file }) => {
      const text = await readFile(file, 'utf8');
      return { contents: text.replaceAll(/new URL\('\.\.\//g, "new URL('./") };
    });
  },
};

/** What both files need is in the first: three.js, and modules of the package, named by where they are in it. */
const shared = {
  name: 'shared',
  setup({ onResolve, onLoad, resolve }) {
    onResolve({ filter: /^three(\/addons\/(loaders|libs)\/.*)?$/ }, ({ path: name }) => ({ path: name, external: true }));
    onResolve({ filter: /tiles-package\.js$/ }, () => ({ path: 'package', namespace: 'parts' }));
    onResolve({ filter: /^\./ }, async ({ path: name, pluginData, ...where }) => {
      if (pluginData === 'asked' || !where.resolveDir.includes('pkg')) return undefined;
      const { path: file } = await resolve(name, { ...where, pluginData: 'asked' });
      const [, inside] = /[\\/]pkg[\\/](.*)$/.exec(file) ?? [];
      return inside && !STREAMS.test(file) && !/node_modules/.test(inside) ? { path: `pkg/${inside.replaceAll('\\', '/')}`, external: true } : undefined;
    });
    onLoad({ filter: /.*/, namespace: 'parts' }, () => ({
      resolveDir: path('.'),
      contents: "import { DownloadPriorityQueue, LRUCache, PriorityQueue, TilesRenderer } from '3d-tiles-renderer';\n"
        + 'export const tilesPackage = async () => ({ DownloadPriorityQueue, LRUCache, PriorityQueue, TilesRenderer });',
    }));
  },
};

const tiles = { ...OPTIONS, entryPoints: [path('../pkg/viewer/tiles.js')], plugins: [shared] };

/** The names that the second file takes from each module of the first. */
const { outputFiles: [{ text }] } = await build({ ...tiles, format: 'esm', write: false });
const taken = new Map();
for (const [, names, module] of text.matchAll(/^import \{([^}]*)\} from "([^"]+)";/gm)) {
  const known = taken.get(module) ?? new Set();
  for (const name of names.split(',')) known.add(name.trim().split(' ')[0]);
  taken.set(module, known);
}
taken.set('three/addons/libs/meshopt_decoder.module.js', new Set(['MeshoptDecoder'])); // which is imported when it is needed

await build({
  ...tiles,
  outfile: path(`../pkg/${SECOND}`),
  minify: true,
  format: 'cjs',
  supported: { 'dynamic-import': false }, // what it imports later, it is handed, too
  banner: { js: '/*! with 3d-tiles-renderer, Copyright California Institute of Technology, Apache-2.0 */\nexport default(require)=>{const module={};' },
  footer: { js: 'return module.exports};' },
});

/** In the first file, what loads the second and hands it what it needs. */
const second = {
  name: 'second',
  setup({ onResolve, onLoad }) {
    onResolve({ filter: /^\.\/tiles\.js$/ }, ({ kind }) => (kind === 'dynamic-import' ? { path: 'tiles', namespace: 'second' } : undefined));
    onResolve({ filter: /^\.\/element-tiles\.min\.js$/ }, ({ path: name }) => ({ path: name, external: true }));
    onLoad({ filter: /.*/, namespace: 'second' }, () => {
      const modules = [...taken].map(([module, names], i) => [module, [...names].map((name) => [name, `${name}_${i}`])]);
      const imports = modules.map(([module, names]) =>
        `import { ${names.map(([name, here]) => `${name} as ${here}`)} } from ${JSON.stringify(module.replace(/^pkg\//, path('../pkg/')))};`);
      const given = modules.map(([module, names]) => `${JSON.stringify(module)}: { ${names.map(([name, here]) => `${name}: ${here}`)} }`);
      return {
        resolveDir: path('.'),
        contents: `${imports.join('\n')}
          const given = { ${given} };
          let made;
          const failed = ({ message }) => {
            throw new given['pkg/engine/errors.js'].PointweaveError({ code: 'load-failed', message: 'element-tiles.min.js did not load: ' + message });
          };
          const load = async () => (made ??= (await import('${SECOND}').catch(failed)).default((name) => given[name]));
          export const Tiles = { open: async (...all) => (await load()).Tiles.open(...all) };`,
      };
    });
  },
};

await build({
  ...OPTIONS, entryPoints: [path('../pkg/element.js')], outfile: path('../pkg/element.min.js'), plugins: [beside, second], minify: true, format: 'esm',
});
