/** What `--help` prints. */
import { CLOUD_ROWS } from './cloud-flags.js';
import { FORMATS, isMesh } from './formats.js';
import { flagsOf } from './flags.js';
import { MERGE_ROWS, PREPARE_ROWS } from './prepare-flags.js';
import { READ_ROWS } from './read-flags.js';

/** @import { Command, Flag } from './flags.js' */

/** @type {Record<Command, string>} */
const DOES = {
  reduce: 'fewer points that stand for all',
  reconstruct: 'a mesh through the points',
  inspect: 'count, bounds, spacing, noise',
  prepare: 'the object alone: without floor, strays and other things',
  merge: 'several scans as one',
  simplify: 'any mesh with fewer triangles',
};

const COMMON = [
  ['--json', 'print the report alone, as JSON, on standard output'],
  ['--threads N', 'threads to compute with; default: one a core'],
  ['-h, --help', 'print this'],
];
const OUTPUT = [
  ['-o, --out FILE', `where the result goes: ${FORMATS.map((name) => `.${name}`).join(' ')}; - is standard output`],
  ['--out-dir FOLDER', 'where the results of several files go, under their own names'],
  ['--format NAME', `of what has no file name of its own; default: ${FORMATS[0]}`],
];

/** @type {[Flag['group'][], string][]} */
const SECTIONS = [
  [['target'], 'How much is kept, one of'],
  [['reduce', 'none'], 'Reduction'],
  [['reconstruct', 'texture'], 'Surface'],
  [['simplify'], 'How light it becomes, one of or both'],
  [['write'], 'File'],
];

/** The overview. */
export function overview() {
  const commands = Object.entries(DOES).map(([command, does]) => [command, does]);
  return `Raw 3D scans to reduced point clouds and meshes.

  pointweave reduce scan.ply -o light.ply --ratio 0.2
  pointweave reconstruct scan.ply -o mesh.glb
  pointweave inspect scan.ply
  pointweave prepare scan.e57 -o object.ply --drop-floor --keep-largest
  pointweave simplify mesh.ply -o light.glb --triangles 10000

Commands, each with --help
${rows(commands)}
  pointweave --version
`;
}

/** @param {Command} command */
export function help(command) {
  const flags = flagsOf(command);
  const output = command === 'inspect' ? '' : ` -o result.${isMesh(command) ? 'glb' : 'ply'} [options]`;
  const sections = SECTIONS.map(([groups, title]) => [title, flags.filter(({ group }) => groups.includes(group)).map(row)]);
  const works = command !== 'inspect';
  const listed = [...sections, ['Before', works && command !== 'simplify' ? [...(command === 'merge' ? MERGE_ROWS : []), ...PREPARE_ROWS] : []], ['Scan', [...flags.filter(({ group }) => group === 'read').map(row), ...READ_ROWS, ...(works ? CLOUD_ROWS : [])]], ['General', [...(works ? OUTPUT : []), ...COMMON]]];
  const filled = listed.filter(([, lines]) => lines.length > 0);
  const several = `  pointweave ${command} a.ply b.ply${command === 'inspect' ? '' : ' --out-dir results'}\n  - reads standard input`;
  const usage = command === 'merge' ? `  pointweave merge a.ply b.ply${output}` : `  pointweave ${command} ${command === 'simplify' ? 'mesh' : 'scan'}.ply${output}\n${several}`;
  return `pointweave ${command}: ${DOES[command]}

${usage}

${filled.map(([title, lines]) => `${title}\n${rows(/** @type {string[][]} */ (lines))}`).join('\n')}`;
}

/** @param {Flag} flag */
function row({ name, group, rule, kind, words }) {
  if (group === 'none') return [`--${name}`, words];
  if (kind === 'list') return [`--${name} NAME=HOW`, words];
  if (kind === 'switch') return [rule.fallback ? `--no-${name}` : `--${name}`, `${rule.fallback ? 'do not ' : ''}${words}`];
  const fallback = rule.fallback === undefined || typeof rule.fallback === 'object' ? '' : `; default: ${rule.fallback}`;
  const values = rule.names ? rule.names.join(', ') : rule.expected;
  return [`--${name} ${rule.names ? 'NAME' : 'N'}`, `${words}: ${values}${fallback}`];
}

/** @param {string[][]} lines pairs, the second of which start in one column */
function rows(lines) {
  const width = Math.max(...lines.map(([left]) => left.length));
  return lines.map(([left, right]) => `  ${left.padEnd(width)}  ${right}\n`).join('');
}
