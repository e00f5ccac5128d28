/** What a tile holds, as the viewer draws it: points and bare meshes in its own materials, all else as its file says. */
import { LoadingManager, Mesh, Points, Texture, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { typicalSpacing } from './density.js';
import { fadable } from './fade.js';
import { frameOf, toFrame } from './frame.js';
import { bareIn, dressMesh, dressPoints } from './glb.js';
import { cover } from './layers.js';
import { studioMatcap } from './matcap.js';
import { addSkirts, showStripsFromOutside } from './skirts.js';

/** @import { BufferAttribute, Object3D } from 'three' */

/** So many points say how far apart all are. */
const SAMPLE = 32_768;
/** Points of a tile are at most so many times as far apart, or as close, as is said of its level. */
const LOOSE = 1.5;
/** How far down a mesh's border goes, in distances between its points. */
const SKIRT = 1;
/** Pixels have four bytes, and smaller pictures of a picture a third of that again. */
const PIXEL = 4 * (4 / 3);

/** Notes which meshes have no material. */
class Loader extends GLTFLoader {
  /** @param {ArrayBuffer} bytes @param {string} path */
  async parseAsync(bytes, path) {
    const gltf = await super.parseAsync(bytes, path);
    const isBare = bareIn(gltf);
    gltf.scene?.traverse((object) => (object.userData.bare = isBare(object)));
    return gltf;
  }
}

/** What the renderer loads with. */
export async function loading() {
  const { MeshoptDecoder } = await import('three/addons/libs/meshopt_decoder.module.js');
  const manager = new LoadingManager();
  return manager.addHandler(/\.gl(tf|b)$/i, new Loader(manager).setMeshoptDecoder(MeshoptDecoder));
}

/** @param {Object3D} scene @returns {(Points | Mesh)[]} */
export function objectsOf(scene) {
  /** @type {(Points | Mesh)[]} */
  const found = [];
  scene.traverse((object) => (object instanceof Points || object instanceof Mesh) && found.push(object));
  return found;
}

/**
 * Gives a tile's objects their materials.
 * @param {Object3D} scene in the tileset's frame
 * @param {number} diagonal of the tileset
 * @param {number | undefined} said how far apart points are on average, where the tileset says so: sparse tiles are then not of huge
 *   points, and meshes go down at their borders
 */
export function dress(scene, diagonal, said) {
  scene.updateMatrixWorld(true);
  for (const object of objectsOf(scene)) {
    if (object instanceof Points) {
      const found = spacingOf(object.geometry) * object.matrixWorld.getMaxScaleOnAxis();
      const spacing = said ? Math.min(LOOSE * said, Math.max(said / LOOSE, found)) : found;
      dressPoints(object, (normals) => cover(spacing / diagonal, normals));
      continue;
    }
    dressMesh(object, object.userData.bare === true);
    if (!said || !object.geometry.index) continue;
    addSkirts(object.geometry, (SKIRT * said) / object.matrixWorld.getMaxScaleOnAxis());
    [object.material].flat().forEach(showStripsFromOutside);
  }
  fadable(scene);
}

/** How far apart neighbours are, in the geometry's own unit. @param {import('three').BufferGeometry} geometry */
function spacingOf(geometry) {
  const position = /** @type {BufferAttribute} */ (geometry.getAttribute('position'));
  const step = Math.max(1, Math.ceil(position.count / SAMPLE));
  const positions = new Float32Array(3 * Math.ceil(position.count / step));
  const point = new Vector3();
  for (let i = 0; i < position.count; i += step) point.fromBufferAttribute(position, i).toArray(positions, (3 * i) / step);
  const frame = frameOf({ positions });
  return (frame.diagonal * typicalSpacing(toFrame({ positions }, frame))) / Math.sqrt(step);
}

/** Bytes of points, triangles and pictures. @param {Object3D} scene */
export function bytesOf(scene) {
  const arrays = new Set();
  let bytes = 0;
  for (const { geometry, material } of objectsOf(scene)) {
    for (const attribute of [...Object.values(geometry.attributes), geometry.index]) {
      if (attribute) arrays.add('data' in attribute ? attribute.data.array : attribute.array);
    }
    for (const { image } of texturesOf(material)) bytes += PIXEL * (image?.width ?? 0) * (image?.height ?? 0);
  }
  for (const { byteLength } of arrays) bytes += byteLength;
  return Math.round(bytes);
}

/** Without the one that all share. @param {import('three').Material | import('three').Material[]} material @returns {any[]} */
export function texturesOf(material) {
  return [material].flat().flatMap((one) => Object.values(one)).filter((value) => value instanceof Texture && value !== studioMatcap());
}
