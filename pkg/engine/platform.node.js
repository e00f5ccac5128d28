/** Node. */
import { readFile } from 'node:fs/promises';
import { availableParallelism } from 'node:os';
import { pathToFileURL } from 'node:url';
import { Worker } from 'node:worker_threads';
import { PointweaveError } from './errors.js';
import { loadBindings } from './wasm-bindings.js';
import { compileOnce } from './modules.js';

/** @type {import('./engine.js').Platform} */
export const platform = {
  worker: false,
  cores: availableParallelism,
  threads: () => ({ possible: true, reason: 'Node has threads' }),
  compile: (build, wasmUrl) => compileOnce(wasmFile(build, wasmUrl).href, compileFrom),
  loadBindings,
  startWorker(workerUrl) {
    const script = workerUrl ? new URL(workerUrl, pathToFileURL('./')) : new URL('../worker.node.js', import.meta.url);
    const worker = new Worker(script, { name: 'pointweave', execArgv: [] });
    return {
      post: (message, transfer) => worker.postMessage(message, transfer),
      listen(receive, fail) {
        worker.on('message', receive);
        worker.on('error', (error) => fail(error.message));
        worker.on('exit', (code) => fail(`it exited with ${code}`));
        worker.unref(); // a listener holds the process, so only now
      },
      hold: (busy) => (busy ? worker.ref() : worker.unref()),
      terminate: () => void worker.terminate(),
    };
  },
};

/**
 * @param {import('./core.js').WasmBuild} build
 * @param {import('../types.js').EngineOptions['wasmUrl']} given
 * @returns {URL}
 */
function wasmFile(build, given) {
  const here = pathToFileURL('./');
  if (typeof given === 'string' || given instanceof URL) return new URL(`${given}`.replace(/\/?$/, `/${build}/pointweave_bg.wasm`), here);
  return given?.[build] ? new URL(given[build], here) : new URL(`../wasm/${build}/pointweave_bg.wasm`, import.meta.url);
}

/** @param {string} url */
async function compileFrom(url) {
  try {
    return await WebAssembly.compile(await bytesAt(url));
  } catch (error) {
    throw new PointweaveError({ code: 'load-failed', message: `${url} did not load: ${error instanceof Error ? error.message : error}` });
  }
}

/** @param {string} url */
async function bytesAt(url) {
  if (!/^https?:/.test(url)) return readFile(new URL(url));
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}
