/** A file to a cloud, slice by slice, by the wasm that has its reader. */
import { PointColumns } from './point-columns.js';
import { PointweaveError } from '../engine/errors.js';

/** @import { FileCloud, Format, Progress } from '../types.js' */
/** @import { Block, Summary } from './point-columns.js' */
/** @import { Request, WasmBuild } from '../engine/core.js' */
/** @import { ByteSource } from './byte-source.js' */

/** The builds that hold readers alone. @typedef {Extract<WasmBuild, 'files' | 'las' | 'e57' | 'packed'>} Reader */

/**
 * What a caller says of a file.
 * @typedef {{ name?: string, format?: Format, columns?: string[], delimiter?: string, decimal?: string, skip?: number, sentinels?: 'drop' | 'keep', faces?: 'sample' | 'vertices' | 'mesh' }} ReadingOptions
 */

/** How the files start whose reader is a build of its own, and the formats' names. @type {[string, Format, Reader][]} */
const READERS = [
  ['LASF', 'las', 'las'],
  ['ASTM-E57', 'e57', 'e57'],
  ['glTF', 'glb', 'packed'],
  ['PK', '3mf', 'packed'],
  ['NGSP', 'spz', 'packed'],
  ['II*\0', 'tif', 'packed'],
  ['MM\0*', 'tif', 'packed'],
  ['II+\0', 'tif', 'packed'],
  ['MM\0+', 'tif', 'packed'],
];

/**
 * The build that reads a file: by the format that the caller says, else by how the file starts.
 * @param {ByteSource} file
 * @param {Format} [format]
 * @returns {Promise<Reader>}
 */
export async function readerOf(file, format) {
  const start = String.fromCharCode(...(await file.read(0)).subarray(0, 8));
  const found = READERS.find(([magic, name]) => (format ? name === format : start.startsWith(magic)));
  return found?.[2] ?? 'files';
}

/**
 * What a mesh needs besides its file.
 * @typedef {object} Helpers
 * @property {(name: string) => Promise<Uint8Array | undefined>} find the bytes of a file beside
 * @property {(bytes: Uint8Array) => Promise<{ width: number, height: number, pixels: Uint8Array } | undefined>} decode a picture's
 */

/**
 * @param {(request: Request) => Promise<any>} ask one request of the wasm that has the reader
 * @param {ByteSource} file
 * @param {ReadingOptions} options
 * @param {{ signal: AbortSignal, onProgress?: (progress: Progress) => void }} watch
 * @param {Helpers} helpers
 * @returns {Promise<FileCloud>}
 */
export async function readFile(ask, file, options, watch, helpers) {
  const columns = new PointColumns();
  const { summary, indices, skin } = await readBlocks(ask, file, options, watch, helpers, (block, expected) => void columns.add(block, expected));
  const cloud = columns.finish(summary);
  return indices ? { ...cloud, indices, ...(skin && (await worn(skin, helpers.decode))) } : cloud;
}

/**
 * A file's points as they come, none of which is kept here.
 * @param {(request: Request) => Promise<any>} ask
 * @param {ByteSource} file
 * @param {ReadingOptions} options
 * @param {{ signal: AbortSignal, onProgress?: (progress: Progress) => void }} watch
 * @param {Helpers} helpers
 * @param {(block: Block, expected: number) => Promise<void> | void} take a block, and how many points there will be in all, as far as can be told
 * @returns {Promise<{ summary: Summary, indices?: Uint32Array, skin?: Skin }>}
 */
export async function readBlocks(ask, file, options, { signal, onProgress }, { find, decode }, take) {
  let told = 0;
  let points = 0;
  /** @param {number} share */
  const tell = (share) => {
    told = Math.max(told, share);
    onProgress?.({ stage: 'read', fraction: told, overall: told });
    signal.throwIfAborted();
  };
  /** @param {Block | undefined} block @param {number} read bytes */
  const add = async (block, read) => {
    if (!block) return 0;
    points += block.positions.length / 3;
    const expected = block.most ?? Math.ceil((1.02 * points * file.size) / Math.max(read, 1));
    await take(block, expected);
    return expected;
  };

  tell(0);
  await ask({ call: 'readStart', args: [{ ...options, size: file.size }] });
  for (let at = 0; at < file.size; ) {
    const slice = await file.read(at);
    signal.throwIfAborted();
    if (slice.length === 0) throw new PointweaveError({ code: 'bad-input', message: 'the data ended before its size', expected: file.size, found: at });
    at += slice.length;
    await add(await ask({ call: 'readPush', args: [slice] }), at);
    // Some formats give no point before all of the file is there; to take it apart is then the other half.
    tell((at / file.size) * (points > 0 ? 0.99 : 0.5));
  }
  for (;;) {
    /** @type {{ block?: Block, skin?: Skin, indices?: Uint32Array, summary?: Summary, want?: { file?: string, picture?: Uint8Array } }} */
    const { block, skin, indices, summary, want } = await ask({ call: 'readEnd', args: [] });
    const expected = await add(block, file.size);
    if (summary) {
      tell(1);
      return { summary, indices, skin };
    }
    if (want?.file !== undefined) await ask({ call: 'readFile', args: [await find(want.file)] });
    if (want?.picture) {
      const { width = 0, height = 0, pixels } = (await decode(want.picture)) ?? {};
      await ask({ call: 'readPicture', args: [pixels, width, height] });
    }
    tell(0.5 + 0.49 * Math.min(1, points / Math.max(expected, 1)));
  }
}

/** Files of pictures, and where the vertices are in them. @typedef {{ uvs: Float32Array, tangents?: Float32Array } & Record<string, any>} Skin */

/**
 * What is worn of a mesh's pictures, with their sizes; one that cannot be read is left out.
 * @param {Skin} skin
 * @param {Helpers['decode']} decode
 */
async function worn({ uvs, tangents, ...files }, decode) {
  /** @type {Record<string, import('../types.js').Texture>} */
  const textures = {};
  for (const [map, data] of Object.entries(files)) {
    const picture = data && (await decode(data.slice()));
    if (picture) textures[map] = { width: picture.width, height: picture.height, data, type: typeOf(data) };
  }
  return { uvs, ...(tangents && { tangents }), textures };
}

/** What a file is that is one of the three. @param {Uint8Array} file @returns {import('../types.js').Texture['type']} */
function typeOf([first]) {
  return first === 0x89 ? 'image/png' : first === 0xff ? 'image/jpeg' : 'image/webp';
}

/**
 * What went wrong in a reader's wasm. That it trapped, at data which it did not expect, says that they are damaged.
 * @param {unknown} error
 * @param {Reader | 'pictures'} reader
 */
export function readerError(error, reader) {
  if (!(error instanceof PointweaveError) || error.code !== 'internal' || reader === 'files' || reader === 'pictures') return error;
  const expected = `the content of ${{ las: 'a LAS or LAZ', e57: 'an E57', packed: 'a packed' }[reader]} file`;
  const found = 'data that cannot be taken apart';
  return new PointweaveError({ code: 'bad-file', message: `bad ${reader.toUpperCase()} file: expected ${expected}, found ${found} (${error.message})`, expected, found });
}
