/** Calls into one instance in the caller's thread, all but `read` synchronous: `direct.js` and `direct.node.js` export them. */
import { direction } from './axes.js';
import { keepAlive } from './keep-alive.js';
import { cloudArgument, resultArgument } from './clouds.js';
import { Core } from './core.js';
import { PointweaveError } from './errors.js';
import { inProcessHost, runHere } from './worker-host.js';
import { EXPORTED, checkCoreOptions, checkModel, checkOptions } from './options.js';
import { readScan } from '../files/archive.js';
import { readerError } from '../files/reading.js';
import { signed } from './reports.js';
import { byteSourceOf } from '../files/byte-source.js';

const CHOICE = /** @type {const} */ ({ build: 'single', threads: 1, reason: 'called directly' });

/**
 * What wasm takes, of what a call was given.
 * @type {{ [call in Exclude<keyof import('../types.core.js').Core, 'read'>]: (subject: any, own: Record<string, any>, transfer?: boolean) => unknown[] }}
 */
const ARGUMENTS = {
  reduce: (cloud, own, transfer) => [cloudArgument(cloud, transfer), own],
  reconstruct: (cloud, own, transfer) => [cloudArgument(cloud, transfer), own],
  inspect: (cloud, _, transfer) => [cloudArgument(cloud, transfer)],
  write: (result, own, transfer) => [resultArgument(result, transfer), ownWriters(own)],
  sample: (model, own) => [{ model: checkModel(model), ...own }],
};

/** Compression, and writers that are wasm of their own, wait for their loading, and no call here waits. @param {Record<string, any>} own */
function ownWriters({ meshopt, up, ...plain }) {
  if (EXPORTED.includes(plain.format)) {
    const message = `${plain.format} is not written here: the engine's write does it`;
    throw new PointweaveError({ code: 'bad-option', message, expected: 'ply, xyz, glb, obj or stl', found: plain.format });
  }
  if (!meshopt) return { ...plain, ...(up && { up: direction(up) }) };
  throw new PointweaveError({
    code: 'bad-option',
    message: "meshopt is not done here: give what write makes to compress of 'pointweave/meshopt'",
    expected: 'false',
    found: meshopt,
  });
}

/**
 * @param {Pick<import('./engine.js').Platform, 'compile' | 'loadBindings'>} platform
 * @returns {typeof import('../types.core.js').load}
 */
export function makeLoad(platform) {
  return async (options) => {
    const { wasmUrl } = checkCoreOptions(options);
    const core = await keepAlive(start(platform, wasmUrl));
    const calls = Object.entries(ARGUMENTS).map(([call, args]) => [
      call,
      (/** @type {any} */ subject, /** @type {any} */ options) =>
        run(core, /** @type {keyof typeof ARGUMENTS} */ (call), (own, transfer) => args(subject, own, transfer), options),
    ]);
    return Object.fromEntries([...calls, ['read', (/** @type {any} */ data, /** @type {any} */ options) => read(platform, wasmUrl, data, options)]]);
  };
}

/**
 * @param {Parameters<typeof makeLoad>[0]} platform
 * @param {import('../types.js').EngineOptions['wasmUrl']} wasmUrl
 */
async function start(platform, wasmUrl) {
  const [module, bindings] = await Promise.all([platform.compile('single', wasmUrl), platform.loadBindings('single')]);
  return Core.start(bindings, { build: 'single', module });
}

/**
 * @param {Core} core
 * @param {keyof typeof ARGUMENTS} call
 * @param {(own: Record<string, any>, transfer?: boolean) => unknown[]} args
 * @param {unknown} options
 */
function run(core, call, args, options) {
  const { own, transfer, signal, onProgress } = checkOptions(call, options);
  signal?.throwIfAborted();
  if (!core.alive) throw new PointweaveError({ code: 'internal', message: 'a call before has broken this instance: load another' });
  return signed(runHere(core, { call, args: args(own, transfer) }, { signal, onProgress }), CHOICE);
}

/**
 * Readers are wasm of their own, which is loaded when a file of theirs comes: the one call that waits.
 * @param {Parameters<typeof makeLoad>[0]} platform
 * @param {import('../types.js').EngineOptions['wasmUrl']} wasmUrl
 * @param {any} data
 * @param {unknown} options
 */
async function read({ compile, loadBindings }, wasmUrl, data, options) {
  const { own, transfer, signal = NEVER, onProgress } = checkOptions('read', options);
  signal.throwIfAborted();
  const file = byteSourceOf(data, transfer);
  /** @type {import('../files/archive.js').Open} */
  const open = async (build, job) => {
    const [module, bindings] = await Promise.all([compile(build, wasmUrl), loadBindings(build)]);
    const host = await inProcessHost(bindings, { build, module });
    try {
      return await keepAlive(job((request) => host.run(request, { signal })));
    } catch (error) {
      throw readerError(error, build);
    }
  };
  return readScan(open, file, { name: data.name, ...own }, { signal, onProgress });
}

const NEVER = new AbortController().signal;
