// What is shown: scans in their three views, GLBs as they are, in the right shape and colour.

import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { resolve } from 'node:path';
import { decodePng, difference, expectedSilhouette, meanColor, overlap, silhouette as silhouetteWithin } from '../page/pictures.mjs';
import { ball, boxScan, duckScan, glb } from './files.mjs';
import { startSite, test } from './site.mjs';

const SHARED = process.env.POINTWEAVE_SHARED ?? resolve(import.meta.dirname, '../../../shared');

const silhouette = (png) => silhouetteWithin(png, 0);

/** Reads as a colour: how much each channel has of the brightest. */
function hue(png) {
  const color = meanColor(png, silhouette(png));
  return color.map((value) => value / Math.max(...color));
}

const site = await startSite();
const duck = await duckScan();
site.put('/duck.ply', duck.bytes);

test('a scan: points, reduced, mesh', async () => {
  const shown = await site.open('<point-weave src="/duck.ply" alt="A toy duck" view="points" count="800"></point-weave>', { style: 'point-weave { width: 480px; height: 360px }' });
  const expected = expectedSilhouette(duck.points).closed(8).normalized();
  for (const view of ['points', 'reduced', 'mesh']) {
    await shown.set({ view });
    await shown.loaded();
    const picture = await shown.picture();
    const mask = silhouette(picture).closed(6);
    const share = Math.max(mask.box.width / mask.width, mask.box.height / mask.height);
    assert.ok(share > 0.7 && share <= 1, `${view} fills the picture: ${share}`);
    assert.ok(overlap(mask.normalized(), expected) > 0.85, `${view} has the shape of the scan: ${overlap(mask.normalized(), expected)}`);
    const [red, green, blue] = meanColor(picture, silhouette(picture));
    assert.ok(red > green && green > 1.5 * blue, `${view} is a yellow duck: ${[red, green, blue].map(Math.round)}`);
    await shown.keep(view);
  }
  const loads = (await shown.events()).filter(({ type }) => type === 'load');
  assert.deepEqual(loads.map(({ view, kind, points, bubbles }) => ({ view, kind, bubbles, points: view === 'mesh' || points })), [
    { view: 'points', kind: 'scan', points: 3000, bubbles: false },
    { view: 'reduced', kind: 'scan', points: 800, bubbles: false },
    { view: 'mesh', kind: 'scan', points: true, bubbles: false },
  ]);
  assert.equal(loads[0].report, undefined);
  assert.deepEqual([loads[1].report.inputPoints, loads[1].report.outputPoints], [3000, 800]);
  assert.ok(loads[2].triangles > 500);
  assert.deepEqual(shown.faults, []);
});

test('progress goes from the file to the result and never back; the points come first', async () => {
  const shown = await site.open('<point-weave src="/duck.ply" alt="A toy duck" ratio="0.2" threads="1"></point-weave>');
  const events = await shown.heard('load');
  const progress = events.filter(({ type }) => type === 'progress');
  assert.deepEqual([progress[0].stage, progress[0].overall], ['fetch', 0]);
  assert.equal(progress.at(-1).overall, 1);
  for (let i = 1; i < progress.length; i++) assert.ok(progress[i].overall >= progress[i - 1].overall);
  const stages = [...new Set(progress.map(({ stage }) => stage))];
  for (const stage of ['fetch', 'read', 'cluster', 'fit', 'extract']) assert.ok(stages.includes(stage), `${stage} is among ${stages}`);
  const load = events.at(-1);
  assert.deepEqual([load.type, load.view, load.src], ['load', 'mesh', '/duck.ply']);
  assert.deepEqual([load.report.outputPoints, load.report.build, load.report.threads], [600, 'single', 1]);
  assert.equal(await shown.spoken(), `A toy duck. Mesh of ${load.triangles.toLocaleString('en')} triangles`);
});

test('what may be wrong is the title of the picture, and spoken; orientation and flip turn the mesh', async () => {
  const hills = Array.from({ length: 1600 }, (_, i) => [i % 40, Math.floor(i / 40)].map((k) => k / 10 - 2));
  site.put('/hills.xyz', Buffer.from(hills.map(([x, y]) => `${x} ${y} ${0.3 * Math.sin(2 * x) * Math.cos(1.7 * y)}`).join('\n')));
  const shown = await site.open('<point-weave src="/hills.xyz" alt="Hills"></point-weave>');
  await shown.loaded();
  const state = () => shown.element().evaluate(({ report, shadowRoot }) => ({
    doubts: report.doubts.map(({ code, message }) => [code, message]),
    sources: report.orientation.sources.filter(({ share }) => share > 0).map(({ source }) => source),
    title: shadowRoot.querySelector('canvas').title,
  }));
  const guessed = await state();
  assert.deepEqual(guessed.doubts.map(([code]) => code), ['side-guessed']);
  assert.deepEqual(guessed.sources, ['guess']);
  assert.equal(guessed.title, guessed.doubts[0][1]);
  assert.ok((await shown.spoken()).endsWith(`triangles. ${guessed.title}`), await shown.spoken());

  const loads = async () => (await shown.events()).filter(({ type }) => type === 'load').length;
  assert.equal(await loads(), 1);
  await shown.element().evaluate((element) => element.toggleAttribute('flip', true));
  await shown.loaded();
  await shown.set({ orientation: 'up' });
  await shown.loaded();
  const told = await state();
  assert.deepEqual([told.doubts, told.title], [[], '']);
  assert.equal(await loads(), 3);
  await shown.set({ view: 'points' });
  await shown.loaded();
  assert.equal(await shown.element().evaluate(({ report }) => report), null);
  assert.deepEqual(shown.faults, []);
});

