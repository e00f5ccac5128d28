/**
 * Several files as one scan.
 *
 * A file by its place among those that came in together; `off`: it is listed and not shown. @typedef {{ of: number, off?: true }} Part
 */
import { prepareTogether } from './preparing.js';

/**
 * @import { Opened } from './session.js'
 * @import { Watch } from './preparing.js'
 */

/** More files that look like scans are a folder of this and that: one of them is opened. */
const MOST = 16;

/** Whether these files are opened as one scan. @param {import('./dropped.js').Dropped[]} all */
export function areParts(all) {
  const scans = all.filter(({ kind }) => kind === 'scan');
  return scans.length > 1 && scans.length <= MOST;
}

/** Reads several files as one scan; each of them once, whichever are shown. */
export class Reading {
  /** What was read of a file. @type {WeakMap<File, Opened>} */
  #known = new WeakMap();

  /**
   * The clouds of the files that can be read, and these as they lie as one.
   * @param {File[]} files
   * @param {(file: File, watch: Watch) => Promise<Opened>} read
   * @param {(file: File) => void} failed told of a file that cannot be read
   * @param {Required<Pick<Watch, 'signal' | 'onProgress'>>} watch
   */
  async all(files, read, failed, { signal, onProgress }) {
    /** @type {Opened[]} */
    const clouds = [];
    /** @type {unknown} */
    let why;
    for (const [i, file] of files.entries()) {
      try {
        const known = this.#known.get(file) ?? await read(file, { signal, onProgress: (progress) => onProgress({ ...progress, overall: (i + progress.overall) / files.length }) });
        this.#known.set(file, known);
        clouds.push(known);
      } catch (error) {
        signal.throwIfAborted();
        why = error;
        failed(file);
      }
    }
    if (!clouds.length) throw why;
    return { clouds, cloud: clouds.length > 1 ? await prepareTogether(clouds, signal) : clouds[0] };
  }
}
