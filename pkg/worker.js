/** A browser's worker. */
import { serve } from './engine/serve.js';

const scope = /** @type {Worker} */ (/** @type {unknown} */ (globalThis));

serve({
  listen: (receive) => void (scope.onmessage = ({ data }) => receive(data)),
  post: (message, transfer = []) => scope.postMessage(message, transfer),
});
