// A viewer on a canvas of a page's own: layers, looks, keys, sizes, and what it holds.

import assert from 'node:assert/strict';
import { decodePng, difference, meanColor, silhouette as silhouetteWithin } from '../page/pictures.mjs';
import { ball, glb } from './files.mjs';
import { startSite, test } from './site.mjs';

const silhouette = (png) => silhouetteWithin(png, 0);
const site = await startSite();
site.put('/ball.glb', await glb([{ ...ball(16), color: [200, 10, 10] }]));

/** In the page: a box of triangles, 2 wide, 1 high and 0.5 deep; its cloud of corners and edges; a viewer on the first canvas. */
const setUp = (page, options) => page.evaluate(async (given) => {
  const { createViewer } = await import('pointweave/viewer');
  const corners = Array.from({ length: 8 }, (_, i) => [2 * (i & 1), (i >> 1) & 1, 0.5 * (i >> 2)]);
  const faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
  const flat = faces.map((face) => face.map((i) => corners[i]));
  window.box = {
    positions: Float32Array.from(flat.flat(2)),
    indices: Uint32Array.from(faces.flatMap((_, f) => [0, 1, 2, 0, 2, 3].map((i) => 4 * f + i))),
  };
  const points = [];
  for (let i = 0; i <= 40; i++) for (let j = 0; j <= 40; j++) for (const z of [0, 0.5]) points.push(i / 20, j / 40, z);
  window.cloud = { positions: Float32Array.from(points) };
  window.viewer = createViewer(document.querySelector('canvas'), given);
}, options);

/** Opens a page with a canvas and a viewer on it. */
async function open(tag = '<canvas style="width: 400px; height: 300px; display: block" aria-label="A box"></canvas>', options = {}, more = {}) {
  const shown = await site.open(tag, { define: false, ...more });
  await setUp(shown.page, options);
  const act = async (job, argument) => {
    const answer = await shown.page.evaluate(job, argument);
    await shown.drawn();
    return answer;
  };
  return { ...shown, page: shown.page, act, faults: shown.faults, picture: () => shown.page.locator('canvas').first().screenshot({ animations: 'disabled' }) };
}

test('clouds and meshes are shown whole, one layer or two that meet', async () => {
  const { act, picture, faults } = await open();
  await act(() => viewer.show(box));
  const mesh = await picture();
  const { box, width, height } = silhouette(mesh);
  assert.ok(box.width > 0.8 * width && box.left > 0 && box.left + box.width < width && box.top > 0 && box.top + box.height < height);
  assert.deepEqual(await act(() => [viewer.view, viewer.layers, viewer.size('mesh')]), ['mesh', ['mesh'], { points: 24, triangles: 12 }]);

  await act(() => viewer.set('points', cloud));
  assert.equal(difference(mesh, await picture()), 0, 'another layer changes nothing');
  await act(() => (viewer.view = 'points'));
  const points = await picture();
  assert.ok(difference(mesh, points) > 0.05);
  await act(() => (viewer.view = { left: 'points', right: 'mesh', at: 0.25 }));
  const both = await picture();
  assert.ok(difference(both, points, 0, 0.24) < 0.001 && difference(both, mesh, 0.26, 1) < 0.001);
  for (const [at, alone] of [[-1, mesh], [2, points]]) {
    await act((at) => (viewer.view = { left: 'points', right: 'mesh', at }), at);
    assert.ok(difference(alone, await picture()) < 0.001, `at ${at}`);
  }

  await act(() => {
    for (let i = 0; i < 29; i++) viewer.set(`more ${i}`, box);
  });
  assert.match(await act(() => { try { viewer.set('one', box); } catch (error) { return error.message; } }), /31 layers/);
  await act(() => {
    for (let i = 0; i < 29; i++) viewer.set(`more ${i}`, null);
    viewer.view = 'mesh';
  });
  assert.equal(difference(mesh, await picture()), 0);
  await act(() => viewer.clear());
  assert.equal(silhouette(await picture()).area, 0);
  assert.deepEqual(faults, []);
});

