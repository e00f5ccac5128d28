// What is drawn: views, the divider, colours that can be read, sides, and at what cost.

import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';
import { colorAt } from '../../pkg/viewer/colormap.js';
import { PATIENCE, start } from './browser.mjs';
import { colorsOf, difference, meanColor, silhouette } from './pictures.mjs';
import { spherePoints, toXyz } from './scans.mjs';

/** Counts what the page asks the GPU to do, from the start. */
const countGpu = (page) => page.addInitScript(() => {
  const counts = (globalThis.gpu = { draws: 0, uploads: 0, frames: 0 });
  const watch = (prefix, counter) => {
    const prototype = WebGL2RenderingContext.prototype;
    for (const name of Object.getOwnPropertyNames(prototype).filter((name) => prefix.test(name))) {
      const original = prototype[name];
      prototype[name] = function (...args) {
        counts[counter]++;
        return original.apply(this, args);
      };
    }
  };
  watch(/^draw(Arrays|Elements|RangeElements)/, 'draws');
  watch(/^(buffer(Sub)?Data|texImage|texSubImage|texStorage)/, 'uploads');
});

/** Opens a scan that lies beside the page, instead of the duck. */
async function openScan(t, name, bytes, hash = '', prepare = undefined) {
  const server = await start(t);
  const site = await server.open({}, prepare, `?src=${server.serve(name, bytes)}${hash}`);
  await site.opened(name);
  return site;
}

/** How far from the start of the colour map, 0 to 1, a colour lies; light and shade do not matter. */
function placeInMap([r, g, b]) {
  const size = Math.hypot(r, g, b);
  const likeness = (i) => {
    const color = colorAt(i / 100);
    return (color[0] * r + color[1] * g + color[2] * b) / (size * Math.hypot(...color));
  };
  return Array.from({ length: 101 }, (_, i) => i).reduce((best, i) => (likeness(i) > likeness(best) ? i : best), 0) / 100;
}

