/** USDZ files of what an element shows, for Quick Look. */
import { BufferAttribute, Color, Matrix3, SRGBColorSpace, Vector3 } from 'three';
import { sharedEngine } from './engines.js';

/** @import { Mesh, MeshStandardMaterial } from 'three' */
/** @import { EngineOptions, SurfaceMesh } from '../types.js' */

/**
 * A mesh of ours by our own writer. A GLB with pictures by three.js's, which knows materials; it does not show colours of vertices, so
 * that a GLB without pictures becomes one mesh, for ours.
 * @param {SurfaceMesh | import('./source.js').Glb} subject
 * @param {EngineOptions} options
 * @returns {Promise<Uint8Array<ArrayBuffer>>}
 */
export async function usdzOf(subject, options) {
  if (!('kind' in subject)) return written(subject, options);
  const { readGlb } = await import('../viewer/glb.js');
  const { scene, layers } = /** @type {import('../viewer/glb.js').Parts} */ (/** @type {unknown} */ (await readGlb(subject.bytes)));
  const [own] = scene.children;
  own.removeFromParent();
  own.updateMatrixWorld(true);
  const meshes = /** @type {Mesh[]} */ (layers.mesh ?? []);
  if (!meshes.some((mesh) => materialOf(mesh).map)) return written(joined(meshes), options);
  const { USDZExporter } = await import('three/addons/exporters/USDZExporter.js');
  return new Uint8Array(await new USDZExporter().parseAsync(own));
}

/** @param {SurfaceMesh | ReturnType<typeof joined>} mesh @param {EngineOptions} options */
async function written(mesh, options) {
  const engine = await sharedEngine(options);
  return /** @type {Uint8Array<ArrayBuffer>} */ (await engine.write(/** @type {SurfaceMesh} */ (mesh), { format: 'usdz' }));
}

/** @param {Mesh} mesh */
function materialOf(mesh) {
  return /** @type {MeshStandardMaterial} */ ([mesh.material].flat()[0]);
}

/** Meshes as one, where they stand, with the colours of vertices and materials. @param {Mesh[]} meshes */
function joined(meshes) {
  const count = meshes.reduce((sum, { geometry }) => sum + geometry.getAttribute('position').count, 0);
  const [positions, normals, colors] = [new Float32Array(3 * count), new Float32Array(3 * count), new Uint8Array(3 * count)];
  /** @type {number[][]} */
  const corners = [];
  const [place, direction, color, turn] = [new Vector3(), new Vector3(), new Color(), new Matrix3()];
  let first = 0;
  for (const mesh of meshes) {
    const { geometry, matrixWorld } = mesh;
    const [at, normal, painted] = ['position', 'normal', 'color'].map((name) => /** @type {BufferAttribute} */ (geometry.getAttribute(name)));
    turn.getNormalMatrix(matrixWorld);
    for (let i = 0; i < at.count; i++) {
      const to = 3 * (first + i);
      place.fromBufferAttribute(at, i).applyMatrix4(matrixWorld).toArray(positions, to);
      direction.fromBufferAttribute(normal, i).applyMatrix3(turn).normalize().toArray(normals, to);
      color.copy(materialOf(mesh).color);
      if (painted) color.multiply(new Color().fromBufferAttribute(painted, i));
      const { r, g, b } = color.getRGB({ r: 0, g: 0, b: 0 }, SRGBColorSpace);
      colors.set([r, g, b].map((value) => Math.round(255 * Math.min(1, value))), to);
    }
    const order = geometry.index ? Array.from(geometry.index.array) : Array.from({ length: at.count }, (_, i) => i);
    corners.push(order.map((corner) => corner + first));
    first += at.count;
  }
  return { positions, normals, colors, indices: Uint32Array.from(corners.flat()) };
}
