// An element's life: what it fetches and when, what becomes of work that is no longer wanted, and what it leaves behind.

import assert from 'node:assert/strict';
import { decodePng, difference, meanColor, silhouette as silhouetteWithin } from '../page/pictures.mjs';
import { ball, boxScan, duckScan, glb, poster } from './files.mjs';
import { startSite, test } from './site.mjs';

const silhouette = (png) => silhouetteWithin(png, 0);
const COLORS = { red: [200, 10, 10], green: [10, 200, 10], blue: [10, 10, 200] };

const site = await startSite();
const duck = await duckScan();
site.put('/duck.ply', duck.bytes);
site.put('/box.xyz', boxScan());
site.put('/many.ply', (await duckScan({ count: 60_000 })).bytes);
site.put('/violet.svg', poster('#8020c0'));
for (const [name, color] of Object.entries(COLORS)) site.put(`/${name}.glb`, await glb([{ ...ball(16), color }]));

/** Which of red, green and blue a picture has most of, or none where nothing is drawn. */
function color(png) {
  const mask = silhouette(png);
  if (mask.area < 500) return 'nothing';
  const channels = meanColor(png, mask);
  return Object.keys(COLORS)[channels.indexOf(Math.max(...channels))];
}

/** Holds the answers for a path until told to let them go. */
async function hold(page, path) {
  let release;
  const held = new Promise((resolve) => (release = resolve));
  await page.route(path, async (route) => {
    await held;
    await route.continue().catch(() => {}); // the page no longer waits for it
  });
  return release;
}

const heavy = (path) => /three|\.wasm|\/engine\.js|worker/.test(path);
const moved = (shown, by) => shown.page.evaluate((y) => window.scrollBy(0, y), by);

test('nothing is fetched, loaded or computed before it nears the viewport', async () => {
  const shown = await site.open(`<div style="height: 5000px"></div>
    <point-weave id="far" src="/red.glb" poster="/violet.svg" alt="A red ball"></point-weave>
    <point-weave id="hidden" src="/green.glb" alt="A green ball" style="display: none"></point-weave>`);
  await shown.page.waitForLoadState('networkidle');
  const files = () => shown.asked.filter((path) => heavy(path) || /\.(glb|svg)$/.test(path));
  assert.deepEqual(files(), []);
  assert.equal(await shown.page.evaluate(() => window.contexts.length), 0);
  await moved(shown, 3000);
  await shown.page.waitForLoadState('networkidle');
  assert.deepEqual(files(), [], 'still two viewports away');
  await moved(shown, 1200);
  await shown.loaded('#far');
  assert.ok(files().includes('/red.glb') && files().includes('/violet.svg') && files().some(heavy));
  assert.ok(!files().includes('/green.glb'), 'what is not displayed is not fetched');
  await moved(shown, 2000);
  await shown.drawn();
  assert.equal(color(await shown.picture('#far')), 'red');
});

test('loading="eager" does not wait', async () => {
  const shown = await site.open('<div style="height: 5000px"></div><point-weave loading="eager" src="/red.glb" alt="A red ball"></point-weave>');
  await shown.loaded();
  assert.equal(await shown.page.evaluate(() => scrollY), 0);
});

test('the poster comes first and goes when the view is there', async () => {
  let release;
  const shown = await site.open('<point-weave src="/green.glb" poster="/violet.svg" alt="A green ball"></point-weave>', {
    prepare: async (page) => (release = await hold(page, '**/green.glb')),
  });
  await shown.page.waitForFunction(() => document.querySelector('point-weave').shadowRoot.querySelector('img').complete);
  await shown.page.getByRole('progressbar', { name: 'Loading' }).waitFor();
  await shown.keep('poster');
  const { data, channels, width, height } = decodePng(await shown.picture());
  const middle = channels * (Math.floor(height / 2) * width + Math.floor(width / 2));
  assert.deepEqual([...data.subarray(middle, middle + 3)], [0x80, 0x20, 0xc0]);
  release();
  await shown.loaded();
  assert.equal(color(await shown.picture()), 'green');
});

