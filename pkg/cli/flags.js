/** The flags of each command, from the same tables as the package's options: `curvatureWeight` is `--curvature-weight`. */
import { PointweaveError } from '../engine/errors.js';
import { TARGETS } from '../engine/options-table.js';
import { LODS, TABLES } from '../engine/options.js';
import { MAPS } from '../engine/pictures.js';
import { choice, rule } from '../engine/rules.js';
import { FLAGS } from './flags-table.js';
import { UsageError } from './usage.js';

/** @import { Rule, Table } from '../engine/rules.js' */
/** @typedef {'reduce' | 'reconstruct' | 'prepare' | 'simplify' | 'merge' | 'inspect' | 'poster' | 'catalogue' | 'tiles'} Command */

/**
 * @typedef {object} Flag
 * @property {string} name as it is typed, without the dashes
 * @property {string} key the option's name
 * @property {'target' | 'reduce' | 'reconstruct' | 'simplify' | 'texture' | 'poster' | 'read' | 'write' | 'none'} group
 * @property {Rule} rule
 * @property {'switch' | 'value' | 'list'} kind a switch has `--no-` too, a list can be given more than once
 * @property {string} words what it does, in one line
 */

/** What each flag does, by its option's name. An option without words has no flag. @type {Record<string, string>} */
export const WORDS = {
  ...FLAGS,
  faces: 'of a mesh: points are taken from its faces, or its vertices are the points',
  texture: 'pictures of the points on the mesh, so many texels wide; for GLB, USDZ and ZIP files',
  maps: 'which pictures',
  scalar: "values in the place of colours: height, or an attribute's name",
  range: 'the values that the ends of the colours stand for',
  pictures: 'what the pictures of a GLB file are; webp needs @jsquash/webp, ktx2 needs ktx2-encoder',
  error: 'largest distance between the mesh as it was and as it is, a share of the diagonal',
  lods: 'most triangles of several meshes, instead of --triangles; the second is FILE.lod1.glb',
  size: 'of the picture, in pixels',
  camera: 'from where, as camera-orbit of <point-weave>',
  background: 'behind it: #rrggbb or transparent',
  up: 'which way is up in the result; default: what its format asks for',
  unit: 'the unit of the result; default: what its format asks for',
  encoding: 'of a PLY file',
  quantize: 'a GLB file with positions rounded to 1/65535 and normals to 1/127, in half the room',
  meshopt: 'a compressed GLB file; needs @gltf-transform/core, @gltf-transform/extensions and meshoptimizer',
};

/** `--texture 2048 --maps color,normal`. */
const TEXTURES = { texture: TABLES.texture.size, maps: rule(`one or more of ${MAPS.join(',')}`, (value) => typeof value === 'string' && value.split(',').every((name) => MAPS.includes(name))), scalar: TABLES.texture.scalar, range: rule('LOW,HIGH', (value, path) => TABLES.texture.range.accepts(rangeOf(value), path)) };

/** `--lods 50000,10000,2000`. */
const LEVELS = { lods: rule('1 to 8 numbers apart by commas, each less than the one before', (value, path) => LODS.accepts(numbersIn(value), path)) };

/** How the models of a catalogue are compressed: as the element shows them. */
const SHOWN = { pictures: choice('png', 'webp'), meshopt: TABLES.write.meshopt };

/** `--size 800x600`. */
const POSTERS = { ...TABLES.poster, size: rule('WIDTHxHEIGHT, each 16 to 4096', (value, path) => TABLES.poster.size.accepts(sizeOf(value), path)) };

/** `--count auto` is `target: 'auto'`. */
const AMOUNTS = {
  ...TARGETS,
  count: rule(`'auto' or ${TARGETS.count.expected}`, (value, path) => value === 'auto' || TARGETS.count.accepts(value, path)),
};

/**
 * @param {Command} command
 * @returns {Flag[]}
 */
export function flagsOf(command) {
  const read = flags('read', TABLES.read);
  if (command === 'inspect' || command === 'tiles') return read;
  if (command === 'prepare' || command === 'merge') return [...read, ...flags('write', TABLES.write)];
  if (command === 'poster') return [...flags('poster', POSTERS), ...read.filter(({ key }) => key !== 'faces')];
  if (command === 'simplify') return [...flags('simplify', TABLES.simplify), ...read.filter(({ key }) => key !== 'faces'), ...flags('write', TABLES.write)];
  const reduce = [...flags('target', AMOUNTS), ...flags('reduce', TABLES.reduce)];
  const { reduce: nested, ...surface } = TABLES.reconstruct;
  /** `reduce: false`. @type {Flag} */
  const none = { name: 'no-reduce', key: 'reduce', group: 'none', rule: nested, kind: 'value', words: WORDS.reduce };
  return [...read, ...reduce, ...(command !== 'reduce' ? [none, ...flags('reconstruct', surface), ...flags('texture', { ...LEVELS, ...TEXTURES })] : []), ...flags('write', command === 'catalogue' ? SHOWN : TABLES.write)];
}

/**
 * @param {Flag['group']} group
 * @param {Table} table
 * @returns {Flag[]}
 */
function flags(group, table) {
  const keys = Object.keys(table).filter((key) => key in WORDS);
  return keys.map((key) => {
    const rule = table[key];
    const kind = key === 'attributes' ? 'list' : rule.accepts(true, '') ? 'switch' : 'value';
    // What a file says of itself and what is written are two things: `--up` and `--to-up`.
    const name = group === 'write' && (key === 'up' || key === 'unit') ? `to-${key}` : kebab(key);
    return { name, key, group, rule, kind, words: WORDS[key] };
  });
}

