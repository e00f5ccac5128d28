import { announce } from './dom.js';
import { say } from './words/say.js';

/** Puts a text on the clipboard, and says so on the button for a moment. */
export async function copyText(/** @type {string} */ text, /** @type {HTMLButtonElement} */ button) {
  const label = button.dataset.label ?? button.textContent ?? '';
  button.dataset.label = label;
  const done = (await write(text)) ? say('Copied') : say('Not allowed: select and copy it yourself');
  button.textContent = done;
  announce(done);
  setTimeout(() => (button.textContent = label), 2000);
}

/** Where a page is not served securely the clipboard of today is missing, and the old way may work. */
async function write(/** @type {string} */ text) {
  if (navigator.clipboard) return navigator.clipboard.writeText(text).then(() => true, () => false);
  const area = document.createElement('textarea');
  area.value = text;
  document.body.append(area);
  area.select();
  const done = document.execCommand('copy');
  area.remove();
  return done;
}
