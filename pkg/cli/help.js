/** What `--help` prints. The flags come from the tables of options; only the words for each are here. */
import { CLOUD_ROWS } from './cloud-flags.js';
import { FORMATS } from './formats.js';
import { flagsOf } from './flags.js';

/** @import { Command, Flag } from './flags.js' */

/** One line for each option, by its name. @type {Record<string, string>} */
export const WORDS = {
  ratio: 'keep this share of the points',
  count: 'keep exactly so many points',
  tolerance: 'keep the fewest points whose surface stays within this share of the diagonal',
  flatness: "the paper's lambda: reduce what is flatter, keep the rest",
  method: 'how points are chosen',
  fuzzifier: 'm of fuzzy c-means',
  epsilon: 'stop when less than this changes',
  maxIterations: 'sweeps of fuzzy c-means, at most',
  norm: "the norm, for the paper's method",
  clusters: 'how many clusters a sub-domain gets',
  curvatureWeight: 'from even spacing to concentration on curved regions',
  placement: 'where a point goes',
  seed: "of the random start, for the paper's method",
  cellPoints: 'most points of a sub-domain',
  maxDepth: 'deepest level of the octree',
  attributes: 'how an attribute is carried to the result, can be repeated: NAME=mean, majority or nearest',
  outliers: 'whether isolated points are dropped first',
  reduce: 'fit every point',
  accuracy: 'residual that the fit has to reach, a share of the diagonal',
  kernel: 'of the radial basis functions',
  smoothing: 'of the fit; auto follows the measured noise',
  orient: "infer which side is out: the file's normals say it",
  orientation: 'what says which side is out; auto takes all that is known',
  flip: 'turn the result to its other side',
  propagation: 'how orientation spreads',
  resolution: 'edge length of the mesh, a share of the diagonal',
  sharp: 'keep creases',
  boundary: 'close the surface, or let it end where points do',
  faces: 'of a mesh: points are taken from its faces, or its vertices are the points',
  up: 'which way is up in the result; default: what its format asks for',
  unit: 'the unit of the result; default: what its format asks for',
  encoding: 'of a PLY file',
  quantize: 'a GLB file with positions rounded to 1/65535 and normals to 1/127, in half the room',
  meshopt: 'a compressed GLB file; needs @gltf-transform/core, @gltf-transform/extensions and meshoptimizer',
};

/** @type {Record<Command, string>} */
const DOES = {
  reduce: 'fewer points that stand for all',
  reconstruct: 'a mesh through the points',
  inspect: 'count, bounds, spacing, noise',
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
  [['reconstruct'], 'Surface'],
  [['write'], 'File'],
];

/** The overview. */
export function overview() {
  const commands = Object.entries(DOES).map(([command, does]) => [command, does]);
  return `Raw 3D scans to reduced point clouds and meshes.

  pointweave reduce scan.ply -o light.ply --ratio 0.2
  pointweave reconstruct scan.ply -o mesh.glb
  pointweave inspect scan.ply

Commands, each with --help
${rows(commands)}
  pointweave --version
`;
}

/** @param {Command} command */
export function help(command) {
  const flags = flagsOf(command);
  const output = command === 'inspect' ? '' : ` -o result.${command === 'reduce' ? 'ply' : 'glb'} [options]`;
  const sections = SECTIONS.map(([groups, title]) => [title, flags.filter(({ group }) => groups.includes(group)).map(row)]);
  const works = command !== 'inspect';
  const listed = [...sections, ['Scan', works ? CLOUD_ROWS : []], ['General', [...(works ? OUTPUT : []), ...COMMON]]];
  const filled = listed.filter(([, lines]) => lines.length > 0);
  return `pointweave ${command}: ${DOES[command]}

  pointweave ${command} scan.ply${output}
  pointweave ${command} a.ply b.ply${command === 'inspect' ? '' : ' --out-dir results'}
  - reads standard input

${filled.map(([title, lines]) => `${title}\n${rows(/** @type {string[][]} */ (lines))}`).join('\n')}`;
}

/** @param {Flag} flag */
function row({ name, key, group, rule, kind }) {
  const words = WORDS[key];
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
