/** What a command line names: files, and the scans of folders. */
import { readdir, stat } from 'node:fs/promises';
import { join } from 'node:path';
import { isScan } from '../files/archive.js';
import { UsageError } from './usage.js';

/**
 * A file, or the scans of a folder, however deep, in an order that does not depend on the disk.
 * @param {string} source
 * @returns {Promise<{ isFolder: boolean, paths: string[] }>}
 */
export async function scansAt(source) {
  const there = await stat(source).catch(() => undefined);
  if (!there) throw new UsageError(`'${source}': there is no such file or folder`);
  if (!there.isDirectory()) return { isFolder: false, paths: [source] };
  const within = await readdir(source, { recursive: true, withFileTypes: true });
  const scans = within.filter((entry) => entry.isFile() && isScan(entry.name)).map(({ parentPath, path = parentPath, name }) => join(path, name));
  return { isFolder: true, paths: scans.sort() };
}
