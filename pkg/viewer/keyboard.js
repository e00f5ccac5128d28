/** Keys for what has the focus; all else in the page keeps its own. */

/** @import { Viewer } from '../viewer.js' */
/** What moves. @typedef {Pick<Viewer, 'turn' | 'zoom' | 'home'>} Hands */

const TURN = Math.PI / 12;
const NEARER = 1 / 1.2;

/** How a viewer is moved, by `KeyboardEvent.key`. @type {Record<string, (hands: Hands) => void>} */
export const MOVES = {
  ArrowRight: (hands) => hands.turn(TURN, 0),
  ArrowLeft: (hands) => hands.turn(-TURN, 0),
  ArrowUp: (hands) => hands.turn(0, TURN),
  ArrowDown: (hands) => hands.turn(0, -TURN),
  '+': (hands) => hands.zoom(NEARER),
  '=': (hands) => hands.zoom(NEARER),
  '-': (hands) => hands.zoom(1 / NEARER),
  _: (hands) => hands.zoom(1 / NEARER),
  Home: (hands) => hands.home(),
};

/**
 * @template Subject
 * @param {HTMLElement} element
 * @param {Record<string, (subject: Subject) => void>} keys what each does
 * @param {() => Subject | undefined} subject to what; none while there is nothing to handle
 */
export function listenToKeys(element, keys, subject) {
  element.addEventListener('keydown', (event) => {
    const act = event.ctrlKey || event.metaKey || event.altKey ? undefined : keys[event.key];
    const present = act && subject();
    if (!act || !present) return;
    event.preventDefault();
    act(present);
  });
}
