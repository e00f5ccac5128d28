/** The simulated scans, with their number of points (`src/samples/model.rs`): the duck and the pig have the paper's. */
export const SAMPLES = /** @type {const} */ ({
  duck: { title: 'Toy duck', count: 35_647 },
  pig: { title: 'Toy pig', count: 171_875 },
  part: { title: 'Machined part', count: 60_000 },
  desk: { title: 'Duck on a table', count: 60_000 },
});

/** @typedef {keyof typeof SAMPLES} SampleName */

/** Samples that hold more than their object. @type {(string | undefined)[]} */
export const MESSY = ['desk'];

/** @returns {name is SampleName} */
export function isSample(/** @type {string | null} */ name) {
  return name !== null && Object.hasOwn(SAMPLES, name);
}
