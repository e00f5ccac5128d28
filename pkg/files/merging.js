/** Several scans of one frame as one cloud. */

/** @import { FileCloud } from '../types.js' */

/** A point of which nobody knows where it was seen from. */
const UNKNOWN = 2 ** 32 - 1;

/**
 * All points, one cloud after the other. What one of them lacks is white (colours), zero (normals) or 0 (attributes).
 * @param {any[]} clouds each a {@link FileCloud}
 * @param {string[]} names of their files
 * @returns {FileCloud}
 */
export function merged(clouds, names) {
  if (clouds.length === 1) return clouds[0];
  const counts = clouds.map(({ positions }) => positions.length / 3);
  const total = counts.reduce((sum, count) => sum + count, 0);
  const some = (/** @type {string} */ name) => clouds.some((cloud) => cloud[name]);
  const Positions = clouds.some(({ positions }) => positions instanceof Float64Array) ? Float64Array : Float32Array;
  const attributes = new Set(clouds.flatMap(({ attributes = {} }) => Object.keys(attributes)));
  const viewpoints = clouds.every((cloud) => cloud.viewpoints) ? viewpointsOf(clouds, counts) : undefined;
  const [{ up, unit, crs, seenFromAbove, file }] = clouds;
  const alike = (/** @type {string} */ name) => clouds.every((cloud) => JSON.stringify(cloud[name]) === JSON.stringify(clouds[0][name]));
  const sum = (/** @type {string} */ name) => clouds.reduce((all, cloud) => all + cloud.file[name], 0);
  return /** @type {FileCloud} */ ({
    positions: joined(clouds, ({ positions }) => positions, counts, 3, new Positions(3 * total)),
    ...(some('normals') && { normals: joined(clouds, ({ normals }) => normals, counts, 3, new Float32Array(3 * total)) }),
    ...(some('colors') && { colors: joined(clouds, ({ colors }) => colors, counts, 3, new Uint8Array(3 * total).fill(255)) }),
    ...(attributes.size > 0 && {
      attributes: Object.fromEntries([...attributes].map((name) => [name, joined(clouds, (cloud) => cloud.attributes?.[name], counts, 1, new Float32Array(total))])),
    }),
    ...(viewpoints && { viewpoints }),
    ...(up && alike('up') && { up }),
    ...(unit && alike('unit') && { unit }),
    ...(crs && alike('crs') && { crs }),
    ...(seenFromAbove && alike('seenFromAbove') && { seenFromAbove }),
    ...(some('faces') && { faces: clouds.reduce((all, cloud) => all + (cloud.faces ?? 0), 0) }),
    skipped: summed(clouds.map(({ skipped = {} }) => skipped)),
    file: { ...file, table: undefined, dropped: sum('dropped'), replaced: sum('replaced'), faces: sum('faces'), notes: notesOf(clouds, names), ...ofFaces(clouds) },
  });
}

/** @param {any[]} clouds */
function ofFaces(clouds) {
  const sampled = clouds.reduce((all, { file }) => all + (file.sampled ?? 0), 0);
  const missing = clouds.flatMap(({ file }) => file.missing ?? []);
  return { sampled: sampled || undefined, missing: missing.length > 0 ? missing : undefined };
}

/**
 * @template {Uint8Array | Float32Array | Float64Array} T
 * @param {any[]} clouds
 * @param {(cloud: any) => ArrayLike<number> | undefined} pick
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

/** @param {any[]} clouds @param {number[]} counts */
function viewpointsOf(clouds, counts) {
  const positions = new Float64Array(clouds.flatMap(({ viewpoints }) => [...viewpoints.positions]));
  const of = new Uint32Array(counts.reduce((sum, count) => sum + count, 0));
  let [point, place] = [0, 0];
  clouds.forEach(({ viewpoints }, i) => {
    for (let j = 0; j < counts[i]; j++) {
      const station = viewpoints.of?.[j] ?? 0;
      of[point++] = station === UNKNOWN ? UNKNOWN : place + station;
    }
    place += viewpoints.positions.length / 3;
  });
  return { positions, of };
}

/** @param {Record<string, number>[]} records */
function summed(records) {
  /** @type {Record<string, number>} */
  const all = {};
  for (const [key, value] of records.flatMap((record) => Object.entries(record))) all[key] = (all[key] ?? 0) + value;
  return all;
}

/** @param {any[]} clouds @param {string[]} names */
function notesOf(clouds, names) {
  const notes = clouds.flatMap(({ file }) => file.notes);
  return [`The points are those of ${names.length} files: ${names.join(', ')}.`, ...new Set(notes)];
}
