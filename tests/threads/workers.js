/** Starts workers that lend their threads. This file is the workers' script, too. */

const START = 'lend-thread';

// Named here, or Firefox would collect them.
const workers = [];

export async function startWorkers(bindings, module, memory, threads) {
  await Promise.all(Array.from({ length: threads }, () => new Promise((resolve, reject) => {
    const worker = new Worker(new URL(import.meta.url), { type: 'module' });
    workers.push(worker);
    worker.onmessage = resolve;
    worker.onerror = (event) => reject(new Error(event.message));
    worker.postMessage({ type: START, bindings, module, memory });
  })));
}

// In a worker alone: whoever imports this file for `startWorkers` gets no such message.
addEventListener('message', async ({ data }) => {
  if (data?.type !== START) return;
  const bindings = await import(data.bindings);
  await bindings.default({ module_or_path: data.module, memory: data.memory });
  postMessage('ready');
  bindings.lendThread();
});
