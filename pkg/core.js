/**
 * One wasm instance and the calls into it. Runs where it is imported: in a worker, or in the caller's
 * own thread.
 */
import { PointweaveError, fromTrap } from './errors.js';

/** @import { Build, Progress } from './types.js' */

/**
 * What the wasm instance computes, by name, with its arguments as `src/wasm.rs` takes them.
 * @typedef {object} Request
 * @property {'reduce' | 'reconstruct' | 'inspect' | 'read' | 'write' | 'sample'} call
 * @property {unknown[]} args
 */

/**
 * The module that wasm-bindgen writes, as far as it is used here.
 * @typedef {{
 *   default: (from: { module_or_path: WebAssembly.Module }) => Promise<{ memory: WebAssembly.Memory }>,
 *   initThreadPool?: (threads: number) => Promise<unknown>,
 *   stopThreadPool?: () => void,
 *   panicMessage: () => string,
 * } & Record<Request['call'], (...args: unknown[]) => unknown>} Glue
 */

/**
 * @typedef {object} CoreOptions
 * @property {Build} build
 * @property {number} threads size of the pool; 1 for the single-threaded build
 * @property {WebAssembly.Module} module the compiled wasm of that build
 */

export class Core {
  /** @type {Glue} */
  #glue;

  /** Becomes true when the instance died; it must not be called again. */
  broken = false;

  /** @param {Glue} glue */
  constructor(glue) {
    this.#glue = glue;
  }

  /**
   * @param {Glue} glue an instance of its own
   * @param {CoreOptions} options
   */
  static async start(glue, { build, threads, module }) {
    await glue.default({ module_or_path: module });
    if (build === 'threads') await glue.initThreadPool?.(threads);
    return new Core(glue);
  }

  /**
   * @param {Request} request
   * @param {(progress: Progress) => boolean} onProgress its answer true stops the work
   * @returns {any} what the call gives; arrays in it belong to the caller
   */
  run({ call, args }, onProgress) {
    let last = 0;
    /** @type {(stage: Progress['stage'], fraction: number, overall: number) => boolean} */
    const report = (stage, fraction, overall) => {
      last = Math.max(last, Math.min(overall, 1));
      return onProgress({ stage, fraction, overall: last });
    };
    try {
      return this.#glue[call](...args, report);
    } catch (thrown) {
      if (isRecord(thrown)) throw new PointweaveError(thrown);
      this.broken = true;
      throw fromTrap(thrown, this.#panic());
    }
  }

  #panic() {
    try {
      return this.#glue.panicMessage();
    } catch {
      return ''; // the instance is too broken even to say why
    }
  }
}

/**
 * An error that `src/wasm.rs` made, as opposed to a trap.
 * @param {unknown} thrown
 * @returns {thrown is import('./errors.js').ErrorRecord}
 */
function isRecord(thrown) {
  return typeof thrown === 'object' && thrown !== null && !(thrown instanceof Error) && 'code' in thrown;
}
