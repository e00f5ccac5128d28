import type { PictureEncoder } from './types.js';

/**
 * Encodes a picture as WebP, of a quality of 92 of 100. Needs `@jsquash/webp`. Where a bundler makes the program, hand it to `write` as
 * `pictures`.
 */
export const webp: PictureEncoder;