test('another src: the old job ends with an abort, and nothing of it is ever shown', async () => {
  let release;
  const shown = await site.open('<point-weave src="/red.glb" alt="A ball"></point-weave>', {
    prepare: async (page) => (release = await hold(page, '**/red.glb')),
  });
  await shown.heard('progress');
  await shown.set({ src: '/green.glb' });
  await shown.loaded();
  release();
  await shown.page.waitForLoadState('networkidle');
  await shown.drawn();
  assert.equal(color(await shown.picture()), 'green');
  const told = (await shown.events()).filter(({ type }) => type !== 'progress').map(({ type, src, reason }) => [type, src, reason]);
  assert.deepEqual(told, [['abort', '/red.glb', 'src'], ['load', '/green.glb', undefined]]);
});

test('another src at the last moment: nothing of the old one either', async () => {
  const shown = await site.open('<point-weave alt="A ball"></point-weave>');
  await shown.element().evaluate((element) => {
    element.addEventListener('progress', ({ detail }) => {
      if (detail.overall === 1 && detail.src === '/red.glb') element.src = '/green.glb';
    });
    element.src = '/red.glb';
  });
  await shown.loaded();
  assert.equal(color(await shown.picture()), 'green');
  const told = (await shown.events()).filter(({ type }) => type !== 'progress').map(({ type, src }) => [type, src]);
  assert.deepEqual(told, [['abort', '/red.glb'], ['load', '/green.glb']]);
});

test('another src while a scan is computed, and many in one go', async () => {
  const shown = await site.open('<point-weave alt="Something" threads="1"></point-weave>');
  const released = await hold(shown.page, '**/box.xyz');
  const pixels = shown.at('cluster', (element) => {
    const { context, count } = { context: element.shadowRoot.querySelector('canvas').getContext('2d'), count: () => context.getImageData(0, 0, 300, 225).data.filter((value, i) => i % 4 === 3 && value > 0).length };
    const before = count();
    element.src = '/box.xyz';
    return [before, count()];
  });
  await shown.set({ src: '/many.ply' });
  const [before, after] = await pixels;
  assert.ok(before > 5000, `the points are shown meanwhile: ${before} pixels`);
  assert.equal(after, 0, 'they are gone at once when another src is wanted');
  assert.ok((await shown.events()).every(({ type }) => type !== 'load'));
  released();
  await shown.loaded();
  await shown.element().evaluate((element) => {
    for (const src of ['/red.glb', '/duck.ply', '/green.glb', '/many.ply', '/blue.glb']) element.src = src;
  });
  await shown.loaded();
  assert.equal(color(await shown.picture()), 'blue');
  const told = (await shown.events()).filter(({ type }) => type !== 'progress').map(({ type, src, reason }) => [type, src, reason]);
  assert.deepEqual(told, [['abort', '/many.ply', 'src'], ['load', '/box.xyz', undefined], ['load', '/blue.glb', undefined]]);
  assert.deepEqual(shown.asked.filter((path) => /(red|green)\.glb|duck/.test(path)), [], 'what was only passed through is not fetched');
  await shown.set({ src: null });
  assert.equal(color(await shown.picture()), 'nothing');
});

test('another count while computing starts over from the points', async () => {
  const shown = await site.open('<point-weave alt="Something" view="reduced" count="20000"></point-weave>');
  const changed = shown.at('cluster', (element) => void (element.count = 500));
  await shown.set({ src: '/many.ply' });
  await changed;
  await shown.loaded();
  await shown.set({ count: null, ratio: 0.01 });
  await shown.loaded();
  const told = (await shown.events()).filter(({ type }) => type !== 'progress').map(({ type, points, reason }) => [type, points ?? reason]);
  assert.deepEqual(told, [['abort', 'target'], ['load', 500], ['load', 600]]);
  assert.equal(shown.asked.filter((path) => path === '/many.ply').length, 1, 'the file is fetched once');
});

