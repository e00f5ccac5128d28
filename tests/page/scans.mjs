// The scans of the tests, as points and as the files that a person would drop.

import { sharedFile } from './browser.mjs';

/** Points of an XYZ text: the first three columns. */
export function parseXyz(text) {
  return text.trim().split('\n').map((line) => line.trim().split(/\s+/).slice(0, 3).map(Number));
}

/** Points of oni.ply: binary little-endian, double x y z nx ny nz. */
export function parseOni(bytes) {
  const start = bytes.indexOf('end_header\n') + 'end_header\n'.length;
  const rows = Math.floor((bytes.length - start) / 48);
  return Array.from({ length: rows }, (_, i) => [0, 8, 16].map((offset) => bytes.readDoubleLE(start + 48 * i + offset)));
}

/** Points of a binary PCD with float x y z, as Zaghetto.pcd is. */
export function parsePcd(bytes) {
  const start = bytes.indexOf('DATA binary\n') + 'DATA binary\n'.length;
  const rows = Number(/POINTS (\d+)/.exec(bytes.toString('latin1', 0, start))[1]); // padding follows them
  return Array.from({ length: rows }, (_, i) => [0, 4, 8].map((offset) => bytes.readFloatLE(start + 12 * i + offset)));
}

/** A binary PLY of points. */
export function toPly(points) {
  const header = `ply\nformat binary_little_endian 1.0\nelement vertex ${points.length}\n`
    + 'property float x\nproperty float y\nproperty float z\nend_header\n';
  const values = Float32Array.from(points.flat());
  return Buffer.concat([Buffer.from(header), Buffer.from(values.buffer)]);
}

/** The ten raw scans of the bunny in one frame; null where the shared data is missing. */
export async function mergedBunny() {
  const poses = await sharedFile('scans/bunny_raw/bun.conf');
  if (!poses) return null;
  const merged = [];
  for (const [, name, pose] of poses.toString().matchAll(/^bmesh (\S+) (.*)$/gm)) {
    const [tx, ty, tz, qx, qy, qz, qw] = pose.trim().split(/\s+/).map(Number);
    const rotate = rotation(qx, qy, qz, -qw); // the file's quaternion turns the other way
    const scan = parseAsciiVertices((await sharedFile(`scans/bunny_raw/${name}`)).toString('latin1'));
    for (const point of scan) {
      const turned = rotate(point);
      merged.push([turned[0] + tx, turned[1] + ty, turned[2] + tz]);
    }
  }
  return merged;
}

function parseAsciiVertices(text) {
  const count = Number(/element vertex (\d+)/.exec(text)[1]);
  const body = text.slice(text.indexOf('end_header') + 'end_header'.length).trimStart();
  return body.split('\n', count).map((line) => line.trim().split(/\s+/).slice(0, 3).map(Number));
}

function rotation(x, y, z, w) {
  const rows = [
    [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
  ];
  return (point) => rows.map((row) => row[0] * point[0] + row[1] * point[1] + row[2] * point[2]);
}

/** Points evenly spread over a sphere of radius 1; `move` changes each of them, given its direction and its number. */
export function spherePoints(count, move = (direction) => direction) {
  const golden = Math.PI * (3 - Math.sqrt(5));
  return Array.from({ length: count }, (_, i) => {
    const z = 1 - (2 * i + 1) / count;
    const ring = Math.sqrt(1 - z * z);
    return move([ring * Math.cos(i * golden), ring * Math.sin(i * golden), z], i);
  });
}

/** Points as an XYZ text. */
export function toXyz(points) {
  return Buffer.from(points.map((point) => point.join(' ')).join('\n'));
}
