/** A worker of the pool, in a browser. */
import { lendThread } from './pool.js';
import * as glue from './wasm/threads/pointweave.js';

onmessage = ({ data }) => lendThread(glue, data, () => postMessage('ready'));