test('Cancel stops the work, Try again does it', async () => {
  const shown = await site.open('<point-weave src="/many.ply" poster="/violet.svg" alt="Something" controls></point-weave>', { style: 'point-weave { width: 600px }' });
  const cancel = shown.page.getByRole('button', { name: 'Cancel' });
  await cancel.waitFor();
  await shown.keep('progress');
  await cancel.click();
  const [last] = (await shown.events()).slice(-1);
  assert.deepEqual([last.type, last.reason], ['abort', 'called']);
  const retry = shown.page.getByRole('button', { name: 'Try again' });
  assert.ok(await retry.evaluate((button) => button.matches(':focus')), 'the focus is not lost');
  assert.match(await shown.page.getByRole('alert').innerText(), /Stopped/);
  const { length } = await shown.events();
  await shown.set({ alt: 'Something else', autoRotate: true });
  assert.equal((await shown.events()).length, length, 'nothing starts it again that does not ask for work');
  await retry.click();
  await shown.heard('load');
  await shown.element().evaluate((element) => element.reload());
  await cancel.click();
  assert.equal(color(await shown.picture()), 'nothing', 'the poster lies over the points');
  await shown.set({ view: 'points' });
  await shown.loaded();
  assert.notEqual(color(await shown.picture()), 'nothing', 'it makes way for them when they are asked for');
  await shown.set({ src: '/duck.ply' });
  await shown.loaded();
  assert.equal(await retry.isVisible(), false);
});

test('removed: the job is aborted, the GPU is freed; put back: it is shown again', async () => {
  const shown = await site.open(`<div id="home"><point-weave id="ball" src="/red.glb" alt="A red ball"></point-weave></div>
    <point-weave id="scan" src="/duck.ply" view="reduced" alt="A duck"></point-weave>`);
  await shown.loaded();
  const { page } = shown;
  const held = () => page.evaluate(() => ({ ...window.held }));
  const removal = () => page.evaluate(() => {
    window.kept = [...document.querySelectorAll('point-weave')];
    for (const element of window.kept) element.remove();
  });
  await removal();
  await shown.drawn();
  const empty = await held();
  for (let k = 0; k < 5; k++) {
    await page.evaluate(() => document.querySelector('#home').append(...window.kept));
    await shown.loaded();
    assert.equal(color(await shown.picture('#ball')), 'red');
    assert.notEqual(color(await shown.picture('#scan')), 'nothing');
    const full = await held();
    assert.ok(full.Buffer >= empty.Buffer + 4, `${full.Buffer} buffers are more than ${empty.Buffer}`);
    await removal();
    await shown.drawn();
    assert.deepEqual(await held(), empty);
  }
  assert.equal(shown.asked.filter((path) => path === '/red.glb').length, 1, 'it is not fetched again');

  const removed = shown.at('features', (element) => new Promise((resolve) => {
    element.addEventListener('abort', ({ detail }) => resolve(detail));
    element.remove();
  }));
  await page.evaluate(() => {
    const element = document.createElement('point-weave');
    element.src = '/many.ply';
    document.querySelector('#home').append(element);
  });
  assert.deepEqual(await removed, { src: '/many.ply', reason: 'removed' });
});

test('moved: nothing is aborted, nothing done again', async () => {
  const shown = await site.open('<div id="home"><point-weave view="reduced" alt="Something"></point-weave></div>');
  const done = shown.at('features', (element) => document.querySelector('#home').append(element));
  await shown.set({ src: '/many.ply' });
  await done;
  await shown.loaded();
  assert.deepEqual((await shown.events()).filter(({ type }) => type !== 'progress').map(({ type }) => type), ['load']);
  assert.equal(shown.asked.filter((path) => path === '/many.ply').length, 1);
});

test('what is removed and forgotten is collected', async () => {
  const shown = await site.open('<div id="home"></div><point-weave src="/blue.glb" alt="Stays"></point-weave>');
  const { page } = shown;
  for (let k = 0; k < 3; k++) {
    await page.evaluate((src) => {
      window.refs ??= [];
      const element = document.createElement('point-weave');
      Object.assign(element, { src, view: 'reduced', controls: true, autoRotate: true });
      document.querySelector('#home').append(element);
      window.refs.push(new WeakRef(element));
    }, k ? '/red.glb' : '/duck.ply');
    await shown.loaded();
    await page.evaluate(() => document.querySelector('#home').replaceChildren());
  }
  await page.evaluate(() => (window.heard.length = 0));
  await page.waitForFunction(() => {
    gc();
    return window.refs.every((ref) => !ref.deref());
  });
});

