/** Several clouds of one frame as one. */

/** @import { PointCloud } from '../types.js' */

/** A point of which nobody knows where it was seen from. */
const UNKNOWN = 2 ** 32 - 1;

/**
 * All points, one cloud after the other. What one of them lacks is white (colours), zero (normals) or 0 (attributes). Where the
 * clouds' origins differ, positions become those of the first origin, in double precision.
 * @param {PointCloud[]} clouds one at least
 * @returns {PointCloud}
 */
export function joinedCloud(clouds) {
  const counts = clouds.map(({ positions }) => positions.length / 3);
  const total = counts.reduce((sum, count) => sum + count, 0);
  const some = (/** @type {keyof PointCloud} */ name) => clouds.some((cloud) => cloud[name]);
  const alike = (/** @type {keyof PointCloud} */ name) => clouds.every((cloud) => JSON.stringify(cloud[name]) === JSON.stringify(clouds[0][name]));
  const attributes = new Set(clouds.flatMap(({ attributes = {} }) => Object.keys(attributes)));
  const viewpoints = clouds.every((cloud) => cloud.viewpoints) ? viewpointsOf(clouds, counts) : undefined;
  const [{ origin, up, unit, crs, seenFromAbove }] = clouds;
  const moved = !alike('origin');
  const Positions = moved || clouds.some(({ positions }) => positions instanceof Float64Array) ? Float64Array : Float32Array;
  return {
    positions: joined(clouds, (cloud) => (moved ? fromOrigin(cloud, origin) : cloud.positions), counts, 3, new Positions(3 * total)),
    ...(some('normals') && { normals: joined(clouds, ({ normals }) => normals, counts, 3, new Float32Array(3 * total)) }),
    ...(some('colors') && { colors: joined(clouds, ({ colors }) => colors, counts, 3, new Uint8Array(3 * total).fill(255)) }),
    ...(attributes.size > 0 && {
      attributes: Object.fromEntries([...attributes].map((name) => [name, joined(clouds, (cloud) => cloud.attributes?.[name], counts, 1, new Float32Array(total))])),
    }),
    ...(origin && { origin }),
    ...(viewpoints && { viewpoints }),
    ...(up && alike('up') && { up }),
    ...(unit && alike('unit') && { unit }),
    ...(crs && alike('crs') && { crs }),
    ...(seenFromAbove && alike('seenFromAbove') && { seenFromAbove }),
    ...(some('faces') && { faces: clouds.reduce((all, cloud) => all + (cloud.faces ?? 0), 0) }),
  };
}

/**
 * Positions from another origin.
 * @param {Pick<PointCloud, 'positions' | 'origin'>} cloud
 * @param {readonly number[]} [to]
 */
export function fromOrigin({ positions, origin = [0, 0, 0] }, to = [0, 0, 0]) {
  return Float64Array.from(positions, (x, i) => x + (origin[i % 3] - to[i % 3]));
}

/**
 * @template {Uint8Array | Float32Array | Float64Array} T
 * @param {PointCloud[]} clouds
 * @param {(cloud: PointCloud) => ArrayLike<number> | undefined} pick
 * @param {number[]} counts
 * @param {number} each
 * @param {T} into
 */
function joined(clouds, pick, counts, each, into) {
  let at = 0;
  clouds.forEach((cloud, i) => {
    const values = pick(cloud);
    if (values) into.set(values, at);
    at += each * counts[i];
  });
  return into;
}

/** @param {PointCloud[]} clouds @param {number[]} counts */
function viewpointsOf(clouds, counts) {
  const [first] = clouds;
  const placesOf = (/** @type {PointCloud} */ cloud) => {
    const { positions } = /** @type {NonNullable<PointCloud['viewpoints']>} */ (cloud.viewpoints);
    return fromOrigin({ positions, origin: cloud.origin }, first.origin);
  };
  const positions = new Float64Array(clouds.flatMap((cloud) => [...placesOf(cloud)]));
  const of = new Uint32Array(counts.reduce((sum, count) => sum + count, 0));
  let [point, place] = [0, 0];
  clouds.forEach(({ viewpoints }, i) => {
    for (let j = 0; j < counts[i]; j++) {
      const station = viewpoints?.of?.[j] ?? 0;
      of[point++] = station === UNKNOWN ? UNKNOWN : place + station;
    }
    place += (viewpoints?.positions.length ?? 0) / 3;
  });
  return { positions, of };
}
