import type { PictureEncoder } from './types.js';

/**
 * Encodes a picture as KTX2 (Basis Universal), which graphics cards keep compressed: colours and occlusion as ETC1S, normals as UASTC; with
 * its smaller copies. At most 12.5 million pixels. Needs `ktx2-encoder`. Where a bundler makes the program, hand it to `write` as `pictures`.
 */
export const ktx2: PictureEncoder;
