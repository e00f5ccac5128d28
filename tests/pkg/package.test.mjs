// What is published: the entries, the files, the licences, the sizes.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import test, { after } from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { gzipSync } from 'node:zlib';
import { build } from 'esbuild';
import { publint } from 'publint';
import { formatMessage } from 'publint/utils';
import { PACKAGE, pack } from './tarball.mjs';

const run = promisify(execFile);
const path = (name) => fileURLToPath(new URL(name, PACKAGE));
const text = (name) => readFile(new URL(name, PACKAGE), 'utf8');
const manifest = JSON.parse(await text('package.json'));

/** Where three.js is found. */
const MODULES = fileURLToPath(new URL('../node_modules', import.meta.url));

const tarball = await pack({ after });

/** The files that a manifest's `exports` or `bin` names. */
function targets(value) {
  return typeof value === 'string' ? [value.replace(/^\.\//, '')] : Object.values(value ?? {}).flatMap(targets);
}

/** How one module names another, or a file beside it. */
const REFERENCES = [/\bfrom '(\.[^']+)'/g, /\bimport\('(\.[^']+)'\)/g, /\bimport '(\.[^']+)'/g, /new URL\('(\.\/[^']+)', import\.meta\.url\)/g];

/** Modules, and all that they name, and so on. */
async function reached(names, found = new Set()) {
  for (const name of names) {
    if (found.has(name)) continue;
    found.add(name);
    if (!/\.(js|ts)$/.test(name)) continue;
    const source = (await text(name)).replace(/\/\*[^]*?\*\/|^\s*\/\/.*$/gm, '');
    const named = REFERENCES.flatMap((pattern) => [...source.matchAll(pattern)].map(([, relative]) => new URL(relative, `file:///${name}`).pathname.slice(1)));
    await reached(named.map((other) => (name.endsWith('.d.ts') ? other.replace(/(?<!\.d)\.js$/, '.d.ts') : other)), found);
  }
  return found;
}

test('the tarball holds what the entries reach, documentation and licences, and nothing else', async () => {
  const wasm = ['single', 'threads', 'files', 'las', 'e57', 'packed', 'pictures', 'exports', 'prepare', 'light', 'tiles', 'samples'].map((name) => `wasm/${name}/pointweave_bg.wasm`);
  const entries = [manifest.exports, manifest.bin].flatMap(targets).filter((name) => !name.includes('*'));
  const needed = await reached([...entries, ...wasm, 'element-tiles.min.js']);
  const documents = tarball.contents.filter((name) => /^docs\/[a-z-]+\.md$/.test(name));
  assert.deepEqual(tarball.contents, [...needed, ...documents, 'README.md', 'LICENSE-APACHE', 'LICENSE-MIT'].sort());
  assert.ok(needed.has('types.core.d.ts') && needed.has('worker.node.js') && documents.length > 3);
});

test('the licences are those of the project', async () => {
  for (const name of ['LICENSE-MIT', 'LICENSE-APACHE']) assert.equal(await text(name), await readFile(new URL(`../../${name}`, import.meta.url), 'utf8'));
});

test('the package installs nothing and runs nothing', () => {
  for (const key of ['dependencies', 'scripts', 'main']) assert.equal(manifest[key], undefined, key);
});

test('publint finds nothing', async () => {
  const { messages } = await publint({ pkgDir: path('.'), strict: true, pack: 'npm' });
  assert.deepEqual(messages.map((message) => formatMessage(message, manifest)), []);
});

test('the types are not wrong', async () => {
  const attw = fileURLToPath(new URL('../node_modules/@arethetypeswrong/cli/dist/index.js', import.meta.url));
  const { stdout } = await run(process.execPath, [attw, tarball.file, '--profile', 'esm-only', '--format', 'json']);
  const { analysis, problems } = JSON.parse(stdout);
  assert.deepEqual(Object.keys(analysis.entrypoints).sort(), Object.keys(manifest.exports).sort());
  // What imports ES modules; `require` and Node 10 are not served.
  const wrong = Object.values(problems).flat().filter(({ resolutionKind }) => !['node10', 'node16-cjs'].includes(resolutionKind));
  assert.deepEqual(wrong, []);
});

test('what is not called is left out of a bundle, and the worker is not', async () => {
  const bundled = async (contents) => {
    const { metafile } = await build({
      stdin: { contents, resolveDir: fileURLToPath(new URL('..', import.meta.url)) }, nodePaths: [MODULES],
      bundle: true, format: 'esm', write: false, metafile: true, logLevel: 'silent',
    });
    return Object.values(metafile.outputs)[0];
  };
  assert.equal((await bundled("import 'pointweave'")).bytes, 0);
  assert.equal((await bundled("import 'pointweave/core'")).bytes, 0);
  assert.equal((await bundled("import 'pointweave/viewer'")).bytes, 0);
  assert.ok((await bundled("import 'pointweave/worker'")).bytes > 1000);
  assert.ok((await bundled("import 'pointweave/tiles'")).bytes > 100);
});

