/** Scans in frames of their own: on their way to wasm, and put together by what it found. */
import { cloudArgument } from './clouds.js';
import { fromOrigin, joinedCloud } from '../files/joining.js';

/** @import { PointCloud, ScanReport, Step } from '../types.js' */

/** Whether a recipe takes scans one by one. @param {Step[]} steps @param {unknown} clouds */
export function registers(steps, clouds) {
  return steps[0]?.step === 'register' && Array.isArray(clouds) && clouds.length > 1;
}

/**
 * Scans in memory of this call, told from one origin.
 * @param {unknown[]} clouds
 * @param {boolean} [transfer]
 * @returns {PointCloud[]}
 */
export function scansArgument(clouds, transfer) {
  const scans = clouds.map((cloud) => cloudArgument(cloud, transfer));
  const [{ origin }] = scans;
  const here = JSON.stringify(origin);
  return scans.map((scan) => (JSON.stringify(scan.origin) === here ? scan : told(scan, origin)));
}

/** @param {PointCloud} scan @param {PointCloud['origin']} origin @returns {PointCloud} */
function told(scan, origin) {
  const from = (/** @type {Float32Array | Float64Array} */ positions) => fromOrigin({ positions, origin: scan.origin }, origin);
  const { viewpoints } = scan;
  return { ...scan, origin, positions: from(scan.positions), viewpoints: viewpoints && { ...viewpoints, positions: from(viewpoints.positions) } };
}

/**
 * All scans as one cloud: those that were placed where they belong, in colours that agree.
 * @param {PointCloud[]} scans
 * @param {ScanReport[]} reports
 * @returns {PointCloud}
 */
export function together(scans, reports) {
  const { up } = scans[reports.findIndex(({ placed }) => placed)];
  return joinedCloud(scans.map((scan, i) => ({ ...placed(scan, reports[i]), up })));
}

/** @param {PointCloud} scan @param {ScanReport} report @returns {PointCloud} */
function placed(scan, { pose, gain }) {
  if (!pose) return scan;
  const { positions, normals, viewpoints, colors } = scan;
  return {
    ...scan,
    positions: moved(positions, pose, pose.slice(12, 15)),
    normals: normals && moved(normals, pose, [0, 0, 0]),
    viewpoints: viewpoints && { ...viewpoints, positions: moved(viewpoints.positions, pose, pose.slice(12, 15)) },
    colors: colors && (gain ? colors.map((x, i) => Math.min(Math.floor(x * gain[i % 3] + 0.5), 255)) : colors),
  };
}

/**
 * @template {Float32Array | Float64Array} A
 * @param {A} points
 * @param {number[]} m a rotation by columns of four
 * @param {number[]} shift
 */
function moved(points, m, [x, y, z]) {
  const there = /** @type {A} */ (new /** @type {any} */ (points.constructor)(points.length));
  for (let i = 0; i < points.length; i += 3) {
    const [a, b, c] = [points[i], points[i + 1], points[i + 2]];
    there[i] = m[0] * a + m[4] * b + m[8] * c + x;
    there[i + 1] = m[1] * a + m[5] * b + m[9] * c + y;
    there[i + 2] = m[2] * a + m[6] * b + m[10] * c + z;
  }
  return there;
}
