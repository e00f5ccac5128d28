/**
 * Calls into one instance in the caller's thread: `direct.js` and `direct.node.js` export them. Those of the engine are synchronous;
 * `prepare`, `simplify`, `poster`, `read`, `write` and `sample` are wasm of their own, which is loaded when they are called.
 */
import { counted } from './amount.js';
import { direction } from './axes.js';
import { keepAlive } from './keep-alive.js';
import { cloudArgument, resultArgument } from './clouds.js';
import { Core } from './core.js';
import { PointweaveError } from './errors.js';
import { lightened, meshArgument } from './light.js';
import { withInstance } from './instance.js';
import { runHere } from './worker-host.js';
import { checkCoreOptions, checkModel, checkOptions } from './options.js';
import { checkRecipe, lookedAt, preparedArgument, preparedOf } from './preparing.js';
import { encoded, opened } from './pictures.js';
import { posterArguments, posterOf } from './posing.js';
import { badOption } from './rules.js';
import { encoderFor } from '../files/compressor.js';
import { readScan } from '../files/archive.js';
import { readerError } from '../files/reading.js';
import { signed } from './reports.js';
import { byteSourceOf, nameOf } from '../files/byte-source.js';

const CHOICE = /** @type {const} */ ({ build: 'single', threads: 1, reason: 'called directly' });

/** @typedef {{ platform: Parameters<typeof makeLoad>[0], wasmUrl: import('../types.js').EngineOptions['wasmUrl'] }} Place where wasm is loaded from */

/**
 * What wasm takes, of what a synchronous call was given.
 * @type {{ [call in 'reduce' | 'reconstruct' | 'inspect']: (subject: any, own: Record<string, any>, transfer?: boolean) => unknown[] }}
 */
const ARGUMENTS = {
  reduce: (cloud, own, transfer) => withCount(cloudArgument(cloud, transfer), own),
  reconstruct: (cloud, own, transfer) => withCount(cloudArgument(cloud, transfer), own),
  inspect: (cloud, _, transfer) => [cloudArgument(cloud, transfer)],
};

/** @param {import('../types.js').PointCloud} cloud @param {Record<string, any>} own */
function withCount(cloud, own) {
  return [cloud, counted(own, cloud)];
}

/** Calls that wait for wasm of their own. @type {Record<string, (place: Place, ...given: [any, any, any]) => Promise<any>>} */
const WAITING = { prepare, simplify, poster, read, write, sample };

/**
 * @param {Pick<import('./engine.js').Platform, 'compile' | 'loadBindings'>} platform
 * @returns {typeof import('../types.core.js').load}
 */