/**
 * Most bytes of the element's parts with all that they import, three.js too, minified and gzipped: what is loaded at once, when one
 * nears the viewport, and for a GLB.
 */
const ELEMENT = { element: 14_900, viewer: 164_500, glb: 165_500, tiles: 172_000 };
/** Most bytes of `element.min.js` and of `element-tiles.min.js`, which it loads for a tileset, gzipped. */
const FILES = { file: 234_000, streams: 25_900 };

test('the element is not larger than its budget', async (t) => {
  const { outputFiles, metafile: { outputs } } = await build({
    entryPoints: [path('element.js')], outdir: 'out', nodePaths: [MODULES],
    bundle: true, minify: true, splitting: true, format: 'esm', write: false, metafile: true, logLevel: 'silent',
  });
  const names = Object.keys(outputs);
  const withImports = (name, found = new Set()) => {
    found.add(name);
    for (const { path, kind } of outputs[name].imports) if (kind === 'import-statement' && !found.has(path)) withImports(path, found);
    return [...found];
  };
  for (const [part, most] of Object.entries(ELEMENT)) {
    const files = withImports(names.find((name) => new RegExp(`/${part}(-\\w+)?\\.js$`).test(name)));
    const bytes = files.reduce((sum, name) => sum + gzipSync(outputFiles[names.indexOf(name)].contents, { level: 9 }).length, 0);
    t.diagnostic(`${part}: ${bytes} bytes`);
    assert.ok(bytes <= most, `${part}: ${bytes} bytes`);
  }
});

test('the element in one file is not larger than its budget, and names nothing that is not beside it', async (t) => {
  const named = [];
  for (const [part, most] of Object.entries(FILES)) {
    const name = { file: 'element.min.js', streams: 'element-tiles.min.js' }[part];
    const file = await readFile(path(name));
    const bytes = gzipSync(file, { level: 9 }).length;
    t.diagnostic(`${name}: ${bytes} bytes`);
    assert.ok(bytes <= most, `${name}: ${bytes} bytes`);
    named.push(...[...String(file).matchAll(/\b(?:import\("([^"]+)"\)|new URL\("([^"]+)",import)/g)].map(([, one, other]) => one ?? other));
  }
  assert.ok(named.length > 9 && named.includes('./element-tiles.min.js'), named.join());
  for (const name of named) {
    assert.ok(name.startsWith('./'), name);
    assert.ok(tarball.contents.includes(name.slice(2)), name);
  }
});

/** Most bytes of each part, gzipped: about one per cent more than it has. */
const BUDGET = {
  single: 406_000, threads: 450_000, files: 187_000, las: 122_000, e57: 147_000, packed: 244_000, pictures: 171_000,
  exports: 223_000, prepare: 193_000, light: 308_000, samples: 44_000, script: 24_000,
};

test('nothing is larger than its budget', async () => {
  const zipped = (bytes) => gzipSync(bytes, { level: 9 }).length;
  const { script, ...wasm } = BUDGET;
  const tooLarge = [];
  for (const [name, most] of Object.entries(wasm)) {
    const bytes = zipped(await readFile(new URL(`wasm/${name}/pointweave_bg.wasm`, PACKAGE)));
    if (bytes > most) tooLarge.push(`${name}: ${bytes} bytes`);
  }
  assert.deepEqual(tooLarge, []);
  const { outputFiles } = await build({
    entryPoints: [path('index.js'), path('worker.js')], outdir: 'out',
    bundle: true, minify: true, splitting: true, format: 'esm', write: false, logLevel: 'silent',
  });
  const sizes = outputFiles.map(({ path, contents }) => ({ path, bytes: zipped(contents) }));
  // Of those that belong to the wasm builds a page loads one, and a reader's when it reads a file.
  const builds = sizes.filter(({ path }) => /\/pointweave-\w+\.js$/.test(path)).map(({ bytes }) => bytes);
  assert.equal(builds.length, Object.keys(wasm).length);
  const sum = (numbers) => numbers.reduce((sum, number) => sum + number, 0);
  const bytes = sum(sizes.map(({ bytes }) => bytes)) - sum(builds) + Math.max(...builds);
  assert.ok(bytes <= script, `JavaScript, minified: ${bytes} bytes`);
});

test('docs/bundlers.md has the sizes as numbers', async () => {
  const rows = [...(await text('docs/bundlers.md')).matchAll(/^\| `(\w+)` \| (\d+) \|/gm)].map(([, part, size]) => [part, Number(size)]);
  const budgets = Object.entries({ ...BUDGET, ...ELEMENT, ...FILES }).map(([part, bytes]) => [part, Math.ceil(bytes / 1000)]);
  assert.deepEqual(Object.fromEntries(rows), Object.fromEntries(budgets));
});

test('the manifest says whom to ask and where', () => {
  const { author, homepage, bugs, repository } = manifest;
  const home = repository.url.replace(/^git\+|\.git$/g, '');
  assert.deepEqual({ author, homepage, bugs }, { author: 'The Pointweave authors', homepage: `${home}#readme`, bugs: `${home}/issues` });
});
