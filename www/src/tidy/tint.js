/** Colours that say what would be cut off. */

/** @typedef {[number, number, number]} Rgb */

/** How much of its colour what would go keeps, and what is chosen. */
const OWN = 0.3;

/** Of pieces beside each other, which differ for everybody. @type {Rgb[]} */
const PIECES = [[42, 157, 143], [233, 196, 106], [86, 120, 210], [160, 196, 90], [150, 110, 190], [110, 190, 225], [200, 150, 110], [120, 140, 130]];

/** @param {number} i */
export const pieceColor = (i) => PIECES[i % PIECES.length];

/** The colour that a style sheet has under a name, as `#rrggbb`. @param {string} name @returns {Rgb} */
function styled(name) {
  const hex = getComputedStyle(document.documentElement).getPropertyValue(`--layer-${name}`).trim();
  return /** @type {Rgb} */ ([1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) || 0));
}

/** What points have of their own; without any, as the picture shows them. @param {import('pointweave').PointCloud} cloud */
function ownColors({ positions, colors }) {
  if (colors) return colors.slice();
  const out = new Uint8Array(positions.length);
  const [red, green, blue] = styled('points');
  for (let i = 0; i < out.length; i += 3) {
    out[i] = red;
    out[i + 1] = green;
    out[i + 2] = blue;
  }
  return out;
}

/**
 * The colours of points, some of which would go or are chosen.
 * @param {import('pointweave').PointCloud} cloud
 * @param {ArrayLike<number>} mask not 0 for those
 * @param {'gone' | 'chosen'} what
 */
export function marked(cloud, mask, what) {
  const out = ownColors(cloud);
  const color = styled(what);
  for (let i = 0; i < mask.length; i++) if (mask[i]) blend(out, 3 * i, color, OWN);
  return out;
}

/**
 * Each point in the colour of its piece; of pieces that would go, little of it is left.
 * @param {import('pointweave').PointCloud} cloud
 * @param {ArrayLike<number>} pieceOf
 * @param {ArrayLike<number>} stays not 0 for points that do
 */
export function pieced(cloud, pieceOf, stays) {
  const out = ownColors(cloud);
  const gone = styled('gone');
  for (let i = 0; i < pieceOf.length; i++) {
    blend(out, 3 * i, pieceColor(pieceOf[i]), stays[i] ? OWN : 0);
    if (!stays[i]) blend(out, 3 * i, gone, OWN);
  }
  return out;
}

/** @param {Uint8Array} out @param {number} at @param {Rgb} color @param {number} own */
function blend(out, at, color, own) {
  for (let k = 0; k < 3; k++) out[at + k] = own * out[at + k] + (1 - own) * color[k];
}