/** @param {unknown} text @param {string} [mark] */
function numbersIn(text, mark = ',') {
  return String(text).split(mark).map((digits) => (/^\d+$/.test(digits) ? Number(digits) : NaN));
}

/** @param {unknown} text */
function rangeOf(text) {
  return String(text).split(',').map((digits) => (digits.trim() === '' ? NaN : Number(digits)));
}

/** @param {unknown} text */
function sizeOf(text) {
  return numbersIn(text, 'x');
}

/** @param {string} key */
function kebab(key) {
  return key.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);
}

/**
 * How `parseArgs` is told of these flags.
 * @param {Flag[]} flags
 */
export function parserOptions(flags) {
  /** @type {Record<string, { type: 'boolean' | 'string', multiple?: boolean }>} */
  const options = {};
  for (const { name, kind, group } of flags) {
    if (kind === 'switch') options[name] = options[`no-${name}`] = { type: 'boolean' };
    else if (group === 'none') options[name] = { type: 'boolean' };
    else options[name] = { type: 'string', multiple: kind === 'list' };
  }
  return options;
}

/**
 * The package's options that were given as flags.
 * @param {Command} command
 * @param {Record<string, any>} values by name, of `parseArgs`
 */
export function optionsFrom(command, values) {
  /** @type {Record<Flag['group'], Record<string, any>>} */
  const given = { target: {}, reduce: {}, reconstruct: {}, simplify: {}, texture: {}, poster: {}, read: {}, write: {}, none: {} };
  for (const flag of flagsOf(command)) {
    const value = valueOf(flag, values);
    if (value !== undefined) given[flag.group][flag.key] = value;
  }
  if (command === 'poster') return { own: { ...given.poster, ...(given.poster.size && { size: sizeOf(given.poster.size) }) }, read: given.read, write: {} };
  if (command === 'simplify') return { own: given.simplify, read: given.read, write: given.write };
  const targets = Object.keys(given.target);
  if (targets.length > 1) throw new UsageError(`${targets.map((key) => `--${key}`).join(' and ')} exclude each other`);
  if (targets.length === 1) given.reduce.target = given.target.count === 'auto' ? 'auto' : given.target;
  const reduces = Object.keys(given.reduce).length > 0;
  if ('reduce' in given.none && reduces) throw new UsageError('--no-reduce leaves nothing for the options of the reduction to say');
  const nested = reduces ? { reduce: given.reduce } : given.none;
  const { texture: size, maps, lods, range, ...baked } = given.texture;
  if (lods !== undefined && given.reconstruct.triangles !== undefined) throw new UsageError('--lods and --triangles exclude each other');
  if (maps !== undefined && size === undefined) throw new UsageError('--maps says which pictures --texture makes');
  if (baked.scalar !== undefined && size === undefined) throw new UsageError('--scalar says what the pictures of --texture show');
  if (range !== undefined && baked.scalar === undefined) throw new UsageError('--range says which values of --scalar the colours stand for');
  const texture = size === undefined ? {} : { texture: { size, ...baked, ...(maps && { maps: maps.split(',') }), ...(range && { range: rangeOf(range) }) } };
  return { own: command === 'reduce' ? given.reduce : { ...nested, ...given.reconstruct, ...(lods !== undefined && { lods: numbersIn(lods) }), ...texture }, read: given.read, write: given.write };
}

/** @param {Flag} flag @param {Record<string, any>} values */
function valueOf({ name, key, group, rule, kind }, values) {
  if (group === 'none') return values[name] ? false : undefined;
  if (kind === 'switch') {
    const [on, off] = [values[name], values[`no-${name}`]];
    if (on && off) throw new UsageError(`--${name} and --no-${name} exclude each other`);
    return on ? true : off ? false : undefined;
  }
  if (values[name] === undefined) return undefined;
  return kind === 'list' ? listOf(name, key, rule, values[name]) : parseValue(name, rule, values[name]);
}

/**
 * A word where the rule takes it, or the number that it spells.
 * @param {string} name
 * @param {Rule} rule
 * @param {string} text
 */
export function parseValue(name, rule, text) {
  const number = text.trim() === '' ? NaN : Number(text);
  const value = [text, number].find((candidate) => rule.accepts(candidate, name));
  if (value !== undefined) return value;
  const meant = shareIn(text);
  const hint = meant !== undefined && rule.accepts(meant, name) ? `: did you mean ${meant}?` : '';
  throw new UsageError(`--${name} is '${text}': expected ${rule.expected}${hint}`);
}

/** The number that a percentage or a fraction means. @param {string} text `20%`, `20 %`, `1/3` @returns {number | undefined} */
function shareIn(text) {
  const [, above, sign, below] = /^\s*([\d.]+)\s*(%|\/)\s*([\d.]*)\s*$/.exec(text) ?? [];
  const value = sign === '%' && below === '' ? Number(above) / 100 : Number(above) / Number(below);
  return Number.isFinite(value) ? Number(value.toPrecision(4)) : undefined;
}

/** @param {string} name @param {string} key @param {Rule} rule @param {string[]} texts each `name=how` */
function listOf(name, key, rule, texts) {
  const entries = texts.map((text) => {
    const at = text.lastIndexOf('=');
    if (at < 1) throw new UsageError(`--${name} is '${text}': expected NAME=HOW`);
    return [text.slice(0, at), text.slice(at + 1)];
  });
  const value = Object.fromEntries(entries);
  try {
    rule.accepts(value, key);
  } catch (error) {
    throw error instanceof PointweaveError ? new UsageError(error.message) : error;
  }
  return value;
}