test('what cannot be seen is not drawn', async () => {
  const shown = await site.open('<point-weave src="/red.glb" alt="A ball" auto-rotate></point-weave><div style="height: 3000px"></div>', { reducedMotion: 'no-preference' });
  await shown.loaded();
  const copies = () => shown.page.evaluate(async () => {
    window.copies ??= 0;
    if (!window.copies) {
      const { drawImage } = CanvasRenderingContext2D.prototype;
      CanvasRenderingContext2D.prototype.drawImage = function (...rest) {
        window.copies++;
        return drawImage.apply(this, rest);
      };
    }
    const before = window.copies;
    for (let k = 0; k < 20; k++) await new Promise(requestAnimationFrame);
    return window.copies - before;
  });
  assert.ok(await copies() > 0, 'it turns');
  await moved(shown, 2000);
  await shown.drawn();
  await shown.drawn();
  assert.equal(await copies(), 0);
  await moved(shown, -2000);
  await shown.drawn();
  assert.ok(await copies() > 0, 'and turns on');
});

test('thirty on one page share one context; each shows its own', async () => {
  const names = Object.keys(COLORS);
  const balls = Array.from({ length: 24 }, (_, i) => `<point-weave id="b${i}" src="/${names[i % 3]}.glb?${i}" alt="Ball ${i}" auto-rotate></point-weave>`);
  const scans = Array.from({ length: 6 }, (_, i) => `<point-weave id="s${i}" src="/${['duck.ply', 'box.xyz'][i % 2]}?${i}" view="${['mesh', 'reduced', 'points'][i % 3]}" alt="Scan ${i}"></point-weave>`);
  const shown = await site.open(`<div class="grid">${balls.join('')}${scans.join('')}</div>`, {
    style: '.grid { display: grid; grid-template-columns: repeat(6, 1fr); gap: 8px } point-weave { width: 100% }',
    viewport: { width: 1200, height: 900 },
  });
  await shown.loaded();
  assert.deepEqual(await shown.page.evaluate(() => [window.contexts.length, window.contexts[0].isContextLost()]), [1, false]);
  for (let i = 0; i < 24; i += 5) assert.equal(color(await shown.picture(`#b${i}`)), names[i % 3]);
  for (let i = 0; i < 6; i++) assert.notEqual(color(await shown.picture(`#s${i}`)), 'nothing');
  assert.equal((await shown.events()).filter(({ type }) => type === 'load').length, 30);
  assert.equal(shown.page.workers().length, 1, 'one engine computes all scans; readers have ended');
  await shown.keep('thirty');
  assert.deepEqual(shown.faults, []);
});

test('a lost context leaves the pictures, a restored one draws again', async () => {
  const shown = await site.open(`<point-weave id="ball" src="/red.glb" alt="A ball"></point-weave>
    <point-weave id="scan" src="/duck.ply" view="points" alt="A duck"></point-weave>`);
  await shown.loaded();
  const pictures = () => Promise.all(['#ball', '#scan'].map((selector) => shown.picture(selector)));
  const before = await pictures();
  const lose = () => shown.page.evaluate(async () => {
    const [context] = window.contexts;
    window.loss = context.getExtension('WEBGL_lose_context');
    const lost = new Promise((resolve) => context.canvas.addEventListener('webglcontextlost', resolve));
    window.loss.loseContext();
    await lost;
  });
  await lose();
  await shown.set({ up: 'z' }, '#ball'); // wants a frame while there is no context
  const during = await pictures();
  during.forEach((picture, i) => assert.equal(difference(picture, before[i]), 0));
  await shown.page.evaluate(async () => {
    const restored = new Promise((resolve) => window.contexts[0].canvas.addEventListener('webglcontextrestored', resolve));
    window.loss.restoreContext();
    await restored;
  });
  await shown.drawn();
  await shown.set({ view: 'reduced' }, '#scan');
  await shown.loaded();
  await shown.set({ view: 'points' }, '#scan');
  await shown.set({ up: 'y' }, '#ball');
  const after = await pictures();
  after.forEach((picture, i) => assert.ok(difference(picture, before[i]) < 0.005, `picture ${i} is as before`));
  await shown.set({ src: '/green.glb' }, '#ball');
  await shown.loaded();
  assert.equal(color(await shown.picture('#ball')), 'green');
  assert.equal(await shown.page.evaluate(() => window.contexts.length), 1);
});