export function makeLoad(platform) {
  return async (options) => {
    const { wasmUrl } = checkCoreOptions(options);
    const core = await keepAlive(start(platform, wasmUrl));
    const calls = Object.keys(ARGUMENTS).map((call) => [
      call,
      (/** @type {any} */ subject, /** @type {any} */ options) => run(core, /** @type {keyof typeof ARGUMENTS} */ (call), subject, options),
    ]);
    const waiting = Object.entries(WAITING).map(([call, f]) => [
      call,
      (/** @type {[any, any, any]} */ ...given) => f({ platform, wasmUrl }, ...given),
    ]);
    return Object.fromEntries([...calls, ...waiting]);
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
 * @param {any} subject
 * @param {unknown} options
 */
function run(core, call, subject, options) {
  const { own: { prepare, ...own }, transfer, signal, onProgress } = checkOptions(call, options);
  signal?.throwIfAborted();
  if (prepare) throw badOption('prepare', "undefined: call prepare before, as it waits for its wasm", prepare);
  if (own.triangles !== undefined) throw badOption('triangles', "undefined: call simplify after, as it waits for its wasm", own.triangles);
  for (const option of ['texture', 'lods']) {
    if (own[option]) throw badOption(option, 'undefined: only an engine does it, as its wasm has to be waited for', own[option]);
  }
  if (!core.alive) throw new PointweaveError({ code: 'internal', message: 'a call before has broken this instance: load another' });
  return signed(runHere(core, { call, args: ARGUMENTS[call](subject, own, transfer) }, { signal, onProgress }), CHOICE);
}

/**
 * Does something with an instance that is made for it.
 * @template T
 * @param {Place} place
 * @param {Exclude<import('./core.js').WasmBuild, import('../types.js').Build>} build
 * @param {import('./worker-host.js').Watch} watch
 * @param {(ask: (request: import('./core.js').Request) => Promise<any>) => Promise<T>} job
 * @returns {Promise<T>}
 */
async function withModule({ platform: { compile, loadBindings }, wasmUrl }, build, watch, job) {
  return keepAlive(withInstance([compile(build, wasmUrl), loadBindings(build)], build, watch, job));
}

/** @param {Place} place @param {any} cloud @param {any} steps @param {unknown} options */
async function prepare(place, cloud, steps, options) {
  const { transfer, ...watch } = checkOptions('prepare', options);
  watch.signal?.throwIfAborted();
  const recipe = checkRecipe(steps);
  const given = preparedArgument(cloud, recipe, transfer);
  const args = [lookedAt(given), recipe];
  return withModule(place, 'prepare', watch, async (ask) => preparedOf(given, await ask({ call: 'prepare', args })));
}

/** @param {Place} place @param {any} mesh @param {unknown} options */
async function simplify(place, mesh, options) {
  const { own, transfer, ...watch } = checkOptions('simplify', options);
  watch.signal?.throwIfAborted();
  const args = [meshArgument(mesh, transfer), own];
  return withModule(place, 'light', watch, async (ask) => lightened(mesh, await ask({ call: 'simplify', args })));
}

/** @param {Place} place @param {any} what @param {unknown} options */
async function poster(place, what, options) {
  const { own, transfer, ...watch } = checkOptions('poster', options);
  watch.signal?.throwIfAborted();
  const [shown, settings] = posterArguments(what, own, transfer);
  const args = [await opened(shown, decoder(place, watch)), settings];
  return withModule(place, 'light', watch, async (ask) => posterOf(await ask({ call: 'poster', args }), settings));
}

/** @param {Place} place @param {any} data @param {unknown} options */
async function read(place, data, options) {
  const { own, transfer, signal = NEVER, onProgress } = checkOptions('read', options);
  signal.throwIfAborted();
  const file = byteSourceOf(data, transfer);
  /** @type {import('../files/archive.js').Open} */
  const open = (build, job) => withModule(place, build, { signal }, job).catch((error) => {
    throw readerError(error, build);
  });
  return readScan(open, file, { name: nameOf(data), ...own }, { signal, onProgress });
}

/** What reads pictures. @param {Place} place @param {import('./worker-host.js').Watch} watch @returns {import('./pictures.js').Decode} */
function decoder(place, { signal }) {
  return (file) => withModule(place, 'pictures', { signal }, (ask) => ask({ call: 'decodePicture', args: [file] }));
}

/** @param {Place} place @param {any} result @param {unknown} options */
async function write(place, result, options) {
  const { own, transfer, ...watch } = checkOptions('write', options);
  const { meshopt, pictures, up, ...plain } = own;
  if (meshopt) {
    throw new PointweaveError({
      code: 'bad-option',
      message: "meshopt is not done here: give what write makes to compress of 'pointweave/meshopt'",
      expected: 'false',
      found: meshopt,
    });
  }
  watch.signal?.throwIfAborted();
  const encode = await encoderFor(pictures);
  const given = resultArgument(result, transfer);
  const args = [encode ? await encoded(given, decoder(place, watch), encode) : given, { ...plain, ...(up && { up: direction(up) }) }];
  return withModule(place, 'exports', watch, (ask) => ask({ call: 'write', args }));
}

/** @param {Place} place @param {any} model @param {unknown} options */
async function sample(place, model, options) {
  const { own, ...watch } = checkOptions('sample', options);
  watch.signal?.throwIfAborted();
  const args = [{ model: checkModel(model), ...own }];
  return withModule(place, 'samples', watch, (ask) => ask({ call: 'sample', args }));
}

const NEVER = new AbortController().signal;
