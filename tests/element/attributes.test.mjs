// Attributes and properties, as HTML authors know them; servers; and the types.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { startSite, test } from './site.mjs';

const site = await startSite();

test('importing it on a server does nothing, and needs no three.js', async () => {
  const before = Object.keys(globalThis);
  const { PointWeaveElement } = await import('pointweave/element');
  assert.equal(typeof PointWeaveElement, 'function');
  assert.deepEqual(Object.keys(globalThis), before);
  const alone = fileURLToPath(new URL('../../pkg/', import.meta.url)); // from there, three.js is not found
  const code = "await import('./element.js'); process.stdout.write(await import('three').then(() => 'three', ({ code }) => code))";
  assert.equal(execFileSync(process.execPath, ['--input-type=module', '-e', code], { cwd: alone, encoding: 'utf8' }), 'ERR_MODULE_NOT_FOUND');
});

test('properties say what attributes say, and the other way round', async () => {
  const shown = await site.open('<point-weave></point-weave>');
  const seen = await shown.element().evaluate((element) => {
    const defaults = Object.fromEntries(['src', 'alt', 'ratio', 'count', 'view', 'poster', 'threads', 'autoRotate', 'controls', 'loading', 'up', 'orientation', 'flip'].map((name) => [name, element[name]]));
    /** Sets an attribute and reads the property. */
    const read = (attribute, value, name = attribute) => {
      element.setAttribute(attribute, value);
      return element[name];
    };
    /** Sets a property and reads the attribute. */
    const write = (name, value, attribute = name) => {
      element[name] = value;
      return element.getAttribute(attribute);
    };
    return {
      defaults,
      ratio: ['0.3', ' 1 ', '1e-2', '', '0', '2', '-1', 'much'].map((value) => read('ratio', value)),
      count: ['12', '1.5', '0', '-3', '4294967295', '4294967296'].map((value) => read('count', value)),
      view: ['points', 'REDUCED', ' mesh ', 'solid', ''].map((value) => read('view', value)),
      threads: ['2', '64', '65', '0', 'auto', 'x'].map((value) => read('threads', value)),
      loading: ['eager', 'lazy', 'never'].map((value) => read('loading', value)),
      up: ['z', '-Y', 'w'].map((value) => read('up', value)),
      orientation: ['Inward', 'up', 'down'].map((value) => read('orientation', value)),
      switched: [read('camera-controls', '', 'controls'), write('controls', false, 'camera-controls'), read('exposure', '2'), read('exposure', '-1'), read('shadow-intensity', 'x', 'shadowIntensity'),
        read('reveal', 'MANUAL'), read('interaction-prompt', 'no', 'interactionPrompt'), read('auto-rotate-delay', '0', 'autoRotateDelay'), read('camera-orbit', '1deg 2deg 3m', 'cameraOrbit'),
        write('minFieldOfView', '10deg', 'min-field-of-view'), write('disableZoom', true, 'disable-zoom')],
      flags: [read('flip', ''), read('controls', 'false'), read('controls', ''), read('auto-rotate', '', 'autoRotate')],
      written: [write('ratio', 0.25), write('ratio', null), write('count', 7), write('count', undefined), write('view', 'points'), write('threads', 3),
        write('autoRotate', false, 'auto-rotate'), write('autoRotate', 1, 'auto-rotate'), write('controls', true), write('controls', ''), write('alt', ''), write('src', null)],
    };
  });
  assert.deepEqual(seen.defaults, { src: '', alt: '', ratio: null, count: null, view: 'mesh', poster: '', threads: 'auto', autoRotate: false, controls: false, loading: 'lazy', up: 'auto', orientation: 'auto', flip: false });
  assert.deepEqual(seen.ratio, [0.3, 1, 0.01, null, null, null, null, null]);
  assert.deepEqual(seen.count, [12, null, null, null, 4294967295, null]);
  assert.deepEqual(seen.view, ['points', 'reduced', 'mesh', 'mesh', 'mesh']);
  assert.deepEqual(seen.threads, [2, 64, 'auto', 'auto', 'auto', 'auto']);
  assert.deepEqual(seen.loading, ['eager', 'lazy', 'lazy']);
  assert.deepEqual(seen.up, ['z', '-y', 'auto']);
  assert.deepEqual(seen.orientation, ['inward', 'up', 'auto']);
  assert.deepEqual(seen.switched, [true, null, 2, 1, 0, 'manual', 'auto', 0, '1deg 2deg 3m', '10deg', '']);
  assert.deepEqual(seen.flags, [true, true, true, true]);
  assert.deepEqual(seen.written, ['0.25', null, '7', null, 'points', '3', null, '', '', null, '', null]);
  assert.deepEqual(shown.faults, []);
});

test('what was set before it was defined is kept', async () => {
  const shown = await site.open('<point-weave id="marked" view="points"></point-weave>', { define: false });
  const seen = await shown.page.evaluate(async () => {
    const marked = document.querySelector('point-weave');
    Object.assign(marked, { alt: 'A duck', view: 'reduced', autoRotate: true, ratio: 0.5 });
    const made = document.createElement('point-weave');
    made.controls = true;
    await import('/pointweave/element.js');
    document.body.append(made);
    return [marked.getAttribute('alt'), marked.getAttribute('view'), marked.getAttribute('auto-rotate'), marked.getAttribute('ratio'),
      Object.keys(marked), made.hasAttribute('controls'), made.shadowRoot !== null];
  });
  assert.deepEqual(seen, ['A duck', 'reduced', '', '0.5', [], true, true]);
});

test('importing it twice, from two places, defines it once', async () => {
  const shown = await site.open('<point-weave></point-weave>');
  await shown.page.evaluate(() => import('/pointweave/element.js?again'));
  assert.deepEqual(shown.faults, []);
});
