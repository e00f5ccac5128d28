// What a picture shows: its silhouette, and how much of two silhouettes is the same.

import { inflateSync } from 'node:zlib';

/** Pixels of an 8-bit RGB or RGBA PNG without interlacing, as screenshots are. */
export function decodePng(bytes) {
  const chunks = [];
  let width = 0, height = 0, channels = 0;
  for (let at = 8; at < bytes.length;) {
    const length = bytes.readUInt32BE(at);
    const kind = bytes.toString('latin1', at + 4, at + 8);
    const data = bytes.subarray(at + 8, at + 8 + length);
    if (kind === 'IHDR') {
      [width, height] = [data.readUInt32BE(0), data.readUInt32BE(4)];
      channels = { 2: 3, 6: 4 }[data[9]];
    }
    if (kind === 'IDAT') chunks.push(data);
    at += length + 12;
  }
  return { width, height, channels, data: unfilter(inflateSync(Buffer.concat(chunks)), width * channels, height, channels) };
}

function unfilter(raw, stride, height, channels) {
  const out = new Uint8Array(stride * height);
  for (let row = 0; row < height; row++) {
    const kind = raw[row * (stride + 1)];
    for (let i = 0; i < stride; i++) {
      const left = i < channels ? 0 : out[row * stride + i - channels];
      const up = row ? out[(row - 1) * stride + i] : 0;
      const corner = row && i >= channels ? out[(row - 1) * stride + i - channels] : 0;
      const guess = [0, left, up, (left + up) >> 1, paeth(left, up, corner)][kind];
      out[row * stride + i] = raw[row * (stride + 1) + 1 + i] + guess;
    }
  }
  return out;
}

function paeth(left, up, corner) {
  const [a, b, c] = [Math.abs(up - corner), Math.abs(left - corner), Math.abs(left + up - 2 * corner)];
  return a <= b && a <= c ? left : b <= c ? up : corner;
}

/** A yes or no for each pixel. */
class Mask {
  constructor(width, height) {
    this.width = width;
    this.height = height;
    this.bits = new Uint8Array(width * height);
  }

  get area() {
    return this.bits.reduce((sum, bit) => sum + bit, 0);
  }

  /** Smallest box that holds every yes. */
  get box() {
    let [left, top, right, bottom] = [this.width, this.height, -1, -1];
    this.bits.forEach((bit, i) => {
      if (!bit) return;
      const [x, y] = [i % this.width, Math.floor(i / this.width)];
      [left, top, right, bottom] = [Math.min(left, x), Math.min(top, y), Math.max(right, x), Math.max(bottom, y)];
    });
    return { left, top, width: right - left + 1, height: bottom - top + 1 };
  }

  /** Gaps narrower than twice the radius are closed: a cloud of points becomes the shape that it samples. */
  closed(radius) {
    return this.#spread(radius, 1).#spread(radius, 0);
  }

  /** Every pixel within the radius (a square) of one of `value` takes that value. */
  #spread(radius, value) {
    const across = new Mask(this.width, this.height);
    const down = new Mask(this.width, this.height);
    for (const [from, to, step, length, count, line] of [
      [this, across, 1, this.width, this.height, this.width],
      [across, down, this.width, this.height, this.width, 1],
    ]) {
      to.bits.fill(1 - value);
      for (let k = 0; k < count; k++) {
        let last = -Infinity;
        for (let i = 0; i < length + radius; i++) {
          if (i < length && from.bits[k * line + i * step] === value) last = i;
          const center = i - radius;
          if (center < 0) continue;
          if (last >= center - radius) to.bits[k * line + center * step] = value;
        }
      }
    }
    return down;
  }

  /**
   * The same shape at a standard place and size, comparable across pictures: its centre of mass in the middle, its
   * radius of gyration a fixed share. A stray pixel moves neither.
   */
  normalized(size = 128) {
    const pixels = [];
    this.bits.forEach((bit, i) => bit && pixels.push([i % this.width, Math.floor(i / this.width)]));
    const mean = [0, 1].map((axis) => pixels.reduce((sum, pixel) => sum + pixel[axis], 0) / pixels.length);
    const spread = Math.sqrt(
      pixels.reduce((sum, [x, y]) => sum + (x - mean[0]) ** 2 + (y - mean[1]) ** 2, 0) / pixels.length);
    const scale = (4.5 * spread) / size;
    const out = new Mask(size, size);
    for (let y = 0; y < size; y++) {
      for (let x = 0; x < size; x++) {
        const [fromX, fromY] = [x, y].map((value, axis) => Math.round(mean[axis] + (value + 0.5 - size / 2) * scale));
        const inside = fromX >= 0 && fromX < this.width && fromY >= 0 && fromY < this.height;
        out.bits[y * size + x] = inside ? this.bits[fromY * this.width + fromX] : 0;
      }
    }
    return out;
  }
}

