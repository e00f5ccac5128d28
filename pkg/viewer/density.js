/** Grids have at most this many cells along the diagonal. */
const MOST_CELLS = 96;
/** Points closer than a third of a cell are averaged over many; those further apart would count themselves alone. */
const SPACINGS_A_CELL = 3;
/** A cell's weighted count for points one cell apart on a plane, the mean over how the plane crosses the cells. */
const PLANE = 0.655;

/**
 * Mean distance between neighbours, from the area that the points cover: the share of a coarse grid's cells that
 * hold a point, each standing for the piece of surface that crosses it.
 * @param {Float32Array} positions in the frame
 */
export function typicalSpacing(positions) {
  const cells = 64;
  const areaOfCell = 0.7 / cells ** 2;
  const taken = new Uint8Array(cells ** 3);
  const index = (/** @type {number} */ value) => Math.min(cells - 1, Math.max(0, Math.floor((value + 0.5) * cells)));
  let count = 0;
  for (let i = 0; i < positions.length; i += 3) {
    const cell = index(positions[i]) + cells * (index(positions[i + 1]) + cells * index(positions[i + 2]));
    count += 1 - taken[cell];
    taken[cell] = 1;
  }
  return Math.sqrt((areaOfCell * count) / Math.max(1, positions.length / 3));
}

/** Turns the grid, so that no face of a scan lies along it: whatever the place, a plane then crosses cells in every way. */
const AXES = [
  [0.6195, 0.5795, 0.5296],
  [-0.7834, 0.4136, 0.4638],
  [0.0498, -0.7022, 0.7102],
];

/**
 * About how far apart neighbours are, at each point: points are spread over the corners of a grid and read back, both
 * with tent weights, which smooths over two cells. One pass each, whatever the number of points.
 * @param {Float32Array} positions in the frame
 * @returns {Float32Array} distances in the frame
 */
export function localSpacing(positions) {
  const wanted = 1 / (SPACINGS_A_CELL * typicalSpacing(positions));
  const cells = Math.round(Math.min(MOST_CELLS, Math.max(4, wanted)));
  const side = cells + 2;
  const counts = new Float32Array(side ** 3);
  const corner = [0, 0, 0];
  const share = [0, 0, 0];
  const locate = (/** @type {number} */ i) => {
    for (let axis = 0; axis < 3; axis++) {
      const [x, y, z] = AXES[axis];
      const along = x * positions[i] + y * positions[i + 1] + z * positions[i + 2];
      const place = Math.min(cells, Math.max(0, (along + 0.5) * cells)) || 0;
      corner[axis] = Math.floor(place);
      share[axis] = place - corner[axis];
    }
    return corner[0] + side * (corner[1] + side * corner[2]);
  };
  const weight = (/** @type {number} */ k) =>
    (k & 1 ? share[0] : 1 - share[0]) * (k & 2 ? share[1] : 1 - share[1]) * (k & 4 ? share[2] : 1 - share[2]);
  const steps = Array.from({ length: 8 }, (_, k) => (k & 1) + side * (((k >> 1) & 1) + side * (k >> 2)));
  for (let i = 0; i < positions.length; i += 3) {
    const at = locate(i);
    for (let k = 0; k < 8; k++) counts[at + steps[k]] += weight(k);
  }
  const out = new Float32Array(positions.length / 3);
  for (let i = 0; i < positions.length; i += 3) {
    const at = locate(i);
    let count = 0;
    for (let k = 0; k < 8; k++) count += weight(k) * counts[at + steps[k]];
    out[i / 3] = Math.sqrt(PLANE / count) / cells;
  }
  return out;
}
