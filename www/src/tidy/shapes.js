/** Shapes that are drawn over the picture: rings of corners, of which those inside of others are holes. */

/** @typedef {[number, number]} Corner */
/** @typedef {Corner[][]} Shape */

/** What a lasso may be off by, in CSS pixels. */
const OFF = 1.2;
/** Pixels of a shape along each side, to know fast which points it covers. */
const FINE = 1024;

/** The same line with fewer corners (Ramer, 1972; Douglas and Peucker, 1973). @param {Corner[]} line @returns {Corner[]} */
export function simplified(line) {
  if (line.length < 3) return line;
  const [first, last] = [line[0], line[line.length - 1]];
  const [dx, dy] = [last[0] - first[0], last[1] - first[1]];
  const long = Math.hypot(dx, dy);
  const away = (/** @type {Corner} */ [x, y]) => (long ? Math.abs(dx * (y - first[1]) - dy * (x - first[0])) / long : Math.hypot(x - first[0], y - first[1]));
  let far = 0;
  for (let i = 1; i < line.length - 1; i++) if (away(line[i]) > away(line[far]) || !far) far = i;
  if (away(line[far]) <= OFF) return [first, last];
  return [...simplified(line.slice(0, far + 1)).slice(0, -1), ...simplified(line.slice(far))];
}

/** What one or both cover. @param {Shape} one @param {Shape} other @returns {Promise<Shape>} */
export async function joinedShape(one, other) {
  const { union } = await import('polyclip-ts');
  return union(one, other).flatMap(opened);
}

/** What the first covers and the other does not. @param {Shape} one @param {Shape} other @returns {Promise<Shape>} */
export async function without(one, other) {
  const { difference } = await import('polyclip-ts');
  return difference(one, other).flatMap(opened);
}

/** Rings without the first corner at their end once more. @param {Shape} rings @returns {Shape} */
function opened(rings) {
  return rings.map((ring) => ring.slice(0, -1));
}

/**
 * One line around all rings: from the end of each it goes back to where the first begins. Whoever counts how often it is crossed finds
 * these ways twice, and holes as holes.
 * @param {Shape} shape
 * @returns {Corner[]}
 */
export function cornersOf(shape) {
  if (shape.length < 2) return shape[0] ?? [];
  const [start] = shape[0];
  return shape.flatMap((ring) => [...ring, ring[0], start]);
}

/** A picture of a shape: for each pixel not 0 where it is covered. @param {Shape} shape */
export function coveredBy(shape) {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = FINE;
  const pen = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d', { willReadFrequently: true }));
  pen.beginPath();
  for (const ring of shape) {
    ring.forEach(([x, y], i) => pen[i ? 'lineTo' : 'moveTo'](((x + 1) * FINE) / 2, ((1 - y) * FINE) / 2));
    pen.closePath();
  }
  pen.fill('evenodd');
  return pen.getImageData(0, 0, FINE, FINE).data;
}

/** The points that a camera sees on a covered pixel. @param {ArrayLike<number>} positions @param {Uint8ClampedArray} covered @param {number[]} m product of projection and view, by columns @returns {import('./bench.js').Fill} */
export function insideOf(positions, covered, m) {
  return (mask, from, to) => {
    for (let i = from; i < to; i++) {
      const [x, y, z] = [positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]];
      const w = m[3] * x + m[7] * y + m[11] * z + m[15];
      if (w <= 0) continue;
      const column = Math.floor((((m[0] * x + m[4] * y + m[8] * z + m[12]) / w + 1) * FINE) / 2);
      const row = Math.floor(((1 - (m[1] * x + m[5] * y + m[9] * z + m[13]) / w) * FINE) / 2);
      if (column >= 0 && column < FINE && row >= 0 && row < FINE && covered[4 * (FINE * row + column) + 3] > 127) mask[i] = 1;
    }
  };
}
