// Every text of the page has its words in every language, with the same places for values.

import assert from 'node:assert/strict';
import { readFile, readdir } from 'node:fs/promises';
import { test } from 'node:test';
import { TELLS, TOLD_BY } from '../../pkg/engine/side.js';
import { PAINT_WORDS } from '../../pkg/viewer/words.js';
import { FIELDS, TARGETS } from '../../www/src/controls/fields-table.js';
import { SAMPLES } from '../../www/src/controls/samples.js';
import { UNITS } from '../../www/src/controls/standing.js';
import { NAMES as VIEWS, SIDES } from '../../www/src/look/names.js';
import { DOUBTS } from '../../www/src/results/doubt-words.js';
import { MESSAGES } from '../../www/src/results/error-messages.js';
import { REASONS, reasonWords } from '../../www/src/results/reasons.js';
import { STAGES } from '../../www/src/results/stages.js';
import { ROLES } from '../../www/src/session/column-chooser.js';
import { PRESETS } from '../../www/src/session/light-models.js';
import { FORMATS, NAMES } from '../../www/src/session/saving.js';
import { ACTIONS } from '../../www/src/tidy/tidy.js';
import { PATIENCE, start } from './browser.mjs';

const SRC = new URL('../../www/src/', import.meta.url);
/** Names, signs and file formats are the same in all languages. */
const SAME = /^(Pointweave|x|y|z|r|[–%…]|RMS|[1-4?]|)$/;

/** The texts in `index.html`: between tags, and in attributes that are read. */
async function textsOfPage() {
  const html = (await readFile(new URL('../index.html', SRC), 'utf8')).replace(/<!--[^]*?-->|<svg[^]*?<\/svg>|<script[^]*?<\/script>/g, '<>');
  const between = html.replace(/<[^>]*>/g, '\n\0').split('\0');
  const attributes = [...html.matchAll(/\b(?:title|aria-label|placeholder)="([^"]*)"/g)].map(([, text]) => text);
  return [...between, ...attributes].map((text) => text.trim().replace(/\s+/g, ' '));
}

/** The texts that the code says as they stand there. */
async function textsOfCode() {
  const names = (await readdir(SRC, { recursive: true })).filter((name) => name.endsWith('.js'));
  const files = await Promise.all(names.map((name) => readFile(new URL(name, SRC), 'utf8')));
  return files.flatMap((text) => [...text.matchAll(/\bsay\(\s*(?:[\w.]+(?: === '\w+')? \? )?'((?:[^'\\]|\\.)*)'(?: : '((?:[^'\\]|\\.)*)')?/g)].flatMap(([, one, other]) => (other ? [one, other] : [one])));
}

function textsOfTables() {
  const fields = Object.values(FIELDS).flatMap(({ label, hint, choices = {} }) => [label, hint, ...Object.values(choices)]);
  const { names, density, error, sharp } = PAINT_WORDS;
  return [
    ...fields, ...Object.values(TARGETS).map(({ label }) => label), ...Object.values(SAMPLES).map(({ title }) => title), ...Object.values(UNITS),
    ...Object.values(VIEWS), ...Object.values(SIDES), ...Object.values(MESSAGES).flatMap(Object.values), ...Object.values(STAGES), ...Object.values(DOUBTS),
    ...ROLES.map(([, name]) => name), ...Object.values(FORMATS).flatMap(Object.values).flatMap(({ use, prints }) => [use, prints ?? '']), ...Object.values(NAMES),
    ...Object.values(PRESETS).flatMap(({ label, kinds }) => [label, ...kinds.map(({ use }) => use)]),
    ...Object.values(ACTIONS).flatMap(Object.values),
    ...REASONS, TELLS, ...Object.values(TOLD_BY), ...Object.values(names), density.title, ...Object.values(error.titles), sharp.title, sharp.sharp, sharp.smooth,
  ];
}

const places = (text) => [...text.matchAll(/\{\w+\}/g)].map(([place]) => place).sort();

const texts = new Set([...await textsOfPage(), ...await textsOfCode(), ...textsOfTables()].filter((text) => !SAME.test(text)));
if (process.env.POINTWEAVE_TEXTS) console.log(JSON.stringify([...texts], null, 1));

test('every reason that the package gives is known', async () => {
  const files = ['pkg/engine/choice.js', 'pkg/engine/engine.js', 'pkg/engine/platform.web.js', 'pkg/engine/memory.js', 'src/reduce/mod.rs', 'src/reduce/tolerance.rs', 'src/pipeline/input.rs'];
  const code = (await Promise.all(files.map((file) => readFile(new URL(`../../${file}`, import.meta.url), 'utf8')))).join('\n');
  for (const reason of REASONS) {
    const pieces = reason.split(/\{\w+\}/).filter(Boolean);
    assert.ok(pieces.every((piece) => code.includes(piece)), reason);
  }
  const given = [...code.matchAll(/reason: '([^']+)'/g), ...code.matchAll(/reason: `([^`$]+)/g)].map(([, text]) => text);
  assert.ok(given.length >= 6);
  for (const text of given) assert.ok(REASONS.some((reason) => reason.startsWith(text)), text);
  assert.equal(reasonWords('threads need a worker; memory is limited to 512 MiB here; so it is'), 'Threads need a worker. Memory is limited to 512 MiB here. So it is.');
});

for (const language of ['de', 'fr']) {
  test(`all texts are said in ${language}`, async () => {
    assert.ok(texts.size > 250);
    const { default: table } = await import(`../../www/src/words/${language}.js`);
    assert.deepEqual([...texts].filter((text) => !table[text]), [], 'texts without words');
    assert.deepEqual(Object.keys(table).filter((text) => !texts.has(text)), [], 'words without a text');
    for (const [text, words] of Object.entries(table)) assert.deepEqual(places(words), places(text), text);
  });
}

test('the browser chooses the language, of the page and of what is measured beside it', { timeout: PATIENCE }, async (t) => {
  const server = await start(t);
  const site = await server.open({ locale: 'de-DE' }, undefined, '#count=2000');
  const { page } = site;
  await site.made();
  assert.equal(await page.getAttribute('html', 'lang'), 'de');
  assert.equal(await page.innerText('#caption-title'), 'Spielzeugente');
  assert.equal(await page.innerText('#caption-detail'), 'simulierter Scan, 35.647 Punkte');
  assert.equal(await page.innerText('#choose'), 'Scan öffnen');
  await page.fill('#keep-field', '0');
  assert.equal(await page.innerText('#keep-error'), 'Möglich ist eine ganze Zahl ab 1.');
  await site.paint('error');
  assert.match(await page.innerText('#legend'), /Abstand zum Scan[^]*0,\d+[^]*als Anteil der Diagonale/);
  // Nothing that a person sees is left in English.
  const seen = await page.evaluate(() => document.body.innerText.split('\n').map((line) => line.trim()).filter(Boolean));
  const english = seen.filter((line) => / (the|and|of|is|with) /.test(` ${line} `));
  assert.deepEqual(english, []);
  await page.context().close();
  const other = await server.open({ locale: 'pt-BR' }, undefined, '#count=2000');
  await other.made();
  assert.equal(await other.page.innerText('#caption-title'), 'Toy duck', 'in English for all others');
});
