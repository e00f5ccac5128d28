/** `pointweave/ktx2`: pictures as KTX2 files, by ktx2-encoder, an optional peer dependency. Nothing else of the package imports it. */
import { encodeToKTX2 } from 'ktx2-encoder';

/**
 * ETC1S for colours and occlusion. Normals are UASTC, which keeps directions, compressed by Zstandard.
 * @type {Record<string, object>}
 */
const HOW = {
  color: { isUASTC: false, qualityLevel: 200, isPerceptual: true, isSetKTX2SRGBTransferFunc: true },
  normal: { isUASTC: true, uastcLDRQualityLevel: 1, needSupercompression: true, enableRDO: true, rdoQualityLevel: 2, isNormalMap: true, isPerceptual: false, isSetKTX2SRGBTransferFunc: false },
  occlusion: { isUASTC: false, qualityLevel: 200, isPerceptual: false, isSetKTX2SRGBTransferFunc: false },
};

/**
 * @param {{ map: string, width: number, height: number, pixels: Uint8Array }} picture
 * @returns {Promise<Uint8Array>}
 */
export async function ktx2({ map, width, height, pixels }) {
  const restore = quiet();
  const imageDecoder = async () => {
    restore(); // it has started
    return { width, height, data: pixels };
  };
  try {
    return await encodeToKTX2(pixels, { ...HOW[map], generateMipmap: true, imageDecoder });
  } finally {
    restore();
  }
}

/** The encoder keeps `console.log` when it starts, and tells it all that it does: it gets one that says nothing once this is over. */
function quiet() {
  const { log } = console;
  let over = false;
  const own = (/** @type {unknown[]} */ ...said) => {
    if (!over) log(...said);
  };
  console.log = own;
  return () => {
    over = true;
    if (console.log === own) console.log = log;
  };
}
