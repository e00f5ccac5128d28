/** A GLB as things to draw: its own objects where they are, in the studio's light. */
import { Box3, BufferGeometry, Group, Mesh, Points, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { PointweaveError } from '../engine/errors.js';
import { frameBetween, joined } from './frame.js';
import { diameter } from './layers.js';
import { meshMaterial, pointMaterial } from './materials.js';

/** What a file may require and is not shown without; the loader would need programs that are not here. */
const UNSUPPORTED = ['KHR_draco_mesh_compression', 'KHR_texture_basisu'];
const MESHOPT = 'EXT_meshopt_compression';
const JSON_CHUNK = 0x4e4f534a;

/**
 * A GLB that can be shown: its scene in the frame, its objects by layer, and a few of its vertices.
 * @typedef {{ frame: import('../viewer.js').Frame, scene: Group, layers: Record<string, (Points | Mesh)[]>, outline: Float32Array }} Parts
 */

/** Enough vertices to know how large something looks. */
const OUTLINE = 4096;

/**
 * Reads a GLB for a viewer to show. Rejects with a `PointweaveError` where it cannot be read.
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @returns {Promise<import('../viewer.js').Model & Parts>}
 */
export async function readGlb(bytes) {
  const { extensionsRequired = [], extensionsUsed = [] } = header(bytes);
  const unsupported = extensionsRequired.find((name) => UNSUPPORTED.includes(name));
  if (unsupported) {
    throw new PointweaveError({ code: 'unsupported-file', message: `the GLB needs ${unsupported}, which is not supported`, found: unsupported });
  }
  const loader = new GLTFLoader();
  if (extensionsUsed.includes(MESHOPT)) {
    const { MeshoptDecoder } = await import('three/addons/libs/meshopt_decoder.module.js');
    loader.setMeshoptDecoder(MeshoptDecoder);
  }
  const gltf = await loader.parseAsync(bufferOf(bytes), '').catch((error) => {
    throw badFile(error instanceof Error ? error.message : String(error));
  });
  return dressed(gltf.scene, bareIn(gltf));
}

/**
 * Says which meshes of a file have no material.
 * @param {import('three/addons/loaders/GLTFLoader.js').GLTF} gltf
 * @returns {(mesh: import('three').Object3D) => boolean}
 */
export function bareIn({ parser: { associations, json } }) {
  return (mesh) => {
    const { meshes = -1, primitives = 0 } = associations.get(mesh) ?? {};
    return json.meshes?.[meshes]?.primitives[primitives]?.material === undefined;
  };
}

/**
 * The part of the file that says what it needs.
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @returns {{ extensionsRequired?: string[], extensionsUsed?: string[] }}
 */
function header(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 20 || view.getUint32(16, true) !== JSON_CHUNK) throw badFile('it does not begin with a JSON chunk');
  const length = view.getUint32(12, true);
  if (20 + length > bytes.length) throw badFile(`it ends after ${bytes.length} bytes, in its JSON chunk of ${length}`);
  try {
    return JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
  } catch (error) {
    throw badFile(String(error));
  }
}

/**
 * Moves the scene into the frame, and gives its points and what has no material ours.
 * @param {Group} scene
 * @param {(mesh: Mesh) => boolean} isBare whether the file gives it no material
 */
function dressed(scene, isBare) {
  const box = new Box3().setFromObject(scene, true);
  if (box.isEmpty()) throw new PointweaveError({ code: 'empty-cloud', message: 'the GLB holds nothing to show' });
  const frame = frameBetween(box.min.toArray(), box.max.toArray());
  const { center, diagonal } = frame;
  const placed = new Group().add(scene);
  placed.scale.setScalar(1 / diagonal);
  placed.position.fromArray(center).multiplyScalar(-1 / diagonal);
  placed.updateMatrixWorld(true);
  /** @type {Points[]} */
  const points = [];
  /** @type {Mesh[]} */
  const mesh = [];
  scene.traverse((object) => {
    if (object instanceof Points) points.push(dressPoints(object, (normals) => diameter(placedPositions(object), normals)));
    else if (object instanceof Mesh) mesh.push(dressMesh(object, isBare(object)));
  });
  const objects = [...points, ...mesh];
  return {
    kind: /** @type {const} */ ('glb'),
    frame,
    scene: placed,
    layers: { ...(points.length && { points }), ...(mesh.length && { mesh }) },
    outline: joined(objects.map((object) => placedPositions(object, OUTLINE / objects.length))),
  };
}

/** @param {Points} points @param {(normals: 'unoriented' | 'none') => number} diameter of its points in the frame */
export function dressPoints(points, diameter) {
  const { geometry } = points;
  const normals = geometry.hasAttribute('normal') ? 'unoriented' : 'none';
  const colored = geometry.hasAttribute('color');
  points.material = pointMaterial({ colored, linear: true, normals, diameter: diameter(normals) });
  return points;
}

/**
 * Materials stay as the file has them. What has none gets the studio's light and the theme's colour, and plain white the colour that
 * a page asks for.
 * @param {Mesh} mesh
 * @param {boolean} bare
 */
export function dressMesh(mesh, bare) {
  if (!mesh.geometry.hasAttribute('normal')) mesh.geometry.computeVertexNormals();
  const own = /** @type {import('three').MeshStandardMaterial} */ (mesh.material);
  if (own.type === 'MeshBasicMaterial') own.toneMapped = false; // unlit: its colours hold their own light
  else if (bare) {
    const { vertexColors } = own;
    mesh.material = meshMaterial({ vertexColors });
    mesh.userData.themed = !vertexColors;
  } else if (!own.map && !own.vertexColors && own.color.getHex() === 0xffffff) mesh.userData.plain = true;
  return mesh;
}

/**
 * Where an object's vertices are in the frame, at most so many of them.
 * @param {Mesh | Points} object
 * @param {number} [most]
 * @param {import('three').Matrix4} [matrix] from the object to the frame
 */
export function placedPositions(object, most = Infinity, matrix = object.matrixWorld) {
  const position = /** @type {BufferGeometry} */ (object.geometry).getAttribute('position');
  const step = Math.max(1, Math.ceil(position.count / most));
  const out = new Float32Array(3 * Math.ceil(position.count / step));
  const point = new Vector3();
  for (let i = 0; i < position.count; i += step) {
    point.fromBufferAttribute(/** @type {import('three').BufferAttribute} */ (position), i).applyMatrix4(matrix);
    point.toArray(out, (3 * i) / step);
  }
  return out;
}

/** Just those bytes: of a larger buffer, a copy. @param {Uint8Array<ArrayBuffer>} bytes */
function bufferOf({ buffer, byteOffset, byteLength }) {
  return byteLength === buffer.byteLength ? buffer : buffer.slice(byteOffset, byteOffset + byteLength);
}

/** @param {string} why */
function badFile(why) {
  return new PointweaveError({ code: 'bad-file', message: `the GLB cannot be read: ${why}` });
}
