// What a page knows from <model-viewer>: materials and light, camera attributes, hotspots, methods, poster; and how narrow it can be.

import assert from 'node:assert/strict';
import { decodePng, meanColor, silhouette as silhouetteWithin } from '../page/pictures.mjs';
import { ball, boxScan, glb, poster } from './files.mjs';
import { startSite, test } from './site.mjs';

const silhouette = (png) => silhouetteWithin(png, 0);
const mean = (png) => meanColor(png, silhouette(png));
const pbr = (color, metallicFactor, roughnessFactor, more = {}) => ({ pbrMetallicRoughness: { baseColorFactor: [...color, 1], metallicFactor, roughnessFactor }, ...more });

const site = await startSite();
for (const [name, material] of Object.entries({
  white: pbr([1, 1, 1], 0, 0.9), metal: pbr([0.9, 0.9, 0.9], 1, 0.25), lamp: pbr([0, 0, 0], 0, 1, { emissiveFactor: [0, 1, 0] }), bare: undefined,
})) site.put(`/${name}.glb`, await glb([{ ...ball(24), material }]));
// Two wide, four high, one deep, away from the middle.
const box = boxScan([2, 4, 1]);
site.put('/box.xyz', box);
site.put('/poster.svg', poster('#c00'), { 'Content-Type': 'image/svg+xml' });
// Radiance's format: four columns, two rows, all red.
site.put('/red.hdr', Buffer.concat([Buffer.from('#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n'), Buffer.alloc(32, Buffer.from([128, 8, 8, 129]))]));
const BARE = '--point-weave-background: none; inline-size: 200px; block-size: 200px; border-radius: 0';

test('materials of a GLB are lit as they are; what has none gets the theme’s colour', async () => {
  const names = ['white', 'metal', 'lamp', 'bare'];
  const shown = await site.open(names.map((name) => `<point-weave id="${name}" src="/${name}.glb" alt="A ball" loading="eager"></point-weave>`).join(''), { style: `point-weave { ${BARE} }` });
  await shown.loaded();
  const colors = {};
  for (const name of names) colors[name] = mean(await shown.picture(`#${name}`));
  const [red, green, blue] = colors.white;
  assert.ok(Math.min(red, green, blue) > 228 && Math.max(red, green, blue) - Math.min(red, green, blue) < 4, `white is white: ${colors.white}`);
  assert.ok(colors.metal[0] > 140 && colors.metal[0] < 200, `metal mirrors a studio: ${colors.metal}`);
  assert.ok(colors.lamp[1] > 150 && colors.lamp[0] < 60, `a lamp shines green: ${colors.lamp}`);
  assert.ok(colors.bare[0] - colors.bare[2] > 8, `no material: the theme's cream: ${colors.bare}`);

  await shown.set({ exposure: 0.3 }, '#white');
  assert.ok(mean(await shown.picture('#white'))[0] < 190, 'exposure');
  await shown.page.addStyleTag({ content: '#white, #bare { --point-weave-mesh: rgb(200, 0, 0) }' });
  for (const name of ['white', 'bare']) {
    await shown.page.waitForFunction((id) => new Promise((done) => requestAnimationFrame(() => done(document.getElementById(id)))), name);
    await shown.page.waitForTimeout(300);
    const [r, g] = mean(await shown.picture(`#${name}`));
    assert.ok(r > 1.8 * g, `${name} takes the page's colour: ${[r, g]}`);
  }
  assert.deepEqual(shown.faults, []);
});

test('a shadow lies on the ground, and a picture of the surroundings lights', async () => {
  const shown = await site.open('<point-weave src="/white.glb" alt="A ball" loading="eager" camera-orbit="0deg 60deg 200%"></point-weave>', { style: `point-weave { ${BARE} }` });
  await shown.loaded();
  const below = async () => {
    const { width, height, channels, data } = decodePng(await shown.picture());
    const at = (x, y) => data[channels * (Math.round(y * height) * width + Math.round(x * width))];
    return at(0.5, 0.78);
  };
  const bright = await below();
  await shown.set({ shadowIntensity: 1 });
  assert.ok((await below()) < bright - 25, `${await below()} of ${bright}`);
  const white = mean(await shown.picture());
  await shown.set({ shadowIntensity: 0 });
  for (const environmentImage of ['/poster.svg', '/red.hdr']) {
    await shown.set({ environmentImage });
    let color;
    for (let tries = 0; tries < 50 && !(color?.[0] > 2 * color?.[1]); tries++) {
      await shown.page.waitForTimeout(100);
      color = mean(await shown.picture());
    }
    assert.ok(color[0] > 2 * color[1], `red surroundings of ${environmentImage}: ${color} after ${white}`);
    await shown.set({ environmentImage: 'neutral' });
    assert.ok(mean(await shown.picture())[1] > 200, 'the studio again');
  }
  await shown.set({ environmentImage: '/none.jpg' });
  assert.match((await shown.heard('error')).at(-1).message, /none\.jpg did not load/);
  assert.equal(await shown.page.getByRole('alert').count(), 0, 'what is shown stays');
  assert.ok(mean(await shown.picture())[1] > 200, 'in the studio');
});

