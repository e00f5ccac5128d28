/** Which triangle, or which point, lies under a place of the picture, and how the surface around it stands. */
import { Matrix3, Matrix4, Raycaster, Vector3 } from 'three';

/** @import { BufferGeometry, Mesh, PerspectiveCamera, Plane } from 'three' */
/** @import { Layer } from './stage.js' */

/** The plane of a triangle is that of what lies around it within this share of the mesh's size … */
const REACH = 0.1;
/** … and is inclined by no more, as a cosine: 20°. */
const ALIKE = Math.cos(Math.PI / 9);
/** So often the plane is found from what is like it. */
const ROUNDS = 3;

/** How much farther away, as a share of the diagonal, a point may be that is hit in its middle and not at the end of the reach. */
const WORTH = 0.05;

const ray = new Raycaster();

/**
 * The nearest triangle of a layer: its index, counted through the layer's objects, where it is hit, and the direction of the plane
 * around it that looks at the camera, both as it stands before the camera. `null` where there is none.
 * @param {Layer} layer
 * @param {PerspectiveCamera} camera which may have the projection of another kind
 * @param {Plane[]} planes what is behind one of them is not there
 * @param {number} x from -1 at the left of the picture to 1
 * @param {number} y from -1 at the bottom to 1
 */
export function triangleAt({ bit, objects }, camera, planes, x, y) {
  const from = new Vector3(x, y, -1).unproject(camera);
  ray.set(from, new Vector3(x, y, 1).unproject(camera).sub(from).normalize());
  ray.layers.set(bit);
  const meshes = /** @type {Mesh[]} */ (objects.filter(({ type }) => type !== 'Points'));
  const hit = ray.intersectObjects(meshes, false).find(({ point }) => planes.every((plane) => plane.distanceToPoint(point) >= 0));
  if (!hit) return null;
  const at = meshes.findIndex((mesh) => mesh === hit.object);
  const before = meshes.slice(0, at).reduce((sum, { geometry }) => sum + (geometry.index ?? geometry.getAttribute('position')).count / 3, 0);
  const { geometry, matrixWorld } = meshes[at];
  const normal = planeAround(geometry, Number(hit.faceIndex)).applyNormalMatrix(new Matrix3().getNormalMatrix(matrixWorld));
  if (normal.dot(ray.ray.direction) > 0) normal.negate();
  return { triangle: before + Number(hit.faceIndex), point: hit.point, normal };
}

/**
 * The point of a layer that is meant by a place: of those within reach the nearest to the eye, but no point hides one that is much nearer
 * to the place. `null` where there is none.
 * @param {Layer} layer
 * @param {PerspectiveCamera} camera
 * @param {Plane[]} planes what is behind one of them is not there
 * @param {{ x: number, y: number, width: number, height: number, reach: number }} place in device pixels from the top left
 */
export function pointAt({ objects }, camera, planes, { x, y, width, height, reach }) {
  let found = null;
  let least = Infinity;
  let before = 0;
  for (const { type, geometry, matrixWorld } of objects) {
    if (type !== 'Points') continue;
    const positions = /** @type {import('three').BufferAttribute} */ (geometry.getAttribute('position'));
    const eye = new Matrix4().multiplyMatrices(camera.matrixWorldInverse, matrixWorld);
    const m = new Matrix4().multiplyMatrices(camera.projectionMatrix, eye).elements;
    const [ex, ey, ez, ew] = [eye.elements[2], eye.elements[6], eye.elements[10], eye.elements[14]];
    const { array, step, offset } = valuesOf(positions);
    for (let i = 0; i < positions.count; i++) {
      const px = array[step * i + offset];
      const py = array[step * i + offset + 1];
      const pz = array[step * i + offset + 2];
      const w = m[3] * px + m[7] * py + m[11] * pz + m[15];
      const dx = ((w + m[0] * px + m[4] * py + m[8] * pz + m[12]) * width) / 2 - w * x;
      const dy = ((w - m[1] * px - m[5] * py - m[9] * pz - m[13]) * height) / 2 - w * y;
      // Most are elsewhere, or behind the camera.
      const far = w * reach;
      if (!(dx < far && -dx < far && dy < far && -dy < far)) continue;
      const off = Math.hypot(dx, dy) / far;
      if (off >= 1) continue;
      // The frame's diagonal is 1: a place that is off by the whole reach is worth so much depth.
      const cost = WORTH * off - (ex * px + ey * py + ez * pz + ew);
      if (cost >= least) continue;
      const point = new Vector3(px, py, pz).applyMatrix4(matrixWorld);
      if (planes.some((plane) => plane.distanceToPoint(point) < 0)) continue;
      least = cost;
      found = { index: before + i, point };
    }
    before += positions.count;
  }
  return found;
}

/**
 * Where an attribute's values lie. Files that are quantised put bytes between them, and may mean shares of the largest whole number.
 * @param {import('three').BufferAttribute | import('three').InterleavedBufferAttribute} attribute
 */
function valuesOf(attribute) {
  const { count, itemSize, normalized } = attribute;
  if (normalized) {
    const array = new Float32Array(itemSize * count);
    for (let i = 0; i < array.length; i++) array[i] = attribute.getComponent(Math.floor(i / itemSize), i % itemSize);
    return { array, step: itemSize, offset: 0 };
  }
  if ('data' in attribute) return { array: attribute.data.array, step: attribute.data.stride, offset: attribute.offset };
  return { array: attribute.array, step: itemSize, offset: 0 };
}

/** The mean direction, by area, of the faces near one that stand as it does. @param {BufferGeometry} geometry @param {number} face */
function planeAround(geometry, face) {
  const { index } = geometry;
  const positions = geometry.getAttribute('position');
  const [a, b, c, center, across] = Array.from({ length: 5 }, () => new Vector3());
  /** Centre of a face, and its direction as long as twice its area. @param {number} i */
  const read = (i) => {
    [a, b, c].forEach((corner, k) => corner.fromBufferAttribute(positions, index ? index.getX(3 * i + k) : 3 * i + k));
    center.copy(a).add(b).add(c).divideScalar(3);
    across.copy(b).sub(a).cross(c.sub(a));
  };
  read(face);
  const middle = center.clone();
  const plane = across.clone().normalize();
  if (!geometry.boundingSphere) geometry.computeBoundingSphere();
  const reach = REACH * (geometry.boundingSphere?.radius ?? 0);
  /** @type {Vector3[]} */
  const near = [];
  for (let i = 0; i < (index ?? positions).count / 3; i++) {
    read(i);
    if (center.distanceTo(middle) <= reach) near.push(across.clone());
  }
  for (let round = 0; round < ROUNDS; round++) {
    const sum = new Vector3();
    for (const one of near) if (one.dot(plane) >= ALIKE * one.length()) sum.add(one);
    if (sum.lengthSq() > 0) plane.copy(sum).normalize();
  }
  return plane;
}
