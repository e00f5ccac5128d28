/**
 * Whose scan is computed next. One at a time, as the engine has one queue; those that can be seen come before those that
 * cannot, whoever asked first.
 */

/** @typedef {{ seen: () => boolean, go: () => void }} Waiting */

/** @type {Waiting[]} */
const waiting = [];
let busy = false;

/**
 * Does the work when its turn has come.
 * @template T
 * @param {{ seen: () => boolean, signal: AbortSignal }} who
 * @param {() => Promise<T>} work
 * @returns {Promise<T>}
 */
export async function inTurn({ seen, signal }, work) {
  await turn(seen, signal);
  try {
    signal.throwIfAborted();
    return await work();
  } finally {
    busy = false;
    next();
  }
}

/** @param {() => boolean} seen @param {AbortSignal} signal @returns {Promise<void>} */
function turn(seen, signal) {
  return new Promise((resolve, reject) => {
    const entry = { seen, go: () => (signal.removeEventListener('abort', leave), resolve()) };
    const leave = () => {
      waiting.splice(waiting.indexOf(entry), 1);
      reject(signal.reason);
    };
    if (signal.aborted) return reject(signal.reason);
    signal.addEventListener('abort', leave, { once: true });
    waiting.push(entry);
    next();
  });
}

function next() {
  if (busy || waiting.length === 0) return;
  const first = waiting.findIndex(({ seen }) => seen());
  const [entry] = waiting.splice(Math.max(first, 0), 1);
  busy = true;
  entry.go();
}
