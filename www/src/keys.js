/**
 * A key: what it is called in the help, what it does in words, and what it does, unless somebody else does it.
 * With `ctrl` it is pressed together with Ctrl, or with Command.
 * @typedef {{ key: string, ctrl?: boolean, also?: string[], shown?: string, does?: string, act?: () => void }} Key
 */

/** What takes letters itself. */
const TYPING = 'input:not([type="checkbox"], [type="radio"], [type="range"]), textarea, select, dialog';

/**
 * Keys of the page, wherever nobody types. While the picture has the focus, it takes its own.
 * @param {Key[]} keys  by KeyboardEvent.key, letters in lower case
 */
export function listenToKeys(keys) {
  const actions = new Map(keys.flatMap(({ key, ctrl, also = [], act }) => [key, ...also].map((name) => [`${ctrl ? 'ctrl ' : ''}${name}`, act])));
  document.addEventListener('keydown', (event) => {
    if (event.defaultPrevented || event.altKey) return;
    const ctrl = event.ctrlKey || event.metaKey;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const act = actions.get(ctrl ? `ctrl ${event.shiftKey ? 'shift ' : ''}${key}` : key);
    if (!act || document.activeElement?.closest(TYPING)) return;
    event.preventDefault();
    act();
  });
}

/** The keys with what they do, for the help. */
export function describeKeys(/** @type {Key[]} */ keys) {
  return keys.flatMap(({ key, shown = key.toUpperCase(), does }) => (does ? [{ keys: shown, does }] : []));
}
