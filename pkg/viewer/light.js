/**
 * What lights the materials of a GLB: a neutral studio, or a picture of the surroundings. Materials read it prefiltered for their
 * roughness (Karis, 2013); each is prefiltered once for the page's one renderer.
 */
import { DataTexture, EquirectangularReflectionMapping, FloatType, LinearFilter, LinearSRGBColorSpace, PMREMGenerator, RGBAFormat } from 'three';

const WIDTH = 256;
const HEIGHT = 128;

/** Radiance of the studio's walls, looking down, level and up. */
const WALLS = { down: 0.55, level: 0.07, up: 0.3 };
/**
 * Soft boxes around what is shown, x right, y up, z towards the first look: direction, half the angle that one covers in degrees, and
 * radiance. Two rows left, a wide one right and in front, two behind that draw the outline.
 */
const BOXES = [
  { towards: unit([-0.82, 0.42, 0.46]), half: 5.2, radiance: 106 },
  { towards: unit([-0.8, 0.56, -0.24]), half: 5, radiance: 106 },
  { towards: unit([0.82, 0.5, 0]), half: 10, radiance: 24 },
  { towards: unit([0, 0.36, 0.93]), half: 10, radiance: 18 },
  { towards: unit([0.44, 0.28, -0.85]), half: 5.2, radiance: 106 },
  { towards: unit([-0.38, 0.6, -0.7]), half: 4.6, radiance: 106 },
];

/** The name of the studio. */
export const NEUTRAL = 'neutral';

export class Lights {
  #renderer;
  /** Prefiltered, by name or by picture. @type {Map<import('three').Texture | typeof NEUTRAL, import('three').WebGLRenderTarget>} */
  #made = new Map();

  /** @param {import('three').WebGLRenderer} renderer */
  constructor(renderer) {
    this.#renderer = renderer;
  }

  /** @param {import('three').Texture | typeof NEUTRAL} surroundings @returns {import('three').Texture} */
  of(surroundings) {
    let target = this.#made.get(surroundings);
    if (!target) {
      const generator = new PMREMGenerator(this.#renderer);
      const picture = surroundings === NEUTRAL ? studio() : surroundings;
      target = generator.fromEquirectangular(picture);
      generator.dispose();
      picture.dispose(); // off the GPU: what was made of it stays
      this.#made.set(surroundings, target);
    }
    return target.texture;
  }

  /** @param {import('three').Texture | typeof NEUTRAL} surroundings that nobody shows any more */
  drop(surroundings) {
    this.#made.get(surroundings)?.dispose();
    this.#made.delete(surroundings);
  }

  /** A restored context has forgotten them. */
  forget() {
    this.#made.clear();
  }
}

function studio() {
  const data = new Float32Array(4 * WIDTH * HEIGHT);
  for (let row = 0; row < HEIGHT; row++) {
    const latitude = ((row + 0.5) / HEIGHT - 0.5) * Math.PI;
    for (let column = 0; column < WIDTH; column++) {
      const longitude = ((column + 0.5) / WIDTH - 0.5) * 2 * Math.PI;
      const direction = [Math.cos(latitude) * Math.cos(longitude), Math.sin(latitude), Math.cos(latitude) * Math.sin(longitude)];
      const radiance = radianceFrom(direction);
      data.set([radiance, radiance, radiance, 1], 4 * (row * WIDTH + column));
    }
  }
  const texture = new DataTexture(data, WIDTH, HEIGHT, RGBAFormat, FloatType);
  texture.mapping = EquirectangularReflectionMapping;
  texture.colorSpace = LinearSRGBColorSpace;
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/** Light that comes from a direction: the walls', and a box's with an edge as wide as itself. @param {number[]} direction */
function radianceFrom(direction) {
  const height = direction[1];
  const wall = WALLS.level + (height > 0 ? WALLS.up - WALLS.level : WALLS.level - WALLS.down) * height;
  return BOXES.reduce((sum, { towards, half, radiance }) => {
    const cosine = direction.reduce((dot, x, axis) => dot + x * towards[axis], 0);
    const angle = (Math.acos(Math.min(1, Math.max(-1, cosine))) * 180) / Math.PI;
    return sum + radiance * smooth(1.5 - angle / half);
  }, wall);
}

/** From 0 to 1, without a corner. @param {number} t */
function smooth(t) {
  const share = Math.min(1, Math.max(0, t));
  return share * share * (3 - 2 * share);
}

/** @param {number[]} v */
function unit(v) {
  const length = Math.hypot(...v);
  return v.map((value) => value / length);
}
