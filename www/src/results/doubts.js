/** @import { Outcome } from '../session/session.js' */

/** A mesh that is further from the points than this share of the diagonal (RMS) is none to rely on. */
const FAR = 0.01;
/** A piece of land is at most so many degrees wide, and hardly a hundredth as many metres high. */
const DEGREES = 5;
const STRETCHED = 100;

/**
 * Why the mesh is better not relied on, for people who do not read the numbers; empty where nothing speaks against it.
 * @param {Pick<Outcome, 'scan' | 'mesh'>} outcome
 */
export function doubtsAbout({ scan: { frame }, mesh }) {
  if (!mesh) return '';
  const [x, y, z] = frame.size;
  const onGlobe = Math.abs(frame.center[0]) <= 180 && Math.abs(frame.center[1]) <= 90;
  if (onGlobe && Math.max(x, y) < DEGREES && z > STRETCHED * Math.max(x, y)) {
    return 'x and y look like degrees of longitude and latitude, and z like metres, so the shape is drawn out. '
      + 'Convert the scan to metres first: to a projected coordinate system.';
  }
  return mesh.report.distance.rms > FAR
    ? 'The mesh is not close to the points. There are too few of them to tell where the surface is, or some lie far from the rest.'
    : '';
}
