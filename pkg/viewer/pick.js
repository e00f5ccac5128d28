/** Which triangle lies under a place of the picture. */
import { Raycaster, Vector3 } from 'three';

/** @import { PerspectiveCamera } from 'three' */
/** @import { Layer } from './stage.js' */

const ray = new Raycaster();

/**
 * The index of the nearest triangle of a layer, counted through its objects; -1 where there is none.
 * @param {Layer} layer
 * @param {PerspectiveCamera} camera which may have the projection of another kind
 * @param {number} x from -1 at the left of the picture to 1
 * @param {number} y from -1 at the bottom to 1
 */
export function triangleAt({ bit, objects }, camera, x, y) {
  const from = new Vector3(x, y, -1).unproject(camera);
  ray.set(from, new Vector3(x, y, 1).unproject(camera).sub(from).normalize());
  ray.layers.set(bit);
  const meshes = objects.filter(({ type }) => type !== 'Points');
  const [hit] = ray.intersectObjects(meshes, false);
  if (!hit) return -1;
  const before = meshes.slice(0, meshes.findIndex((mesh) => mesh === hit.object));
  const count = before.reduce((sum, { geometry }) => sum + (geometry.index ?? geometry.getAttribute('position')).count / 3, 0);
  return count + Number(hit.faceIndex);
}
