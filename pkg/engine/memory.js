/** The memory that the threads of an engine share. It states beforehand how far it may grow. */

const PAGE = 65_536;

/** What the threads build starts with: the 4 MiB that `xtask` tells its linker, and a page that wasm-bindgen adds. */
const FIRST_PAGES = 65;

/** All that WebAssembly can address, and less for where so much cannot be promised: on phones, above all on iOS. */
const LIMITS = [32, 31, 30, 29, 28].map((exponent) => 2 ** exponent);

/**
 * The largest that is to be had here.
 * @returns {{ memory: WebAssembly.Memory, note: string }} what to say of it in reports, or ''
 * @throws {RangeError} what the smallest was refused with
 */
export function sharedMemory() {
  /** @type {unknown} */
  let refusal;
  for (const limit of LIMITS) {
    try {
      const memory = new WebAssembly.Memory({ initial: FIRST_PAGES, maximum: limit / PAGE, shared: true });
      return { memory, note: limit === LIMITS[0] ? '' : `memory is limited to ${limit / 2 ** 20} MiB here` };
    } catch (error) {
      refusal = error;
    }
  }
  throw refusal;
}
