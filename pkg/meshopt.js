/**
 * `pointweave/meshopt`: compresses GLB files by `EXT_meshopt_compression`, with glTF-Transform and meshoptimizer, which are
 * optional peer dependencies of the package. Nothing else of the package imports them.
 */
import { WebIO } from '@gltf-transform/core';
import { EXTMeshoptCompression, EXTTextureWebP, KHRMeshQuantization, KHRTextureBasisu } from '@gltf-transform/extensions';
import { MeshoptEncoder } from 'meshoptimizer';

/**
 * Loses nothing of a file that `write` made: points keep their order, vertices and triangles of a mesh get another.
 * @param {Uint8Array} glb
 * @returns {Promise<Uint8Array>}
 */
export async function compress(glb) {
  await MeshoptEncoder.ready;
  const io = new WebIO().registerExtensions([EXTMeshoptCompression, EXTTextureWebP, KHRMeshQuantization, KHRTextureBasisu]);
  io.registerDependencies({ 'meshopt.encoder': MeshoptEncoder });
  const document = await io.readBinary(glb);
  for (const mesh of document.getRoot().listMeshes()) mesh.listPrimitives().forEach(reorder);
  document.createExtension(EXTMeshoptCompression).setRequired(true);
  return io.writeBinary(document);
}

/**
 * Puts triangles, and vertices in the order in which they are first used, which makes both compress well.
 * @param {import('@gltf-transform/core').Primitive} primitive
 */
function reorder(primitive) {
  const indices = primitive.getIndices();
  if (!indices) return;
  const triangles = Uint32Array.from(/** @type {Uint32Array} */ (indices.getArray()));
  const [places, used] = MeshoptEncoder.reorderMesh(triangles, true, true); // which also writes the new triangles over the old
  const Type = used <= 65_535 ? Uint16Array : Uint32Array;
  indices.setArray(Type.from(triangles));
  for (const accessor of primitive.listAttributes()) {
    const from = /** @type {import('@gltf-transform/core').TypedArray} */ (accessor.getArray());
    const size = accessor.getElementSize();
    const to = from.slice(0, used * size);
    places.forEach((place, vertex) => {
      if (place < used) to.set(from.subarray(vertex * size, (vertex + 1) * size), place * size);
    });
    accessor.setArray(to);
  }
}
