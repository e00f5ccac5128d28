/** A folder of scans as a web page: what changed is made, what is there stays, and a scan that fails stops no other. */
import { createHash } from 'node:crypto';
import { createReadStream } from 'node:fs';
import { copyFile, readFile, rm, stat } from 'node:fs/promises';
import { availableParallelism } from 'node:os';
import { basename, extname, join, relative, resolve, sep } from 'node:path';
import { createEngine } from '../index.node.js';
import { PointweaveError } from '../engine/errors.js';
import { compressorFor, encoderFor } from '../files/compressor.js';
import { contactPage, indexPage } from './catalogue-page.js';
import { DEFAULTS, make } from './catalogue-scan.js';
import { makeFolder, sentence, writeOutput } from '../files/disk.js';
import { version } from '../files/version.js';
import { stepsOf } from './prepare-flags.js';
import { say } from './say.js';
import { scansAt } from './sources.js';
import { UsageError } from './usage.js';

/** @import { Task } from './arguments.js' */
/** @import { CatalogueSaid } from './catalogue-flags.js' */
/** @import { Made } from './catalogue-scan.js' */

/**
 * A scan of the catalogue: what it was made of, and what was made or went wrong.
 * @typedef {{ name: string, source: string, key: string } & ({ made: Made } | { error: { code: string, message: string } })} Entry
 * @typedef {{ name: string, source: string, path: string }} Source
 */

const MANIFEST = 'catalogue.json';
const PACKAGE = new URL('../', import.meta.url);
/** Failures that another run may not have: of the machine, not of the scan. */
const PASSING = ['out-of-memory', 'internal', 'load-failed', 'ENOSPC', 'EACCES', 'EMFILE'];

/**
 * @param {Task} task
 * @param {CatalogueSaid} said
 * @param {AbortSignal} signal
 * @returns {Promise<boolean>} whether all scans are in it
 */
export async function catalogue(task, { sources, site, jobs, title }, signal) {
  const steps = await stepsOf(task.prepare);
  // That packages are missing is known before the work.
  await compressorFor(task.write.meshopt);
  await encoderFor(task.write.pictures);
  const scans = await scansIn(sources, site);
  if (scans.length === 0) throw new UsageError(`there are no scans in ${sources.join(', ')}`);
  await makeFolder(site);
  const before = await manifestOf(site);
  const whole = { ...task, own: { ...(task.own.lods ? { texture: DEFAULTS.texture } : DEFAULTS), ...task.own }, steps };
  const options = JSON.stringify([await version(), whole.own, task.read, task.cloud, steps, task.write]);
  /** @type {Map<string, Entry>} */
  const entries = new Map();
  /** @type {(Source & { key: string })[]} */
  const waiting = [];
  for (const scan of scans) {
    signal.throwIfAborted();
    const key = await keyOf(scan, options);
    const known = before.find((entry) => entry.name === scan.name && entry.key === key);
    if (known && (await isWhole(known, site))) entries.set(scan.name, known);
    else waiting.push({ ...scan, key });
  }
  const save = () => writeOutput(join(site, MANIFEST), bytesOf(`${JSON.stringify(listed(scans, entries), null, 1)}\n`), signal);
  const count = waiting.length;
  let done = 0;
  let last = Promise.resolve();
  const work = async () => {
    const engine = await createEngine({ threads: threadsOf(task.threads, jobs), worker: true });
    try {
      for (let scan = waiting.shift(); scan; scan = waiting.shift()) {
        const { path, ...told } = scan;
        const folder = join(site, scan.name);
        /** @type {Entry} */
        let entry;
        try {
          await clear(folder);
          entry = { ...told, made: await make(engine, whole, path, folder, signal) };
        } catch (error) {
          signal.throwIfAborted();
          await rm(folder, { recursive: true, force: true });
          entry = { ...told, error: { code: codeOf(error), message: sentence(error) } };
        }
        entries.set(scan.name, entry);
        last = last.then(save);
        await last;
        say(`${++done}/${count} ${lineOf(entry)}`);
      }
    } finally {
      await engine.dispose();
    }
  };
  await Promise.all(Array.from({ length: Math.min(jobs, count) }, work));
  const all = listed(scans, entries);
  const kept = new Set(all.map(({ name }) => name));
  for (const { name } of before) if (!kept.has(name)) await rm(join(site, name), { recursive: true, force: true });
  await save();
  await pages(site, title, all, signal);
  return tell(task, site, all, count);
}

/** @param {Task} task @param {string} site @param {Entry[]} all @param {number} made */
function tell({ json }, site, all, made) {
  const failed = all.filter((entry) => 'error' in entry);
  if (json) process.stdout.write(`${JSON.stringify(all, null, 2)}\n`);
  if (made === 0) failed.forEach((entry) => say(lineOf(entry)));
  say(`${site}: ${made === 0 ? `nothing to do, ${failed.length} of ${all.length} failed` : `${made} of ${all.length} made, ${failed.length} failed`}`);
  return failed.length === 0;
}

