// `pkg/element.min.js`: `<point-weave>` with three.js in one file, for one script tag. What it does not hold (wasm with its bindings, and
// the worker's script) lies beside it, where the package has it.

import { readFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const path = (name) => fileURLToPath(new URL(name, import.meta.url));

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

await build({
  entryPoints: [path('../pkg/element.js')],
  outfile: path('../pkg/element.min.js'),
  nodePaths: [path('node_modules')],
  plugins: [beside],
  bundle: true,
  minify: true,
  format: 'esm',
  target: 'es2022',
  charset: 'utf8',
  legalComments: 'inline',
  logLevel: 'warning',
});
