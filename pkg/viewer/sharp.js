/** Which points and vertices are on sharp features. */

/** @import { PointCloud, ReducedCloud, SurfaceMesh } from '../types.js' */

/** Surface variation of a right-angled crease is about 0.1, of a sphere seen through a tenth of its radius 0.001. */
const SHARP_VARIATION = 0.04;
/** A vertex is on a crease where a triangle at it turns away from the mean of all by more than this cosine says. */
const CREASE_COSINE = Math.cos((22 * Math.PI) / 180);

/**
 * Which reduced points are on sharp features: those with a large surface variation, and the samples that a flatness target kept as
 * they were. One byte a point.
 * @param {ReducedCloud} reduced
 * @param {PointCloud} cloud what it was made from
 * @param {number} diagonal of its bounding box
 */
export function sharpPoints({ positions, variation, weights, nearest }, cloud, diagonal) {
  const all = 3 * weights.length === cloud.positions.length;
  const near = 1e-6 * diagonal;
  return Uint8Array.from(variation, (value, i) => {
    if (value > SHARP_VARIATION) return 1;
    if (all || weights[i] !== 1) return 0;
    const apart = (/** @type {number} */ axis) => positions[3 * i + axis] - cloud.positions[3 * nearest[i] + axis];
    return Math.hypot(apart(0), apart(1), apart(2)) <= near ? 1 : 0;
  });
}

/** Which vertices lie on creases of the mesh. One byte a vertex. @param {Pick<SurfaceMesh, 'positions' | 'indices'>} mesh */
export function creases({ positions, indices }) {
  const mean = new Float32Array(positions.length);
  /** @type {[number, number, number]} */
  const normal = [0, 0, 0];
  for (let t = 0; t < indices.length; t += 3) {
    turn(positions, indices, t, normal);
    for (let k = 0; k < 3; k++) for (let axis = 0; axis < 3; axis++) mean[3 * indices[t + k] + axis] += normal[axis];
  }
  const out = new Uint8Array(positions.length / 3);
  for (let t = 0; t < indices.length; t += 3) {
    turn(positions, indices, t, normal);
    const size = Math.hypot(...normal) || 1;
    for (let k = 0; k < 3; k++) {
      const v = indices[t + k];
      const [x, y, z] = mean.subarray(3 * v, 3 * v + 3);
      const cosine = (x * normal[0] + y * normal[1] + z * normal[2]) / (size * Math.hypot(x, y, z) || 1);
      if (cosine < CREASE_COSINE) out[v] = 1;
    }
  }
  return out;
}

/**
 * The normal of a triangle, as long as twice its area.
 * @param {ArrayLike<number>} p
 * @param {Uint32Array} indices
 * @param {number} t where its corners begin
 * @param {[number, number, number]} out
 */
function turn(p, indices, t, out) {
  const [a, b, c] = [3 * indices[t], 3 * indices[t + 1], 3 * indices[t + 2]];
  const [ux, uy, uz] = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
  const [vx, vy, vz] = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
  out[0] = uy * vz - uz * vy;
  out[1] = uz * vx - ux * vz;
  out[2] = ux * vy - uy * vx;
}
