/** Numbers as people read them. */
import { say, words } from '../words/say.js';

const { language } = words;
const whole = new Intl.NumberFormat(language, { maximumFractionDigits: 0 });
const digits = new Intl.NumberFormat(language, { maximumSignificantDigits: 3 });
const two = new Intl.NumberFormat(language, { maximumSignificantDigits: 2 });
const tenths = new Intl.NumberFormat(language, { minimumFractionDigits: 1, maximumFractionDigits: 1 });
const compact = new Intl.NumberFormat(language, { notation: 'compact', maximumSignificantDigits: 2 });

export const count = (/** @type {number} */ n) => whole.format(n);

export const points = (/** @type {number} */ n) => (n === 1 ? say('1 point') : say('{count} points', { count: count(n) }));

/** As on an axis: 30K, 1.5M. */
export const short = (/** @type {number} */ n) => compact.format(n);

/** Three digits, with a power of ten where zeros would crowd them out. */
export function length(/** @type {number} */ value) {
  const size = Math.abs(value);
  if (size === 0 || (size >= 1e-4 && size < 1e7)) return digits.format(value);
  const [mantissa, exponent] = value.toExponential(2).split('e');
  return `${mantissa} × 10${superscript(exponent)}`;
}

function superscript(/** @type {string} */ digits) {
  return digits.replace('+', '').replace('-', '⁻').replace(/\d/g, (digit) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(digit)]);
}

/** A factor: 1.5×. */
export const times = (/** @type {number} */ factor) => `${digits.format(factor)}×`;

/** A fraction as a percentage with two digits. */
export function percent(/** @type {number} */ fraction) {
  return `${two.format(100 * fraction)} %`;
}

export function duration(/** @type {number} */ ms) {
  if (ms < 1000) return `${whole.format(ms)} ms`;
  return ms < 60_000 ? `${tenths.format(ms / 1000)} s` : `${Math.floor(ms / 60_000)} min ${Math.round((ms % 60_000) / 1000)} s`;
}

/** A volume in cubic millimetres, in the unit that suits its size. */
export function volume(/** @type {number} */ cubic) {
  const [unit, factor] = cubic < 1000 ? ['mm³', 1] : cubic < 1e9 ? ['cm³', 1e3] : ['m³', 1e9];
  return `${length(cubic / Number(factor))} ${unit}`;
}

export function bytes(/** @type {number} */ n) {
  return n < 1e6 ? `${Math.ceil(n / 1e3)} kB` : `${digits.format(n / 1e6)} MB`;
}
