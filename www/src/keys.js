/**
 * A key: what it is called in the help, what it does in words, and what it does.
 * @typedef {{ key: string, also?: string[], shown?: string, does?: string, act: () => void }} Key
 */

/**
 * Keys for the picture. They act while the picture or nothing in particular has the focus, so that typing and
 * other controls keep theirs.
 * @param {HTMLElement} stage
 * @param {Key[]} keys  by KeyboardEvent.key, letters in lower case
 */
export function listenToKeys(stage, keys) {
  const actions = new Map(keys.flatMap(({ key, also = [], act }) => [key, ...also].map((name) => [name, act])));
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const focus = document.activeElement;
    const onPicture = focus instanceof HTMLCanvasElement;
    const typing = focus instanceof HTMLSelectElement || focus instanceof HTMLDialogElement || focus?.closest('dialog');
    const free = focus === null || focus === document.body || (stage.contains(focus) && !typing);
    const moves = event.key.startsWith('Arrow');
    if (!(moves ? onPicture : free)) return;
    const act = actions.get(event.key.length === 1 ? event.key.toLowerCase() : event.key);
    if (!act) return;
    event.preventDefault();
    act();
  });
}

/** The keys with what they do, for the help. */
export function describeKeys(/** @type {Key[]} */ keys) {
  return keys.flatMap(({ key, shown = key.toUpperCase(), does }) => (does ? [{ keys: shown, does }] : []));
}
