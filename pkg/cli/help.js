/** What `--help` prints. */
import { CLOUD_ROWS } from './cloud-flags.js';
import { FORMATS, LIGHT, firstOf, isMesh } from './formats.js';
import { flagsOf } from './flags.js';
import { MERGE_ROWS, PREPARE_ROWS } from './prepare-flags.js';
import { CATALOGUE_ROWS } from './catalogue-flags.js';
import { READ_ROWS } from './read-flags.js';
import { STEPS, STEP_ROWS, TILES_ROWS } from './tiles-flags.js';

/** @import { Command, Flag } from './flags.js' */

/** @type {Record<Command, string>} */
const DOES = {
  reduce: 'fewer points that stand for all',
  reconstruct: 'a mesh through the points',
  inspect: 'count, bounds, spacing, noise',
  prepare: 'the object alone: without floor, strays and other things',
  merge: 'several scans as one',
  simplify: 'any mesh with fewer triangles',
  poster: 'a picture of a scan or a mesh',
  catalogue: 'a folder of scans as a web page of light models',
  tiles: 'a scan of any size as tiles that a page streams',
};

const COMMON = [
  ['--json', 'print the report alone, as JSON, on standard output'],
  ['--threads N', 'threads to compute with; default: one a core'],
  ['-h, --help', 'print this'],
];
/** @param {Command} command */
const outputOf = (command) => [
  ['-o, --out FILE', `where the result goes: ${(command === 'poster' ? ['png'] : FORMATS).map((name) => `.${name}`).join(' ')}; - is standard output`],
  ['--out-dir FOLDER', 'where the results of several files go, under their own names'],
  ['--format NAME', `of what has no file name of its own; default: ${firstOf(command)}`],
];

/** @type {[Flag['group'][], string][]} */
const SECTIONS = [
  [['target'], 'How much is kept, one of'],
  [['reduce', 'none'], 'Reduction'],
  [['reconstruct', 'texture'], 'Surface'],
  [['simplify'], 'How light it becomes, one of or both'],
  [['poster'], 'Picture'],
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
  pointweave poster mesh.glb -o poster.png --size 800x600
  pointweave catalogue scans/ -o site/
  pointweave tiles survey/*.laz -o tiles/

Commands, each with --help
${rows(commands)}
  pointweave --version
`;
}

/** @param {Command} command */
export function help(command) {
  const flags = flagsOf(command);
  if (command === 'tiles') return tilesHelp(flags.map(row));
  const result = command === 'poster' ? 'poster.png' : `result.${isMesh(command) ? 'glb' : 'ply'}`;
  const output = command === 'inspect' ? '' : ` -o ${result} [options]`;
  const sections = SECTIONS.map(([groups, title]) => [title, flags.filter(({ group }) => groups.includes(group)).map(row)]);
  const works = command !== 'inspect';
  const listed = [...sections, ['Before', works && !LIGHT.includes(command) ? [...(command === 'merge' ? MERGE_ROWS : []), ...PREPARE_ROWS] : []], ['Scan', [...flags.filter(({ group }) => group === 'read').map(row), ...READ_ROWS, ...(works ? CLOUD_ROWS : [])]], ['General', [...(command === 'catalogue' ? CATALOGUE_ROWS : works ? outputOf(command) : []), ...COMMON]]];
  const filled = listed.filter(([, lines]) => lines.length > 0);
  const several = `  pointweave ${command} a.ply b.ply${command === 'inspect' ? '' : ' --out-dir results'}\n  - reads standard input`;
  const usage = command === 'catalogue' ? '  pointweave catalogue scans/ -o site/ [options]' : command === 'merge' ? `  pointweave merge a.ply b.ply${output}` : `  pointweave ${command} ${command === 'simplify' ? 'mesh' : 'scan'}.ply${output}\n${several}`;
  return `pointweave ${command}: ${DOES[command]}

${usage}

${filled.map(([title, lines]) => `${title}\n${rows(/** @type {string[][]} */ (lines))}`).join('\n')}`;
}

/** @param {string[][]} read */
function tilesHelp(read) {
  const unit = CLOUD_ROWS.filter(([flag]) => flag.startsWith('--unit'));
  const sections = [['Tiles', TILES_ROWS], [`A step alone, for schedulers: ${STEPS.join(', ')}`, STEP_ROWS], ['Scan', [...read, ...READ_ROWS, ...unit]], ['General', COMMON.filter(([flag]) => !flag.startsWith('--threads'))]];
  return `pointweave tiles: ${DOES.tiles}

  pointweave tiles scan.laz more.e57 folder/ -o tiles/ [options]
  pointweave tiles make -o tiles/ --tile 3-1-0-2

${sections.map(([title, lines]) => `${title}\n${rows(/** @type {string[][]} */ (lines))}`).join('\n')}`;
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