test('colours, edges and boxes', async () => {
  const { act, picture } = await open();
  await act(() => viewer.show(box));
  const plain = await picture();
  await act(() => (viewer.colors = { mesh: 'oklch(0.6 0.2 30)' }));
  const [red, , blue] = meanColor(await picture(), silhouette(plain));
  assert.ok(red > 2 * blue, `any CSS colour: ${red} and ${blue}`);
  await act(() => {
    const colors = new Uint8Array(72).map((_, i) => (i % 3 === 2 ? 220 : 20));
    viewer.paint('mesh', { colors, legend: null });
  });
  const painted = meanColor(await picture(), silhouette(plain));
  assert.ok(painted[2] > 3 * painted[0], `painted: ${painted}`);
  await act(() => {
    viewer.paint('mesh', { colors: null, legend: null });
    viewer.colors = { mesh: '#f1e7d8' };
  });
  assert.ok(difference(plain, await picture()) < 0.001);
  await act(() => viewer.showEdges(true));
  const edges = difference(plain, await picture());
  assert.ok(edges > 0.003, `edges: ${edges}`);
  await act(() => viewer.showEdges(false));
  await act(() => viewer.showBoxes({ positions: Float32Array.of(0, 0, 0, 1, 1, 1) }));
  assert.ok(difference(plain, await picture()) > 0.003, 'a box');
  await act(() => viewer.showBoxes(null));
  assert.equal(difference(plain, await picture()), 0);
});

test('sides, up, zoom, first look; who moved is said', async () => {
  const { act, page, picture } = await open();
  await act(() => {
    window.moves = [];
    viewer.addEventListener('move', ({ detail }) => moves.push(detail.by));
    viewer.show(box);
  });
  const first = await picture();
  for (const [side, width, height] of [['front', 2, 1], ['left', 0.5, 1], ['bottom', 2, 0.5]]) {
    await act((side) => viewer.lookFrom(side), side);
    const { box } = silhouette(await picture());
    assert.ok(Math.abs(box.width / box.height / (width / height) - 1) < 0.03, `${side}: ${box.width} × ${box.height}`);
  }
  await act(() => (viewer.parallel = false, viewer.home()));
  assert.ok(difference(first, await picture()) < 0.001);
  assert.equal(await act(() => viewer.upright), 'y');
  await act(() => (viewer.up = 'x'));
  const standing = silhouette(await picture()).box;
  assert.ok(standing.height > standing.width, 'on its side it is tall');
  await act(() => (viewer.up = 'auto', viewer.zoom(0.5)));
  assert.ok(Math.abs((await act(() => viewer.pose.zoom)) - 2) < 1e-6);
  await act(() => viewer.fit());
  assert.ok(difference(first, await picture()) < 0.001);

  await act(() => (moves.length = 0));
  await act(() => viewer.turn(0.1, 0));
  await page.locator('canvas').focus();
  await page.keyboard.press('ArrowRight');
  await act(() => {});
  await page.mouse.move(200, 200);
  await page.mouse.down();
  await page.mouse.move(260, 200, { steps: 3 });
  await page.mouse.up();
  await act(() => {});
  const moves = await act(() => moves);
  assert.deepEqual([...new Set(moves)], ['program', 'keys', 'pointer'], moves.join());
  await act(() => (viewer.interactive = false));
  const still = await picture();
  await page.keyboard.press('ArrowRight');
  await act(() => {});
  assert.equal(difference(still, await picture()), 0, 'nobody moves what is not interactive');
});

test('which point is meant by a place, what the camera makes of a position, and another place to turn around', async () => {
  const { act, faults } = await open();
  const found = await act(() => {
    // On the near side, and far away from zero on a map.
    const origin = [1e6, 2e6, 0];
    viewer.show({ ...cloud, origin });
    viewer.draw();
    const { width, height } = document.querySelector('canvas').getBoundingClientRect();
    return [true, false].map((parallel) => {
      viewer.parallel = parallel;
      viewer.draw();
      return [1, 555, 1681].map((index) => {
        const local = [0, 1, 2].map((k) => cloud.positions[3 * index + k]);
        const place = viewer.project(local.map((value, k) => value + origin[k]));
        const m = viewer.sight(origin);
        const [x, y, w] = [0, 1, 3].map((row) => m[row] * local[0] + m[row + 4] * local[1] + m[row + 8] * local[2] + m[row + 12]);
        const off = Math.hypot(((1 + x / w) * width) / 2 - place.x, ((1 - y / w) * height) / 2 - place.y);
        return { index, off, picked: viewer.pickPoint(place.x, place.y, 3) };
      });
    });
  });
  for (const { index, off, picked } of found.flat()) {
    assert.ok(off < 0.02, `sight and project agree: ${off}`);
    assert.ok(index % 2 === 0 || picked.index === index, `${picked.index} for ${index}`);
    assert.equal(picked.layer, 'points');
  }
  assert.equal(await act(() => viewer.pickPoint(2, 2)), null);
  const middle = await act(() => {
    viewer.pivot([1e6 + 2, 2e6 + 1, 0.5]);
    return new Promise((then) => setTimeout(() => then(viewer.stance.target), 600));
  });
  [1e6 + 2, 2e6 + 1, 0.5].forEach((value, k) => assert.ok(Math.abs(middle[k] - value) < 1e-3, middle.join(' ')));
  assert.deepEqual(faults, []);
});

