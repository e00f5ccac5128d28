// What several tests of the package need.

import { createEngine } from 'pointweave';

/** `count` points of a sphere, evenly spread, with colours and one attribute. */
export function sphere(count = 2000, { radius = 1, center = [0, 0, 0], type = Float32Array } = {}) {
  const golden = Math.PI * (3 - Math.sqrt(5));
  const positions = new type(3 * count);
  const colors = new Uint8Array(3 * count);
  const height = new Float32Array(count);
  for (let i = 0; i < count; i++) {
    const z = 1 - (2 * i + 1) / count;
    const ring = Math.sqrt(1 - z * z);
    const direction = [ring * Math.cos(i * golden), ring * Math.sin(i * golden), z];
    direction.forEach((x, axis) => (positions[3 * i + axis] = center[axis] + radius * x));
    colors.set([255, Math.round(127.5 * (z + 1)), 0], 3 * i);
    height[i] = z;
  }
  return { positions, colors, attributes: { height } };
}

/** An engine that ends with the test. */
export async function engineFor(t, options) {
  const engine = await createEngine(options);
  t.after(() => engine.dispose());
  return engine;
}

/** What a promise rejects with; fails when it does not. */
export async function rejection(promise) {
  try {
    await promise;
  } catch (error) {
    return error;
  }
  throw new Error('expected a rejection');
}

/** All typed arrays of a result by their path, and the rest left out. */
export function arraysOf(value, path = '') {
  if (ArrayBuffer.isView(value)) return { [path]: value };
  if (typeof value !== 'object' || value === null) return {};
  return Object.assign({}, ...Object.entries(value).map(([key, part]) => arraysOf(part, path ? `${path}.${key}` : key)));
}
