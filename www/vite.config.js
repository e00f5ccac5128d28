import { createHash } from 'node:crypto';
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { defineConfig } from 'vite';

/** With these two headers a page is cross-origin isolated, so Pointweave takes its threads build. */
const isolation = {
  'Cross-Origin-Opener-Policy': 'same-origin',
  'Cross-Origin-Embedder-Policy': 'require-corp',
};

/**
 * The wasm modules that `cargo xtask serve` is still building behind this page. They are left out, and the page says so
 * (`src/building.js`).
 */
const missing = (process.env.POINTWEAVE_BUILDING ?? '').split(',').filter(Boolean);

/** A module that is missing fails when it is loaded; the engine then does without threads, and a reader says why it cannot read. */
function withoutMissing() {
  const mark = '\0missing:';
  return {
    name: 'pointweave-without-missing',
    enforce: /** @type {const} */ ('pre'),
    resolveId(/** @type {string} */ source) {
      const name = /\/wasm\/(\w+)\/pointweave\.js$/.exec(source)?.[1];
      return name && missing.includes(name) ? mark + name : undefined;
    },
    load(/** @type {string} */ id) {
      if (!id.startsWith(mark)) return undefined;
      return `throw new Error('the module ${id.slice(mark.length)} is still being built');`;
    },
  };
}

/** Writes the service worker beside the built page, with the list of all its files. */
function serviceWorker() {
  let folder = '';
  return {
    name: 'pointweave-service-worker',
    apply: /** @type {const} */ ('build'),
    configResolved(/** @type {import('vite').ResolvedConfig} */ { root, build }) {
      folder = join(root, build.outDir);
    },
    closeBundle() {
      const source = readFileSync(new URL('service-worker.js', import.meta.url), 'utf8');
      const names = readdirSync(folder, { recursive: true, withFileTypes: true })
        .filter((entry) => entry.isFile())
        .map((entry) => join(entry.parentPath, entry.name).slice(folder.length + 1).replaceAll('\\', '/'))
        .sort();
      const hash = createHash('sha256').update(source);
      for (const name of names) hash.update(name).update(readFileSync(join(folder, name)));
      const version = hash.digest('hex').slice(0, 16);
      const files = names.map((name) => (name === 'index.html' ? './' : `./${name}`));
      const head = `const VERSION = ${JSON.stringify(version)};\nconst FILES = ${JSON.stringify(files, null, 2)};\n`;
      writeFileSync(join(folder, 'service-worker.js'), head + source);
    },
  };
}

export default defineConfig({
  // Relative addresses: the built page works from any folder of any static server.
  base: './',
  // A page that is not whole is not kept for later.
  plugins: [withoutMissing(), missing.length ? undefined : serviceWorker()],
  define: { 'import.meta.env.BUILDING': JSON.stringify(missing) },
  // The engine's workers are ES modules and load more modules of their own.
  worker: { format: 'es', plugins: () => [withoutMissing()] },
  build: { target: 'es2022', chunkSizeWarningLimit: 1000 },
  // The package is a neighbour of this folder, outside Vite's root.
  // It has no packages of its own: these are the page's.
  resolve: { dedupe: ['three', '3d-tiles-renderer', '@gltf-transform/core', '@gltf-transform/extensions', 'meshoptimizer'] },
  server: { headers: isolation, fs: { allow: ['..'] } },
  preview: { headers: isolation },
});
