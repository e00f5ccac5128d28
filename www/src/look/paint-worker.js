/**
 * Makes colours that cost a pass over all points, in a thread of its own. Arrays come in first, each once: `{ id, array }`. Then
 * `{ job, name, layer, subject, live, scale }`, where `{ id }` stands for an array; those that are not `live` are forgotten. What goes out is
 * `{}` when all is ready, and `{ job, colors, legend, texts }`: a legend's function cannot be sent, so its three texts are.
 */
import { paintOf } from 'pointweave/viewer';
import { WORDS, size } from './paint-words.js';

/** @type {Map<number, import('./painting.js').Numbers>} */
const arrays = new Map();

addEventListener('message', ({ data }) => {
  if (data.array) {
    arrays.set(data.id, data.array);
    return;
  }
  const { job, name, layer, subject, live } = data;
  size.scale = data.scale;
  for (const id of arrays.keys()) if (!live.includes(id)) arrays.delete(id);
  const { colors, legend } = paintOf(name, layer, filled(subject), WORDS);
  if (legend && 'words' in legend) {
    const { words, ...scale } = legend;
    const texts = [scale.low, (scale.low + scale.high) / 2, scale.high].map((value) => [value, words(value)]);
    postMessage({ job, colors, legend: scale, texts });
  } else postMessage({ job, colors, legend });
});

/** With the arrays in their places. @param {any} value @returns {any} */
function filled(value) {
  if (typeof value !== 'object' || value === null || Array.isArray(value)) return value;
  if ('arrayId' in value) return arrays.get(value.arrayId);
  return Object.fromEntries(Object.entries(value).map(([key, part]) => [key, filled(part)]));
}

postMessage({});
