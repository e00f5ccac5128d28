/** Files in, files out. A result is there whole or not at all. */
import { randomUUID } from 'node:crypto';
import { constants, openAsBlob } from 'node:fs';
import { access, mkdir, readFile, realpath, rename, rm, stat, writeFile } from 'node:fs/promises';
import { basename, dirname, extname, join, relative, sep } from 'node:path';
import { addAbortSignal } from 'node:stream';
import { buffer } from 'node:stream/consumers';

/** What the system's codes mean. @type {Record<string, string>} */
const MEANINGS = {
  ENOENT: 'there is no such file or folder',
  EISDIR: 'it is a folder',
  EEXIST: 'a file has that name',
  ENOTDIR: 'a part of the path is no folder',
  EACCES: 'access is not allowed',
  EPERM: 'access is not allowed',
  ENOSPC: 'the disk is full',
  EROFS: 'the disk is read-only',
};

/**
 * @param {string} input a path, or - for standard input
 * @param {AbortSignal} signal
 * @returns {Promise<Blob | Uint8Array>}
 */
export function openInput(input, signal) {
  return input === '-' ? buffer(addAbortSignal(signal, process.stdin)) : explained('', open(input, signal));
}

/**
 * The bytes of a file in the folder of an input, or in a folder within; a path of another computer is its name alone.
 * @param {string} input
 */
export function besideOf(input) {
  const folder = input === '-' ? '.' : dirname(input);
  return async (/** @type {string} */ name) => {
    const path = name.replaceAll('\\', '/');
    // A library may have been renamed with its mesh.
    const own = /\.mtl$/i.test(path) ? [join(folder, `${basename(input).replace(/\.[^.]*$/, '')}.mtl`)] : [];
    const inside = [join(folder, path), join(folder, basename(path)), ...own].filter((file) => !relative(folder, file).startsWith(`..${sep}`));
    for (const file of inside) {
      const bytes = await readFile(file).catch(() => undefined);
      if (bytes) return bytes;
    }
  };
}

/**
 * A file stays on the disk, to be read slice by slice: it may be larger than memory. What is none (a device, a pipe) is taken whole.
 * @param {string} path
 * @param {AbortSignal} signal
 */
async function open(path, signal) {
  await access(path, constants.R_OK);
  return (await stat(path)).isFile() ? openAsBlob(path) : readFile(path, { signal });
}

/**
 * Whether there is a folder for the result: known before the work, not after it.
 * @param {string} output
 */
export async function checkPlace(output) {
  await explained(`'${output}' cannot be written: `, stat(dirname(output)));
}

/** `model.lod1.glb` beside `model.glb`. @param {string} output @param {number} level */
export function levelName(output, level) {
  const extension = extname(output);
  return `${output.slice(0, output.length - extension.length)}.lod${level}${extension}`;
}

/** @param {string} folder */
export async function makeFolder(folder) {
  await explained(`'${folder}' cannot be made: `, mkdir(folder, { recursive: true }));
}

/**
 * @param {string} output
 * @param {Uint8Array} bytes
 * @param {AbortSignal} signal
 */
export async function writeOutput(output, bytes, signal) {
  await explained(`'${output}' cannot be written: `, replace(output, bytes, signal));
}

/**
 * Writes beside the place and moves there at the end, or nothing stays. What is no file (a device, a pipe) is written
 * directly; a link is followed.
 * @param {string} output
 * @param {Uint8Array} bytes
 * @param {AbortSignal} signal
 */
async function replace(output, bytes, signal) {
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
 * What a promise gives, or the system's error in words and with its code.
 * @template T
 * @param {string} what
 * @param {Promise<T>} promise
 */
async function explained(what, promise) {
  try {
    return await promise;
  } catch (error) {
    const { code = '', message } = /** @type {NodeJS.ErrnoException} */ (error);
    throw Object.assign(new Error(what + (MEANINGS[code] ?? message)), { code });
  }
}

/**
 * One line that says what went wrong.
 * @param {unknown} error
 */
export function sentence(error) {
  return error instanceof Error ? error.message.replace(/\s*\n\s*/g, ' ') : String(error);
}
