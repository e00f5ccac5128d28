/** Results as people read them. */

/** @import { CloudInfo, PointCloud, ReduceReport, SurfaceReport } from '../types.js' */

/** @param {number} count */
const whole = (count) => count.toLocaleString('en-US');
/** @param {number} value */
const short = (value, digits = 6) => String(Number(value.toPrecision(digits)));

/** @param {ReduceReport | SurfaceReport} report */
export function reportLine(report) {
  const { inputPoints, outputPoints, distance, totalMs } = report;
  const mesh = 'triangles' in report ? ` → ${whole(report.triangles)} triangles` : '';
  const error = `${short(100 * distance.rms, 2)} % of the diagonal off (rms)`;
  return `${whole(inputPoints)} → ${whole(outputPoints)} points${mesh}, ${error}, ${(totalMs / 1000).toFixed(1)} s`;
}

/**
 * @param {CloudInfo} info
 * @param {PointCloud} cloud
 */
export function infoLines(info, { colors, normals, attributes = {}, origin }) {
  // To a millionth of the diagonal, however far away the cloud is.
  const decimals = Math.min(Math.max(6 - Math.floor(Math.log10(info.diagonal || 1)), 0), 20);
  const corner = (/** @type {number[]} */ values) => values.map((x) => Number(x.toFixed(decimals))).join(' ');
  const also = [colors && 'colours', normals && 'normals', ...Object.keys(attributes)].filter(Boolean).join(', ');
  const rows = [
    ['points', whole(info.count)],
    ['not finite', whole(info.nonFinite)],
    ['duplicates', whole(info.duplicates)],
    ['also has', also || 'nothing else'],
    ['lowest corner', corner(info.bounds.min)],
    ['highest corner', corner(info.bounds.max)],
    ...(origin ? [['origin to add', origin.join(' ')]] : []),
    ['diagonal', short(info.diagonal)],
    ['spacing', short(info.spacing)],
    ['noise', short(info.noise)],
  ];
  return rows.map(([name, value]) => `  ${name.padEnd(14)}  ${value}\n`).join('');
}
