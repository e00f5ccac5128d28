// A page that was built before all wasm modules were there, as `cargo xtask serve` does on a first start.

import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readdir, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { PATIENCE, start } from './browser.mjs';

const WWW = fileURLToPath(new URL('../../www/', import.meta.url));
const MISSING = ['threads', 'las', 'e57', 'pictures', 'exports', 'packed', 'prepare', 'light'];

test('the first picture needs the single-threaded build alone, and the page says what is missing', async (t) => {
  const dist = await mkdtemp(join(tmpdir(), 'pointweave-building-'));
  t.after(() => rm(dist, { recursive: true }));
  await promisify(execFile)(process.execPath, ['node_modules/vite/bin/vite.js', 'build', '--outDir', dist, '--emptyOutDir'], {
    cwd: WWW, env: { ...process.env, POINTWEAVE_BUILDING: MISSING.join(',') },
  });
  assert.ok(!(await readdir(dist)).includes('service-worker.js'), 'what is not whole is not kept');
  await writeFile(join(dist, 'building.json'), JSON.stringify(MISSING));

  const site = await start(t, { dist });
  const { page } = await site.open({}, undefined, '#sample=duck');
  const note = () => page.textContent('#building');
  assert.match(await note(), /^Still being built: threads.*LAS and LAZ files; E57 files/);
  await page.waitForSelector('#app[data-state="ready"]', { timeout: PATIENCE });
  assert.equal(await page.$eval('[data-number="inputPoints"]', (number) => number.value), '35647');

  await writeFile(join(dist, 'building.json'), '["e57"]');
  await page.waitForFunction(() => document.querySelector('#building').textContent === 'Still being built: E57 files.', null, { timeout: PATIENCE });
  await rm(join(dist, 'building.json'));
  await page.waitForSelector('#building button', { timeout: PATIENCE });
  assert.match(await note(), /^All of the page is built/);
});
