/** `pointweave/webp`: pictures as WebP files, by @jsquash/webp, an optional peer dependency. Nothing else of the package imports it. */
import encode, { init } from '@jsquash/webp/encode.js';

/** Of 100: what is lost is a grey level or two. */
const QUALITY = 92;
/** No bundler is to follow them: they are Node's. */
const [MODULE, FILES] = ['node:module', 'node:fs/promises'];

/** @type {Promise<unknown> | undefined} */
let ready;

/**
 * @param {{ width: number, height: number, pixels: Uint8Array }} picture
 * @returns {Promise<Uint8Array<ArrayBuffer>>}
 */
export async function webp({ width, height, pixels }) {
  ready ??= started();
  await ready;
  const data = new Uint8ClampedArray(/** @type {ArrayBuffer} */ (pixels.buffer), pixels.byteOffset, pixels.byteLength);
  return new Uint8Array(await encode(/** @type {ImageData} */ ({ data, width, height, colorSpace: 'srgb' }), { quality: QUALITY }));
}

/** A browser fetches the encoder's wasm itself. */
async function started() {
  if (!globalThis.process?.versions?.node) return;
  const { createRequire } = await import(/* webpackIgnore: true */ /* turbopackIgnore: true */ /* @vite-ignore */ MODULE);
  const { readFile } = await import(/* webpackIgnore: true */ /* turbopackIgnore: true */ /* @vite-ignore */ FILES);
  const wasm = createRequire(import.meta.url).resolve('@jsquash/webp/codec/enc/webp_enc_simd.wasm');
  await init(/** @type {any} */ (await WebAssembly.compile(await readFile(wasm))));
}
