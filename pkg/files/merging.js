/** Several scans of one frame as one cloud, with what is known of their files. */
import { joinedCloud } from './joining.js';

/** @import { FileCloud } from '../types.js' */

/**
 * All points, one cloud after the other.
 * @param {any[]} clouds each a {@link FileCloud}
 * @param {string[]} names of their files
 * @returns {FileCloud}
 */
export function merged(clouds, names) {
  if (clouds.length === 1) return clouds[0];
  const [{ file }] = clouds;
  const sum = (/** @type {string} */ name) => clouds.reduce((all, cloud) => all + cloud.file[name], 0);
  return /** @type {FileCloud} */ ({
    ...joinedCloud(clouds),
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
