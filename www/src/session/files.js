import { page } from '../page.js';
import { filesOf } from './dropped.js';

/**
 * Files and folders come in by dropping them anywhere, by choosing or by pasting; points may be pasted as text, too.
 * @param {(files: { file: File, path: string }[]) => void} take
 * @returns {() => void} shows the chooser
 */
export function acceptFiles(take) {
  const input = page.file;
  const veil = page.veil;
  const choose = () => input.click();
  const open = (/** @type {File[]} */ files) => take(files.map((file) => ({ file, path: file.name })));

  input.addEventListener('change', () => {
    open([...(input.files ?? [])]);
    input.value = ''; // the same file can be chosen again
  });
  document.addEventListener('paste', (event) => {
    if (event.target instanceof HTMLInputElement) return; // it is meant for the field
    const files = [...(event.clipboardData?.files ?? [])];
    const text = event.clipboardData?.getData('text/plain') ?? '';
    if (files.length) open(files);
    else if (/^\s*([-+.\d]|ply\b|#)/i.test(text)) open([new File([text], 'pasted points.xyz', { type: 'text/plain' })]);
  });

  // A drag enters and leaves every element it crosses; only the balance tells whether it is over the page.
  let inside = 0;
  const carriesFiles = (/** @type {DragEvent} */ event) => event.dataTransfer?.types.includes('Files') ?? false;
  const show = (/** @type {number} */ depth) => {
    inside = Math.max(0, depth);
    veil.hidden = inside === 0;
  };
  addEventListener('dragenter', (event) => {
    if (carriesFiles(event)) show(inside + 1);
  });
  addEventListener('dragleave', (event) => {
    if (carriesFiles(event)) show(inside - 1);
  });
  addEventListener('dragover', (event) => {
    if (carriesFiles(event)) event.preventDefault();
  });
  addEventListener('drop', (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault();
    show(0);
    if (event.dataTransfer) filesOf(event.dataTransfer).then(take);
  });
  return choose;
}

/** Hands a file to the person: the browser saves it, nothing is sent. */
export function saveFile(/** @type {Blob} */ file, /** @type {string} */ name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(file);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