test('a section draws and finds what is behind a plane alone, of meshes and clouds', async () => {
  const { act, picture, faults } = await open();
  for (const name of ['mesh', 'points']) {
    await act((name) => (name === 'mesh' ? viewer.show(box) : viewer.show(cloud)), name);
    await act(() => viewer.lookFrom('front'));
    const whole = silhouette(await picture());
    const find = () => act((name) => [0.5, 1.5].map((x) => {
      const { x: across, y: down } = viewer.project([x, 0.5, 0.5]);
      return (name === 'mesh' ? viewer.pick(across, down) : viewer.pickPoint(across, down))?.position[0] ?? null;
    }), name);
    assert.ok((await find()).every((x) => x !== null));
    await act(() => (viewer.section = { point: [1, 0, 0], normal: [-3, 0, 0] }));
    const half = silhouette(await picture());
    assert.ok(Math.abs(half.box.width / whole.box.width - 0.5) < 0.03, `${name}: ${half.box.width} of ${whole.box.width}`);
    assert.ok(Math.abs(half.box.left - whole.box.left) <= 1, 'the side that the normal points into');
    const [left, right] = await find();
    assert.ok(Math.abs(left - 0.5) < 0.03 && right === null, `${name}: ${left} ${right}`);
    await act(() => (viewer.section = null));
    assert.ok(Math.abs(silhouette(await picture()).box.width - whole.box.width) <= 1);
  }
  const codes = await act(() => [{ point: [0, 0], normal: [1, 0, 0] }, { point: [0, 0, 0], normal: [0, 0, 0] }, { point: [0, NaN, 0], normal: [1, 0, 0] }].map((section) => {
    try {
      viewer.section = section;
    } catch ({ code }) {
      return code;
    }
  }));
  assert.deepEqual(codes, ['bad-input', 'bad-input', 'bad-input']);
  assert.deepEqual([await act(() => viewer.section), faults], [null, []]);
});

test('it is as large as its canvas, however that has its size', async () => {
  const size = () => [document.querySelector('canvas').width, document.querySelector('canvas').clientWidth, document.querySelector('canvas').clientHeight];
  const shown = await open('<canvas width="320" height="240" aria-label="A box"></canvas>', {}, { deviceScaleFactor: 2 });
  await shown.act(() => viewer.show(box));
  assert.deepEqual(await shown.act(size), [640, 320, 240], 'attributes alone');
  await shown.act(() => Object.assign(document.querySelector('canvas').style, { width: '500px', height: '125px' }));
  assert.deepEqual(await shown.act(size), [1000, 500, 125]);
  const mask = silhouette(await shown.picture());
  assert.ok(mask.box.height > 0.7 * mask.height && mask.box.height < mask.height, 'it is fitted again');
  await shown.act(() => (viewer.insets = { left: 200 }));
  const { box } = silhouette(await shown.picture());
  assert.ok(box.left >= 395, `room at the left: ${box.left} of ${mask.width} device pixels`);
  await shown.act(() => (viewer.insets = { left: 0, top: 400 }));
  assert.ok(silhouette(await shown.picture()).box.height > 0.4 * mask.height, 'no inset takes all');

  const bytes = await shown.act(async () => {
    const { createViewer } = await import('pointweave/viewer');
    const canvas = Object.assign(document.createElement('canvas'), { width: 200, height: 100 });
    const poster = createViewer(canvas);
    poster.show(box);
    return [...new Uint8Array(await (await poster.toBlob()).arrayBuffer())];
  });
  const { width, height, data } = decodePng(Buffer.from(bytes));
  assert.deepEqual([width, height, data[3], data[4 * (50 * 200 + 100) + 3]], [200, 100, 0, 255], 'a canvas in no page');
});

test('a wheel over a picture that is the page zooms, and a scan that is wider than its points is seen whole', async () => {
  const { act, page, picture } = await open(undefined, { embedded: false });
  await act(() => viewer.show(cloud));
  const before = silhouette(await picture()).area;
  await act(() => viewer.set('large', { ...box, positions: box.positions.map((x) => 4 * x) }));
  await act(() => (viewer.view = 'large'));
  const { box, width } = silhouette(await picture());
  assert.ok(box.left > 0 && box.left + box.width < width);
  await act(() => (viewer.view = 'points'));
  assert.ok(silhouette(await picture()).area < 0.3 * before);
  const far = silhouette(await picture()).area;
  await page.mouse.move(200, 200);
  await page.mouse.wheel(0, -400);
  await act(() => {});
  assert.ok(silhouette(await picture()).area > 1.2 * far);
});

