/**
 * A studio in one texture: the colour of a softly lit white sphere for each direction of the normal. One look-up a pixel
 * replaces all lights, so a mesh looks the same on a phone and a workstation.
 */
import { DataTexture, LinearFilter, SRGBColorSpace } from 'three';

const SIZE = 256;

/** Directions in eye space (x right, y up, z to the viewer) and how each light acts. */
const KEY = { towards: unit([-0.45, 0.75, 0.55]), color: [1.0, 0.96, 0.9], strength: 0.6 };
const FILL = { towards: unit([0.85, 0.05, 0.5]), color: [0.72, 0.82, 1.0], strength: 0.12 };
const SKY = [0.3, 0.32, 0.35];
const GROUND = [0.23, 0.21, 0.195];
const RIM = { color: [0.85, 0.93, 1.0], strength: 0.2 };
const GLOSS = { exponent: 40, strength: 0.1 };

/** @type {DataTexture | undefined} */
let studio;

/** One for the whole page. */
export function studioMatcap() {
  return (studio ??= paint());
}

function paint() {
  const data = new Uint8Array(SIZE * SIZE * 4);
  for (let row = 0; row < SIZE; row++) {
    for (let column = 0; column < SIZE; column++) {
      data.set([...shade(sphereNormal(column, row)).map(encode), 255], 4 * (row * SIZE + column));
    }
  }
  const texture = new DataTexture(data, SIZE, SIZE);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/** The sphere's normal under a texel; outside the disc, the nearest one of its outline. @param {number} column @param {number} row */
function sphereNormal(column, row) {
  const x = ((column + 0.5) / SIZE) * 2 - 1;
  const y = ((row + 0.5) / SIZE) * 2 - 1;
  const flat = Math.hypot(x, y);
  return flat < 1 ? [x, y, Math.sqrt(1 - flat * flat)] : [x / flat, y / flat, 0];
}

/** Linear colour of the lit sphere where its normal is `n`. @param {number[]} n */
function shade(n) {
  const sky = 0.5 + 0.5 * n[1];
  const key = wrapped(dot(n, KEY.towards), 0.25) * KEY.strength;
  const fill = wrapped(dot(n, FILL.towards), 0.4) * FILL.strength;
  const rim = (1 - n[2]) ** 3 * (0.35 + 0.65 * sky) * RIM.strength;
  const half = unit([KEY.towards[0], KEY.towards[1], KEY.towards[2] + 1]);
  const gloss = Math.max(0, dot(n, half)) ** GLOSS.exponent * GLOSS.strength;
  return [0, 1, 2].map((c) =>
    GROUND[c] + (SKY[c] - GROUND[c]) * sky + key * KEY.color[c] + fill * FILL.color[c] + rim * RIM.color[c] + gloss);
}

/** Lambert's cosine, reaching a little around the corner. @param {number} cosine @param {number} wrap */
function wrapped(cosine, wrap) {
  return Math.max(0, (cosine + wrap) / (1 + wrap));
}

/** Linear 0-1 to an sRGB byte. @param {number} linear */
function encode(linear) {
  const clamped = Math.min(1, linear);
  const srgb = clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * clamped ** (1 / 2.4) - 0.055;
  return Math.round(255 * srgb);
}

/** @param {number[]} a @param {number[]} b */
function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** @param {number[]} v */
function unit(v) {
  const length = Math.hypot(...v);
  return v.map((value) => value / length);
}
