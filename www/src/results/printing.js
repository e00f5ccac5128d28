/** Whether a mesh can be printed, and how large it then is. */
import { say } from '../words/say.js';
import * as format from './format.js';

/** @import { SurfaceMesh, Unit } from 'pointweave' */

/** Millimetres in a unit of length. @type {Partial<Record<Unit, number>>} */
const MILLIMETRES = { mm: 1, cm: 10, m: 1000, in: 25.4, ft: 304.8, 'us-ft': 1200e3 / 3937 };

/**
 * What a printer asks of a mesh: whether it is closed, what is missing else, and in units of the scan its volume, which is negative where
 * its sides are inside out, and the edges of its box. Costs one pass over the triangles.
 * @param {Pick<SurfaceMesh, 'positions' | 'indices'> & { report: Pick<SurfaceMesh['report'], 'boundaryEdges' | 'nonManifoldEdges' | 'holes'> }} mesh
 */
export function solidOf({ positions, indices, report }) {
  const { boundaryEdges, nonManifoldEdges } = report;
  const closed = boundaryEdges === 0 && nonManifoldEdges === 0;
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i++) {
    low[i % 3] = Math.min(low[i % 3], positions[i]);
    high[i % 3] = Math.max(high[i % 3], positions[i]);
  }
  return { closed, open: report.holes.filter(({ closed }) => !closed).length, volume: closed ? volumeOf(positions, indices, low) : 0, size: low.map((least, axis) => high[axis] - least) };
}

/** Of the tetrahedra between a corner and the triangles. @param {ArrayLike<number>} positions @param {Uint32Array} indices @param {number[]} corner */
function volumeOf(positions, indices, [x, y, z]) {
  let six = 0;
  for (let i = 0; i < indices.length; i += 3) {
    const [a, b, c] = [3 * indices[i], 3 * indices[i + 1], 3 * indices[i + 2]];
    const [ax, ay, az] = [positions[a] - x, positions[a + 1] - y, positions[a + 2] - z];
    const [bx, by, bz] = [positions[b] - x, positions[b + 1] - y, positions[b + 2] - z];
    const [cx, cy, cz] = [positions[c] - x, positions[c + 1] - y, positions[c + 2] - z];
    six += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
  }
  return six / 6;
}

/**
 * The same in words: how large it is printed, or what is missing.
 * @param {ReturnType<typeof solidOf>} solid
 * @param {Unit | undefined} unit
 * @returns {{ ready: boolean, words: string }}
 */
export function printingWords({ closed, open, volume, size }, unit) {
  if (!closed) {
    const words = open === 1 ? say('Not ready for 3D printing: it has an open border.')
      : open ? say('Not ready for 3D printing: it has {count} holes or open borders.', { count: format.count(open) })
        : say('Not ready for 3D printing: it is not watertight.');
    return { ready: false, words };
  }
  if (volume <= 0) return { ready: false, words: say('Not ready for 3D printing: its sides are inside out. Flip it.') };
  const factor = MILLIMETRES[unit ?? 'mm'];
  if (!factor) return { ready: false, words: say('Not ready for 3D printing: its coordinates are degrees, which are no lengths.') };
  const values = { size: size.map((edge) => format.length(edge * factor)).join(' × '), volume: format.volume(volume * factor ** 3) };
  return {
    ready: true,
    words: unit ? say('Watertight, ready for 3D printing: {size} mm, {volume}.', values)
      : say('Watertight, ready for 3D printing: {size} mm, {volume}, if a coordinate of 1 is a millimetre. Say its unit below.', values),
  };
}
