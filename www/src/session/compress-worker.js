/**
 * Compresses GLB files, and takes compressed ones apart, in a thread of its own: what comes in is `{ id, glb, to }`, what goes out
 * `{ id, made }` or `{ id, message }`.
 */
import { WebIO } from '@gltf-transform/core';
import { EXTMeshoptCompression, KHRMeshQuantization } from '@gltf-transform/extensions';
import { MeshoptDecoder } from 'meshoptimizer';
import { compress } from 'pointweave/meshopt';

addEventListener('message', async ({ data: { id, glb, to } }) => {
  try {
    const made = await (to === 'small' ? compress(glb) : expand(glb));
    postMessage({ id, made }, { transfer: [made.buffer] });
  } catch (error) {
    postMessage({ id, message: error instanceof Error ? error.message : String(error) });
  }
});

/** The same without compression. @param {Uint8Array} glb */
async function expand(glb) {
  await MeshoptDecoder.ready;
  const io = new WebIO().registerExtensions([EXTMeshoptCompression, KHRMeshQuantization]).registerDependencies({ 'meshopt.decoder': MeshoptDecoder });
  const document = await io.readBinary(glb);
  document.createExtension(EXTMeshoptCompression).dispose();
  return io.writeBinary(document);
}
