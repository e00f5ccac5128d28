/** What a file's name says of its format. */
import { extname } from 'node:path';
import { TABLES } from '../engine/options.js';
import { UsageError } from './usage.js';

/** @import { Command } from './flags.js' */

/** All that are written. */
export const FORMATS = TABLES.write.format.names;
/** Those that hold triangles alone. */
const MESHES_ALONE = ['stl', '3mf'];

/** What takes meshes as they are. @type {Command[]} */
export const LIGHT = ['simplify', 'poster'];

/** Whether the results have triangles. @param {Command} command */
export function isMesh(command) {
  return command === 'reconstruct' || command === 'simplify';
}

/** @param {Command} command */
function formatsOf(command) {
  if (command === 'poster') return ['png'];
  return FORMATS.filter((name) => isMesh(command) || !MESHES_ALONE.includes(name));
}

/** What is written where nothing says it. @param {Command} command */
export const firstOf = (command) => formatsOf(command)[0];

/**
 * @param {Command} command
 * @param {string} format
 * @param {string} what says it
 */
export function checkFormat(command, format, what) {
  const possible = formatsOf(command);
  if (possible.includes(format)) return format;
  const names = possible.join(', ');
  if (command === 'poster') throw new UsageError(`${what} is no format of posters: expected ${names}`);
  throw new UsageError(
    MESHES_ALONE.includes(format) ? `${what}: STL and 3MF files hold triangles, not points: expected ${names}` : `${what} is no format that is written: expected ${names}`,
  );
}

/**
 * @param {Command} command
 * @param {string} file
 */
export function formatOf(command, file) {
  const extension = extname(file).slice(1).toLowerCase();
  if (!extension) throw new UsageError(`'${file}' has no extension to say the format: expected ${formatsOf(command).join(', ')}`);
  return checkFormat(command, extension, `'${file}'`);
}
