import { job, show } from '../job.js';

show(job({ workerUrl: 'pointweave-worker.js', wasmUrl: 'wasm' }));
