// The typed reference is made from the package's types, without a warning, and has every name that is exported.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, readdir, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import * as api from 'pointweave';
import * as core from 'pointweave/core';
import * as element from 'pointweave/element';

test('a reference is generated from the types and the pages', async (t) => {
  const out = await mkdtemp(join(tmpdir(), 'pointweave-reference-'));
  t.after(() => rm(out, { recursive: true }));
  const tests = fileURLToPath(new URL('..', import.meta.url));
  const typedoc = join(tests, 'node_modules/typedoc/bin/typedoc');
  await promisify(execFile)(process.execPath, [typedoc, '--options', join(tests, 'typedoc.json'), '--out', out]);
  const written = (await readdir(out, { recursive: true })).map((file) => file.replace(/^.*[\\/]/, ''));
    const viewer = await readFile(new URL('../../pkg/viewer.js', import.meta.url), 'utf8'); // it needs three.js beside it
  const ofViewer = [...viewer.matchAll(/export \{ (.*) \}/g)].flatMap(([, names]) => names.split(', '));
  assert.ok(ofViewer.includes('createViewer'));
  for (const name of [...[api, core, element, { compress: true }].flatMap(Object.keys), ...ofViewer]) {
    assert.ok(written.some((file) => file === `${name}.html` || file.endsWith(`.${name}.html`)), name);
  }
  const page = await readFile(join(out, 'interfaces', written.find((file) => file.endsWith('ReduceOptions.html'))), 'utf8');
  assert.match(page, /curvatureWeight/);
  assert.match(page, /strongest concentration on curved regions/);
});
