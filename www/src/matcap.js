import { DataTexture, LinearFilter, SRGBColorSpace, UnsignedByteType, RGBAFormat } from 'three';

const SIZE = 256;

/** Directions in eye space (x right, y up, z to the viewer) and how each light acts. */
const KEY = { towards: normalize([-0.45, 0.75, 0.55]), color: [1.0, 0.96, 0.9], strength: 0.66 };
const FILL = { towards: normalize([0.85, 0.05, 0.5]), color: [0.72, 0.82, 1.0], strength: 0.12 };
const SKY = [0.3, 0.32, 0.35];
const GROUND = [0.15, 0.13, 0.115];
const RIM = { color: [0.85, 0.93, 1.0], strength: 0.2 };
const GLOSS = { exponent: 40, strength: 0.1 };

/**
 * A studio in one texture: the colour of a softly lit white sphere for each direction of the normal.
 * One look-up a pixel replaces all lights, so the mesh looks the same on a phone and a workstation.
 */
export function studioMatcap() {
  const data = new Uint8Array(SIZE * SIZE * 4);
  for (let row = 0; row < SIZE; row++) {
    for (let column = 0; column < SIZE; column++) {
      const color = shade(sphereNormal(column, row));
      data.set([...color.map(encode), 255], 4 * (row * SIZE + column));
    }
  }
  const texture = new DataTexture(data, SIZE, SIZE, RGBAFormat, UnsignedByteType);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/** The sphere's normal under a texel; outside the disc, the nearest one of its outline. */
function sphereNormal(/** @type {number} */ column, /** @type {number} */ row) {
  const x = ((column + 0.5) / SIZE) * 2 - 1;
  const y = ((row + 0.5) / SIZE) * 2 - 1;
  const flat = Math.hypot(x, y);
  return flat < 1 ? [x, y, Math.sqrt(1 - flat * flat)] : [x / flat, y / flat, 0];
}

/** Linear colour of the lit sphere where its normal is `n`. */
function shade(/** @type {number[]} */ n) {
  const sky = 0.5 + 0.5 * n[1];
  const key = wrapped(dot(n, KEY.towards), 0.12) * KEY.strength;
  const fill = wrapped(dot(n, FILL.towards), 0.4) * FILL.strength;
  const rim = (1 - n[2]) ** 3 * (0.35 + 0.65 * sky) * RIM.strength;
  const half = normalize([KEY.towards[0], KEY.towards[1], KEY.towards[2] + 1]);
  const gloss = Math.max(0, dot(n, half)) ** GLOSS.exponent * GLOSS.strength;
  return [0, 1, 2].map((c) =>
    GROUND[c] + (SKY[c] - GROUND[c]) * sky + key * KEY.color[c] + fill * FILL.color[c] + rim * RIM.color[c] + gloss);
}

/** Lambert's cosine, reaching a little around the corner. */
function wrapped(/** @type {number} */ cosine, /** @type {number} */ wrap) {
  return Math.max(0, (cosine + wrap) / (1 + wrap));
}

/** Linear 0-1 to an sRGB byte. */
function encode(/** @type {number} */ linear) {
  const clamped = Math.min(1, linear);
  const srgb = clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * clamped ** (1 / 2.4) - 0.055;
  return Math.round(255 * srgb);
}

function dot(/** @type {number[]} */ a, /** @type {number[]} */ b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function normalize(/** @type {number[]} */ v) {
  const length = Math.hypot(...v);
  return v.map((value) => value / length);
}
