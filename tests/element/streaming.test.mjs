// Tilesets that stream: on a canvas, and in the element.

import assert from 'node:assert/strict';
import { decodePng, difference, meanColor, silhouette as silhouetteWithin } from '../page/pictures.mjs';
import { ball, glb } from './files.mjs';
import { validateTileset } from '../pkg/validate-tileset.mjs';
import { startSite, test } from './site.mjs';
import { height, putTileset, tileset } from './tilesets.mjs';

const silhouette = (png) => silhouetteWithin(png, 0);
const site = await startSite();
/** As of a map: in meters, with thousandths. */
const ORIGIN = [400_000.125, 5_700_000.5, 100.375];
const SIZE = 100;
const SIDE = 32;
/** Places are whole numbers of 2 mm. */
const STEP = 2 ** -9;
const hills = await tileset({ origin: ORIGIN, size: SIZE, side: SIDE, step: STEP });
const points = putTileset(site, '/points', hills);
const field = await tileset({ kind: 'mesh', origin: ORIGIN, meshopt: true });
const mesh = putTileset(site, '/mesh', field);
site.put('/ball.glb', await glb([{ ...ball(16), color: [200, 10, 10] }]));

/** In the page, before all else: counts draw calls, and keeps the most of one picture of the viewer that is watched. */
function countCalls() {
  window.calls = 0;
  window.most = { calls: 0, bytes: 0, tiles: 0 };
  for (const name of ['drawArrays', 'drawElements']) {
    const original = WebGL2RenderingContext.prototype[name];
    WebGL2RenderingContext.prototype[name] = function (...rest) {
      window.calls++;
      return original.apply(this, rest);
    };
  }
  window.watchMost = (viewer) => {
    viewer.addEventListener('draw', () => {
      const { bytes, tiles } = viewer.streamed ?? { bytes: 0, tiles: 0 };
      window.most = { calls: Math.max(most.calls, window.calls), bytes: Math.max(most.bytes, bytes), tiles: Math.max(most.tiles, tiles) };
      window.calls = 0;
    });
  };
}

/** Opens a page with a viewer on a canvas. */
async function open({ imports, style = '', ...more } = {}) {
  const shown = await site.open('<canvas style="width: 480px; height: 360px; display: block" aria-label="Hills"></canvas>', {
    define: false, prepare: (page) => page.addInitScript(countCalls), style, ...(imports && { imports }), ...more,
  });
  await shown.page.evaluate(async () => {
    const { createViewer } = await import('pointweave/viewer');
    window.viewer = createViewer(document.querySelector('canvas'));
    watchMost(viewer);
  });
  const act = (job, argument) => shown.page.evaluate(job, argument);
  /** Until nothing more comes. */
  const settled = async () => {
    await act(() => (window.quiet = 0));
    await shown.page.waitForFunction(() => {
      const { loading, tiles } = viewer.streamed ?? {};
      window.quiet = loading === 0 && tiles > 0 ? (window.quiet ?? 0) + 1 : 0;
      return window.quiet > 20;
    }, undefined, { timeout: 60_000 });
    return act(() => viewer.streamed);
  };
  return { drawn: () => shown.drawn(), page: shown.page, act, settled, faults: shown.faults, asked: shown.asked, picture: () => shown.page.locator('canvas').screenshot() };
}

const streamed = (act, url, options) => act(([url, options]) => viewer.stream(url, options).then(() => null, ({ name, code, message, expected }) => ({ name, code, message, expected })), [url, options]);

