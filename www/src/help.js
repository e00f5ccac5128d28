import { element } from './dom.js';
import { page } from './page.js';

/**
 * The dialog that lists the keys.
 * @param {{ keys: string, does: string }[]} list
 * @returns {() => void} shows it
 */
export function helpDialog(list) {
  const dialog = page.help;
  const rows = page.helpKeys;
  for (const { keys, does } of list) {
    const row = element('div');
    const names = element('dt');
    for (const key of keys.split(' ')) names.append(element('kbd', { textContent: key }));
    row.append(names, element('dd', { textContent: does }));
    rows.append(row);
  }
  page.helpClose.addEventListener('click', () => dialog.close());
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close();
  });
  return () => dialog.open || dialog.showModal();
}
