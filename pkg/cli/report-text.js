/** Reports and what is known of a cloud, as text for the terminal. */
import { sideInWords } from '../engine/side.js';
import { skippedInWords } from '../files/skipped.js';

/** @import { CloudInfo, FileCloud, LightReport, ReduceReport, StepReport, SurfaceReport } from '../types.js' */

/** @param {number} count */
const whole = (count) => count.toLocaleString('en-US');
/** @param {number} value */
const short = (value, digits = 6) => String(Number(value.toPrecision(digits)));

/** @param {number} count */
export const pointsOf = (count) => `${whole(count)} point${count === 1 ? '' : 's'}`;

/**
 * @param {ReduceReport | SurfaceReport} report
 * @param {FileCloud} cloud
 */
export function reportLine(report, { skipped }) {
  const { inputPoints, outputPoints, distance, totalMs } = report;
  const mesh = 'triangles' in report ? ` → ${whole(report.triangles)} triangles` : '';
  const error = `${short(100 * distance.rms, 2)} % of the diagonal off (rms)`;
  const side = 'orientation' in report ? `; ${sideInWords(report)}` : '';
  const out = skippedInWords(skipped);
  const left = out ? `; left out: ${out}` : '';
  const light = 'simplified' in report && report.simplified ? `; ${lightLine(report.simplified)}` : '';
  return `${whole(inputPoints)} → ${pointsOf(outputPoints)}${mesh}, ${error}, ${(totalMs / 1000).toFixed(1)} s${side}${light}${left}`;
}

/** @param {LightReport} report */
export function lightLine({ from, triangles, error }) {
  const off = (/** @type {number} */ share) => `${short(100 * share, 2)} %`;
  return `${whole(from)} → ${whole(triangles)} triangles, ${off(error.rms)} of the diagonal off (rms), ${off(error.max)} at most`;
}

/**
 * @param {number} count of points before
 * @param {StepReport[]} steps
 */
export function stepsLine(count, steps) {
  const left = steps.at(-1)?.kept ?? count;
  const did = steps.map(({ step, dropped, scans }) => (scans ? `${scans.filter(({ placed }) => placed).length} of ${scans.length} scans placed` : `${step} −${whole(dropped)}`));
  return `${whole(count)} → ${[pointsOf(left), ...did].join(', ')}`;
}

/**
 * Steps that did less than may be expected, and scans that were left out.
 * @param {StepReport[]} steps
 * @param {string[]} [inputs] the files of the scans
 */
export function reasonLines(steps, inputs = []) {
  return steps.flatMap(({ step, reason, scans = [] }) => {
    const out = scans.flatMap((scan, i) => (scan.placed ? [] : [`${inputs[i] ?? `scan ${i}`} is left out: ${scan.reason}`]));
    return reason ? [`${step}: ${reason}`, ...out] : out;
  });
}

/** @param {ReduceReport | SurfaceReport} report */
export function doubtLines(report) {
  const reason = 'simplified' in report && report.simplified?.reason;
  return [...report.doubts.map(({ message }) => `doubtful: ${message}`), ...(reason ? [reason] : [])];
}

/**
 * @param {CloudInfo} info
 * @param {FileCloud} cloud
 */
export function infoLines(info, { colors, normals, attributes = {}, viewpoints, up, seenFromAbove, unit, columns, skipped, file }) {
  // To a millionth of the diagonal, however far away the cloud is.
  const decimals = Math.min(Math.max(6 - Math.floor(Math.log10(info.diagonal || 1)), 0), 20);
  const corner = (/** @type {number[]} */ values) => values.map((x) => Number(x.toFixed(decimals))).join(' ');
  const length = (/** @type {number} */ value) => `${short(value)}${unit ? ` ${unit}` : ''}`;
  const places = viewpoints && viewpoints.positions.length / 3;
  const also = [colors && 'colours', normals && 'normals', places && `${places} viewpoint${places === 1 ? '' : 's'}`, ...Object.keys(attributes)].filter(Boolean).join(', ');
  const rows = [
    ['points', whole(info.count)],
    ['left out', skippedInWords(skipped) || 'none'],
    ['duplicates', whole(info.duplicates)],
    ['also has', also || 'nothing else'],
    ...(columns ? [['columns', columns.join(' ') + (file.table?.weak ? ' (a guess: --columns says it)' : '')]] : []),
    ...(file.replaced > 0 ? [['of that', `${whole(file.replaced)} not finite, taken for 0`]] : []),
    ...(file.faces > 0 ? [['faces', `${whole(file.faces)}, ${file.sampled ? `${pointsOf(file.sampled)} taken from them` : 'not read'}`]] : []),
    ...(file.missing ? [['not found', file.missing.join(', ')]] : []),
    ...(up ? [['up', `${corner(up)}${seenFromAbove ? ', seen from above' : ''}`]] : []),
    ['unit', unit ?? 'not known: lengths are in file units'],
    ['lowest corner', corner(info.bounds.min)],
    ['highest corner', corner(info.bounds.max)],
    ['diagonal', length(info.diagonal)],
    ['spacing', length(info.spacing)],
    ['noise', length(info.noise)],
    ...file.notes.map((note) => ['note', note]),
  ];
  return rows.map(([name, value]) => `  ${name.padEnd(14)}  ${value}\n`).join('');
}
