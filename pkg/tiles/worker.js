/** A thread that does steps. */
import { parentPort } from 'node:worker_threads';
import { PointweaveError, toRecord } from '../engine/errors.js';
import { Folder } from './folder.js';
import { runStep } from './run-step.js';

const port = /** @type {import('node:worker_threads').MessagePort} */ (parentPort);
const NEVER = new AbortController().signal;

port.on('message', async (/** @type {import('./schedule.js').Work & { path: string }} */ { path, ...work }) => {
  try {
    await runStep(new Folder(path, NEVER), work);
    port.postMessage({});
  } catch (error) {
    const { code, message } = /** @type {NodeJS.ErrnoException} */ (error);
    // That of the system keeps its code: a full disk is none of ours.
    port.postMessage({ error: code && !(error instanceof PointweaveError) ? { system: true, code, message } : toRecord(error) });
  }
});
