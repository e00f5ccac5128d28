// The documentation's pages run as they stand, and its TypeScript fits.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import ts from 'typescript';
import { silhouette } from '../page/pictures.mjs';
import { ball, duckScan, glb, poster } from './files.mjs';
import { blocks, painted, startSite, test } from './site.mjs';
import { putTileset, tileset } from './tilesets.mjs';

const [DOCUMENT, VIEWER, TILES] = ['embed', 'viewer', 'tiles'].map((name) => readFileSync(new URL(`../../pkg/docs/${name}.md`, import.meta.url), 'utf8'));

const site = await startSite();
site.put('/docs/duck.ply', (await duckScan()).bytes);
site.put('/docs/duck.glb', await glb([{ ...ball(12), color: [200, 160, 10] }]));
site.put('/docs/duck.png', poster('#8020c0'), { 'Content-Type': 'image/svg+xml' });

for (const [i, html] of blocks(DOCUMENT, 'html').entries()) {
  test(`page ${i + 1} of embed.md`, async () => {
    const shown = await site.visit(site.put(`/docs/${i}.html`, html));
    assert.ok(await shown.element().count() > 0);
    await shown.loaded();
    for (let k = 0; k < await shown.element().count(); k++) {
      const picture = await shown.element().nth(k).screenshot({ animations: 'disabled' });
      assert.ok(silhouette(picture).area > 1000, `element ${k} shows something`);
    }
    if (html.includes('id="status"')) assert.equal(await shown.page.innerText('#status'), '3000 points became 2000');
    assert.deepEqual(shown.faults, []);
    await shown.keep(`docs-${i}`);
  });
}

for (const [i, html] of blocks(VIEWER, 'html').entries()) {
  test(`page ${i + 1} of viewer.md`, async () => {
    const shown = await site.visit(site.put(`/docs/viewer-${i}.html`, html));
    await shown.page.waitForFunction(painted, null, { timeout: 60_000 });
    await shown.drawn();
    assert.ok(silhouette(await shown.page.locator('canvas').screenshot({ animations: 'disabled' }), 0).area > 5000);
    if (html.includes('id="legend"')) assert.match(await shown.page.innerText('#legend'), /^Distance to the scan: 0/);
    if (html.includes('<img')) assert.deepEqual(await shown.page.$eval('img', async (image) => (await image.decode(), [image.naturalWidth, image.naturalHeight])), [320, 240]);
    assert.deepEqual(shown.faults, []);
    await shown.keep(`docs-viewer-${i}`);
  });
}

putTileset(site, '/docs/hills', await tileset());
for (const [i, html] of blocks(TILES, 'html').entries()) {
  test(`page ${i + 1} of tiles.md`, async () => {
    const shown = await site.visit(site.put(`/docs/tiles-${i}.html`, html));
    await shown.page.waitForFunction(() => /^\d{4,5} of 16384 points, \d+ MB$/.test(document.querySelector('#status').textContent), null, { timeout: 60_000 });
    await shown.drawn();
    assert.ok(silhouette(await shown.page.locator(html.includes('<canvas') ? 'canvas' : 'point-weave').screenshot({ animations: 'disabled' })).area > 5000);
    assert.deepEqual(shown.faults, []);
  });
}

test('every option and number of what streams is documented', () => {
  const types = readFileSync(new URL('../../pkg/viewer.d.ts', import.meta.url), 'utf8');
  for (const head of ['StreamOptions', 'StreamState']) {
    const [, body] = new RegExp(`interface ${head} \\{\n([^]*?)\n\\}`).exec(types);
    for (const [, name] of body.matchAll(/^  (\w+)\??:/gm)) assert.ok(TILES.includes(`\`${name}\``), `${name} is in tiles.md`);
  }
});

