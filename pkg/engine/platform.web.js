/** Browsers. Nothing here runs before an engine is made, so a server may import it. */
import { PointweaveError } from './errors.js';
import { loadBindings } from './wasm-bindings.js';
import { compileOnce } from './modules.js';
import { startScript } from './worker-script.js';

/** @type {import('./engine.js').Platform} */
export const platform = {
  worker: true,
  cores: () => navigator.hardwareConcurrency ?? 1,
  threads: () =>
    globalThis.crossOriginIsolated
      ? { possible: true, reason: 'the page is cross-origin isolated' }
      : { possible: false, reason: 'the page is not cross-origin isolated' },
  compile: (build, wasmUrl) => compileOnce(wasmFile(build, wasmUrl), compileFrom),
  loadBindings,
  startWorker(workerUrl) {
    const worker = startScript(workerUrl);
    return {
      post: (message, transfer) => worker.postMessage(message, transfer),
      listen(receive, fail) {
        worker.onmessage = ({ data }) => receive(data);
        worker.onerror = ({ message }) => fail(message ?? 'its script did not load');
        worker.onmessageerror = () => fail('a message was not understood');
      },
      hold() {}, // a page never waits for its workers
      terminate: () => worker.terminate(),
    };
  },
};

/**
 * The URLs are spelled out for bundlers to see them.
 * @param {import('./core.js').WasmBuild} build
 * @param {import('../types.js').EngineOptions['wasmUrl']} given
 */
function wasmFile(build, given) {
  const file = {
    single: () => new URL('../wasm/single/pointweave_bg.wasm', import.meta.url),
    threads: () => new URL('../wasm/threads/pointweave_bg.wasm', import.meta.url),
    files: () => new URL('../wasm/files/pointweave_bg.wasm', import.meta.url),
    las: () => new URL('../wasm/las/pointweave_bg.wasm', import.meta.url),
    e57: () => new URL('../wasm/e57/pointweave_bg.wasm', import.meta.url),
    packed: () => new URL('../wasm/packed/pointweave_bg.wasm', import.meta.url),
    pictures: () => new URL('../wasm/pictures/pointweave_bg.wasm', import.meta.url),
    exports: () => new URL('../wasm/exports/pointweave_bg.wasm', import.meta.url),
    prepare: () => new URL('../wasm/prepare/pointweave_bg.wasm', import.meta.url),
    light: () => new URL('../wasm/light/pointweave_bg.wasm', import.meta.url),
    samples: () => new URL('../wasm/samples/pointweave_bg.wasm', import.meta.url),
  }[build]();
  if (!given) return file.href;
  if (typeof given === 'string' || given instanceof URL) return new URL(`${given}`.replace(/\/?$/, `/${build}/pointweave_bg.wasm`), location.href).href;
  return given[build] ? new URL(given[build], location.href).href : file.href;
}

/** @param {string} url */
async function compileFrom(url) {
  const response = await fetch(url);
  if (!response.ok) {
    throw new PointweaveError({ code: 'load-failed', message: `${url} did not load: ${response.status} ${response.statusText}`, found: response.status });
  }
  const wasm = response.headers.get('content-type')?.startsWith('application/wasm');
  return wasm ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
}
