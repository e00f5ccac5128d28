// How people get on with it: with keys, a pointer, a screen reader, little motion; and how pages change it.

import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { decodePng, difference, silhouette as silhouetteWithin } from '../page/pictures.mjs';
import { ball, boxScan, duckScan, glb, poster } from './files.mjs';
import { startSite, test } from './site.mjs';

const silhouette = (png) => silhouetteWithin(png, 0);
const axe = await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

const site = await startSite();
site.put('/duck.ply', (await duckScan()).bytes);
site.put('/box.xyz', boxScan());
site.put('/many.ply', (await duckScan({ count: 60_000 })).bytes);
site.put('/violet.svg', poster('#8020c0'));
site.put('/ball.glb', await glb([{ ...ball(16), color: [200, 10, 10] }]));
/** Two balls, so that one sees it turn. */
site.put('/two.glb', await glb([{ ...ball(12, 1, [-1.2, 0, 0]), color: [200, 10, 10] }, { ...ball(12, 0.6, [1.2, 0, 0]), color: [10, 10, 200] }]));

const LARGE = 'point-weave { width: 600px }';

test('keyboard alone', async () => {
  const shown = await site.open('<point-weave src="/duck.ply" alt="A toy duck" view="points" controls></point-weave><a href="#">Next</a>', { style: LARGE });
  const { page } = shown;
  await shown.loaded();
  const press = async (key, times = 1) => {
    for (let k = 0; k < times; k++) await page.keyboard.press(key);
    await shown.drawn();
  };
  await press('Tab');
  const canvas = page.getByRole('application', { name: 'A toy duck' });
  assert.ok(await canvas.evaluate((element) => element.matches(':focus-visible')));
  assert.equal(await canvas.evaluate((element) => getComputedStyle(element).outlineStyle), 'solid');
  assert.match(await canvas.evaluate((element) => element.getRootNode().getElementById(element.getAttribute('aria-describedby')).textContent), /Arrow keys/);
  await shown.keep('focus');

  const first = await shown.picture();
  await press('ArrowRight', 4);
  assert.ok(difference(first, await shown.picture()) > 0.03, 'right turns it');
  await page.waitForFunction(() => document.querySelector('point-weave').shadowRoot.querySelector('[role=status]').textContent.startsWith('Seen'));
  assert.equal(await shown.spoken(), 'Seen from the right, from above, zoom 100 per cent');
  await press('ArrowLeft', 4);
  assert.ok(difference(first, await shown.picture()) < 0.01, 'left turns it back');
  await press('ArrowUp', 4);
  await page.waitForFunction(() => /from the top/.test(document.querySelector('point-weave').shadowRoot.querySelector('[role=status]').textContent));
  await press('ArrowDown', 8);
  await page.waitForFunction(() => /from below/.test(document.querySelector('point-weave').shadowRoot.querySelector('[role=status]').textContent));
  await press('Home');
  assert.ok(difference(first, await shown.picture()) < 0.01, 'Home starts over');
  await press('-', 3);
  assert.ok(silhouette(await shown.picture()).area < 0.5 * silhouette(first).area, 'minus goes away');
  await press('+', 6);
  assert.ok(silhouette(await shown.picture()).area > 1.2 * silhouette(first).area, 'plus comes nearer');
  await press('Home');

  const view = () => shown.element().evaluate((element) => element.view);
  await press('2');
  await shown.loaded();
  assert.equal(await view(), 'reduced');
  await press('3');
  await shown.loaded();
  assert.equal(await view(), 'mesh');
  await press('1');
  assert.equal(await view(), 'points');
  assert.equal(await shown.spoken(), '3,000 points');

  await press('Tab');
  assert.ok(await page.getByRole('radio', { name: 'Points' }).evaluate((radio) => radio.matches(':focus')));
  await press('ArrowRight');
  assert.equal(await view(), 'reduced');
  assert.deepEqual((await shown.events()).filter(({ type }) => type === 'change').length, 4);
  await press('ArrowLeft');
  await press('ArrowRight', 2);
  assert.equal(await view(), 'mesh');
  const reached = [];
  for (let k = 0; k < 3; k++) {
    await press('Tab');
    reached.push(await page.evaluate(() => {
      const { activeElement } = document;
      return (activeElement.shadowRoot?.activeElement ?? activeElement).getAttribute('aria-label') ?? activeElement.textContent;
    }));
  }
  assert.deepEqual(reached, ['Start over', 'Full screen', 'Next']);
  const away = await shown.picture();
  await press('ArrowRight');
  assert.equal(difference(away, await shown.picture()), 0, 'keys elsewhere do nothing');
});

