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
    /** @type {OffscreenCanvasRenderingContext2D} */ (canvas.getContext('2d', { alpha: false })).drawImage(image, 0, 0);
    image.close();
    let file = await canvas.convertToBlob({ type: 'image/webp', quality: QUALITY });
    if (file.type === 'image/webp') document.createExtension(EXTTextureWebP).setRequired(true);
    else file = await canvas.convertToBlob({ type: 'image/jpeg', quality: QUALITY });
    const bytes = new Uint8Array(await file.arrayBuffer());
    texture.setImage(file.type === 'image/webp' ? bare(bytes) : bytes).setMimeType(file.type);
  }
  return io.writeBinary(document);
}

/** A WebP file with its picture alone, without the colour profile that browsers put beside it. @param {Uint8Array<ArrayBuffer>} file */
function bare(file) {
  const view = new DataView(file.buffer);
  for (let at = 12; at + 8 <= file.length;) {
    const end = at + 8 + 2 * Math.ceil(view.getUint32(at + 4, true) / 2);
    if (/^VP8[ L]$/.test(String.fromCharCode(...file.subarray(at, at + 4)))) {
      const out = new Uint8Array(12 + end - at);
      out.set(file.subarray(0, 12));
      out.set(file.subarray(at, end), 12);
      new DataView(out.buffer).setUint32(4, out.length - 8, true);
      return out;
    }
    at = end;
  }
  return file;
}

/** The same without compression. @param {Uint8Array} glb */
async function expand(glb) {
  await MeshoptDecoder.ready;
  const io = new WebIO().registerExtensions([EXTMeshoptCompression, EXTTextureWebP, KHRMeshQuantization]).registerDependencies({ 'meshopt.decoder': MeshoptDecoder });
  const document = await io.readBinary(glb);
  document.createExtension(EXTMeshoptCompression).dispose();
  return io.writeBinary(document);
}
