/** Keys besides those of the viewer. */

/** @import { View } from '../element.js' */

/** @typedef {{ choose: (view: View) => void, pause: () => void }} Hands */

/** @type {Record<string, (hands: Hands) => void>} */
export const KEYS = {
  1: ({ choose }) => choose('points'),
  2: ({ choose }) => choose('reduced'),
  3: ({ choose }) => choose('mesh'),
  ' ': ({ pause }) => pause(),
};
