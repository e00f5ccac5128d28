// The package as it is published: packed, and installed for all consumers at once.

import { execFile } from 'node:child_process';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';

export const PACKAGE = new URL('../../pkg/', import.meta.url);
export const CONSUMERS = new URL('../consumers/', import.meta.url);

const run = promisify(execFile);

/**
 * @param {{ after: (end: () => Promise<void>) => void }} t after which the tarball is removed
 * @returns {Promise<{ file: string, contents: string[] }>} the tarball, and the paths in it
 */
export async function pack(t) {
  const folder = await mkdtemp(join(tmpdir(), 'pointweave-pack-'));
  t.after(() => rm(folder, { recursive: true }));
  const { stdout } = await run('npm', ['pack', '--json', '--loglevel=error', '--pack-destination', folder], { cwd: fileURLToPath(PACKAGE) });
  const [{ filename, files }] = JSON.parse(stdout);
  return { file: join(folder, filename), contents: files.map(({ path }) => path).sort() };
}

/** Adds the tarball to what `npm ci` has installed for the consumers. @param {string} file */
export async function install(file) {
  const options = ['--no-save', '--prefer-offline', '--no-audit', '--no-fund', '--loglevel=error'];
  await run('npm', ['install', ...options, file], { cwd: fileURLToPath(CONSUMERS) });
}
