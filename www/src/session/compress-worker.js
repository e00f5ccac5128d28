/**
 * Compresses GLB files, and takes compressed ones apart, in a thread of its own: what comes in is `{ id, glb, to }`, what goes out
 * `{ id, made }` or `{ id, message }`.
 */
import { WebIO } from '@gltf-transform/core';
import { EXTMeshoptCompression, EXTTextureWebP, KHRMeshQuantization } from '@gltf-transform/extensions';
import { MeshoptDecoder } from 'meshoptimizer';
import { compress } from 'pointweave/meshopt';

addEventListener('message', async ({ data: { id, glb, to } }) => {
  try {
    const made = await (to === 'plain' ? expand(glb) : compress(to === 'web' ? await packed(glb) : glb));
    postMessage({ id, made }, { transfer: [made.buffer] });
  } catch (error) {
    postMessage({ id, message: error instanceof Error ? error.message : String(error) });
  }
});

/** Of pictures, 0 to 1: what is lost is less than a grey level or two. */
const QUALITY = 0.92;

/** The same with smaller pictures. @param {Uint8Array} glb */
async function packed(glb) {
  const io = new WebIO().registerExtensions([EXTTextureWebP, KHRMeshQuantization]);
  const document = await io.readBinary(glb);
  for (const texture of document.getRoot().listTextures()) {
    const png = new Blob([/** @type {Uint8Array<ArrayBuffer>} */ (texture.getImage())], { type: texture.getMimeType() });
    const image = await createImageBitmap(png, { premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
    const canvas = new OffscreenCanvas(image.width, image.height);
    /** @type {OffscreenCanvasRenderingContext2D} */ (canvas.getContext('2d')).drawImage(image, 0, 0);
    image.close();
    let file = await canvas.convertToBlob({ type: 'image/webp', quality: QUALITY });
    if (file.type === 'image/webp') document.createExtension(EXTTextureWebP).setRequired(true);
    else file = await canvas.convertToBlob({ type: 'image/jpeg', quality: QUALITY });
    texture.setImage(new Uint8Array(await file.arrayBuffer())).setMimeType(file.type);
  }
  return io.writeBinary(document);
}

/** The same without compression. @param {Uint8Array} glb */
async function expand(glb) {
  await MeshoptDecoder.ready;
  const io = new WebIO().registerExtensions([EXTMeshoptCompression, EXTTextureWebP, KHRMeshQuantization]).registerDependencies({ 'meshopt.decoder': MeshoptDecoder });
  const document = await io.readBinary(glb);
  document.createExtension(EXTMeshoptCompression).dispose();
  return io.writeBinary(document);
}
