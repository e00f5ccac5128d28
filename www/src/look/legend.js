import { cssGradient } from 'pointweave/viewer';
import { element } from '../dom.js';
import { page } from '../page.js';
import { say } from '../words/say.js';

/** @import { Kinds, Scale } from 'pointweave/viewer' */

/** How the colours in the picture are read. */
export class Legend {
  #box = page.legend;

  /** @param {Scale | Kinds | null} legend @param {boolean} [coming]  it is being made */
  show(legend, coming = false) {
    this.#box.hidden = !legend && !coming;
    if (!legend) return this.#box.replaceChildren(...(coming ? [element('span', { textContent: say('Measuring…') })] : []));
    const parts = 'kinds' in legend ? kinds(legend) : scale(legend);
    this.#box.replaceChildren(element('strong', { textContent: legend.title }), ...parts, element('span', { textContent: legend.note }));
  }
}

function scale(/** @type {Scale} */ { low, high, words }) {
  const bar = element('div', { className: 'legend-bar' });
  bar.style.background = cssGradient();
  const ends = element('div', { className: 'legend-ends' });
  for (const value of [low, (low + high) / 2, high]) ends.append(element('data', { value: String(value), textContent: words(value) }));
  return [bar, ends];
}

function kinds(/** @type {Kinds} */ { kinds }) {
  const row = element('div', { className: 'legend-kinds' });
  for (const [color, name] of kinds) {
    const swatch = element('i');
    swatch.style.background = color;
    const kind = element('span');
    kind.append(swatch, name);
    row.append(kind);
  }
  return [row];
}
