/** Keys for a picture that has the focus; all else in the page keeps its own. */

/** @import { View } from '../element.js' */

const TURN = Math.PI / 12;
const NEARER = 1 / 1.2;

/**
 * @typedef {object} Hands
 * @property {(right: number, over: number) => void} turn
 * @property {(factor: number) => void} zoom
 * @property {() => void} home
 * @property {(view: View) => void} choose
 * @property {() => void} pause
 */

/** @type {Record<string, (hands: Hands) => void>} */
const KEYS = {
  ArrowRight: ({ turn }) => turn(TURN, 0),
  ArrowLeft: ({ turn }) => turn(-TURN, 0),
  ArrowUp: ({ turn }) => turn(0, TURN),
  ArrowDown: ({ turn }) => turn(0, -TURN),
  '+': ({ zoom }) => zoom(NEARER),
  '=': ({ zoom }) => zoom(NEARER),
  '-': ({ zoom }) => zoom(1 / NEARER),
  _: ({ zoom }) => zoom(1 / NEARER),
  Home: ({ home }) => home(),
  1: ({ choose }) => choose('points'),
  2: ({ choose }) => choose('reduced'),
  3: ({ choose }) => choose('mesh'),
  ' ': ({ pause }) => pause(),
};

/** @param {HTMLElement} element @param {() => Hands | undefined} hands none while there is nothing to handle */
export function listenToKeys(element, hands) {
  element.addEventListener('keydown', (event) => {
    const act = event.ctrlKey || event.metaKey || event.altKey ? undefined : KEYS[event.key];
    const present = act && hands();
    if (!present) return;
    event.preventDefault();
    act(present);
  });
}
