/**
 * How many closed lines of border edges a manifold mesh has: the rims of its holes and of open sheets.
 * @param {Uint32Array} indices three a triangle, all turning the same way
 * @param {number} vertices
 */
export function countHoles(indices, vertices) {
  // An edge is a number that grows with its ends; inside of the surface it appears once in each direction.
  const edges = new Float64Array(indices.length);
  const reversed = new Float64Array(indices.length);
  for (let i = 0; i < indices.length; i++) {
    const [from, to] = [indices[i], indices[i % 3 === 2 ? i - 2 : i + 1]];
    edges[i] = from * vertices + to;
    reversed[i] = to * vertices + from;
  }
  edges.sort();
  reversed.sort();
  /** Where the border goes on from a vertex. @type {Map<number, number>} */
  const next = new Map();
  for (let i = 0, k = 0; i < edges.length; i++) {
    while (k < reversed.length && reversed[k] < edges[i]) k++;
    if (reversed[k] !== edges[i]) next.set(Math.floor(edges[i] / vertices), edges[i] % vertices);
  }
  let holes = 0;
  for (const start of next.keys()) {
    if (!next.has(start)) continue;
    holes++;
    for (let at = start, to; (to = next.get(at)) !== undefined; at = to) next.delete(at);
  }
  return holes;
}
