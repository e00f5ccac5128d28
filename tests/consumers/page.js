/** What every page of these does, and how it says what came out. */
import { elements } from './elements.js';
import { job } from './job.js';

/** Writes the results into the page, where the test reads them. @param {{ workerUrl?: string, wasmUrl?: string }} [options] */
export function run(options) {
  const write = (result) => (document.documentElement.dataset.result = JSON.stringify(result));
  const results = job(options).then(async (said) => ({ ...said, ...(await elements(options)) }));
  results.then(write, (error) => write({ error: `${error.code}: ${error.message}` }));
}