test('camera attributes in model-viewer’s syntax, and what they say now', async () => {
  const shown = await site.open('<point-weave src="/box.xyz" alt="A box" view="points" controls camera-orbit="90deg 60deg 4m" camera-target="2m 0m auto" field-of-view="20deg"></point-weave>');
  await shown.loaded();
  const now = () => shown.element().evaluate((element) => {
    const { theta, phi, radius } = element.getCameraOrbit();
    const { x, y, z } = element.getCameraTarget();
    return [(theta * 180) / Math.PI, (phi * 180) / Math.PI, radius, x, y, z, element.getFieldOfView()].map((value) => Math.round(1000 * value) / 1000);
  });
  assert.deepEqual(await now(), [90, 60, 4, 2, 0, 0.5, 20]);
  assert.match(await shown.element().evaluate((element) => `${element.getCameraTarget()}`), /^2m 0(\.0+\d*)?m 0\.5m$/);
  assert.deepEqual(await shown.element().evaluate((element) => [...`${element.getDimensions()}`.split(' ')].map((word) => parseFloat(word))), [2, 4, 1]);

  await shown.set({ cameraTarget: '', cameraOrbit: '0rad 90deg 100%', fieldOfView: 'auto' });
  const [theta, phi, near, x, y, z, fov] = await now();
  assert.deepEqual([theta, phi, x, y, z, fov], [0, 90, 1, 2, 0.5, 32]);
  await shown.set({ cameraOrbit: '0rad 90deg 200%' });
  assert.ok(Math.abs((await now())[2] - 2 * near) < 0.01);
  for (const wrong of ['0 90deg 100%', '0deg 90deg', 'left', '0deg 90deg 2km']) {
    await shown.set({ cameraOrbit: wrong });
    assert.deepEqual((await now()).slice(0, 2).map(Math.round), [29, 72], `${wrong} is none: the usual first look`);
  }

  await shown.set({ cameraOrbit: '0deg 80deg auto', minCameraOrbit: '-20deg 70deg 90%', maxCameraOrbit: '20deg auto 120%', maxFieldOfView: '25deg' });
  const act = (keys) => shown.page.keyboard.press(keys);
  await shown.element().evaluate((element) => element.focus());
  for (let i = 0; i < 4; i++) await act('ArrowRight');
  for (let i = 0; i < 4; i++) await act('ArrowUp');
  assert.deepEqual((await now()).slice(0, 2), [20, 70]);
  for (let i = 0; i < 8; i++) await act('+');
  const closest = (await now())[2];
  for (let i = 0; i < 12; i++) await act('-');
  assert.ok(Math.abs((await now())[2] / closest - 120 / 90) < 0.02, `${(await now())[2]} and ${closest}`);
  assert.equal((await now())[6], 25);
  const sources = await shown.element().evaluate((element) => new Promise((resolve) => {
    element.addEventListener('camera-change', ({ detail, bubbles }) => resolve([detail.source, bubbles]), { once: true });
    element.shadowRoot.querySelector('canvas').dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowLeft' }));
  }));
  assert.deepEqual(sources, ['user-interaction', false]);

  await shown.set({ minCameraOrbit: '', maxCameraOrbit: '', disableZoom: true, disablePan: true });
  const before = await now();
  await shown.page.mouse.move(150, 180);
  await shown.page.mouse.wheel(0, -300);
  await shown.page.mouse.down({ button: 'middle' });
  await shown.page.mouse.up({ button: 'middle' });
  await shown.drawn();
  assert.deepEqual((await now()).slice(2), before.slice(2));
  assert.deepEqual(shown.faults, []);
});

