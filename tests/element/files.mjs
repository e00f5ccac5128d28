// Files for the element to show, made here: scans by the package, GLBs by hand.

import { createEngine } from 'pointweave';
import { MeshoptEncoder } from 'meshoptimizer';

const FLOAT = 5126, BYTE = 5121, SHORT = 5123, UINT = 5125;

/** A generated scan of a toy duck, y up, as a file and as points. */
export async function duckScan({ count = 3000, format = 'ply' } = {}) {
  const engine = await createEngine({ threads: 1 });
  const cloud = await engine.sample('duck', { count });
  const bytes = await engine.write(cloud, { format });
  await engine.dispose();
  const points = Array.from({ length: count }, (_, i) => [...cloud.positions.subarray(3 * i, 3 * i + 3)]);
  return { bytes: Buffer.from(bytes), points };
}

/** A box as text, x y z on each line: a surface that is quickly made. */
export function boxScan([width, height, depth] = [1, 1, 1], steps = 14) {
  const lines = [];
  for (let i = 0; i <= steps; i++) {
    for (let j = 0; j <= steps; j++) {
      const [a, b] = [i / steps, j / steps];
      for (const [x, y, z] of [[a, b, 0], [a, b, 1], [a, 0, b], [a, 1, b], [0, a, b], [1, a, b]]) {
        lines.push(`${x * width} ${y * height} ${z * depth}`);
      }
    }
  }
  return Buffer.from([...new Set(lines)].join('\n'));
}

/** A ball of the radius around the centre: vertices, triangles. */
export function ball(rings = 24, radius = 1, [x, y, z] = [0, 0, 0]) {
  const positions = [], normals = [], indices = [];
  for (let i = 0; i <= rings; i++) {
    for (let j = 0; j <= 2 * rings; j++) {
      const [theta, phi] = [(Math.PI * i) / rings, (Math.PI * j) / rings];
      const n = [Math.sin(theta) * Math.cos(phi), Math.cos(theta), Math.sin(theta) * Math.sin(phi)];
      normals.push(...n);
      positions.push(x + radius * n[0], y + radius * n[1], z + radius * n[2]);
      if (i === rings || j === 2 * rings) continue;
      const a = i * (2 * rings + 1) + j, b = a + 2 * rings + 1;
      indices.push(a, a + 1, b, a + 1, b + 1, b);
    }
  }
  return { positions: Float32Array.from(positions), normals: Float32Array.from(normals), indices: Uint32Array.from(indices) };
}

/**
 * A GLB of primitives, with one colour each or one a vertex.
 * @param {{ positions: Float32Array, normals?: Float32Array, indices?: Uint32Array, color?: number[], colors?: number[], material?: object }[]} primitives
 *   color: linear, 0-255; colors: one for each vertex; material: as in a glTF
 * @param {{ required?: string[], meshopt?: boolean, at?: number[], step?: number }} [options] meshopt: compressed by EXT_meshopt_compression;
 *   step: positions are whole numbers of so much from `at`, KHR_mesh_quantization
 */
export async function glb(primitives, { required = [], meshopt = false, at = [0, 0, 0], step } = {}) {
  await MeshoptEncoder.ready;
  const parts = [];
  const json = {
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, translation: at, ...(step && { scale: [step, step, step] }) }],
    meshes: [{ primitives: [] }], accessors: [], bufferViews: [], buffers: [{ byteLength: 0 }],
  };
  let length = 0;
  const append = (bytes) => {
    const at = length;
    parts.push(Buffer.from(bytes), Buffer.alloc((4 - (bytes.length % 4)) % 4));
    length = parts.reduce((sum, part) => sum + part.length, 0);
    return at;
  };
  const accessor = (array, type, componentType, extra = {}) => {
    const size = { VEC3: 3, VEC4: 4, SCALAR: 1 }[type];
    const count = array.length / size;
    const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    const stride = bytes.length / count;
    if (meshopt && type !== 'SCALAR') {
      const packed = MeshoptEncoder.encodeVertexBuffer(bytes, count, stride);
      const extension = { buffer: 0, byteOffset: append(packed), byteLength: packed.length, byteStride: stride, mode: 'ATTRIBUTES', count };
      json.bufferViews.push({ buffer: 1, byteOffset: 0, byteLength: bytes.length, byteStride: stride, extensions: { EXT_meshopt_compression: extension } });
    } else {
      json.bufferViews.push({ buffer: 0, byteOffset: append(bytes), byteLength: bytes.length });
    }
    return json.accessors.push({ bufferView: json.bufferViews.length - 1, componentType, count, type, ...extra }) - 1;
  };
  /** Each place has four bytes' alignment: one number in four means nothing. */
  const quantized = (positions, extra) => {
    const count = positions.length / 3;
    const bytes = Buffer.from(Uint16Array.from({ length: 4 * count }, (_, i) => (i % 4 < 3 ? positions[3 * (i >> 2) + (i % 4)] : 0)).buffer);
    json.bufferViews.push({ buffer: 0, byteOffset: append(bytes), byteLength: bytes.length, byteStride: 8 });
    required = [...required, 'KHR_mesh_quantization'];
    return json.accessors.push({ bufferView: json.bufferViews.length - 1, componentType: SHORT, count, type: 'VEC3', ...extra }) - 1;
  };
  for (const { positions, normals, indices, color, colors = color, material } of primitives) {
    const axis = (pick) => [0, 1, 2].map((k) => positions.reduce((best, value, i) => (i % 3 === k ? pick(best, value) : best), positions[k]));
    const attributes = {
      POSITION: step ? quantized(positions, { min: axis(Math.min), max: axis(Math.max) }) : accessor(positions, 'VEC3', FLOAT, { min: axis(Math.min), max: axis(Math.max) }),
      ...(colors && { COLOR_0: accessor(Uint8Array.from({ length: (4 * positions.length) / 3 }, (_, i) => (i % 4 === 3 ? 255 : colors[(3 * (i >> 2) + (i % 4)) % colors.length])), 'VEC4', BYTE, { normalized: true }) }),
      ...(normals && { NORMAL: accessor(normals, 'VEC3', FLOAT) }),
    };
    const place = material && { material: (json.materials ??= []).push(material) - 1 };
    json.meshes[0].primitives.push({ attributes, mode: indices ? 4 : 0, ...place, ...(indices && { indices: accessor(indices, 'SCALAR', UINT) }) });
  }
  json.buffers[0].byteLength = length;
  if (meshopt) {
    json.buffers.push({ byteLength: 1 << 24, extensions: { EXT_meshopt_compression: { fallback: true } } });
    required = [...required, 'EXT_meshopt_compression'];
  }
  if (required.length) json.extensionsRequired = json.extensionsUsed = required;
  const text = Buffer.from(JSON.stringify(json));
  const padded = Buffer.concat([text, Buffer.alloc((4 - (text.length % 4)) % 4, 0x20)]);
  const word = (...values) => Buffer.from(Uint32Array.from(values).buffer);
  return Buffer.concat([
    word(0x46546c67, 2, 28 + padded.length + length), word(padded.length, 0x4e4f534a), padded, word(length, 0x004e4942), ...parts,
  ]);
}

/** A poster of one colour. */
export function poster(color) {
  return Buffer.from(`<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300"><rect width="400" height="300" fill="${color}"/></svg>`);
}
