/** The command line to what is to be done. Whatever is wrong with it is found here, before a file is opened. */
import { basename, extname, join } from 'node:path';
import { parseArgs } from 'node:util';
import { ENGINE } from '../engine/options.js';
import { nearest } from '../engine/rules.js';
import { CLOUD_FLAGS, cloudSaid } from './cloud-flags.js';
import { READ_FLAGS, readSaid } from './read-flags.js';
import { flagsOf, optionsFrom, parseValue, parserOptions } from './flags.js';
import { LIGHT, checkFormat, firstOf, formatOf } from './formats.js';
import { MERGE_FLAGS, PREPARE_FLAGS, isEmpty, preparation } from './prepare-flags.js';
import { CATALOGUE_FLAGS, catalogueSaid } from './catalogue-flags.js';
import { TILES_FLAGS, tilesSaid } from './tiles-flags.js';
import { UsageError } from './usage.js';

/** @import { Command } from './flags.js' */

/**
 * @typedef {object} Job
 * @property {string} input `-` is standard input
 * @property {string[]} [inputs] of files that become one
 * @property {string} [output] `-` is standard output
 */

/**
 * @typedef {object} Task
 * @property {Command} command
 * @property {Job[]} jobs
 * @property {string} [folder] for the results of a batch
 * @property {boolean} json
 * @property {'auto' | number} threads
 * @property {import('./cloud-flags.js').Said} cloud what is said of each scan beside its file
 * @property {import('./prepare-flags.js').Preparation} prepare what is done to each before
 * @property {Record<string, any>} read how each is read
 * @property {Record<string, any>} own options of the function that has the command's name
 * @property {Record<string, any>} write options of `write`, without the format
 * @property {string} [format] of the results
 * @property {import('./catalogue-flags.js').CatalogueSaid} [catalogue] of a catalogue
 * @property {import('./tiles-flags.js').TilesSaid} [tiles] of tiles
 */

/** The formats that a flag is for, and no others. */
const ONLY = { encoding: ['ply'], quantize: ['glb'], meshopt: ['glb'], pictures: ['glb'], texture: ['glb', 'usdz', 'zip'] };

/** @type {Command[]} */
export const COMMANDS = ['reduce', 'reconstruct', 'inspect', 'prepare', 'merge', 'simplify', 'poster', 'catalogue', 'tiles'];
const NAMES = `${COMMANDS.slice(0, -1).join(', ')} or ${COMMANDS.at(-1)}`;

/**
 * @param {string[]} argv
 * @returns {Task | { help?: Command } | { version: true }}
 */
export function parse(argv) {
  const [first, ...rest] = argv;
  if (first === '--version' || first === '-v') return { version: true };
  if (first === '--help' || first === '-h') return {};
  if (first === 'help') return { help: COMMANDS.find((name) => name === rest[0]) };
  if (first === undefined) throw new UsageError(`a command is needed: ${NAMES}`);
  const command = COMMANDS.find((name) => name === first);
  if (!command) throw new UsageError(noCommand(first));
  const { values, positionals: inputs } = parseFlags(command, rest);
  return values.help ? { help: command } : task(command, values, inputs);
}

/** @param {string} first what stands where a command should */
function noCommand(first) {
  if (first.startsWith('-')) return `a command comes before ${first}: ${NAMES}`;
  const known = hint(first, COMMANDS);
  if (known || !/[./\\]/.test(first)) return `there is no command '${first}'${known}`;
  return `'${first}' looks like a file, and a command comes before it: did you mean pointweave reconstruct ${first} -o mesh.glb?`;
}

/** How `parseArgs` is told of a command's flags. @param {Command} command @returns {import('node:util').ParseArgsConfig['options'] & {}} */
export function optionsOf(command) {
  return {
    json: { type: 'boolean' },
    ...(command !== 'tiles' && { threads: { type: 'string' } }),
    help: { type: 'boolean', short: 'h' },
    ...READ_FLAGS,
    ...(command === 'tiles' && { out: { type: 'string', short: 'o' }, unit: CLOUD_FLAGS.unit, ...TILES_FLAGS }),
    ...(!['inspect', 'tiles'].includes(command) && { out: { type: 'string', short: 'o' }, ...CLOUD_FLAGS, ...(!LIGHT.includes(command) && PREPARE_FLAGS) }),
    ...(!['inspect', 'catalogue', 'tiles'].includes(command) && { 'out-dir': { type: 'string' }, format: { type: 'string' } }),
    ...(command === 'catalogue' && CATALOGUE_FLAGS),
    ...(command === 'merge' && MERGE_FLAGS),
    ...parserOptions(flagsOf(command)),
  };
}

/** @param {Command} command @param {string[]} argv */
function parseFlags(command, argv) {
  const options = optionsOf(command);
  try {
    return /** @type {{ values: Record<string, any>, positionals: string[] }} */ (parseArgs({ args: argv, options, allowPositionals: true }));
  } catch (error) {
    throw new UsageError(explain(/** @type {Error & { code?: string }} */ (error), command, Object.keys(options)));
  }
}