test('what goes wrong is said, by code', async () => {
  site.put('/broken.ply', 'ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n1 two 3\n');
  site.put('/two.xyz', '0 0 0\n1 1 1\n');
  site.put('/what.bin', Buffer.from([1, 2, 3, 4, 5, 6, 7, 8]));
  site.put('/short.glb', (await glb([{ ...ball(4), color: COLORS.red }])).subarray(0, 60));
  site.put('/draco.glb', await glb([{ ...ball(4), color: COLORS.red }], { required: ['KHR_draco_mesh_compression'] }));
  const shown = await site.open('<point-weave alt="A thing"></point-weave>', { style: 'point-weave { width: 480px }' });
  for (const [src, code, seen] of [
    ['/none.ply', 'load-failed', ({ found }) => found === 404],
    ['/broken.ply', 'bad-file', ({ index }) => index === 9],
    ['/what.bin', 'unknown-format', () => true],
    ['/short.glb', 'bad-file', ({ message }) => message.includes('60 bytes')],
    ['/draco.glb', 'unsupported-file', ({ found }) => found === 'KHR_draco_mesh_compression'],
    ['/two.xyz', 'too-few-points', () => true],
  ]) {
    const known = (await shown.events()).length;
    await shown.set({ src });
    await shown.page.waitForFunction((least) => window.heard.slice(least).some(({ type }) => type === 'error'), known);
    const event = (await shown.events()).at(-1);
    assert.deepEqual([event.src, event.name, event.code, event.bubbles], [src, 'PointweaveError', code, false]);
    assert.ok(seen(event), JSON.stringify(event));
    assert.ok(!(await shown.page.getByRole('alert').innerText()).includes(event.message), 'a visitor reads a title');
    await shown.page.getByText('Details').click();
    assert.ok((await shown.page.getByRole('alert').innerText()).includes(event.message));
    if (src === '/none.ply') await shown.keep('error');
  }
  await shown.set({ view: 'points' });
  await shown.loaded();
  assert.equal(await shown.page.getByRole('alert').count(), 0, 'the points of too few can be shown');
  await shown.page.route('**/none.ply', (route) => route.fulfill({ body: duck.bytes }));
  await shown.set({ src: '/none.ply' });
  await shown.loaded();
  await shown.page.unroute('**/none.ply');
  await shown.page.route('**/none.ply', (route) => route.abort());
  await shown.element().evaluate((element) => element.reload());
  const events = await shown.heard('error', 7);
  assert.equal(events.at(-1).code, 'load-failed');
  await shown.page.unroute('**/none.ply');
  await shown.page.route('**/none.ply', (route) => route.fulfill({ body: duck.bytes }));
  await shown.page.getByRole('button', { name: 'Try again' }).click();
  await shown.loaded();
  assert.deepEqual(shown.faults, []);
});

test('without WebGL, or without three.js, that is what is said', async () => {
  const blind = await site.open('<point-weave src="/red.glb" alt="A ball"></point-weave>', {
    prepare: (page) => page.addInitScript(() => {
      const { getContext } = HTMLCanvasElement.prototype;
      HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        return kind.startsWith('webgl') ? null : getContext.call(this, kind, ...rest);
      };
    }),
  });
  assert.equal((await blind.heard('error')).at(-1).code, 'no-webgl');
  const alone = await site.open('<point-weave src="/red.glb" alt="A ball"></point-weave>', { imports: {} });
  const { code, message } = (await alone.heard('error')).at(-1);
  assert.equal(code, 'load-failed');
  assert.match(message, /three/);
});

test('a strict content security policy is enough', async () => {
  const shown = await site.open(`<point-weave id="ball" src="/red.glb" alt="A ball" poster="/violet.svg" controls></point-weave>
    <point-weave id="scan" src="/duck.ply" alt="A duck" controls></point-weave>`, { strict: true });
  await shown.loaded();
  assert.deepEqual(shown.faults, []); // before pictures are taken: their own style is forbidden, too
  assert.equal(color(await shown.picture('#ball')), 'red');
  assert.notEqual(color(await shown.picture('#scan')), 'nothing');
  const { width, height } = await shown.element('#ball').boundingBox();
  assert.equal(Math.round((300 * height) / width), 225, 'it is styled');
});