test('a right drag moves, the middle button comes nearer, two fingers move and pinch, a swipe scrolls the page', async () => {
  const { act, page, picture } = await open('<canvas style="width: 400px; height: 300px; display: block" aria-label="A box"></canvas><div style="height: 3000px"></div>', {}, { hasTouch: true });
  await act(() => viewer.show(box));
  const place = async () => silhouette(await picture()).box;
  const pose = () => act(() => viewer.pose);
  const { x, y } = await page.locator('canvas').boundingBox();
  const first = await place();
  const drag = async (button, dx, dy) => {
    await page.mouse.move(x + 200, y + 150);
    await page.mouse.down({ button });
    await page.mouse.move(x + 200 + dx, y + 150 + dy, { steps: 4 });
    await page.mouse.up({ button });
    await act(() => {});
  };
  await drag('right', 40, 30);
  const moved = await place();
  assert.ok(Math.abs(moved.left - first.left - 40) < 8 && Math.abs(moved.top - first.top - 30) < 8, `${moved.left - first.left}, ${moved.top - first.top}`);
  await act(() => viewer.home());
  await drag('middle', 0, -100);
  assert.ok((await pose()).zoom > 1.05);
  await act(() => viewer.home());
  const { azimuth } = await pose();
  await drag('left', 75, 0);
  assert.ok(Math.abs((await pose()).azimuth - (azimuth - 90)) < 1, 'a quarter of the height is a quarter of a turn');

  await act(() => viewer.home());
  const debug = await page.context().newCDPSession(page);
  const touch = (type, ...points) => debug.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([dx, dy], id) => ({ x: x + dx, y: y + dy, id })) });
  await touch('touchStart', [150, 150]);
  await touch('touchStart', [150, 150], [250, 150]);
  for (let k = 1; k <= 10; k++) await touch('touchMove', [150 - 5 * k, 150], [250 + 5 * k, 150]);
  await touch('touchEnd');
  await act(() => {});
  assert.ok(Math.abs((await pose()).zoom - 2) < 0.05, `twice as far apart, twice as near: ${(await pose()).zoom}`);
  await act(() => viewer.home());
  await touch('touchStart', [200, 150]);
  for (let k = 1; k <= 10; k++) await touch('touchMove', [200 + 7.5 * k, 150]);
  await touch('touchEnd');
  await act(() => {});
  assert.ok((await pose()).azimuth < azimuth - 60, 'one finger turns it');
  await act(() => viewer.home());
  await touch('touchStart', [200, 250]);
  for (let k = 1; k <= 10; k++) await touch('touchMove', [200, 250 - 15 * k]);
  await touch('touchEnd');
  await page.waitForFunction(() => scrollY > 50);
  assert.ok(Math.abs((await pose()).azimuth - azimuth) < 1);
});

test('two share one context; one that is lost is said to be, and comes back', async () => {
  const { act, page, picture } = await open('<canvas style="width: 300px; height: 200px" aria-label="A"></canvas><canvas style="width: 200px; height: 300px" aria-label="B"></canvas>');
  await act(async () => {
    const { createViewer, readGlb } = await import('pointweave/viewer');
    window.second = createViewer(document.querySelectorAll('canvas')[1]);
    viewer.show(box);
    second.show(await readGlb(new Uint8Array(await (await fetch('/ball.glb')).arrayBuffer())));
    window.told = [];
    for (const type of ['contextlost', 'contextrestored']) second.addEventListener(type, () => told.push(type));
  });
  assert.equal(await act(() => window.contexts.length), 1);
  const other = () => page.locator('canvas').nth(1).screenshot({ animations: 'disabled' });
  const before = [await picture(), await other()];
  const [red, green] = meanColor(before[1], silhouette(before[1]));
  assert.ok(red > 2 * green && silhouette(before[0]).area > 5000);
  const change = (verb, type) => act(async ([verb, type]) => {
    const [{ canvas }] = window.contexts;
    window.loss ??= window.contexts[0].getExtension('WEBGL_lose_context');
    const changed = new Promise((resolve) => canvas.addEventListener(type, resolve));
    window.loss[verb]();
    await changed;
    viewer.turn(2 * Math.PI, 0);
  }, [verb, type]);
  await change('loseContext', 'webglcontextlost');
  assert.equal(difference(before[1], await other()), 0);
  await change('restoreContext', 'webglcontextrestored');
  assert.ok(difference(before[0], await picture()) < 0.005 && difference(before[1], await other()) < 0.005);
  assert.deepEqual(await act(() => told), ['contextlost', 'contextrestored']);
});

