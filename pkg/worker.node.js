/** A Node worker. */
import { parentPort } from 'node:worker_threads';
import { serve } from './engine/serve.js';

const port = /** @type {import('node:worker_threads').MessagePort} */ (parentPort);

serve({
  listen: (receive) => void port.on('message', receive),
  post: (message, transfer = []) => port.postMessage(message, transfer),
});
