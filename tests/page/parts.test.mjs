// Parts of the page that need no browser, against what is known.

import assert from 'node:assert/strict';
import { readFile, readdir } from 'node:fs/promises';
import { test } from 'node:test';
import { DEFAULTS, reconstruct, reduce, sample } from 'pointweave';
import { ticks } from '../../www/src/controls/chart.js';
import { UNKNOWN, colorAt, colorize } from '../../pkg/viewer/colormap.js';
import { localSpacing } from '../../pkg/viewer/density.js';
import { creases, sharpPoints } from '../../pkg/viewer/sharp.js';
import { likelyUp } from '../../pkg/viewer/upright.js';
import { CONTROLS, PLACES, Settings, TARGETS, defaultOf, entriesOf } from '../../www/src/controls/settings.js';
import { meaningOf } from '../../www/src/controls/targets.js';
import { printingWords, solidOf } from '../../www/src/results/printing.js';
import { MESSAGES } from '../../www/src/results/error-messages.js';

/** What people without red, green or blue cones see of linear colours (Viénot, 1999; Brettel, 1997, one half plane). */
const BLINDNESS = {
  nobody: [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
  protanopia: [[0.1124, 0.8876, 0], [0.1124, 0.8876, 0], [0.004, -0.004, 1]],
  deuteranopia: [[0.2928, 0.7072, 0], [0.2928, 0.7072, 0], [-0.0223, 0.0223, 1]],
  tritanopia: [[1.0126, 0.1346, -0.1472], [-0.0116, 0.8692, 0.1424], [0.0774, 0.8841, 0.0385]],
};

const linear = (byte) => (byte / 255 <= 0.04045 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
const luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

test('one place knows the ids of the page, and the page has all of them', async () => {
  const [table, html] = await Promise.all(['src/page.js', 'index.html'].map((name) => readFile(new URL(`../../www/${name}`, import.meta.url), 'utf8')));
  const wanted = [...table.matchAll(/byId\('([\w-]+)', (\w+)\)/g)];
  assert.ok(wanted.length > 150);
  for (const [, id] of wanted) assert.ok(html.includes(`id="${id}"`), id);
  const sources = (await readdir(new URL('../../www/src/', import.meta.url), { recursive: true })).filter((name) => name.endsWith('.js') && name !== 'page.js');
  for (const name of sources) {
    const text = await readFile(new URL(`../../www/src/${name}`, import.meta.url), 'utf8');
    assert.ok(!/getElementById\('|querySelector\('#/.test(text), name);
  }
});

test('the colour map gets lighter evenly, for everybody', () => {
  for (const [who, matrix] of Object.entries(BLINDNESS)) {
    const light = Array.from({ length: 33 }, (_, i) => {
      const color = colorAt(i / 32).map(linear);
      return Math.cbrt(luminance(matrix.map((row) => row.reduce((sum, m, c) => sum + m * color[c], 0))));
    });
    const steps = light.slice(1).map((value, i) => value - light[i]);
    const mean = (light.at(-1) - light[0]) / steps.length;
    for (const step of steps) assert.ok(step > 0.3 * mean && step < 2 * mean, `${who}: ${steps}`);
  }
});

test('values take their colours, those beyond the ends the ends, and unknown ones grey', () => {
  const colors = colorize([0, 5, 10, -3, 99, NaN], 0, 10);
  const at = (i) => [...colors.subarray(3 * i, 3 * i + 3)];
  assert.deepEqual(at(0), colorAt(0));
  assert.deepEqual(at(2), colorAt(1));
  assert.deepEqual([at(3), at(4), at(5)], [at(0), at(2), [...UNKNOWN]]);
  at(1).forEach((value, c) => assert.ok(Math.abs(value - colorAt(0.5)[c]) <= 3));
});

test('the spacing of a plane of points is found, whichever way it lies', () => {
  for (const spacing of [0.004, 0.02]) {
    for (const [a, b] of [[[1, 0, 0], [0, 1, 0]], [[0, 1, 0], [0, 0, 1]], [[0.6, 0.8, 0], [0, 0, 1]], [[0.36, 0.48, 0.8], [0.8, -0.6, 0]]]) {
      const points = [];
      for (let x = -0.3; x < 0.3; x += spacing) for (let y = -0.3; y < 0.3; y += spacing) points.push(...[0, 1, 2].map((axis) => a[axis] * x + b[axis] * y));
      const found = [...localSpacing(Float32Array.from(points))].sort((p, q) => p - q);
      const median = found[found.length >> 1];
      assert.ok(Math.abs(median / spacing - 1) < 0.08, `${median} of ${spacing}`);
    }
  }
});

test('sharp places are on the edges of the part, and hardly anywhere on the duck', async () => {
  const share = (flags) => flags.reduce((sum, is) => sum + is, 0) / flags.length;
  const [part, duck] = await Promise.all(['part', 'duck'].map((model) => sample(model, { count: 12_000 })));
  const [edges, feathers] = await Promise.all([part, duck].map((cloud) => reduce(cloud)));
  assert.ok(share(sharpPoints(edges, part, 16)) > 3 * share(sharpPoints(feathers, duck, 16)));
  assert.ok(share(creases(await reconstruct(part))) > 3 * share(creases(await reconstruct(duck))));
  // A flatness target keeps samples as they are: these count as sharp.
  const flat = await reduce(part, { target: { flatness: 6e-4 } });
  const flags = sharpPoints(flat, part, 16);
  const kept = [...flat.weights].filter((weight, i) => weight === 1
    && [0, 1, 2].every((axis) => Math.abs(flat.positions[3 * i + axis] - part.positions[3 * flat.nearest[i] + axis]) < 1e-5)).length;
  assert.ok(kept > 100 && share(flags) * flags.length >= kept, `${kept} kept`);
});

test('settings: defaults are the package\'s, and an address brings back what was chosen', () => {
  assert.deepEqual(Object.values(PLACES).flat().sort(), Object.keys(CONTROLS).sort(), 'each has one place');
  for (const key of Object.keys(CONTROLS)) assert.equal(defaultOf(key), DEFAULTS[CONTROLS[key].in][key], key);
  assert.equal(TARGETS.ratio.start, DEFAULTS.reduce.target.ratio);
  const chosen = new Settings();
  assert.equal(chosen.changed, false);
  chosen.target = { kind: 'tolerance', value: 0.002 };
  chosen.set('method', 'paper');
  chosen.set('fuzzifier', 1.8);
  chosen.set('sharp', false);
  chosen.set('accuracy', DEFAULTS.reconstruct.accuracy); // the default is no choice
  const again = new Settings();
  again.read(new URLSearchParams(entriesOf(chosen.chosen)));
  assert.deepEqual([again.target, again.values], [chosen.target, chosen.values]);
  assert.deepEqual(again.options(again.target), {
    reduce: { target: { tolerance: 0.002 }, method: 'paper', fuzzifier: 1.8 }, surface: { sharp: false },
  });
  again.read(new URLSearchParams('ratio=7&count=1.5&tolerance=&method=none&fuzzifier=x&sharp=maybe&toString=1&__proto__=2'));
  assert.equal(again.changed, false, 'nonsense is left out');
});

test('an axis has round values that tell how it runs, and not too many', () => {
  for (const low of [1e-5, 3.1e-4, 0.02, 1, 306, 45_000]) {
    for (const ratio of [1.4, 1.9, 3.6, 6.5, 12, 80, 500]) {
      const found = ticks([low * ratio, low]);
      assert.ok(found.length >= (ratio < 1.9 ? 1 : 2) && found.length <= 8, `${low} to ${low * ratio}: ${found}`);
      assert.ok(found.every((value) => value >= low && value <= low * ratio));
      assert.equal(new Set(found).size, found.length);
    }
  }
  assert.deepEqual(ticks([306, 764, 2000]), [500, 1000, 2000]);
  assert.deepEqual(ticks([0.0012, 0.0031, 0.0075]), [0.002, 0.003, 0.005, 0.007]);
});

test('what was surveyed stands on its z, and so does what is flat', () => {
  assert.equal(likelyUp({}, [1, 2, 1]), 'y');
  assert.equal(likelyUp({}, [10, 20, 2]), 'z');
  assert.equal(likelyUp({}, [24, 29, 36]), 'y');
  assert.equal(likelyUp({ origin: [5e5, 5e6, 0] }, [3, 3, 3]), 'z');
  assert.equal(likelyUp({ seenFromAbove: true }, [24, 29, 36]), 'z');
  assert.equal(likelyUp({ up: [0.1, -0.9, 0.2] }, [10, 20, 2]), '-y', 'what the data name goes first');
});

test('what a printer asks of a mesh', () => {
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1, (i >> 1) & 1, i >> 2].map((bit, axis) => 100 + bit * (axis + 1)));
  const faces = [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5];
  const mesh = (indices, report = {}) => ({
    positions: Float32Array.from(corners.flat()), indices: Uint32Array.from(indices), report: { boundaryEdges: 0, nonManifoldEdges: 0, holes: [], ...report },
  });
  const box = solidOf(mesh(faces));
  assert.deepEqual([box.closed, box.size], [true, [1, 2, 3]]);
  assert.ok(Math.abs(box.volume - 6) < 1e-9);
  assert.deepEqual(printingWords(box, 'cm'), { ready: true, words: 'Watertight, ready for 3D printing: 10 × 20 × 30 mm, 6 cm³.' });
  assert.match(printingWords(box, undefined).words, /1 × 2 × 3 mm, 6 mm³, if a coordinate of 1 is a millimetre/);
  assert.match(printingWords(solidOf(mesh(faces.toReversed())), 'mm').words, /inside out/);
  const holes = [{ diameter: 0.1, closed: false }, { diameter: 0.1, closed: true }, { diameter: 0.2, closed: false }];
  assert.deepEqual(printingWords(solidOf(mesh(faces.slice(6), { boundaryEdges: 8, holes })), 'mm'), { ready: false, words: 'Not ready for 3D printing: it has 2 holes or open borders.' });
  assert.match(printingWords(solidOf(mesh(faces, { nonManifoldEdges: 1 })), 'mm').words, /not watertight/);
  assert.match(printingWords(box, 'deg').words, /degrees/);
});

test('what is kept, in words', () => {
  const scan = /** @type {any} */ ({ count: 1065, frame: { diagonal: 2 } });
  assert.equal(meaningOf({ kind: 'ratio', value: 0.2 }, scan), '213 of 1,065 points. Curved places keep more.');
  assert.equal(meaningOf({ kind: 'ratio', value: 1 }, scan), 'All of 1,065 points.');
  assert.equal(meaningOf({ kind: 'count', value: 5000 }, scan), 'All of 1,065 points.');
  assert.equal(meaningOf({ kind: 'count', value: 5000 }, { ...scan, count: 1 }), 'All of 1 point.');
});

test('every error code of the package has its words', async () => {
  const types = await readFile(new URL('../../pkg/types.d.ts', import.meta.url), 'utf8');
  const codes = /type ErrorCode =([^;]*);/.exec(types)[1].match(/'[a-z-]+'/g).map((code) => code.slice(1, -1));
  assert.ok(codes.length >= 12);
  for (const code of codes) {
    assert.ok(MESSAGES[code]?.title && MESSAGES[code].text && MESSAGES[code].advice, `no words for ${code}`);
  }
});