test('hotspots stay at their places; a place of the picture says where it is', async () => {
  const shown = await site.open(`<point-weave src="/white.glb" alt="A ball" camera-orbit="0deg 90deg 110%" style="${BARE}">
    <button slot="hotspot-front" data-position="0 0 1" data-normal="0 0 1" data-visibility-attribute="visible">Front</button>
    <button slot="hotspot-back" data-position="0m 0m -1m" data-normal="0m 0m -1m" data-visibility-attribute="visible">Back</button>
    <button slot="hotspot-none" data-position="somewhere">None</button></point-weave>`);
  await shown.loaded();
  const places = () => shown.page.evaluate(() => Object.fromEntries([...document.querySelectorAll('button')].map((button) => {
    const { left, top, width, height } = button.getBoundingClientRect();
    const frame = button.parentElement.getBoundingClientRect();
    return [button.textContent, [Math.round(left + width / 2 - frame.left), Math.round(top + height / 2 - frame.top), button.hasAttribute('data-visible'), button.checkVisibility()]];
  })));
  assert.deepEqual(await places(), { Front: [100, 100, true, true], Back: [100, 100, false, true], None: (await places()).None });
  assert.equal((await places()).None[3], false);
  await shown.set({ cameraOrbit: '90deg 90deg 110%' });
  const { Front, Back } = await places();
  assert.ok(Front[0] < 30 && Back[0] > 170, `${Front} ${Back}`);
  await shown.set({ cameraOrbit: '0deg 90deg 110%' });
  const found = await shown.element().evaluate((element) => {
    const { left, top } = element.getBoundingClientRect();
    const at = (x, y) => element.positionAndNormalFromPoint(left + x, top + y);
    return [at(100, 100), at(1, 1)].map((hit) => hit && [hit.position, hit.normal].map(({ x, y, z }) => [x, y, z].map((value) => Math.round(5 * value) / 5 + 0)));
  });
  assert.deepEqual(found, [[[0, 0, 1], [0, 0, 1]], null]);
  assert.match(await shown.element().evaluate((element) => element.toDataURL('image/png')), /^data:image\/png;base64,.{1000}/);
  assert.deepEqual(shown.faults, []);
});

test('the poster stays until it is dismissed; a promise tells of the load; the prompt goes with the first touch', async () => {
  const shown = await site.open('<point-weave src="/white.glb" alt="A ball" poster="/poster.svg" reveal="manual" controls></point-weave>');
  const poster = () => shown.element().evaluate(({ shadowRoot }) => !shadowRoot.querySelector('.poster').classList.contains('gone'));
  const detail = await shown.element().evaluate((element) => element.whenLoaded().then(({ kind, triangles }) => ({ kind, triangles })));
  assert.deepEqual(detail, { kind: 'glb', triangles: 2304 });
  assert.equal(await poster(), true);
  await shown.element().evaluate((element) => element.dismissPoster());
  assert.equal(await poster(), false);
  await shown.element().evaluate((element) => element.showPoster());
  assert.equal(await poster(), true);
  await shown.element().evaluate((element) => element.dismissPoster());
  const prompt = shown.page.locator('point-weave .prompt');
  await prompt.waitFor({ state: 'visible' });
  await shown.element().evaluate((element) => element.focus());
  await shown.page.keyboard.press('ArrowLeft');
  await shown.drawn();
  assert.equal(await prompt.isVisible(), false);
  const failed = await shown.element().evaluate((element) => ((element.src = '/none.glb'), element.whenLoaded().catch(({ code }) => code)));
  assert.equal(failed, 'load-failed');
});

test('a scan without a wish keeps as many points as suit', async () => {
  const shown = await site.open('<point-weave src="/box.xyz" alt="A box" view="reduced"></point-weave>');
  await shown.loaded();
  const { inputPoints, outputPoints } = await shown.element().evaluate(({ report }) => report);
  assert.ok(inputPoints < 2000 && outputPoints === inputPoints, `${outputPoints} of ${inputPoints}: a third would lose its shape`);
});

test('200 pixels: toolbar, full screen and error card fit, and no room is kept for what is not there', async () => {
  const shown = await site.open(`<point-weave id="scan" src="/box.xyz" alt="A box" view="points" controls></point-weave>
    <point-weave id="glb" src="/white.glb" alt="A ball" controls></point-weave>
    <point-weave id="picture" src="/white.glb" alt="A ball"></point-weave>
    <point-weave id="lost" src="/a-very-long-name-of-a-file-that-is-not-there-at-all.glb" alt="Nothing" controls></point-weave>`, { style: 'point-weave { inline-size: 200px; margin: 4px }' });
  await shown.loaded('#scan, #glb, #picture');
  await shown.heard('error');
  await shown.keep('narrow');
  const parts = await shown.page.evaluate(() => [...document.querySelectorAll('point-weave')].map((element) => {
    const frame = element.getBoundingClientRect();
    return [...element.shadowRoot.querySelectorAll('button, label, summary, .error')].filter((part) => part.checkVisibility()).map((part) => {
      const { left, right, top, bottom } = part.getBoundingClientRect();
      return { name: part.className || part.localName, fits: left >= frame.left && right <= frame.right && top >= frame.top && bottom <= frame.bottom };
    });
  }));
  assert.deepEqual(parts.flat().filter(({ fits }) => !fits), []);
  assert.ok(parts[0].some(({ name }) => /fullscreen/.test(name)) && parts[0].filter(({ name }) => name === 'label').length === 3, JSON.stringify(parts[0]));
  assert.deepEqual(parts[3].map(({ name }) => name), ['error', 'summary', 'button retry']);
  // A ball has one view: its tools are above, and nothing is below.
  const below = async (id) => {
    const { height, box } = silhouette(await shown.picture(id));
    return height - box.top - box.height;
  };
  assert.ok((await below('#glb')) <= (await below('#picture')) + 4, `${await below('#glb')} and ${await below('#picture')} rows`);
});
