// Tilesets that stream: on a canvas, and in the element.

import assert from 'node:assert/strict';
import { putTileset, tileset } from './tilesets.mjs';
import { startSite, test } from './site.mjs';

const site = await startSite();
const ORIGIN = [400_000.125, 5_700_000.5, 100.25];
const points = putTileset(site, '/points', await tileset({ origin: ORIGIN, levels: 4 }));

test('try', async () => {
  const shown = await site.open('<canvas style="width: 600px; height: 450px; display: block" aria-label="Hills"></canvas>', { define: false });
  shown.page.on('console', (m) => console.log(m.text()));
  const state = await shown.page.evaluate(async (url) => {
    const { createViewer } = await import('pointweave/viewer');
    window.viewer = createViewer(document.querySelector('canvas'));
    const t = performance.now();
    await viewer.stream(url);
    const first = performance.now() - t;
    await new Promise((r) => setTimeout(r, 2000));
    return { first, state: viewer.streamed, dims: viewer.dimensions, stance: viewer.stance, layers: viewer.layers, view: viewer.view };
  }, points);
  console.log(JSON.stringify(state, null, 1));
  await shown.page.screenshot({ path: '/tmp/s1.png' });
  console.log(shown.faults);
});
