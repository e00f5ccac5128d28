/** A worker of the pool, in Node. */
import { parentPort, workerData } from 'node:worker_threads';
import { lendThread } from './pool.js';
import * as glue from './wasm/threads/pointweave.js';

await lendThread(glue, workerData, () => parentPort?.postMessage('ready'));
