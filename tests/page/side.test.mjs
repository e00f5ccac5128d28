// Which side is out: the page says what tells it and what is doubtful, and turns the mesh or a piece of it.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { PATIENCE, start } from './browser.mjs';
import { decodePng, difference, silhouette } from './pictures.mjs';
import { spherePoints, toXyz } from './scans.mjs';

/** A large ball and a small one at its right. */
const BALLS = toXyz([...spherePoints(3000), ...spherePoints(900, ([x, y, z]) => [2.2 + 0.5 * x, 0.5 * y, 0.5 * z])]);

/** Opens a scan that lies beside the page, and looks at its mesh from the front. */
async function openScan(t, name, bytes, hash = '') {
  const server = await start(t);
  const site = await server.open({}, undefined, `?src=${server.serve(name, bytes)}${hash}`);
  await site.opened(name);
  await site.page.click('#camera-menu > summary');
  await site.page.click('[data-side="front"]');
  await site.page.keyboard.press('Escape');
  await site.settled();
  return site;
}

const words = ({ page }) => page.innerText('#side-words');

/** How bright a part of a picture is, from one share of its width to another. */
function brightness(png, from, to) {
  const { width, height, channels, data } = decodePng(png);
  let [sum, count] = [0, 0];
  for (let y = Math.floor(0.45 * height); y < 0.55 * height; y++) {
    for (let x = Math.floor(from * width); x < to * width; x++, count++) {
      for (let k = 0; k < 3; k++) sum += data[channels * (y * width + x) + k];
    }
  }
  return sum / count;
}

test('two balls: flipped, flipped back, one of them alone', { timeout: PATIENCE }, async (t) => {
  const site = await openScan(t, 'balls.xyz', BALLS, '#ratio=0.5');
  const { page } = site;
  assert.equal(await words(site), 'What tells the outer side: its shape, which encloses the inside.');
  assert.ok(await page.isHidden('#doubt'));
  assert.equal(await site.number('components'), 2);
  const right = await site.pictureOf('mesh', 'side-right');
  const { box, width, height } = silhouette(right);
  const middle = { large: (box.left + box.width / 3.7) / width, small: (box.left + (3.2 / 3.7) * box.width) / width };
  const near = (picture, ball) => brightness(picture, middle[ball] - 0.01, middle[ball] + 0.01);

  await page.click('#flip');
  await site.settled();
  const wrong = await site.pictureOf('mesh', 'side-flipped');
  for (const ball of ['large', 'small']) assert.ok(near(wrong, ball) < 0.9 * near(right, ball), `the inside of the ${ball} ball is darker`);
  assert.match(await words(site), /^What tells the outer side: .*; all of it was turned by hand\.$/);
  assert.match(page.url(), /[#&]flip=true/);
  assert.ok(await page.isChecked('#option-flip'));

  // What is computed from now on is turned, too.
  await site.remade(() => page.evaluate(() => (location.hash = location.hash.replace('ratio=0.5', 'ratio=0.6'))));
  const made = await site.picture();
  for (const ball of ['large', 'small']) assert.ok(near(made, ball) < 0.9 * near(right, ball));
  await site.remade(() => page.evaluate(() => (location.hash = location.hash.replace('ratio=0.6', 'ratio=0.5'))));
  assert.equal(difference(await site.picture(), wrong), 0);

  await page.click('#flip');
  await site.settled();
  assert.equal(difference(await site.picture(), right), 0, 'twice is not at all');
  assert.equal(await words(site), 'What tells the outer side: its shape, which encloses the inside.');
  assert.doesNotMatch(page.url(), /flip/);

  const canvas = await page.locator('#canvas').boundingBox();
  const click = (ball) => page.mouse.click(canvas.x + middle[ball] * canvas.width, canvas.y + ((box.top + box.height / 2) / height) * canvas.height);
  await click('small');
  assert.equal(difference(await site.picture(), right), 0, 'a click alone does nothing');
  await page.click('#flip-piece');
  assert.equal(await page.getAttribute('#flip-piece', 'aria-pressed'), 'true');
  await click('small');
  await site.settled();
  const piece = await site.pictureOf('mesh', 'side-piece');
  assert.ok(near(piece, 'small') < 0.9 * near(right, 'small'));
  assert.equal(near(piece, 'large'), near(right, 'large'));
  assert.match(await words(site), /; a piece was turned by hand\.$/);
  assert.equal(await page.getAttribute('#flip-piece', 'aria-pressed'), 'false');
  assert.doesNotMatch(page.url(), /flip/);

  // By keyboard: Escape gives up, Enter takes what is in the middle.
  await page.click('#flip-piece');
  await page.keyboard.press('Escape');
  assert.equal(await page.getAttribute('#flip-piece', 'aria-pressed'), 'false');
  await page.click('#flip-piece');
  await page.keyboard.press('Enter');
  await site.settled();
  assert.ok(near(await site.picture(), 'large') < 0.9 * near(right, 'large'));
  assert.deepEqual(site.faults, []);
});

test('what nothing tells is said to be a guess, until the person tells it', { timeout: PATIENCE }, async (t) => {
  const hills = Array.from({ length: 1600 }, (_, i) => {
    const [x, y] = [i % 40, Math.floor(i / 40)].map((k) => k / 10 - 2);
    return [x, y, 0.3 * Math.sin(2 * x) * Math.cos(1.7 * y)];
  });
  const site = await openScan(t, 'hills.xyz', toXyz(hills));
  const { page } = site;
  assert.match(await page.innerText('#doubt'), /^Which side is out is a guess/);
  assert.equal(await words(site), 'What tells the outer side: nothing, so this is a guess.');
  assert.ok(await page.isHidden('#flip-piece'), 'there is one piece');
  await page.click('#more > summary');
  await site.remade(() => page.selectOption('#option-orientation', 'up'));
  assert.ok(await page.isHidden('#doubt'));
  assert.match(await words(site), /sheets look up/);
  assert.match(page.url(), /orientation=up/);
  assert.deepEqual(site.faults, []);
});

test('a room that was scanned from inside', { timeout: PATIENCE }, async (t) => {
  // An organised picture from the middle of a ball: its VIEWPOINT is said.
  const header = 'VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3000\nHEIGHT 1\nVIEWPOINT 0.1 0 0.2 1 0 0 0\nPOINTS 3000\nDATA ascii\n';
  const site = await openScan(t, 'room.pcd', Buffer.concat([Buffer.from(header), toXyz(spherePoints(3000)), Buffer.from('\n')]));
  assert.equal(await words(site), 'What tells the outer side: where it was scanned from.');
  assert.ok(await site.page.isHidden('#doubt'));
  await site.pictureOf('mesh', 'side-room');
  assert.deepEqual(site.faults, []);
});
