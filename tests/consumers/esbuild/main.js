import { run } from '../page.js';

run({ workerUrl: 'pointweave-worker.js', wasmUrl: 'wasm' });