test('views and colours of a sphere whose left half is rough', { timeout: PATIENCE }, async (t) => {
  const NOISE = 0.02;
  // The same at every run: the fraction of a growing multiple.
  const rough = (i) => NOISE * 2 * (((i * 0.754877666) % 1) - 0.5);
  const points = spherePoints(12_000, (p, i) => p.map((value) => value * (p[0] < 0 ? 1 + rough(i) : 1)));
  const site = await openScan(t, 'half rough.xyz', toXyz(points), '#count=1500&smoothing=1', countGpu);
  const { page } = site;
  await page.click('#camera-menu > summary');
  await page.click('[data-side="front"]');
  await page.keyboard.press('Escape');

  await t.test('the divider shows both, from one camera', async () => {
    const [scan, mesh] = [await site.pictureOf('points'), await site.pictureOf('mesh')];
    await page.keyboard.press('4');
    const compare = async () => {
      await site.settled();
      return site.picture();
    };
    let both = await compare();
    assert.ok(difference(both, scan, 0, 0.49) < 0.001 && difference(both, mesh, 0.51, 1) < 0.001);
    assert.ok(difference(both, scan, 0.51, 1) > 0.05, 'the sides differ');

    const handle = await page.locator('#split-handle').boundingBox();
    const stage = await page.locator('#stage').boundingBox();
    await page.mouse.move(handle.x + handle.width / 2, handle.y + handle.height / 2);
    await page.mouse.down();
    await page.mouse.move(stage.x + 0.3 * stage.width, handle.y, { steps: 3 });
    await page.mouse.up();
    assert.equal(await page.getAttribute('#split-handle', 'aria-valuenow'), '30');
    both = await compare();
    assert.ok(difference(both, mesh, 0.31, 1) < 0.001, 'dragged to the left');

    await page.focus('#split-handle');
    for (let k = 0; k < 20; k++) await page.keyboard.press('ArrowRight');
    assert.equal(await page.getAttribute('#split-handle', 'aria-valuenow'), '70');
    both = await compare();
    assert.ok(difference(both, scan, 0, 0.69) < 0.001, 'moved to the right with the keys');

    await page.selectOption('#split-right', 'reduced');
    await page.keyboard.press('Escape');
    const reduced = await site.pictureOf('reduced');
    await page.locator('input[name="view"][value="compare"]').check({ force: true });
    assert.ok(difference(await compare(), reduced, 0.71, 1) < 0.001, 'reduced points at the right');
  });

  await t.test('the map of the error is dark where the scan is true and light where it is rough', async () => {
    await site.paint('error');
    const values = await page.$$eval('#legend .legend-ends data', (ends) => ends.map((end) => Number(end.value)));
    const texts = await page.$$eval('#legend .legend-ends data', (ends) => ends.map((end) => end.textContent));
    assert.equal(values.length, 3);
    assert.ok(texts.every((text) => / %$/.test(text)), `in per cent too: ${texts}`);
    const diagonal = 2 * Math.sqrt(3);
    for (const view of ['points', 'reduced', 'mesh']) {
      const color = colorsOf(await site.pictureOf(view, 'half-rough-error'));
      const mean = (left, right) => {
        const places = [];
        for (let x = left; x < right; x += 0.004) {
          for (let y = 0.35; y < 0.65; y += 0.006) {
            const [r, g, b] = color(x, y);
            if (Math.max(r, g, b) - Math.min(r, g, b) > 40) places.push(placeInMap([r, g, b]));
          }
        }
        return (places.reduce((sum, place) => sum + place, 0) / places.length) * values[2] * diagonal;
      };
      const [left, right] = [mean(0.36, 0.48), mean(0.53, 0.65)];
      t.diagnostic(`${view}: read from the colours ${left.toFixed(4)} and ${right.toFixed(4)}, made ${NOISE / 2} and 0`);
      assert.ok(left > 0.6 * (NOISE / 2) && left < 1.6 * (NOISE / 2), `${view}: ${left} at the rough side`);
      assert.ok(right < 0.45 * left, `${view}: ${right} at the true side`);
    }
  });

  await t.test('directions: right is red, up is green, to the front is blue', async () => {
    await site.paint('normals');
    for (const view of ['points', 'mesh']) {
      const picture = await site.pictureOf(view);
      const { box, width, height } = silhouette(picture);
      const color = colorsOf(picture);
      const at = (x, y) => color((box.left + x * box.width) / width, (box.top + y * box.height) / height);
      const [center, right, top] = [at(0.5, 0.5), at(0.9, 0.5), at(0.5, 0.1)];
      assert.ok(center[2] > 1.4 * center[0] && center[2] > 1.4 * center[1], `${view}, centre: ${center}`);
      assert.ok(right[0] > 1.3 * right[1] && right[0] > center[0], `${view}, right: ${right}`);
      assert.ok(top[1] > 1.3 * top[0] && top[1] > center[1], `${view}, top: ${top}`);
    }
  });

  await t.test('one draw call a layer, and nothing is sent to the GPU while the camera turns', async () => {
    await site.paint('natural');
    const debug = await page.context().newCDPSession(page);
    const turn = async () => {
      await page.focus('#canvas');
      await debug.send('HeapProfiler.startSampling', { samplingInterval: 256 });
      const counted = await page.evaluate(async () => {
        const before = { ...globalThis.gpu };
        for (let k = 0; k < 6; k++) {
          const canvas = document.querySelector('canvas');
          canvas.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight', bubbles: true }));
          await new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)));
        }
        return { draws: (globalThis.gpu.draws - before.draws) / 6, uploads: globalThis.gpu.uploads - before.uploads };
      });
      const { profile } = await debug.send('HeapProfiler.stopSampling');
      const bytes = (node) => node.selfSize + node.children.reduce((sum, child) => sum + bytes(child), 0);
      const inPage = (node) => (node.callFrame.url.includes('/assets/') ? bytes(node) : node.children.reduce((sum, child) => sum + inPage(child), 0));
      const kilobytes = inPage(profile.head) / 6 / 1000;
      t.diagnostic(`${kilobytes.toFixed(1)} kB of objects a picture`);
      assert.ok(kilobytes < 4, 'no array is made anew for a picture');
      return counted;
    };
    // Clouds take a second pass over the screen, for the depth.
    for (const [view, draws] of [['points', 2], ['reduced', 2], ['mesh', 1], ['compare', 4]]) {
      await site.show(view);
      assert.deepEqual(await turn(), { draws, uploads: 0 }, view);
    }
    await site.show('mesh');
    const plain = await site.picture();
    await page.keyboard.press('e');
    await site.settled();
    assert.ok(difference(plain, await site.picture()) > 0.02, 'the edges are seen');
    assert.deepEqual(await turn(), { draws: 2, uploads: 0 }, 'mesh with its edges');
    await page.keyboard.press('e');

    await page.keyboard.press('b');
    await site.settled();
    assert.ok(difference(plain, await site.picture()) > 0.01, 'the boxes of the octree are seen');
    assert.deepEqual(await turn(), { draws: 2, uploads: 0 }, 'mesh with boxes');
    await page.keyboard.press('b');
  });

  assert.deepEqual(site.faults, []);
});

test('a mesh larger than its scan is seen whole, until somebody has looked around', { timeout: PATIENCE }, async (t) => {
  // Points all over a cube: the mesh goes beyond them.
  const corners = Array.from({ length: 80 }, (_, i) => [((i * 37) % 61) / 61, ((i * 53) % 67) / 67, ((i * 71) % 73) / 73]);
  const obj = `${corners.map((p) => `v ${p.join(' ')}`).join('\n')}\n`;
  const site = await openScan(t, 'corners.obj', Buffer.from(obj));
  const { page } = site;
  assert.equal(await page.innerText('#caption-detail'), '80 points');
  assert.match(await page.innerText('#doubt'), /not close to the points/);
  const inside = (picture) => {
    const { box, width, height } = silhouette(picture);
    return box.left > 0 && box.top > 0 && box.left + box.width < width && box.top + box.height < height;
  };
  assert.ok(inside(await site.pictureOf('mesh')), 'nothing is cut off');
  await page.focus('#canvas');
  for (let k = 0; k < 4; k++) await page.keyboard.press('+');
  const near = await site.picture();
  await site.remade(async () => {
    await page.click('#more > summary');
    await page.check('#option-flip');
  });
  assert.ok(silhouette(await site.picture()).area > 0.9 * silhouette(near).area, 'the person has chosen the distance');
  assert.deepEqual(site.faults, []);
});

