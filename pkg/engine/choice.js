/** Which build an engine has, and why. */

/** @import { Build } from '../types.js' */
/** @import { Platform } from './engine.js' */

/** More threads than this cost memory and gain nothing. */
const MOST_AUTO_THREADS = 16;

/**
 * Threads need a worker: who waits for them must not be the caller's thread, which could then neither abort nor hear
 * that one of them died.
 * @param {Platform} platform
 * @param {'auto' | number} threads
 * @param {boolean} [worker]
 * @returns {{ build: Build, threads: number, reason: string }}
 */
export function chooseBuild(platform, threads, worker) {
  const single = /** @type {const} */ ({ build: 'single', threads: 1 });
  if (threads === 1) return { ...single, reason: 'one thread was asked for' };
  if (worker === false) return { ...single, reason: 'threads need a worker' };
  const { possible, reason } = platform.threads();
  if (!possible) return { ...single, reason };
  const wanted = threads === 'auto' ? Math.min(platform.cores(), MOST_AUTO_THREADS) : threads;
  if (wanted === 1) return { ...single, reason: 'there is one processor core' };
  return { build: 'threads', threads: wanted, reason };
}
