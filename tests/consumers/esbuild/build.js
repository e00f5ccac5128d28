import { cp } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

// esbuild leaves `new URL(…, import.meta.url)` alone: the worker is an entry of its own, and the wasm files are copied.
await build({
  entryPoints: { main: here('main.js'), 'pointweave-worker': 'pointweave/worker' },
  absWorkingDir: here('.'),
  outdir: here('dist'),
  bundle: true,
  minify: true,
  splitting: true,
  format: 'esm',
  logLevel: 'warning',
});
await cp(new URL('wasm', import.meta.resolve('pointweave/package.json')), here('dist/wasm'), {
  recursive: true,
  filter: (file) => !file.endsWith('.js'),
});
