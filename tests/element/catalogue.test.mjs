// A catalogue of five scans, one of them broken: made, made again, changed, stopped halfway, and opened in a browser.

import assert from 'node:assert/strict';
import { execFile, spawn } from 'node:child_process';
import { mkdir, mkdtemp, readFile, readdir, rm, stat, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after } from 'node:test';
import { fileURLToPath } from 'node:url';
import { duckScan } from './files.mjs';
import { startSite, test } from './site.mjs';

const CLI = fileURLToPath(new URL('../../pkg/cli.js', import.meta.url));
const folder = await mkdtemp(join(tmpdir(), 'catalogue-'));
after(() => rm(folder, { recursive: true }));
const [scans, site] = [join(folder, 'scans'), join(folder, 'site')];

/** The exit code, and what was said. */
function run(...more) {
  const argv = [CLI, 'catalogue', scans, '-o', site, '--triangles', '300', '--texture', '64', '--jobs', '2', '--title', 'Five <ducks>', ...more];
  return new Promise((resolve) => execFile(process.execPath, argv, (error, out, said) => resolve({ code: error?.code ?? 0, out, lines: said.trim().split('\n') })));
}

/** When each file of the site was written. */
async function times() {
  const names = (await readdir(site, { recursive: true })).filter((name) => /\.(glb|usdz|png|json)$/.test(name) && name !== 'catalogue.json').sort();
  return Object.fromEntries(await Promise.all(names.map(async (name) => [name, (await stat(join(site, name))).mtimeMs])));
}

test('a catalogue: what failed is told, a second run does nothing, and only what changed is made', async () => {
  await mkdir(join(scans, 'more'), { recursive: true });
  const duck = await duckScan({ count: 1500 });
  for (const [i, name] of ['a.ply', 'b.ply', 'more/a.ply', 'more/B & b.ply'].entries()) {
    await writeFile(join(scans, name), (await duckScan({ count: 1500 + i })).bytes);
  }
  await writeFile(join(scans, 'broken.ply'), duck.bytes.subarray(0, 3000));

  const first = await run();
  assert.equal(first.code, 1);
  assert.equal(first.lines.length, 6);
  assert.ok(first.lines.some((line) => /\/5 broken\.ply: bad PLY file/.test(line)), first.lines.join('\n'));
  assert.match(first.lines[5], /5 of 5 made, 1 failed/);
  const manifest = JSON.parse(await readFile(join(site, 'catalogue.json'), 'utf8'));
  assert.deepEqual(manifest.map(({ name, error }) => [name, error?.code]), [['a', undefined], ['b', undefined], ['broken', 'bad-file'], ['more-b-b', undefined], ['more-a', undefined]]);
  const [{ made }] = manifest;
  assert.ok(made.points === 1500 && made.triangles <= 300 && made.bytes === (await stat(join(site, 'a/model.glb'))).size && made.rms > 0 && made.lost > 0);
  const report = JSON.parse(await readFile(join(site, 'a/report.json'), 'utf8'));
  assert.deepEqual([report.report.inputPoints, report.model.triangles], [1500, made.triangles]);

  const before = await times();
  assert.equal(Object.keys(before).length, 16);
  const second = await run('--json');
  assert.equal(second.code, 1);
  assert.match(second.lines.at(-1), /nothing to do, 1 of 5 failed/);
  assert.equal(JSON.parse(second.out).length, 5);
  assert.deepEqual(await times(), before);

  await writeFile(join(scans, 'broken.ply'), duck.bytes);
  await rm(join(scans, 'b.ply'));
  const third = await run();
  assert.equal(third.code, 0, third.lines.join('\n'));
  assert.match(third.lines.at(-1), /1 of 4 made, 0 failed/);
  const now = await times();
  assert.deepEqual(Object.keys(now).filter((name) => now[name] !== before[name]).sort(), ['broken/model.glb', 'broken/model.usdz', 'broken/poster.png', 'broken/report.json']);
  assert.ok(!Object.keys(now).some((name) => name.startsWith('b/')));
});

test('what is killed goes on where it was', async () => {
  const other = join(folder, 'other');
  const argv = [CLI, 'catalogue', scans, '-o', other, '--triangles', '300', '--texture', '64'];
  await new Promise((resolve) => {
    const child = spawn(process.execPath, argv, { stdio: ['ignore', 'ignore', 'pipe'] });
    child.stderr.once('data', () => child.kill('SIGKILL'));
    child.once('exit', resolve);
  });
  const said = await new Promise((resolve) => execFile(process.execPath, argv, (_, __, text) => resolve(text)));
  const [, made] = /(\d) of 4 made, 0 failed/.exec(said) ?? [];
  assert.ok(Number(made) >= 1 && Number(made) < 4, said);
});

test('the page shows its models in a browser, and finds them', async () => {
  const served = await startSite();
  for (const name of await readdir(site, { recursive: true })) {
    const path = join(site, name);
    if ((await stat(path)).isFile()) served.put(`/site/${name}`, await readFile(path));
  }
  const shown = await served.visit('/site/index.html');
  await shown.loaded();
  assert.equal(await shown.page.title(), 'Five <ducks>');
  assert.equal(await shown.page.locator('point-weave').count(), 4);
  const heading = await shown.page.locator('h2').allTextContents();
  assert.deepEqual(heading, ['a.ply', 'broken.ply', 'more/B & b.ply', 'more/a.ply']);
  await shown.page.fill('input', 'MORE b');
  assert.equal(await shown.page.locator('li:visible').count(), 1);
  assert.equal(await shown.page.locator('output').textContent(), '1 of 4');
  await shown.page.goto(`${served.address}/site/contact.html`);
  assert.match(await shown.page.locator('main').textContent(), /points1,500triangles\d+/);
  assert.deepEqual(shown.faults, []);
});