test('what does not fit is an error with a code, and what is shown stays', async () => {
  const { act, picture, faults } = await open();
  await act(() => viewer.show(box));
  const before = await picture();
  const thrown = await act(async () => {
    const { createViewer, readGlb } = await import('pointweave/viewer');
    const taken = document.createElement('canvas');
    taken.getContext('webgl2');
    const { positions, indices } = box;
    const jobs = [
      () => viewer.show(undefined), () => viewer.show({}), () => viewer.show({ positions: [0, 0, 0] }), () => viewer.set('mesh', { positions, indices: [0, 1, 2] }),
      () => viewer.show({ positions: new Float32Array() }), () => viewer.show({ positions: positions.slice(1) }),
      () => viewer.show({ positions, normals: new Float32Array(3) }), () => viewer.set('mesh', { positions, colors: new Uint8Array(96) }),
      () => viewer.show({ positions, indices: Uint32Array.of(0, 1, 24) }), () => viewer.show({ positions, indices: Uint32Array.of(0, 1) }),
      () => createViewer(taken), () => createViewer(document.body), () => readGlb(new Uint8Array(40)),
    ];
    return Promise.all(jobs.map(async (job) => {
      try {
        await job();
        return 'nothing';
      } catch ({ name, code, index }) {
        return `${name} ${code} ${index ?? ''}`.trim();
      }
    }));
  });
  const codes = [
    'bad-input', 'bad-input', 'bad-input', 'bad-input', 'empty-cloud', 'bad-length', 'bad-length', 'bad-length', 'bad-index 2', 'bad-length',
    'bad-input', 'bad-input', 'bad-file',
  ];
  assert.deepEqual(thrown, codes.map((code) => `PointweaveError ${code}`));
  assert.equal(difference(before, await picture()), 0);
  assert.deepEqual(faults, []);
});

test('suspended it holds nothing on the GPU, disposed nothing at all', async () => {
  const { act, page, picture } = await open();
  const held = () => act(() => ({ ...window.held }));
  await act(() => (viewer.show(box), viewer.showEdges(true)));
  await act(() => viewer.suspend());
  const empty = await held();
  for (let k = 0; k < 3; k++) {
    await act(() => viewer.resume());
    assert.ok((await held()).Buffer > empty.Buffer && silhouette(await picture()).area > 5000);
    await act(() => viewer.suspend());
    assert.deepEqual(await held(), empty);
  }
  await act(() => {
    viewer.resume();
    viewer.dispose();
    window.reference = new WeakRef(viewer);
    window.viewer = undefined;
    document.querySelector('canvas').remove();
  });
  assert.deepEqual(await held(), empty);
  await page.waitForFunction(() => (gc(), !window.reference.deref()));
});

test('a mesh wears pictures: colours, and less light where less comes to it', async () => {
  const { page, act, picture, faults } = await open();
  await act(async () => {
    const plain = async (color) => {
      const canvas = new OffscreenCanvas(4, 4);
      const context = canvas.getContext('2d');
      context.fillStyle = color;
      context.fillRect(0, 0, 4, 4);
      return { data: new Uint8Array(await (await canvas.convertToBlob({ type: 'image/png' })).arrayBuffer()), type: 'image/png' };
    };
    window.pictures = { red: await plain('#c81e1e'), half: await plain('#808080') };
    window.uvs = new Float32Array(48).fill(0.5);
  });
  /** The mean colour once the pictures are there, which come when they are decoded. */
  const wearing = async (textures, there) => {
    await act((textures) => viewer.show({ ...box, uvs, textures: Object.fromEntries(Object.entries(textures).map(([map, name]) => [map, pictures[name]])) }), textures);
    for (let tries = 0; ; tries++) {
      const seen = await picture();
      const color = meanColor(seen, silhouette(seen));
      if (there(color)) return color;
      assert.ok(tries < 100, `${Object.keys(textures)}: ${color}`);
      await page.waitForTimeout(50);
    }
  };
  const [red] = await wearing({ color: 'red' }, ([r, g]) => r > 2 * g);
  const [shaded] = await wearing({ color: 'red', occlusion: 'half' }, ([r, g]) => r > 2 * g && r < 0.85 * red);
  assert.ok(shaded > 0.4 * red, `${shaded} of ${red}`);
  assert.deepEqual(faults, []);
});
