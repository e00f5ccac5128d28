/** A component as a framework's compiler makes it, and a page's script that shows it: `shown` is called with what the element says. */
import { readFile, writeFile, mkdir } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';
import { compile } from 'svelte/compiler';
import { compileScript, parse } from 'vue/compiler-sfc';

const here = (name) => fileURLToPath(new URL(name, import.meta.url));
const SHOWN = 'const shown = (words) => (document.documentElement.dataset.result = JSON.stringify({ words: String(words) }));';

const ENTRIES = {
  tsx: `import { createElement } from 'react';
    import { createRoot } from 'react-dom/client';
    import { Duck } from './Duck.tsx';
    createRoot(document.querySelector('main')).render(createElement(Duck, { say: shown }));`,
  vue: `import { createApp } from 'vue';
    import Duck from './Duck.vue';
    createApp(Duck, { src: 'duck.glb', onShown: shown }).mount('main');`,
  svelte: `import { mount } from 'svelte';
    import Duck from './Duck.svelte';
    mount(Duck, { target: document.querySelector('main'), props: { src: 'duck.glb', shown } });`,
};

const COMPILERS = {
  vue(source) {
    const { descriptor } = parse(source);
    const compilerOptions = { isCustomElement: (tag) => tag === 'point-weave' };
    return compileScript(descriptor, { id: 'duck', inlineTemplate: true, templateOptions: { compilerOptions } }).content;
  },
  svelte: (source) => compile(source, { generate: 'client', name: 'Duck' }).js.code,
};

/** @param {'tsx' | 'vue' | 'svelte'} framework @param {string} component its source; the page is in dist/ then */
export async function bundle(framework, component) {
  const folder = here(`dist/${framework}/`);
  await mkdir(folder, { recursive: true });
  await writeFile(`${folder}Duck.${framework}`, component);
  await writeFile(`${folder}entry.js`, `${SHOWN}\n${ENTRIES[framework]}`);
  await writeFile(`${folder}index.html`, '<!doctype html><title>A duck</title><link rel="icon" href="data:,"><main></main><script type="module" src="main.js"></script>');
  await build({
    entryPoints: { main: `${folder}entry.js` }, outdir: folder, bundle: true, splitting: true, format: 'esm', jsx: 'automatic',
    conditions: ['browser', 'svelte'], define: { 'process.env.NODE_ENV': '"production"' }, logLevel: 'warning',
    plugins: [{
      name: 'components',
      setup: ({ onLoad }) => onLoad({ filter: /\.(vue|svelte)$/ }, async ({ path }) => ({ contents: COMPILERS[framework](await readFile(path, 'utf8')), loader: 'js' })),
    }],
  });
}