/** @param {Entry} entry */
function lineOf(entry) {
  if ('error' in entry) return `${entry.source}: ${entry.error.message}`;
  const { triangles, bytes, seconds, doubts } = entry.made;
  return `${entry.source}: ${triangles.toLocaleString('en-US')} triangles, ${Math.round(bytes / 1000)} kB, ${seconds.toFixed(1)} s${doubts.map((doubt) => `; ${doubt}`).join('')}`;
}

/**
 * Pages and the element, written where they differ from what is there.
 * @param {string} site @param {string} title @param {Entry[]} entries @param {AbortSignal} signal
 */
async function pages(site, title, entries, signal) {
  for (const [name, text] of [['index.html', indexPage(title, entries)], ['contact.html', contactPage(title, entries)]]) {
    const there = await readFile(join(site, name), 'utf8').catch(() => '');
    if (there !== text) await writeOutput(join(site, name), bytesOf(text), signal);
  }
  await copyFile(new URL('element.min.js', PACKAGE), join(site, 'element.min.js'));
}

/** In the order of the scans. @param {Source[]} scans @param {Map<string, Entry>} entries @returns {Entry[]} */
function listed(scans, entries) {
  return scans.flatMap(({ name }) => entries.get(name) ?? []);
}

/**
 * The scans of files and folders, each with a folder's name of its own.
 * @param {string[]} sources
 * @param {string} site is not looked into
 * @returns {Promise<Source[]>}
 */
async function scansIn(sources, site) {
  /** @type {Omit<Source, 'name'>[]} */
  const found = [];
  for (const source of sources) {
    const { isFolder, paths } = await scansAt(source);
    for (const path of paths) {
      if (isFolder && resolve(path).startsWith(resolve(site) + sep)) continue;
      const told = isFolder ? relative(source, path) : basename(path);
      found.push({ path, source: told.replaceAll(sep, '/') });
    }
  }
  const names = namesOf(found.map(({ source }) => source));
  return found.map((scan, i) => ({ ...scan, name: names[i] }));
}

/**
 * The folder of each scan, no two alike.
 * @param {string[]} sources paths in the folder that was named
 */
export function namesOf(sources) {
  /** @type {Set<string>} */
  const taken = new Set();
  for (const source of sources) {
    const bare = wordOf(source.slice(0, source.length - extname(source).length));
    const choices = [bare, wordOf(source), ...Array.from({ length: sources.length }, (_, i) => `${wordOf(source)}-${i + 2}`)];
    taken.add(/** @type {string} */ (choices.find((name) => !taken.has(name))));
  }
  return [...taken];
}

/** What every server and disk takes as a name. @param {string} text */
function wordOf(text) {
  return text.toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-+|-+$/g, '') || 'scan';
}

/** Of the scan's bytes and of all that is done with them. @param {Source} scan @param {string} options */
async function keyOf({ path }, options) {
  const hash = createHash('sha256').update(options);
  try {
    for await (const chunk of createReadStream(path)) hash.update(chunk);
  } catch (error) {
    hash.update(String(/** @type {any} */ (error).code));
  }
  return hash.digest('hex');
}

/** What an earlier run left. @param {string} site @returns {Promise<Entry[]>} */
async function manifestOf(site) {
  const text = await readFile(join(site, MANIFEST), 'utf8').catch(() => '[]');
  try {
    const entries = JSON.parse(text);
    return Array.isArray(entries) ? entries.filter(({ name, key }) => name === wordOf(name) && key) : [];
  } catch {
    return []; // a damaged one is made anew
  }
}

/** Whether nothing is to be done for it. @param {Entry} entry @param {string} site */
async function isWhole(entry, site) {
  if ('error' in entry) return !PASSING.includes(entry.error.code);
  const there = await Promise.all(entry.made.files.map((name) => stat(join(site, entry.name, name)).catch(() => undefined)));
  return there.every(Boolean);
}

/** Nothing of an earlier try is left. @param {string} folder */
async function clear(folder) {
  await rm(folder, { recursive: true, force: true });
  await makeFolder(folder);
}

/** Each job's share. @param {'auto' | number} threads @param {number} jobs */
function threadsOf(threads, jobs) {
  return threads === 'auto' && jobs > 1 ? Math.max(1, Math.floor(availableParallelism() / jobs)) : threads;
}

/** @param {unknown} error */
function codeOf(error) {
  return error instanceof PointweaveError ? error.code : /** @type {any} */ (error)?.code ?? 'internal';
}

/** @param {string} text */
function bytesOf(text) {
  return new TextEncoder().encode(text);
}
