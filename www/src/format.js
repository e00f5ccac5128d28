/** Numbers as people read them. */

const whole = new Intl.NumberFormat('en', { maximumFractionDigits: 0 });
const short = new Intl.NumberFormat('en', { maximumSignificantDigits: 3 });

export const count = (/** @type {number} */ n) => whole.format(n);

/** Three digits, with a power of ten where zeros would crowd them out. */
export function length(/** @type {number} */ value) {
  const size = Math.abs(value);
  if (size === 0 || (size >= 1e-4 && size < 1e7)) return short.format(value);
  const [digits, exponent] = value.toExponential(2).split('e');
  return `${digits} × 10${superscript(exponent)}`;
}

function superscript(/** @type {string} */ digits) {
  return digits.replace('+', '').replace('-', '⁻').replace(/\d/g, (digit) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(digit)]);
}

/** A fraction as a percentage with two digits. */
export function percent(/** @type {number} */ fraction) {
  return `${new Intl.NumberFormat('en', { maximumSignificantDigits: 2 }).format(100 * fraction)} %`;
}

export function duration(/** @type {number} */ ms) {
  if (ms < 1000) return `${whole.format(ms)} ms`;
  return ms < 60_000 ? `${(ms / 1000).toFixed(1)} s` : `${Math.floor(ms / 60_000)} min ${Math.round((ms % 60_000) / 1000)} s`;
}

export function bytes(/** @type {number} */ n) {
  return n < 1e6 ? `${Math.ceil(n / 1e3)} kB` : `${short.format(n / 1e6)} MB`;
}
