import { byId, element } from './dom.js';

/**
 * The dialog that lists the keys.
 * @param {{ keys: string, does: string }[]} list
 * @returns {() => void} shows it
 */
export function helpDialog(list) {
  const dialog = byId('help', HTMLDialogElement);
  const rows = byId('help-keys', HTMLElement);
  for (const { keys, does } of list) {
    const row = element('div');
    const names = element('dt');
    for (const key of keys.split(' ')) names.append(element('kbd', { textContent: key }));
    row.append(names, element('dd', { textContent: does }));
    rows.append(row);
  }
  byId('help-close', HTMLButtonElement).addEventListener('click', () => dialog.close());
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close();
  });
  return () => dialog.open || dialog.showModal();
}
