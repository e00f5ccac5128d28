/** Colours that say what would be cut off, made for some points at a time. */

/**
 * @import { PointCloud } from 'pointweave'
 * @typedef {[number, number, number]} Rgb
 * Colours points from … to …, by which of them are meant. @typedef {(colors: Uint8Array, mask: Uint8Array, from: number, to: number) => void} Tint
 */

/** How much of its colour what would go keeps, and what is chosen. */
const OWN = 0.3;

/** Of pieces beside each other, which differ for everybody. @type {Rgb[]} */
const PIECES = [[42, 157, 143], [233, 196, 106], [86, 120, 210], [160, 196, 90], [150, 110, 190], [110, 190, 225], [200, 150, 110], [120, 140, 130]];

/** @param {number} i */
export const pieceColor = (i) => PIECES[i % PIECES.length];

/** The colour that the style sheet has under a name, as `#rrggbb`. @param {string} name @returns {Rgb} */
function styled(name) {
  const hex = getComputedStyle(document.documentElement).getPropertyValue(`--layer-${name}`).trim();
  return /** @type {Rgb} */ ([1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) || 0));
}

/** What is meant in the colour of what would go, or of what is chosen, the rest in its own. @param {PointCloud} cloud @param {'gone' | 'chosen'} what @returns {Tint} */
export function tinted(cloud, what) {
  const own = ownColors(cloud);
  const color = styled(what);
  return (colors, mask, from, to) => {
    own(colors, from, to);
    for (let i = from; i < to; i++) if (mask[i]) blend(colors, 3 * i, color, OWN);
  };
}

/** Each point in the colour of its piece; of pieces that would go, little of it is left. @param {PointCloud} cloud @param {(point: number) => number} pieceOf @returns {Tint} */
export function pieced(cloud, pieceOf) {
  const own = ownColors(cloud);
  const gone = styled('gone');
  return (colors, stays, from, to) => {
    own(colors, from, to);
    for (let i = from; i < to; i++) {
      blend(colors, 3 * i, pieceColor(pieceOf(i)), stays[i] ? OWN : 0);
      if (!stays[i]) blend(colors, 3 * i, gone, OWN);
    }
  };
}

/** What points have of their own; without any, as the picture shows them. @param {PointCloud} cloud */
function ownColors({ colors: own }) {
  const [red, green, blue] = styled('points');
  return (/** @type {Uint8Array} */ colors, /** @type {number} */ from, /** @type {number} */ to) => {
    if (own) return colors.set(own.subarray(3 * from, 3 * to), 3 * from);
    for (let i = 3 * from; i < 3 * to; i += 3) {
      colors[i] = red;
      colors[i + 1] = green;
      colors[i + 2] = blue;
    }
  };
}

/** @param {Uint8Array} colors @param {number} at @param {Rgb} color @param {number} own */
function blend(colors, at, color, own) {
  colors[at] = own * colors[at] + (1 - own) * color[0];
  colors[at + 1] = own * colors[at + 1] + (1 - own) * color[1];
  colors[at + 2] = own * colors[at + 2] + (1 - own) * color[2];
}