test('without controls it is an image: no focus, no keys, no pointer', async () => {
  const shown = await site.open('<point-weave src="/ball.glb" alt="A red ball"></point-weave><point-weave id="decoration" src="/ball.glb" alt=""></point-weave>');
  await shown.loaded();
  const { page } = shown;
  assert.equal(await page.getByRole('img', { name: 'A red ball' }).count(), 1);
  assert.equal(await page.getByRole('img').count(), 1, 'decoration is not spoken of');
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.localName), 'body');
  assert.equal(await page.getByRole('button').count(), 0);
  const before = await shown.picture();
  await drag(shown, 80, 0);
  assert.equal(difference(before, await shown.picture()), 0);
});

/** Drags across the middle of the element. */
async function drag({ page, element, drawn }, dx, dy) {
  const { x, y, width, height } = await element.call({ page }).first().boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2 + dx, y + height / 2 + dy, { steps: 4 });
  await page.mouse.up();
  await drawn.call({ page });
}

test('a pointer turns it; a wheel scrolls the page until one has taken hold of it', async () => {
  const shown = await site.open('<point-weave src="/two.glb" alt="Two balls" controls></point-weave><div style="height: 3000px"></div>', { style: LARGE });
  await shown.loaded();
  const { page } = shown;
  const first = await shown.picture();
  await page.mouse.move(300, 250);
  await page.mouse.wheel(0, 60);
  await page.waitForFunction(() => scrollY > 0);
  await page.evaluate(() => scrollTo(0, 0));
  await shown.drawn();
  assert.ok(difference(first, await shown.picture()) < 0.001, 'nothing was zoomed');
  await drag(shown, 120, 0);
  assert.ok(difference(first, await shown.picture()) > 0.03, 'a drag turns it');
  const turned = silhouette(await shown.picture()).area;
  await page.mouse.wheel(0, 300);
  await shown.drawn();
  assert.equal(await page.evaluate(() => scrollY), 0);
  assert.ok(silhouette(await shown.picture()).area < 0.95 * turned, 'now the wheel zooms');
  await page.getByRole('button', { name: 'Start over' }).click();
  await shown.drawn();
  assert.ok(difference(first, await shown.picture()) < 0.001);
  assert.equal(await shown.element().evaluate(({ shadowRoot }) => getComputedStyle(shadowRoot.querySelector('canvas')).touchAction), 'pan-y');
});

test('a drag glides to rest, unless less motion is wanted', async () => {
  for (const reducedMotion of ['no-preference', 'reduce']) {
    const shown = await site.open('<point-weave src="/two.glb" alt="Two balls" controls></point-weave>', { reducedMotion, style: LARGE });
    await shown.loaded();
    const glided = shown.element().evaluate(({ shadowRoot }) => new Promise((resolve) => {
      const canvas = shadowRoot.querySelector('canvas');
      const frame = () => new Promise((drawn) => requestAnimationFrame(drawn));
      canvas.addEventListener('pointerup', async () => {
        await frame();
        await frame(); // what the drag itself asked for is drawn
        const before = canvas.toDataURL();
        for (let k = 0; k < 10; k++) await frame();
        resolve(canvas.toDataURL() !== before);
      });
    }));
    await drag(shown, 120, 0);
    assert.equal(await glided, reducedMotion === 'no-preference');
  }
});

test('auto-rotate turns it, the button and the space bar pause it, less motion stops it', async () => {
  const shown = await site.open('<point-weave src="/two.glb" alt="Two balls" auto-rotate controls></point-weave>', { reducedMotion: 'no-preference', style: LARGE });
  await shown.loaded();
  const { page } = shown;
  const pixels = () => shown.element().evaluate(({ shadowRoot }) => shadowRoot.querySelector('canvas').toDataURL());
  const changes = async () => {
    const before = await pixels();
    await page.waitForFunction((old) => document.querySelector('point-weave').shadowRoot.querySelector('canvas').toDataURL() !== old, before);
  };
  const rests = async () => {
    await shown.drawn();
    const before = await pixels();
    for (let k = 0; k < 10; k++) await shown.drawn();
    assert.equal(await pixels(), before);
  };
  await changes();
  await page.getByRole('button', { name: 'Pause turning' }).click();
  await rests();
  await page.getByRole('button', { name: 'Turn' }).click();
  await changes();
  await page.getByRole('application').focus();
  await page.keyboard.press('Space');
  await rests();
  await page.keyboard.press('Space');
  await changes();
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await rests();
  assert.equal(await page.getByRole('button', { name: 'Pause turning' }).count(), 0, 'there is nothing to pause');
  await page.emulateMedia({ reducedMotion: 'no-preference' });
  await changes();
  await shown.set({ controls: false });
  assert.equal(await page.getByRole('button', { name: 'Pause turning' }).count(), 1, 'what moves by itself can be stopped');
  await shown.set({ autoRotate: false });
  await rests();
});

