/** Boxes that are turned: the step `box` of a recipe, as a person moves it. */

/** @typedef {[number, number, number]} Triple */
/** @typedef {[number, number, number, number]} Quaternion x y z w */
/** `turn`: about x, y and z in degrees, one after the other. @typedef {{ center: Triple, half: Triple, turn: Triple }} Box */

/** @param {Triple} degrees @returns {Quaternion} */
export function quaternionOf([x, y, z]) {
  return [z, y, x].map((degrees, k) => about(2 - k, degrees)).reduce(times);
}

/** @param {number} axis @param {number} degrees @returns {Quaternion} */
function about(axis, degrees) {
  const half = (degrees * Math.PI) / 360;
  const turn = /** @type {Quaternion} */ ([0, 0, 0, Math.cos(half)]);
  turn[axis] = Math.sin(half);
  return turn;
}

/** First `b`, then `a`. @param {Quaternion} a @param {Quaternion} b @returns {Quaternion} */
function times([ax, ay, az, aw], [bx, by, bz, bw]) {
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

/** The axes of a turned box, as three unit vectors. @param {Triple} degrees @returns {[Triple, Triple, Triple]} */
export function axesOf(degrees) {
  const [x, y, z, w] = quaternionOf(degrees);
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ];
}

/** The points that the box does not hold. @param {ArrayLike<number>} positions @param {Box} box @returns {import('./bench.js').Fill} */
export function outside(positions, { center, half, turn }) {
  const [[a, b, c], [d, e, f], [g, h, i]] = axesOf(turn);
  return (mask, from, to) => {
    for (let k = from; k < to; k++) {
      const [x, y, z] = [positions[3 * k] - center[0], positions[3 * k + 1] - center[1], positions[3 * k + 2] - center[2]];
      const inside = Math.abs(a * x + b * y + c * z) <= half[0] && Math.abs(d * x + e * y + f * z) <= half[1] && Math.abs(g * x + h * y + i * z) <= half[2];
      if (!inside) mask[k] = 1;
    }
  };
}

/** A place of the box, in shares of its half edges from its middle. @param {Box} box @param {Triple} share @returns {Triple} */
export function placeIn({ center, half, turn }, share) {
  const axes = axesOf(turn);
  return /** @type {Triple} */ (center.map((value, k) => value + axes.reduce((sum, axis, j) => sum + share[j] * half[j] * axis[k], 0)));
}

/** A face is moved outwards, and the other stays; no further in than that. @param {Box} box @param {number} axis @param {1 | -1} side @param {number} way @returns {Box} */
export function withFace(box, axis, side, way) {
  const moved = Math.max(way, -1.98 * box.half[axis]);
  const direction = axesOf(box.turn)[axis];
  const half = /** @type {Triple} */ (box.half.map((value, k) => (k === axis ? value + moved / 2 : value)));
  return { ...box, half, center: /** @type {Triple} */ (box.center.map((value, k) => value + (side * moved * direction[k]) / 2)) };
}
