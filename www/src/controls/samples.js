/** The simulated scans, at the sizes of the paper's examples. */
export const SAMPLES = /** @type {const} */ ({
  duck: { title: 'Toy duck', count: 35_647 },
  pig: { title: 'Toy pig', count: 171_875 },
  part: { title: 'Machined part', count: 60_000 },
});

/** @typedef {keyof typeof SAMPLES} SampleName */

/** @returns {name is SampleName} */
export function isSample(/** @type {string | null} */ name) {
  return name !== null && Object.hasOwn(SAMPLES, name);
}