test('full screen and back', async () => {
  const shown = await site.open('<point-weave src="/ball.glb" alt="A red ball" controls></point-weave>', { style: LARGE });
  await shown.loaded();
  const { page } = shown;
  const full = () => page.evaluate(() => document.fullscreenElement?.localName);
  const size = () => shown.element().evaluate(({ shadowRoot }) => [shadowRoot.querySelector('canvas').width, shadowRoot.querySelector('canvas').height]);
  await page.getByRole('button', { name: 'Full screen' }).click();
  await page.waitForFunction(() => document.fullscreenElement?.shadowRoot.querySelector('canvas').width > 600);
  assert.deepEqual([await full(), await size()], ['point-weave', [800, 600]]);
  await page.getByRole('button', { name: 'Full screen' }).click();
  await page.waitForFunction(() => document.querySelector('point-weave').shadowRoot.querySelector('canvas').width === 600);
  assert.equal(await full(), undefined);
});

test('the focus stays where it is while a chosen view is computed', async () => {
  const shown = await site.open('<point-weave src="/many.ply" alt="Something" view="points" controls></point-weave>', { style: LARGE });
  await shown.loaded();
  const { page } = shown;
  await page.getByRole('radio', { name: 'Reduced' }).focus();
  await page.keyboard.press('ArrowRight');
  await page.getByRole('button', { name: 'Cancel' }).waitFor();
  assert.ok(await page.getByRole('radio', { name: 'Mesh' }).evaluate((radio) => radio.matches(':focus') && radio.checkVisibility()));
  await page.getByRole('button', { name: 'Cancel' }).focus();
  await shown.loaded();
  assert.ok(await page.getByRole('application').evaluate((canvas) => canvas.matches(':focus')), 'not lost with the button');
});

