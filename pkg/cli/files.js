/** Files in, files out. A result is there whole or not at all. */
import { randomUUID } from 'node:crypto';
import { readFile, realpath, rename, rm, stat, writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { addAbortSignal } from 'node:stream';
import { buffer } from 'node:stream/consumers';

/** What the system's codes mean. @type {Record<string, string>} */
const MEANINGS = {
  ENOENT: 'there is no such file or folder',
  EISDIR: 'it is a folder',
  ENOTDIR: 'a part of the path is no folder',
  EACCES: 'access is not allowed',
  EPERM: 'access is not allowed',
  ENOSPC: 'the disk is full',
  EROFS: 'the disk is read-only',
};

/**
 * @param {string} input a path, or - for standard input
 * @param {AbortSignal} signal
 * @returns {Promise<Uint8Array>}
 */
export async function readInput(input, signal) {
  return input === '-' ? buffer(addAbortSignal(signal, process.stdin)) : readFile(input, { signal });
}

/**
 * Writes beside the place and moves there at the end, or nothing stays. What is no file (a device, a pipe) is written
 * directly; a link is followed.
 * @param {string} output
 * @param {Uint8Array} bytes
 * @param {AbortSignal} signal
 */
export async function writeOutput(output, bytes, signal) {
  const there = await stat(output).catch(() => undefined);
  if (there && !there.isFile()) return writeFile(output, bytes, { signal });
  const target = there ? await realpath(output) : output;
  const part = join(dirname(target), `.pointweave-${randomUUID()}.part`);
  try {
    await writeFile(part, bytes, { signal, mode: there && there.mode & 0o777 });
    signal.throwIfAborted();
    await rename(part, target);
  } catch (error) {
    await rm(part, { force: true });
    throw error;
  }
}

/**
 * Whether two paths lead to one file.
 * @param {string} a
 * @param {string} b
 */
export async function sameFile(a, b) {
  const [one, other] = await Promise.all([a, b].map((path) => stat(path, { bigint: true }).catch(() => undefined)));
  return one !== undefined && other !== undefined && one.isFile() && one.dev === other.dev && one.ino === other.ino;
}

/**
 * One line that says what went wrong.
 * @param {unknown} error
 */
export function sentence(error) {
  if (!(error instanceof Error)) return String(error);
  const { code = '' } = /** @type {NodeJS.ErrnoException} */ (error);
  return MEANINGS[code] ?? error.message.replace(/\s*\n\s*/g, ' ');
}
