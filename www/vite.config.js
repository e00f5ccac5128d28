import { defineConfig } from 'vite';

/** With these two headers a page is cross-origin isolated, so Pointweave takes its threads build. */
const isolation = {
  'Cross-Origin-Opener-Policy': 'same-origin',
  'Cross-Origin-Embedder-Policy': 'require-corp',
};

export default defineConfig({
  // Relative addresses: the built page works from any folder of any static server.
  base: './',
  // The engine's workers are ES modules and load more modules of their own.
  worker: { format: 'es' },
  build: { target: 'es2022', chunkSizeWarningLimit: 1000 },
  // The package is a neighbour of this folder, outside Vite's root.
  server: { headers: isolation, fs: { allow: ['..'] } },
  preview: { headers: isolation },
});
