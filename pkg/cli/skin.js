/** The pictures of a GLB file of one mesh, as `write` makes them: what a poster needs beside the vertices. */

/** @import { FileCloud, Texture } from '../types.js' */

const JSON_CHUNK = 0x4e4f534a;
const FLOAT = 5126;

/** @param {Blob | Uint8Array} file @returns {Promise<Uint8Array>} */
export async function bytesOf(file) {
  return file instanceof Blob ? new Uint8Array(await file.arrayBuffer()) : file;
}

/**
 * Texture coordinates, tangents and PNG files; nothing where the file holds them in another way. Vertices then have the colours that
 * the pictures have there.
 * @param {Uint8Array} bytes
 * @param {FileCloud} mesh what was read of it
 * @returns {{ uvs?: Float32Array, tangents?: Float32Array, textures?: Record<string, Texture> }}
 */
export function skinOf(bytes, { positions }) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 20 || view.getUint32(0) !== 0x676c5446 || view.getUint32(16, true) !== JSON_CHUNK) return {};
  const length = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
  const [mesh, ...others] = json.meshes ?? [];
  const [primitive, ...more] = mesh?.primitives ?? [];
  const material = json.materials?.[primitive?.material];
  if (!material || others.length > 0 || more.length > 0) return {};
  const data = bytes.subarray(20 + length + 8);
  const part = (/** @type {number} */ index) => {
    const { byteOffset = 0, byteLength } = json.bufferViews[index];
    return data.slice(byteOffset, byteOffset + byteLength);
  };
  const floats = (/** @type {number | undefined} */ index, /** @type {number} */ each) => {
    const { componentType, bufferView, byteOffset = 0, count } = json.accessors[index ?? -1] ?? {};
    const tight = [undefined, 4 * each].includes(json.bufferViews[bufferView]?.byteStride);
    if (componentType !== FLOAT || bufferView === undefined || byteOffset !== 0 || !tight || 3 * count !== positions.length) return undefined;
    return new Float32Array(part(bufferView).buffer, 0, each * count);
  };
  const picture = (/** @type {{ index: number } | undefined} */ use) => {
    const image = json.images?.[json.textures?.[use?.index ?? -1]?.source];
    const isPlain = use && image?.mimeType === 'image/png' && image.bufferView !== undefined && Object.keys(use).length === 1;
    return isPlain && { width: 0, height: 0, data: part(image.bufferView), type: /** @type {const} */ ('image/png') };
  };
  const uvs = floats(primitive.attributes.TEXCOORD_0, 2);
  const color = picture(material.pbrMetallicRoughness?.baseColorTexture);
  if (!uvs || !color) return {};
  const tangents = floats(primitive.attributes.TANGENT, 4);
  const normal = picture(material.normalTexture);
  return { uvs, tangents, textures: { color, ...(tangents && normal && { normal }) } };
}