test('the size of the points, the picture as a file, and a poster that the snippet names', { timeout: PATIENCE }, async (t) => {
  const site = await openScan(t, 'ball.xyz', toXyz(spherePoints(700)));
  const { page } = site;
  const area = async () => silhouette(await site.pictureOf('points')).area;
  const size = async (value) => {
    await page.click('#paint-menu > summary');
    await page.fill('#point-size', String(value));
    await page.keyboard.press('Escape');
    await site.settled();
  };
  const usual = await area();
  await size(-1);
  const small = await area();
  await size(0);
  assert.equal(await area(), usual);
  assert.ok(small < 0.7 * usual, `${small} of ${usual}`);

  const saved = async (button) => {
    const [download] = await Promise.all([page.waitForEvent('download'), page.click(button)]);
    return [download.suggestedFilename(), await readFile(await download.path())];
  };
  await site.show('mesh');
  const [name, bytes] = await saved('#picture');
  assert.equal(name, 'ball.png');
  const wide = await page.$eval('#canvas', (canvas) => [canvas.width, canvas.height]);
  assert.deepEqual([bytes.readUInt32BE(16), bytes.readUInt32BE(20)], wide);
  await page.click('#share > summary');
  assert.doesNotMatch(await page.inputValue('#share-embed'), /poster/);
  const [poster, picture] = await saved('#poster');
  assert.equal(poster, 'ball-poster.webp');
  assert.equal(picture.toString('latin1', 8, 12), 'WEBP');
  assert.match(await page.inputValue('#share-embed'), / poster="ball-poster\.webp"/);
  assert.deepEqual(site.faults, []);
});

test('sides, parallel lines, density and sharp places of the part', { timeout: PATIENCE }, async (t) => {
  const site = await (await start(t)).open({}, undefined, '#sample=part&count=9000');
  await site.made();
  const { page } = site;
  const [wide, high, deep] = (await page.innerText('#caption-size')).split(' × ').map(Number);

  // In parallel projection the outline of a side is exactly as wide and high as the part.
  for (const [side, width, height] of [['front', wide, high], ['right', deep, high], ['top', wide, deep]]) {
    await page.click('#camera-menu > summary');
    await page.click(`[data-side="${side}"]`);
    await page.keyboard.press('Escape');
    await site.settled();
    const { box } = silhouette(await site.pictureOf('mesh', `part-${side}`));
    assert.ok(Math.abs(box.width / box.height / (width / height) - 1) < 0.03, `${side}: ${box.width} × ${box.height}`);
  }
  await page.keyboard.press('r');
  const parallel = silhouette(await site.picture()).box;
  await page.keyboard.press('p');
  assert.equal(await page.isChecked('#parallel'), false);
  await site.settled();
  const perspective = silhouette(await site.picture()).box;
  assert.ok(perspective.height / perspective.width > 1.03 * (parallel.height / parallel.width), 'in perspective the near end is larger');

  await page.keyboard.press('f');
  await site.paint('sharp');
  for (const view of ['reduced', 'mesh']) {
    const picture = await site.pictureOf(view, 'part-sharp');
    const [red, , blue] = meanColor(picture, silhouette(picture));
    const orange = await page.$eval('#legend i', (swatch) => getComputedStyle(swatch).backgroundColor);
    assert.equal(orange, 'rgb(222, 94, 12)');
    assert.match(await page.innerText('#legend'), /\d %/);
    await site.paint('natural');
    const natural = await site.pictureOf(view);
    const [before, , beforeBlue] = meanColor(natural, silhouette(natural));
    assert.ok(red - blue > before - beforeBlue, `${view}: edges are orange`);
    await site.paint('sharp');
  }

  // Kept points are denser at the edges than on the plate, and the legend says how dense in file units.
  await site.paint('density');
  const spacings = [];
  for (const view of ['points', 'reduced']) {
    await site.show(view);
    spacings.push(await page.$$eval('#legend .legend-ends data', (ends) => ends.map((end) => Number(end.value))));
  }
  const [scan, reduced] = spacings;
  assert.ok(reduced[1] > 1.8 * scan[1], `9,000 of 60,000 points are further apart: ${scan} and ${reduced}`);
  assert.ok(reduced[2] > 2 * reduced[0]);

  // C goes through what there is, and comes back.
  const shown = () => page.$eval('input[name="paint"]:checked', (input) => input.value);
  const first = await shown();
  const seen = new Set();
  do {
    await page.keyboard.press('c');
    seen.add(await shown());
  } while (await shown() !== first);
  assert.deepEqual([...seen].sort(), ['density', 'error', 'natural', 'normals', 'plain', 'sharp']);
  assert.deepEqual(site.faults, []);
});