test('an XYZ file, which stands as it is told to', async () => {
  site.put('/tall.xyz', boxScan([1, 1, 3]));
  const shown = await site.open('<point-weave src="/tall.xyz" alt="A box" view="points"></point-weave>');
  await shown.loaded();
  const lying = silhouette(await shown.picture()).box;
  await shown.set({ up: 'z' });
  const standing = silhouette(await shown.picture()).box;
  assert.ok(standing.height / standing.width > 1.5 * (lying.height / lying.width), 'z up makes it tall');
  site.put('/land.xyz', boxScan([10, 8, 0.4]));
  await shown.set({ up: 'auto', src: '/land.xyz' });
  await shown.loaded();
  const land = silhouette(await shown.picture()).box;
  assert.ok(land.width > 1.8 * land.height, 'what is wide and flat lies down');
  await shown.element().evaluate(async (element) => (element.src = URL.createObjectURL(await (await fetch('/tall.xyz')).blob())));
  await shown.loaded();
  assert.ok(silhouette(await shown.picture()).area > 1000, 'a file that a visitor has chosen');
});

test('a GLB is shown at once: no engine, no worker', async () => {
  site.put('/red.glb', await glb([{ ...ball(), color: [200, 10, 10] }]));
  const shown = await site.open('<point-weave src="/red.glb" alt="A red ball" view="points"></point-weave>');
  await shown.loaded();
  const picture = await shown.picture();
  const mask = silhouette(picture);
  assert.ok(mask.area > 0.2 * mask.width * mask.height);
  assert.ok(Math.abs(mask.box.width / mask.box.height - 1) < 0.05, 'it is round');
  const [red, green, blue] = hue(picture);
  assert.ok(red === 1 && green < 0.6 && blue < 0.6, `it is red: ${[red, green, blue]}`);
  const load = (await shown.events()).at(-1);
  assert.deepEqual([load.kind, load.view, load.triangles], ['glb', 'mesh', 24 * 24 * 4]);
  assert.deepEqual(shown.asked.filter((path) => /wasm|worker|pointweave\/index|engine\.js/.test(path)), []);
  assert.equal(await shown.element().evaluate((element) => element.view), 'points', 'what was asked for stays said');
});

test('a GLB of points and a mesh has two views; compressed ones are read', async () => {
  const { positions } = ball(40);
  const bytes = await glb([{ ...ball(), color: [10, 10, 200] }, { positions, color: [10, 200, 10] }], { meshopt: true });
  site.put('/both.glb', bytes);
  const shown = await site.open('<point-weave src="/both.glb" alt="A ball" controls></point-weave>');
  await shown.loaded();
  const blue = hue(await shown.picture());
  assert.ok(blue[2] === 1 && blue[1] < 0.8, `the mesh is blue: ${blue}`);
  const { page } = shown;
  assert.deepEqual(await page.getByRole('radio').evaluateAll((inputs) => inputs.filter((input) => input.checkVisibility()).map(({ value }) => value)), ['points', 'mesh']);
  await shown.set({ view: 'points' });
  const picture = await shown.picture();
  const green = hue(picture);
  assert.ok(green[1] === 1 && green[0] < 0.5 && green[2] < 0.5, `the points are green: ${green}`);
  const { data, channels } = decodePng(picture);
  const brightest = data.filter((value, i) => i % channels === 1 && data[i - 1] < 100).reduce((most, value) => Math.max(most, value), 0);
  assert.ok(Math.abs(brightest - 228) <= 3, `linear 200 of 255 is sRGB 228: ${brightest}`);
  assert.deepEqual(shown.asked.filter((path) => /\.wasm|worker/.test(path)), []);
});

test('a GLB far from the origin is as sharp as one that is near', async () => {
  const two = [{ ...ball(12, 1, [-1.2, 0, 0]), color: [200, 10, 10] }, { ...ball(12, 0.6, [1.2, 0, 0]), color: [10, 10, 200] }];
  site.put('/near.glb', await glb(two));
  site.put('/far.glb', await glb(two, { at: [450_000.25, 5_200_000.5, 1200] }));
  const shown = await site.open('<point-weave src="/near.glb" alt="Two balls"></point-weave>');
  await shown.loaded();
  const near = await shown.picture();
  await shown.set({ src: '/far.glb' });
  await shown.loaded();
  const share = difference(near, await shown.picture());
  assert.ok(share < 0.001, `${share} of the pixels differ`);
});

