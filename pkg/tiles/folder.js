/** The folder of a tileset: files are there whole or not at all. */
import { createHash } from 'node:crypto';
import { mkdir, readFile, rm, stat } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { writeOutput } from '../files/disk.js';
import { PointweaveError } from '../engine/errors.js';

export class Folder {
  /** @param {string} path @param {AbortSignal} signal */
  constructor(path, signal) {
    this.path = path;
    this.signal = signal;
  }

  /** @param {string} name */
  at(name) {
    return join(this.path, name);
  }

  /** @param {string} name */
  async has(name) {
    return Boolean(await stat(this.at(name)).catch(() => undefined));
  }

  /** @param {string} name @returns {Promise<Uint8Array>} */
  async read(name) {
    try {
      const bytes = await readFile(this.at(name), { signal: this.signal });
      // What is at no multiple of four in its buffer is moved, as numbers are read of it in place.
      return bytes.byteOffset % 4 === 0 ? bytes : new Uint8Array(bytes);
    } catch (error) {
      this.signal.throwIfAborted();
      throw this.#missing(name, error);
    }
  }

  /** That a file is there. @param {string} name */
  async expect(name) {
    await stat(this.at(name)).catch((error) => {
      throw this.#missing(name, error);
    });
  }

  /** @param {string} name @param {any} error */
  #missing(name, { code }) {
    return new PointweaveError({ code: 'bad-file', message: `${this.at(name)} cannot be read (${code}): the step that makes it has not run`, expected: name });
  }

  /** @param {string} name @returns {Promise<any>} */
  async json(name) {
    const text = new TextDecoder().decode(await this.read(name));
    try {
      return JSON.parse(text);
    } catch {
      throw new PointweaveError({ code: 'bad-file', message: `${this.at(name)} is damaged: remove it, and run the step that makes it`, expected: 'JSON' });
    }
  }

  /** @param {string} name @param {Uint8Array} bytes */
  async write(name, bytes) {
    await mkdir(dirname(this.at(name)), { recursive: true });
    await writeOutput(this.at(name), bytes, this.signal);
  }

  /** @param {string} name @param {unknown} value */
  async writeJson(name, value) {
    await this.write(name, new TextEncoder().encode(`${JSON.stringify(value)}\n`));
  }

  /** @param {string} name */
  async remove(name) {
    await rm(this.at(name), { recursive: true, force: true });
  }
}

/** @param {Uint8Array} bytes */
export function sha256(bytes) {
  return createHash('sha256').update(bytes).digest('hex');
}
