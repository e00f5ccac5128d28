/**
 * The one error type of the package, and how an error travels: out of wasm and across a worker's
 * border it is a plain {@link ErrorRecord}, to the caller it is a {@link PointweaveError}.
 */

/**
 * @typedef {object} ErrorRecord
 * @property {string} code
 * @property {string} message
 * @property {number} [index]
 * @property {unknown} [expected]
 * @property {unknown} [found]
 * @property {import('../types.js').FileCloud['file']['table']} [table]
 */

/** Thrown by every function of the package, except that an abort rejects with its signal's reason. */
export class PointweaveError extends Error {
  /** @param {ErrorRecord} record */
  constructor({ code, message, index, expected, found, table }) {
    super(message);
    this.name = 'PointweaveError';
    /** Stable and meant for programs, such as `'empty-cloud'`; the README lists them all. */
    this.code = code;
    /** The point, line or byte that is wrong, where there is one. */
    this.index = index;
    /** What would have been right. */
    this.expected = expected;
    /** What was there instead. */
    this.found = found;
    /** Of a table of text that could not be read: its first rows, for a person who knows what its columns are. */
    this.table = table;
  }
}

/**
 * What of an error survives structured cloning.
 * @param {unknown} error
 * @returns {ErrorRecord}
 */
export function toRecord(error) {
  if (error instanceof PointweaveError) {
    const { code, message, index, expected, found, table } = error;
    return { code, message, index, expected, found, table };
  }
  return { code: 'internal', message: error instanceof Error ? error.message : String(error) };
}

/**
 * Whether an instance that threw this must not be called again.
 * @param {unknown} error
 */
export function isFatal(error) {
  return !(error instanceof PointweaveError) || error.code === 'internal' || error.code === 'out-of-memory';
}

/**
 * The error for a wasm instance that died while it worked.
 *
 * A Rust panic leaves its text behind. A failed allocation aborts without any, by an `unreachable`
 * instruction, or is a panic that says the capacity overflowed.
 * @param {unknown} trap what the call into wasm threw
 * @param {string} panic the panic's text, or ''
 */
export function fromTrap(trap, panic) {
  const text = trap instanceof Error ? trap.message : String(trap);
  const allocation = panic
    ? /capacity overflow|memory allocation/.test(panic)
    : trap instanceof WebAssembly.RuntimeError && /unreachable/.test(text);
  return allocation
    ? new PointweaveError({
        code: 'out-of-memory',
        message: 'the memory that WebAssembly can have is not enough for this cloud: reduce it in parts',
      })
    : new PointweaveError({ code: 'internal', message: panic || text });
}