test('threads, where the page is isolated; one engine for all that want as many', async () => {
  const headers = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };
  const tags = ['2', '2', '1'].map((threads, i) => `<point-weave src="/duck.ply?${i}" threads="${threads}" view="reduced" alt="A duck"></point-weave>`);
  const shown = await site.open(tags.join(''), { headers });
  await shown.loaded();
  const loads = (await shown.events()).filter(({ type }) => type === 'load').sort((a, b) => a.src.localeCompare(b.src));
  assert.deepEqual(loads.map(({ report: { build, threads } }) => [build, threads]), [['threads', 2], ['threads', 2], ['single', 1]]);
  assert.equal(shown.page.workers().length, 1 + 2 + 1, 'one that computes, two that lend their threads, and one alone');
});

test('wasm files elsewhere', async () => {
  const builds = ['files', 'single'];
  for (const build of builds) {
    const file = `${build}/pointweave_bg.wasm`;
    site.put(`/elsewhere/${file}`, await readFile(new URL(`../../pkg/wasm/${file}`, import.meta.url)));
  }
  const shown = await site.open('<point-weave src="/duck.ply" view="reduced" alt="A duck"></point-weave>', {
    define: false,
    prepare: (page) => page.addInitScript(() => addEventListener('DOMContentLoaded', async () => {
      const { PointWeaveElement } = await import('/pointweave/element/element.js');
      PointWeaveElement.wasmUrl = '/elsewhere/';
      await import('/pointweave/element.js');
    })),
  });
  await shown.loaded();
  assert.deepEqual(shown.asked.filter((path) => path.endsWith('.wasm')).sort(), builds.map((build) => `/elsewhere/${build}/pointweave_bg.wasm`));
});

test('a textured GLB keeps its picture', async (t) => {
  const file = resolve(SHARED, 'data/meshes/Duck.glb');
  if (!existsSync(file)) return t.diagnostic(`not tested: ${file} is missing (set POINTWEAVE_SHARED to the folder that holds data/)`);
  site.put('/textured.glb', await readFile(file));
  const shown = await site.open('<point-weave src="/textured.glb" alt="A duck"></point-weave>');
  await shown.loaded();
  const [red, green, blue] = hue(await shown.picture());
  assert.ok(red === 1 && green > 0.6 && blue < 0.4, `it is yellow: ${[red, green, blue]}`);
});

test('sized by CSS like an image, in device pixels', async () => {
  const shown = await site.open('<point-weave src="/red.glb" alt="A red ball"></point-weave>', { deviceScaleFactor: 2, style: 'point-weave { display: inline-block }' });
  await shown.loaded();
  const sizes = () => shown.element().evaluate((element) => {
    const { width, height } = element.shadowRoot.querySelector('canvas');
    return [element.offsetWidth, element.offsetHeight, width, height];
  });
  assert.deepEqual(await sizes(), [300, 225, 600, 450]);
  await shown.element().evaluate((element) => (element.style.width = '200px'));
  await shown.drawn();
  assert.deepEqual(await sizes(), [200, 150, 400, 300]);
  await shown.element().evaluate((element) => Object.assign(element.style, { width: '400px', height: '100px' }));
  await shown.drawn();
  assert.deepEqual(await sizes(), [400, 100, 800, 200]);
  const mask = silhouette(await shown.picture());
  assert.ok(Math.abs(mask.box.width / mask.box.height - 1) < 0.1, 'the ball stays round');
  assert.ok(mask.box.height > 0.7 * mask.height, 'and fits again');
});

test('colours are the page’s, and follow it', async () => {
  site.put('/plain.xyz', boxScan());
  const style = ':root { color-scheme: light dark } .blue { --point-weave-mesh: oklch(0.5 0.2 260) } point-weave { --point-weave-points: #c00000 }';
  const shown = await site.open('<point-weave src="/plain.xyz" alt="A box"></point-weave>', { style });
  await shown.loaded();
  const light = await shown.picture();
  const [, , lightBlue] = hue(light);
  await shown.element().evaluate((element) => element.classList.add('blue'));
  await shown.page.waitForTimeout(100);
  await shown.drawn();
  const [red, , blue] = hue(await shown.picture());
  assert.ok(lightBlue < 0.97 && blue === 1 && red < 0.7, `a class makes it blue: ${[red, blue]}`);
  await shown.set({ view: 'points' });
  const points = hue(await shown.picture());
  assert.ok(points[0] === 1 && points[1] < 0.3, `its points are red: ${points}`);
  await shown.page.emulateMedia({ colorScheme: 'dark' });
  await shown.drawn();
  assert.ok(difference(light, await shown.picture()) > 0.8, 'the background gets dark');
  await shown.keep('dark');
});