test('every option, member and event of a viewer is documented', () => {
  const types = readFileSync(new URL('../../pkg/viewer.d.ts', import.meta.url), 'utf8');
  const names = ['ViewerOptions', 'Viewer extends EventTarget', 'ViewerEventMap'].flatMap((head) => {
    const [, body] = new RegExp(`interface ${head} \\{\\n([^]*?)\\n\\}`).exec(types);
    return [...body.matchAll(/^  (?:readonly |get |set )?(\w+)[?(:]/gm)].map(([, name]) => name);
  }).filter((name) => name !== 'addEventListener');
  assert.ok(names.length > 30, names.join());
  for (const name of names) assert.match(VIEWER, new RegExp(`\`[^\`\\n]*\\b${name}\\b[^\`\\n]*\``), `${name} is in viewer.md`);
});

test('the TypeScript of embed.md fits', async (t) => {
  const folder = mkdtempSync(join(import.meta.dirname, 'docs-')); // in here, so that its imports are found
  t.after(() => rmSync(folder, { recursive: true }));
  const files = blocks(DOCUMENT, 'tsx').map((text, i) => {
    const file = join(folder, `${i}.tsx`);
    writeFileSync(file, text);
    return file;
  });
  assert.equal(files.length, 1);
  // As in Vite's template.
  const program = ts.createProgram(files, {
    strict: true, noUnusedLocals: true, noUnusedParameters: true, verbatimModuleSyntax: true, noEmit: true, skipLibCheck: true, types: [], target: ts.ScriptTarget.ES2023, jsx: ts.JsxEmit.ReactJSX,
    module: ts.ModuleKind.ESNext, moduleResolution: ts.ModuleResolutionKind.Bundler,
  });
  assert.deepEqual(ts.getPreEmitDiagnostics(program).map(({ messageText }) => ts.flattenDiagnosticMessageText(messageText, '\n')), []);
});

test('every attribute, event, slot, part and custom property is documented', async () => {
  const shown = await site.open('<point-weave></point-weave>');
  const { attributes, parts, slots, css } = await shown.element().evaluate((element) => {
    const { shadowRoot } = element;
    const all = [...shadowRoot.querySelectorAll('*')];
    return {
      attributes: element.constructor.observedAttributes,
      parts: all.flatMap((part) => [...part.part]),
      slots: all.filter(({ localName }) => localName === 'slot').map(({ name }) => name),
      css: [...shadowRoot.adoptedStyleSheets[0].cssRules].map(({ cssText }) => cssText).join(),
    };
  });
  const properties = css.match(/--point-weave-[a-z-]+/g);
  assert.ok(attributes.length >= 9 && parts.length > 15 && slots.length === 6 && properties.length > 8);
  for (const name of [...attributes, ...parts, ...slots, ...properties]) assert.ok(DOCUMENT.includes(`\`${name}\``), `${name} is in embed.md`);
});

test('every custom property that is documented changes what is seen', async () => {
  const shown = await site.open('<point-weave src="/docs/duck.ply" alt="A toy duck" view="points" controls></point-weave>');
  await shown.loaded();
  const properties = [...new Set(DOCUMENT.match(/(?<=`)--point-weave-[a-z-]+(?=`)/g))];
  const values = { '--point-weave-font': '20px serif', '--point-weave-poster-fit': 'cover' };
  const idle = await shown.element().evaluate((element, wanted) => {
    const parts = [...element.shadowRoot.querySelectorAll('*')];
    for (const part of parts) part.style.transition = 'none';
    const styles = () => parts.flatMap((part) => [...getComputedStyle(part)].map((name) => getComputedStyle(part).getPropertyValue(name))).join();
    const before = styles();
    return wanted.filter(([name, value]) => {
      element.style.setProperty(name, value);
      const changes = styles() !== before;
      element.style.removeProperty(name);
      return !changes;
    });
  }, properties.map((name) => [name, values[name] ?? 'rgb(1, 2, 3)']));
  assert.ok(properties.length >= 11);
  assert.deepEqual(idle, []);
});