/**
 * Which pixels are not background. The background is the same all along a row: what is at its left end.
 * @param {Buffer} png
 * @param {number} [corner] so many rows are left out above and below, where the picture's corners are round
 */
export function silhouette(png, corner = 24) {
  const { width, height, channels, data } = decodePng(png);
  const mask = new Mask(width, height);
  for (let y = corner; y < height - corner; y++) {
    const background = (y * width + 3) * channels;
    for (let x = 0; x < width; x++) {
      const here = (y * width + x) * channels;
      const apart = [0, 1, 2].reduce((sum, c) => sum + Math.abs(data[here + c] - data[background + c]), 0);
      mask.bits[y * width + x] = apart > 24 ? 1 : 0;
    }
  }
  return mask;
}

/** Shared part of two silhouettes of the same size: intersection over union. */
export function overlap(a, b) {
  let both = 0, either = 0;
  a.bits.forEach((bit, i) => {
    both += bit & b.bits[i];
    either += bit | b.bits[i];
  });
  return both / either;
}

/** A function that gives red, green and blue, 0-255, at shares of the width and height. */
export function colorsOf(png) {
  const { width, height, channels, data } = decodePng(png);
  return (x, y) => {
    const at = (Math.round(y * (height - 1)) * width + Math.round(x * (width - 1))) * channels;
    return [...data.subarray(at, at + 3)];
  };
}

/** Mean red, green and blue, 0-255, of the pixels under the mask. */
export function meanColor(png, mask) {
  const { channels, data } = decodePng(png);
  const sum = [0, 0, 0];
  mask.bits.forEach((bit, i) => bit && sum.forEach((_, c) => (sum[c] += data[i * channels + c])));
  return sum.map((value) => value / mask.area);
}

/** Share of pixels that differ visibly between two pictures, or between `from` and `to`, shares of their width. */
export function difference(a, b, from = 0, to = 1) {
  const [first, second] = [decodePng(a), decodePng(b)];
  let differing = 0, pixels = 0;
  for (let i = 0; i < first.width * first.height; i++) {
    const x = (i % first.width) / first.width;
    if (x < from || x >= to) continue;
    pixels++;
    const apart = [0, 1, 2].reduce(
      (sum, c) => sum + Math.abs(first.data[i * first.channels + c] - second.data[i * second.channels + c]), 0);
    if (apart > 24) differing++;
  }
  return differing / pixels;
}

/**
 * The silhouette that the points should have, projected here and not by the page: seen from the direction from
 * which it first looks at a scan (right 0.55, up 0.38, front 1), y up, from two diagonals away.
 */
export function expectedSilhouette(points) {
  const size = 480;
  const forward = unit([0.55, 0.38, 1]);
  const right = unit(cross([0, 1, 0], forward));
  const up = cross(forward, right);
  const { center, diagonal } = box(points);
  const mask = new Mask(size, size);
  for (const point of points) {
    const p = point.map((value, axis) => (value - center[axis]) / diagonal);
    const depth = 2 - dot(p, forward);
    const [x, y] = [dot(p, right) / depth, dot(p, up) / depth].map((value) => value * 1.4 * size);
    mask.bits[Math.round(size / 2 - y) * size + Math.round(size / 2 + x)] = 1;
  }
  return mask;
}

function box(points) {
  const low = [0, 1, 2].map((axis) => points.reduce((least, p) => Math.min(least, p[axis]), Infinity));
  const high = [0, 1, 2].map((axis) => points.reduce((most, p) => Math.max(most, p[axis]), -Infinity));
  return {
    center: low.map((value, axis) => (value + high[axis]) / 2),
    diagonal: Math.hypot(...low.map((value, axis) => high[axis] - value)),
  };
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (v) => v.map((value) => value / Math.hypot(...v));