/** @param {Error & { code?: string }} error @param {Command} command @param {string[]} names */
function explain({ code, message }, command, names) {
  const unknown = code === 'ERR_PARSE_ARGS_UNKNOWN_OPTION' && message.match(/'--?([^']+)'/);
  if (unknown) return `${command} has no option '${unknown[1]}'${elsewhere(unknown[1]) || hint(unknown[1], names, '--')}`;
  const value = code === 'ERR_PARSE_ARGS_INVALID_OPTION_VALUE' && message.match(/--([\w-]+)/);
  if (!value) return message;
  const flag = `--${value[1]}`;
  if (message.includes('does not take')) return `${flag} takes no value`;
  return `${flag} needs a value${message.includes('ambiguous') ? `; one that begins with - is given as ${flag}=-…` : ''}`;
}

/** Which commands have it. @param {string} flag its name or its letter */
function elsewhere(flag) {
  const having = COMMANDS.filter((name) => Object.entries(optionsOf(name)).some(([long, { short }]) => flag === long || flag === short));
  return having.length > 0 ? `, which is for ${having.join(', ').replace(/, (?!.*, )/, ' and ')}` : '';
}

/** @param {string} word @param {string[]} names */
function hint(word, names, dashes = '') {
  const near = nearest(word, names);
  return near ? `: did you mean ${dashes}${near}?` : '';
}

/**
 * @param {Command} command
 * @param {Record<string, any>} values
 * @param {string[]} inputs
 * @returns {Task}
 */
function task(command, values, inputs) {
  if (inputs.length === 0) throw new UsageError(`${command} needs a file${command === 'tiles' ? ' or a folder of files' : ''}`);
  if (inputs.filter((input) => input === '-').length > 1) throw new UsageError('standard input can be read once');
  const threads = values.threads === undefined ? 'auto' : parseValue('threads', ENGINE.threads, values.threads);
  const { own, read, write } = optionsFrom(command, values);
  const shared = { command, json: Boolean(values.json), threads: /** @type {'auto' | number} */ (threads), cloud: cloudSaid(values), read: { ...read, ...readSaid(values) }, own, write, prepare: preparation(values) };
  if (command === 'tiles') return { ...shared, jobs: [], tiles: tilesSaid(values, inputs, { read: shared.read, unit: shared.cloud.unit }) };
  if (command === 'prepare' && isEmpty(shared.prepare)) throw new UsageError('what should be cut? --prepare RECIPE, --crop, --drop-strays, --drop-planes, --drop-floor or --keep-largest');
  if (command === 'simplify' && Object.keys(own).length === 0) throw new UsageError('how light should it be? --triangles N, --error SHARE, or both');
  if (command === 'catalogue') return { ...shared, jobs: [], catalogue: catalogueSaid(values, inputs) };
  if (command === 'inspect') return { ...shared, jobs: inputs.map((input) => ({ input })) };

  const { out, 'out-dir': folder } = values;
  if (out !== undefined && folder !== undefined) throw new UsageError('--out and --out-dir exclude each other');
  const format = formatFor(command, values);
  checkKind({ ...write, texture: own.texture }, format);
  if (own.lods && out === '-') throw new UsageError('--lods makes several files: -o FILE names the first');
  if (command === 'merge') return { ...shared, jobs: [oneOf(inputs, out, shared.json)], format };
  if (out !== undefined) return { ...shared, jobs: [single(inputs, out, shared.json)], format };
  if (folder !== undefined) return { ...shared, jobs: batch(inputs, folder, format), folder, format };
  if (shared.json) return { ...shared, jobs: inputs.map((input) => ({ input })) };
  throw new UsageError(`where should the result go? -o FILE for one file, --out-dir FOLDER for several, --json for the report alone`);
}

/** @param {Command} command @param {Record<string, any>} values */
function formatFor(command, { out, format }) {
  if (out === undefined || out === '-') return checkFormat(command, format ?? firstOf(command), `--format ${format ?? firstOf(command)}`);
  if (format !== undefined) throw new UsageError(`--format is for --out-dir and standard output: '${out}' has its extension`);
  return formatOf(command, out);
}

/** @param {Record<string, any>} write @param {string} format */
function checkKind(write, format) {
  for (const [name, only] of Object.entries(ONLY)) {
    if (write[name] && !only.includes(format)) throw new UsageError(`--${name} is for ${only.map((other) => other.toUpperCase()).join(' and ')} files`);
  }
}

/** @param {string[]} inputs @param {string | undefined} output @param {boolean} json @returns {Job} */
function oneOf(inputs, output, json) {
  if (inputs.includes('-')) throw new UsageError('merge reads files, not standard input');
  if (output === undefined && !json) throw new UsageError('where should the result go? -o FILE, or --json for the report alone');
  if (output === '-' && json) throw new UsageError('--json and --out - both want standard output');
  return { input: inputs.join(' + '), inputs, output };
}

/** @param {string[]} inputs @param {string} output @param {boolean} json @returns {Job} */
function single(inputs, output, json) {
  if (inputs.length > 1) throw new UsageError(`--out takes one file, and there are ${inputs.length}: --out-dir takes them all`);
  if (output === '-' && json) throw new UsageError('--json and --out - both want standard output');
  return { input: inputs[0], output };
}

/** @param {string[]} inputs @param {string} folder @param {string} format @returns {Job[]} */
function batch(inputs, folder, format) {
  /** @type {Map<string, string>} */
  const taken = new Map();
  return inputs.map((input) => {
    if (input === '-') throw new UsageError('standard input has no name for --out-dir to use: -o FILE gives it one');
    const output = join(folder, `${basename(input, extname(input))}.${format}`);
    const other = taken.get(output);
    if (other !== undefined) throw new UsageError(`'${other}' and '${input}' would both become '${output}'`);
    taken.set(output, input);
    return { input, output };
  });
}