test('axe finds nothing, in any state, light and dark', async () => {
  site.put('/slow.glb', await glb([{ ...ball(8), color: [200, 10, 10] }]));
  const body = `<point-weave id="scan" src="/duck.ply" alt="A toy duck" controls auto-rotate></point-weave>
    <point-weave id="plain" src="/ball.glb" alt="A red ball"></point-weave>
    <point-weave id="decoration" src="/ball.glb" alt=""></point-weave>
    <point-weave id="failed" src="/none.ply" alt="Something" controls></point-weave>
    <point-weave id="waiting" src="/slow.glb" alt="Something else" poster="/violet.svg" controls></point-weave>`;
  for (const colorScheme of ['light', 'dark']) {
    const shown = await site.open(body, {
      colorScheme, reducedMotion: 'no-preference', style: ':root { color-scheme: light dark } body { background: Canvas } point-weave { width: 480px }',
      viewport: { width: 1280, height: 2200 }, // all at once: what is far away waits
      prepare: (page) => page.route('**/slow.glb', () => {}), // never answered
    });
    await shown.loaded('#scan, #plain, #decoration');
    await shown.element('#waiting').getByRole('button', { name: 'Cancel' }).waitFor();
    await shown.heard('error');
    await shown.page.evaluate(axe);
    const { violations, incomplete, passes } = await shown.page.evaluate(() => axe.run());
    const named = (rules) => rules.map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target).join(' ')}`);
    assert.deepEqual(named(violations), []);
    assert.deepEqual(named(incomplete), []);
    const looked = new Set(passes.flatMap(({ nodes }) => nodes).map(({ target: [path] }) => String(path)));
    assert.ok([...looked].some((path) => path.startsWith('#scan,canvas')), `axe looked into the elements: ${[...looked]}`);
    await shown.keep(`states-${colorScheme}`);
  }
});

test('a phone: everything fits and is large enough to touch', async () => {
  const shown = await site.open(`<point-weave src="/duck.ply" alt="A toy duck" controls auto-rotate></point-weave>
    <point-weave id="failed" src="/none.ply" alt="Something" controls></point-weave>
    <point-weave id="tiny" src="/box.xyz" alt="A box" controls style="width: 200px"></point-weave>`, {
    viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2, reducedMotion: 'no-preference', style: 'point-weave { width: 100%; margin-block: 8px }',
  });
  await shown.loaded('[src="/duck.ply"], #tiny');
  await shown.heard('error');
  await shown.keep('phone');
  const outside = await shown.page.evaluate(() => [...document.querySelectorAll('point-weave')].flatMap((element) => {
    const frame = element.getBoundingClientRect();
    return [...element.shadowRoot.querySelectorAll('button, label')].filter((part) => part.checkVisibility()).map((part) => part.getBoundingClientRect())
      .filter(({ left, right, top, bottom, height }) => left < frame.left || right > frame.right || top < frame.top || bottom > frame.bottom || height < 44);
  }));
  assert.deepEqual(outside, []);
  assert.equal(await shown.page.evaluate(() => document.documentElement.scrollWidth), 360);
});

test('slots and parts: a page puts its own in their place', async () => {
  const shown = await site.open(`<point-weave src="/slow.glb" alt="A ball" controls>
      <button slot="poster">Show it</button>
      <p slot="progress" id="progress">Just a moment</p>
      <div slot="toolbar" id="toolbar"><button id="own">Mine</button></div>
      <p slot="error" id="error">Sorry</p>
    </point-weave>`, {
    style: `${LARGE} point-weave::part(frame) { outline: 3px solid rgb(1, 2, 3) } point-weave::part(error) { background: rgb(4, 5, 6) }`,
    prepare: (page) => page.route('**/slow.glb', () => {}),
  });
  const { page } = shown;
  await page.locator('#progress').waitFor();
  assert.ok(await page.getByRole('button', { name: 'Show it' }).isVisible());
  assert.equal(await page.getByRole('button', { name: 'Cancel' }).count(), 0);
  await shown.set({ src: '/none.ply' });
  await page.locator('#error').waitFor();
  const styles = await shown.element().evaluate(({ shadowRoot }) => [
    getComputedStyle(shadowRoot.querySelector('[part=frame]')).outlineColor, getComputedStyle(shadowRoot.querySelector('[part=error]')).backgroundColor,
  ]);
  assert.deepEqual(styles, ['rgb(1, 2, 3)', 'rgb(4, 5, 6)']);
  await shown.set({ src: '/ball.glb' });
  await shown.loaded();
  assert.ok(await page.locator('#own').isVisible());
  assert.equal(await page.getByRole('button', { name: 'Show it' }).isVisible(), false);
  assert.equal(await page.getByRole('button', { name: 'Start over' }).count(), 0);
});

test('other words', async () => {
  const shown = await site.open('<point-weave src="/ball.glb" controls></point-weave>', {
    define: false,
    prepare: (page) => page.addInitScript(() => addEventListener('DOMContentLoaded', async () => {
      const { PointWeaveElement } = await import('/pointweave/element/element.js');
      PointWeaveElement.words = { ...PointWeaveElement.words, untitled: '3D-Bild', reset: 'Von vorn' };
      await import('/pointweave/element.js');
    })),
  });
  await shown.page.waitForFunction(() => customElements.get('point-weave'));
  await shown.loaded();
  assert.equal(await shown.page.getByRole('button', { name: 'Von vorn' }).count(), 1);
  assert.equal(await shown.page.getByRole('application', { name: '3D-Bild' }).count(), 1);
});

test('a poster can be made of it', async () => {
  const shown = await site.open('<point-weave src="/ball.glb" alt="A red ball"></point-weave>');
  await shown.loaded();
  const bytes = await shown.element().evaluate(async (element) => [...new Uint8Array(await (await element.toBlob('image/png')).arrayBuffer())]);
  const { width, height, channels, data } = decodePng(Buffer.from(bytes));
  assert.deepEqual([width, height, channels], [300, 225, 4]);
  const alpha = (x, y) => data[4 * (y * width + x) + 3];
  assert.deepEqual([alpha(0, 0), alpha(150, 112)], [0, 255], 'the background is let through');
});
