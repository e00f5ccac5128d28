/**
 * One wasm instance and the calls into it. Runs where it is imported: in a worker, or in the caller's
 * own thread.
 */
import { PointweaveError, fromTrap, isFatal } from './errors.js';
import { track } from './progress.js';

/** @import { Build, Progress } from '../types.js' */

/**
 * A function of `src/js` and what it takes; a progress callback is added as the last argument.
 * @typedef {object} Request
 * @property {'prepare' | 'simplify' | 'texture' | 'poster' | 'reduce' | 'reconstruct' | 'inspect' | 'readStart' | 'readPush' | 'readEnd' | 'readFile' | 'readPicture' | 'decodePicture' | 'openArchive' | 'unpack' | 'lazChunks' | 'write' | 'countPoints' | 'takeCounts' | 'planTiles' | 'openLeaves' | 'splitPoints' | 'sampleTile' | 'measureTiles' | 'tileSurroundings' | 'reduceTile' | 'sample' | 'buildPool' | 'lendThread'} call
 * @property {unknown[]} args
 */

/**
 * An instance and the functions that wasm-bindgen writes for it, as far as they are used here.
 * @typedef {{
 *   instantiate: (from: { module_or_path: WebAssembly.Module, memory?: WebAssembly.Memory }) => Promise<unknown>,
 *   panicMessage: () => string,
 * } & { [call in Request['call']]?: (...args: any[]) => any }} Bindings
 */

/**
 * The engine's builds, and those that hold readers of files, decoders of pictures, writers, recipes, what makes meshes light, or samples alone.
 * @typedef {Build | 'files' | 'las' | 'e57' | 'packed' | 'pictures' | 'exports' | 'prepare' | 'light' | 'samples'} WasmBuild
 */

/**
 * @typedef {object} CoreOptions
 * @property {WasmBuild} build
 * @property {WebAssembly.Module} module the compiled wasm of that build
 * @property {WebAssembly.Memory} [memory] of the threads build, shared by all instances of a pool
 */

export class Core {
  /** @type {Bindings} */
  #bindings;
  /** Whether it can be called again. */
  alive = true;

  /** @param {Bindings} bindings an instance of its own, started */
  constructor(bindings) {
    this.#bindings = bindings;
  }

  /**
   * @param {Bindings} bindings
   * @param {CoreOptions} options
   */
  static async start(bindings, { module, memory }) {
    await bindings.instantiate({ module_or_path: module, memory });
    return new Core(bindings);
  }

  /**
   * @param {Request} request
   * @param {(progress: Progress) => boolean} listener its answer true stops the work
   * @returns {any} what the call gives; arrays in it belong to the caller
   */
  run({ call, args }, listener) {
    const progress = track(call, listener);
    try {
      const result = this.#bindings[call]?.(...args, progress.update);
      progress.finish();
      return result;
    } catch (thrown) {
      const error = isRecord(thrown) ? new PointweaveError(thrown) : fromTrap(thrown, this.#panic());
      this.alive = !isFatal(error);
      throw error;
    }
  }

  #panic() {
    try {
      return this.#bindings.panicMessage();
    } catch {
      return ''; // the instance is too broken even to say why
    }
  }
}

/**
 * An error that `src/js/wasm.rs` made, as opposed to a trap.
 * @param {unknown} thrown
 * @returns {thrown is import('./errors.js').ErrorRecord}
 */
function isRecord(thrown) {
  return typeof thrown === 'object' && thrown !== null && !(thrown instanceof Error) && 'code' in thrown;
}
