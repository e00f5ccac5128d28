import * as format from '../results/format.js';
import { say } from '../words/say.js';

const SVG = 'http://www.w3.org/2000/svg';
const WIDTH = 310;
const HEIGHT = 170;
const LEFT = 52;
const RIGHT = 22;
const TOP = 12;
const BOTTOM = 34;

/** @typedef {{ count: number, error: number }} Dot  points kept, and how far the mesh is from the scan (a fraction) */

/**
 * Draws error against count, both in equal factors. Every dot can be chosen.
 * @param {SVGElement} svg
 * @param {Dot[]} dots  from few points to many
 * @param {number} current  the count that is shown now
 * @param {(count: number) => void} choose
 */
export function drawChart(svg, dots, current, choose) {
  svg.setAttribute('viewBox', `0 0 ${WIDTH} ${HEIGHT}`);
  svg.replaceChildren();
  if (!dots.length) return;
  const x = scaleOf(dots.map(({ count }) => count), LEFT, WIDTH - RIGHT);
  const y = scaleOf(dots.map(({ error }) => error), HEIGHT - BOTTOM, TOP);
  for (const value of ticks(dots.map(({ error }) => error))) {
    svg.append(shape('line', { x1: LEFT, x2: WIDTH - RIGHT, y1: y(value), y2: y(value), class: 'grid' }));
    svg.append(label(format.percent(value), { x: LEFT - 8, y: y(value) + 4, 'text-anchor': 'end' }));
  }
  for (const value of ticks(dots.map(({ count }) => count))) {
    svg.append(label(format.short(value), { x: x(value), y: HEIGHT - BOTTOM + 20, 'text-anchor': 'middle' }));
  }
  svg.append(shape('polyline', { points: dots.map(({ count, error }) => `${x(count)},${y(error)}`).join(' '), class: 'line' }));
  for (const { count, error } of dots) {
    const values = { count: format.count(count), error: format.percent(error) };
    const words = count === current ? say('{count} points: {error} of the diagonal, shown now', values) : say('{count} points: {error} of the diagonal', values);
    const dot = shape('g', { class: 'dot', role: 'button', tabindex: 0, 'aria-label': words, 'aria-pressed': count === current });
    dot.append(shape('circle', { cx: x(count), cy: y(error), r: 22, class: 'target' }));
    dot.append(shape('circle', { cx: x(count), cy: y(error), r: 5 }));
    const title = document.createElementNS(SVG, 'title');
    title.textContent = words;
    dot.append(title);
    dot.addEventListener('click', () => choose(count));
    dot.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter' && event.key !== ' ') return;
      event.preventDefault();
      choose(count);
    });
    svg.append(dot);
  }
}

/** Places values so that equal factors are equally far. @param {number[]} values @param {number} from @param {number} to */
function scaleOf(values, from, to) {
  const [low, high] = [Math.min(...values), Math.max(...values)].map((value) => Math.log(Math.max(value, 1e-12)));
  const span = high - low || 1;
  return (/** @type {number} */ value) => from + ((Math.log(Math.max(value, 1e-12)) - low) / span) * (to - from);
}

/** First digits of round values, from few to many to a power of ten. */
const DIGITS = [[1], [1, 3], [1, 2, 5], [1, 2, 3, 5, 7], [1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9]];
/** So many values and no fewer tell how an axis runs, where the dots are far enough apart. */
const FEWEST_TICKS = 3;

/** Round values inside of what is shown: as few as tell how the axis runs. */
export function ticks(/** @type {number[]} */ values) {
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const choices = DIGITS.map((digits) => {
    const found = [];
    for (let power = Math.floor(Math.log10(low || 1e-12)); 10 ** power <= high; power++) {
      for (const digit of digits) found.push(Number((digit * 10 ** power).toPrecision(2)));
    }
    return found.filter((value) => value >= low && value <= high);
  });
  return choices.find((found) => found.length >= FEWEST_TICKS) ?? choices[choices.length - 1];
}

/** @param {string} name @param {Record<string, unknown>} attributes @returns {SVGElement} */
function shape(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  return /** @type {SVGElement} */ (made);
}

function label(/** @type {string} */ text, /** @type {Record<string, unknown>} */ attributes) {
  const made = shape('text', attributes);
  made.textContent = text;
  return made;
}
