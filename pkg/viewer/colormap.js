/**
 * Colours for numbers. Lightness rises evenly from the least value to the greatest, and the hue goes from blue to
 * yellow, so that the order is seen by everybody: with any kind of colour blindness, and in black and white.
 * The stops are OKLab colours (Ottosson, 2020): lightness, and chroma at a hue in degrees.
 */
const STOPS = [
  { lightness: 0.3, chroma: 0.115, hue: 272 },
  { lightness: 0.46, chroma: 0.1, hue: 238 },
  { lightness: 0.62, chroma: 0.105, hue: 182 },
  { lightness: 0.78, chroma: 0.14, hue: 132 },
  { lightness: 0.94, chroma: 0.165, hue: 105 },
];

/** Where there is nothing to measure. */
export const UNKNOWN = /** @type {const} */ ([150, 150, 150]);

const SIZE = 256;
/** sRGB triples from the least value to the greatest. */
export const RAMP = Uint8Array.from({ length: 3 * SIZE }, (_, i) => colorAt(Math.floor(i / 3) / (SIZE - 1))[i % 3]);

/**
 * sRGB triples of values between `low` and `high`; those beyond take the colour of the end, NaN is {@link UNKNOWN}.
 * @param {ArrayLike<number>} values
 * @param {number} low
 * @param {number} high
 */
export function colorize(values, low, high) {
  const scale = high > low ? (SIZE - 1) / (high - low) : 0;
  const out = new Uint8Array(3 * values.length);
  for (let i = 0; i < values.length; i++) {
    if (Number.isNaN(values[i])) {
      out.set(UNKNOWN, 3 * i);
      continue;
    }
    const at = 3 * Math.round(Math.min(SIZE - 1, Math.max(0, (values[i] - low) * scale)));
    for (let c = 0; c < 3; c++) out[3 * i + c] = RAMP[at + c];
  }
  return out;
}

/** The whole map as a CSS gradient to the right. */
export function cssGradient() {
  const stops = Array.from({ length: 17 }, (_, i) => `rgb(${colorAt(i / 16).join(' ')})`);
  return `linear-gradient(to right, ${stops.join(', ')})`;
}

/** The sRGB bytes at a share of the way from the least to the greatest. @param {number} share */
export function colorAt(share) {
  const place = Math.min(1, Math.max(0, share)) * (STOPS.length - 1);
  const k = Math.min(STOPS.length - 2, Math.floor(place));
  const [from, to] = [STOPS[k], STOPS[k + 1]];
  const mix = (/** @type {number} */ a, /** @type {number} */ b) => a + (b - a) * (place - k);
  const hue = (mix(from.hue, to.hue) * Math.PI) / 180;
  const chroma = mix(from.chroma, to.chroma);
  return srgb(mix(from.lightness, to.lightness), chroma * Math.cos(hue), chroma * Math.sin(hue));
}

/** OKLab to sRGB bytes. @param {number} L @param {number} a @param {number} b */
function srgb(L, a, b) {
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const [red, green, blue] = [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ].map((linear) => {
    const clamped = Math.min(1, Math.max(0, linear));
    return Math.round(255 * (clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * clamped ** (1 / 2.4) - 0.055));
  });
  return /** @type {[number, number, number]} */ ([red, green, blue]);
}