test('points: whole at first, finer where one comes near, exact where one points', async (t) => {
  const { act, settled, picture, faults, asked, drawn } = await open();
  const first = await act(async (url) => {
    const start = performance.now();
    await viewer.stream(url);
    viewer.draw();
    return performance.now() - start;
  }, points);
  t.diagnostic(`first picture after ${Math.round(first)} ms`);
  assert.deepEqual(await act(() => [viewer.layers, viewer.view, viewer.upright]), [['points'], 'points', 'z']);
  const whole = await settled();
  assert.equal(whole.total, (4 * SIDE) ** 2);
  assert.ok(whole.points >= SIDE ** 2 && whole.failed === 0 && whole.error === 2, JSON.stringify(whole));
  const { box, width, height: tall } = silhouette(await picture());
  assert.ok(box.width > 0.8 * width && box.left > 0 && box.left + box.width < width && box.height < tall, JSON.stringify(box));
  assert.ok(box.width > 2 * box.height, 'it lies');
  const { x, y, z } = await act(() => Object.fromEntries(['x', 'y', 'z'].map((axis, i) => [axis, viewer.dimensions[i]])));
  assert.deepEqual([x, y, Math.round(1e6 * z) / 1e6], [SIZE, SIZE, 0.2 * SIZE]);

  // Near a corner, whole and exact.
  const corner = [0.9, 0.9].map((share, i) => ORIGIN[i] + share * SIZE);
  await act(([x, y, z]) => {
    viewer.limits = {};
    viewer.firstLook = { target: [x, y, z], distance: 12, polar: 50 };
  }, [...corner, ORIGIN[2]]);
  const near = await settled();
  assert.ok(near.points < (4 * SIDE) ** 2 / 2, `what is out of sight is not drawn: ${near.points}`);
  assert.ok(asked.some((path) => path.startsWith('/points/points/2-3-3')), 'the finest tiles came');
  await drawn();
  const found = await act(() => viewer.pickPoint(240, 180, 60));
  const local = found.position.map((value, axis) => value - ORIGIN[axis]);
  const step = SIZE / SIDE / 4;
  const place = [0, 1].map((axis) => (Math.round(local[axis] / step - 0.5) + 0.5) * step);
  const expected = [...place, SIZE * height(place[0] / SIZE, place[1] / SIZE)].map((value) => STEP * Math.round(value / STEP));
  for (let axis = 0; axis < 3; axis++) assert.ok(Math.abs(local[axis] - expected[axis]) < 2e-8, `${local} is not ${expected}`);
  const back = await act((position) => viewer.project(position), found.position);
  assert.ok(Math.hypot(back.x - 240, back.y - 180) < 60 && back.visible, JSON.stringify(back));
  const most = await act(() => most);
  t.diagnostic(JSON.stringify(most));
  assert.ok(most.calls <= 200 && most.bytes <= whole.budget, JSON.stringify(most));
  assert.deepEqual(faults, []);
});

