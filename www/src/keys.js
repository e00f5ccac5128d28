/**
 * Keys for the picture. They act while the picture or nothing in particular has the focus, so that typing and
 * other controls keep theirs.
 * @param {HTMLElement} stage
 * @param {Record<string, () => void>} actions  by KeyboardEvent.key, letters in lower case
 */
export function listenToKeys(stage, actions) {
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const focus = document.activeElement;
    const onPicture = focus instanceof HTMLCanvasElement;
    const free = focus === null || focus === document.body || stage.contains(focus);
    const moves = event.key.startsWith('Arrow');
    if (!(moves ? onPicture : free)) return;
    const act = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
}