test('the tilesets of these tests are valid, and what is not is told', async () => {
  const facts = await validateTileset(hills);
  assert.deepEqual([facts.tiles, facts.depth, facts.leafPoints, facts.triangles], [21, 2, (4 * SIDE) ** 2, 0]);
  assert.ok([0, 1].every((axis) => facts.box[0][axis] > ORIGIN[axis] && facts.box[1][axis] < ORIGIN[axis] + SIZE));
  assert.equal((await validateTileset(field)).leafTriangles, 2 * (4 * SIDE) ** 2);
  const broken = new Map(hills);
  const json = JSON.parse(String(hills.get('tileset.json')));
  json.root.children[0].geometricError = 100;
  json.root.children[1].boundingVolume.box[0] += 30;
  broken.set('tileset.json', Buffer.from(JSON.stringify(json))).delete('points/2-0-0-0.glb');
  await assert.rejects(validateTileset(broken), ({ message, actual }) => {
    for (const words of [/root\/0: its error is larger/, /root\/1: its box is not inside/, /outside of the tile's box/, /2-0-0-0.glb is not there/]) assert.match(actual.join(), words);
    return /things are wrong/.test(message);
  });
});

test('a mesh: colours, picked exactly', async () => {
  const { act, settled, picture, faults, drawn } = await open();
  assert.equal(await streamed(act, mesh, { errorTarget: 20 }), null);
  const { triangles } = await settled();
  assert.ok(triangles > 0);
  assert.deepEqual(await act(() => [viewer.layers, viewer.view]), [['mesh'], 'mesh']);
  const looks = await picture();
  const [red, green] = meanColor(looks, silhouette(looks));
  assert.ok(red > 60 && green > 60, `${red}, ${green}`);
  await act(([x, y, z]) => (viewer.firstLook = { target: [x, y, z], distance: 60, polar: 30 }), [ORIGIN[0] + 50, ORIGIN[1] + 50, ORIGIN[2]]);
  await settled();
  await drawn();
  const { position: [x, y, z], normal } = await act(() => viewer.pick(240, 180));
  const truth = ORIGIN[2] + SIZE * height((x - ORIGIN[0]) / SIZE, (y - ORIGIN[1]) / SIZE);
  assert.ok(Math.abs(z - truth) < 0.5, `${z} and ${truth}`);
  assert.ok(normal[2] > 0.7, normal.join());
  assert.deepEqual(faults, []);
});

test('between levels of a mesh no crack shows the page', async () => {
  const { act, settled, picture, drawn } = await open({ style: 'canvas { width: 800px !important; height: 600px !important }' });
  const steps = putTileset(site, '/steps', await tileset({ kind: 'mesh', levels: 5, side: 12 }));
  await act(() => (viewer.firstLook = { target: [30, 30, 0], distance: 45, polar: 62, azimuth: 30 }));
  await streamed(act, steps, { errorTarget: 30 });
  const { tiles } = await settled();
  assert.ok(tiles > 40 && tiles < 200);
  await drawn();
  const { data, channels, width, height: tall } = decodePng(await picture());
  // Nothing of the hills is so light: red and green of the page, or a part of that.
  const isBare = (u, v) => Math.min(...data.subarray(channels * (v * width + u), channels * (v * width + u) + 2)) > 190;
  let cracks = 0;
  for (let v = 4; v < tall - 4; v++) for (let u = 0; u < width; u++) cracks += isBare(u, v) && !isBare(u, v - 4) && !isBare(u, v + 4) ? 1 : 0;
  assert.equal(cracks, 0);
});

test('it never holds more than its budget, and comes to rest', async (t) => {
  const { act, settled, asked } = await open();
  const full = putTileset(site, '/full', await tileset({ levels: 4, side: 48, own: false }));
  assert.equal((await streamed(act, full, { budget: 1000 })).code, 'bad-input');
  assert.equal(await streamed(act, full, { budget: 2 ** 20, errorTarget: 0.1 }), null);
  const state = await settled();
  const { bytes } = await act(() => most);
  t.diagnostic(JSON.stringify({ ...state, most: bytes }));
  assert.ok(bytes <= 2 ** 20 && bytes > 2 ** 19, `${bytes} bytes`);
  assert.ok(state.error > 0.1, 'coarser than was asked for');
  const before = asked.length;
  await new Promise((next) => setTimeout(next, 700));
  assert.equal(asked.length, before, 'nothing is fetched again and again');
  await act(() => (viewer.turn(1, 0.2), viewer.zoom(0.3)));
  await settled();
  assert.ok((await act(() => most)).bytes <= 2 ** 20);
});

test('at most 200 draw calls, however many tiles there are', async (t) => {
  const { act, settled } = await open();
  const many = putTileset(site, '/many', await tileset({ kind: 'mesh', levels: 5, side: 3 }));
  assert.equal(await streamed(act, many, { errorTarget: 0.01 }), null);
  const state = await settled();
  const { calls } = await act(() => most);
  t.diagnostic(JSON.stringify({ ...state, calls }));
  assert.ok(calls <= 200 && state.tiles > 20, `${calls} calls for ${state.tiles} tiles`);
  await act(() => viewer.zoom(0.3));
  await settled();
  assert.ok((await act(() => most)).calls <= 200);
});

test('levels fade into each other, unless a person wants less motion', async () => {
  for (const [reducedMotion, fades] of [['no-preference', true], ['reduce', false]]) {
    const { act, settled } = await open({ reducedMotion });
    await streamed(act, points, { errorTarget: 30 });
    await settled();
    await act(() => {
      window.both = 0;
      viewer.addEventListener('draw', () => (both = Math.max(both, viewer.streamed.tiles)));
      viewer.zoom(0.3);
    });
    const { tiles: last } = await settled();
    const seen = { most: await act(() => both), last };
    assert.equal(seen.most > seen.last, fades, `${reducedMotion}: ${JSON.stringify(seen)}`);
  }
});

test('what is no tileset, does not come, or needs what is not there says so', async () => {
  const { act } = await open();
  site.put('/no.json', Buffer.from('<html>'));
  site.put('/other.json', Buffer.from('{"asset":{"version":"2.0"},"scenes":[]}'));
  site.put('/rootless.json', Buffer.from('{"asset":{"version":"1.1"}}'));
  site.put('/implicit.json', Buffer.from('{"asset":{"version":"1.1"},"root":{"boundingVolume":{"sphere":[0,0,0,1]},"implicitTiling":{}}}'));
  site.put('/empty.json', Buffer.from('{"asset":{"version":"1.1"},"root":{"boundingVolume":{"sphere":[0,0,0,1]},"geometricError":1,"content":{"uri":"none.glb"}}}'));
  site.put('/placeless.json', Buffer.from('{"asset":{"version":"1.1"},"root":{"boundingVolume":{"box":["a"]}}}'));
  putTileset(site, '/broad', new Map([['large.glb', await glb([{ positions: new Float32Array(300_000) }])]]));
  site.put('/broad.json', Buffer.from('{"asset":{"version":"1.1"},"root":{"boundingVolume":{"sphere":[0,0,0,1]},"geometricError":1,"content":{"uri":"broad/large.glb"}}}'));
  for (const [url, code, words] of [
    ['/nowhere.json', 'load-failed', /404/], ['/no.json', 'bad-file', /no tileset.*JSON/], ['/other.json', 'unsupported-file', /version is 2.0/],
    ['/rootless.json', 'bad-file', /has no root/], ['/placeless.json', 'bad-file', /boundingVolume/], ['/broad.json', 'load-failed', /budget/], ['/implicit.json', 'unsupported-file', /implicit/], ['/empty.json', 'load-failed', /no tile did load/],
  ]) {
    const error = await streamed(act, url, { budget: 2 ** 20 });
    assert.equal(error?.code, code, url);
    assert.match(error.message, words);
  }
  assert.equal(await act(() => viewer.streamed), null);
  const bare = await open({ imports: { 'pointweave/viewer': '/pointweave/viewer.js', three: '/node_modules/three/build/three.module.js', 'three/addons/': '/node_modules/three/examples/jsm/' } });
  const missing = await streamed(bare.act, points);
  assert.deepEqual([missing.code, missing.expected], ['missing-package', ['3d-tiles-renderer']]);
  assert.match(missing.message, /npm install 3d-tiles-renderer/);
});

test('a tile that does not come leaves no hole', async () => {
  const { act, settled, picture, faults } = await open();
  const torn = new Map(hills);
  torn.delete('points/1-1-1-0.glb');
  const url = putTileset(site, '/torn', torn);
  await streamed(act, url, { errorTarget: 3 });
  const { failed } = await settled();
  assert.equal(failed, 1);
  const holed = await picture();
  await streamed(act, points, { errorTarget: 3 });
  await settled();
  const whole = await picture();
  const [left, right] = [holed, whole].map((png) => silhouette(png).closed(8).area);
  assert.ok(left > 0.95 * right, `${left} of ${right} pixels`);
  assert.ok(faults.every((fault) => /TilesRenderer|Failed to load model/.test(fault)), faults.join());
});

test('another thing to show ends it; it frees what it holds; a lost context comes back', async () => {
  const { act, settled, picture, drawn } = await open();
  await act(() => viewer.show({ positions: Float32Array.of(0, 0, 0, 1, 1, 1) }));
  await drawn();
  const before = await act(() => ({ ...held }));
  const [aborted] = await act((url) => Promise.allSettled([viewer.stream(url), viewer.stream(url)]), points);
  assert.equal(aborted.status, 'rejected');
  const signalled = await act(async (url) => {
    const controller = new AbortController();
    const going = viewer.stream(url, { signal: controller.signal });
    controller.abort(new Error('enough'));
    return going.then(() => 'no', (error) => [error.message, viewer.streamed, viewer.layers.length]);
  }, points);
  assert.deepEqual(signalled, ['enough', null, 0]);
  await streamed(act, points, { errorTarget: 1 });
  await settled();
  await drawn();
  const looks = await picture();
  const taken = await act(() => held.Buffer);
  assert.ok(taken > before.Buffer + 5);
  await act(async () => {
    const [context] = contexts.filter((one) => one.canvas.getContext);
    const lose = context.getExtension('WEBGL_lose_context');
    lose.loseContext();
    await new Promise((next) => setTimeout(next, 100));
    lose.restoreContext();
    await new Promise((next) => viewer.addEventListener('contextrestored', next, { once: true }));
  });
  await settled();
  await drawn();
  assert.ok(difference(looks, await picture()) < 0.001);
  await act(() => viewer.suspend());
  await act(() => viewer.resume());
  await settled();
  await drawn();
  assert.ok(difference(looks, await picture()) < 0.001, 'after it was suspended');
  const full = await act(() => ({ ...held }));
  await act(() => viewer.show({ positions: Float32Array.of(0, 0, 0, 1, 1, 1) }));
  await drawn();
  const freed = await act(() => ({ ...held }));
  assert.ok(freed.Buffer <= full.Buffer - 5, `${JSON.stringify(full)} ${JSON.stringify(freed)}`);
  assert.equal(await act(() => viewer.streamed), null);
});

test('the element: one tag, with camera, hotspots and what is told', async () => {
  const [x, y, z] = ORIGIN;
  const tag = `<point-weave src="${points}" alt="Hills" controls camera-orbit="0deg 40deg auto" interaction-prompt="none">
    <button slot="hotspot-top" data-position="${x + 50}m ${y + 50}m ${z}m">Middle</button></point-weave>`;
  const shown = await site.open(tag, { style: 'point-weave { width: 480px; height: 360px }' });
  await shown.page.evaluate(() => {
    window.told = [];
    document.querySelector('point-weave').addEventListener('stream', ({ detail }) => told.push(detail));
  });
  const events = await shown.heard('load');
  const { kind, view, points: some, triangles } = events.at(-1);
  assert.deepEqual([kind, view, triangles], ['tiles', 'points', 0]);
  assert.ok(some >= SIDE ** 2);
  assert.equal(events.filter(({ type }) => type === 'progress').at(-1).overall, 1);
  await shown.page.waitForFunction(() => told.at(-1)?.loading === 0 && told.at(-1).tiles > 1);
  const said = await shown.element().evaluate((element) => {
    const { x, y } = element.getDimensions();
    const { theta, phi } = element.getCameraOrbit();
    const { left, top, width, height } = element.querySelector('button').getBoundingClientRect();
    const frame = element.getBoundingClientRect();
    return { x, y, theta, polar: (phi * 180) / Math.PI, spot: [left + width / 2 - frame.left, top + height / 2 - frame.top], report: element.report };
  });
  assert.deepEqual([said.x, said.y, said.theta, Math.round(said.polar), said.report], [SIZE, SIZE, 0, 40, null]);
  assert.ok(Math.abs(said.spot[0] - 240) < 2, said.spot.join());
  assert.match(await shown.spoken(), /^Hills\. [\d,]+ points$/);
  assert.equal(await shown.element().locator('fieldset').isVisible(), false, 'there is nothing to choose');
  await shown.set({ src: '/ball.glb' });
  await shown.loaded();
  assert.equal(await shown.element().evaluate((element) => element.getDimensions().x.toFixed(3)), '2.000');
  await shown.set({ src: mesh });
  await shown.loaded();
  assert.equal((await shown.events()).at(-1).view, 'mesh');
  await shown.set({ src: '/no.json' });
  const error = (await shown.heard('error')).at(-1);
  assert.equal(error.code, 'bad-file');
  assert.deepEqual(shown.faults, []);
});

test('the element in one file loads what streams when a tileset comes', async () => {
  const shown = await site.open('<script type="module" src="/pointweave/element.min.js"></script><point-weave src="/ball.glb" alt="A ball"></point-weave>', {
    define: false, imports: {}, style: 'point-weave { width: 480px; height: 360px }',
  });
  await shown.page.waitForFunction(() => document.querySelector('point-weave').loaded);
  assert.ok(!shown.asked.some((path) => /tiles/.test(path)));
  await shown.set({ src: points });
  await shown.loaded();
  assert.equal(shown.asked.filter((path) => /element-tiles\.min\.js/.test(path)).length, 1);
  assert.ok(!shown.asked.some((path) => /node_modules/.test(path)));
  assert.ok(silhouette(await shown.picture()).area > 5000);
  assert.deepEqual(shown.faults, []);
});
