import { element } from './dom.js';

/** What each wasm module adds to the page. @type {Record<string, string>} */
const ADDS = { threads: 'threads, which make it faster', las: 'LAS and LAZ files', e57: 'E57 files', pictures: 'pictures of textures', exports: 'files to save', packed: 'packed files', prepare: 'recipes', light: 'light meshes' };

const EVERY_MS = 2000;

/**
 * On a first start `cargo xtask serve` shows the page before all of it is built. Says what is still missing, and offers the whole
 * page when it is there.
 * @param {string[]} missing names of wasm modules
 */
export function showBuilding(missing) {
  const note = element('p', { id: 'building', role: 'status' });
  note.style.cssText = 'position: fixed; inset: auto auto 0 0; margin: 0; padding: 0.3em 0.8em; z-index: 9; background: Canvas; color: CanvasText; font-size: 0.8rem';
  document.body.append(note);
  const say = (/** @type {string[]} */ names) => (note.textContent = `Still being built: ${names.map((name) => ADDS[name] ?? name).join('; ')}.`);
  say(missing);
  const timer = setInterval(async () => {
    const left = await stillMissing();
    if (!left) return;
    if (left.length) return say(left);
    clearInterval(timer);
    const reload = element('button', { type: 'button', textContent: 'Reload' });
    reload.addEventListener('click', () => location.reload());
    note.replaceChildren('All of the page is built. ', reload);
  }, EVERY_MS);
}

/**
 * The list lies beside the page as long as something is missing; a server that is gone says nothing.
 * @returns {Promise<string[] | undefined>}
 */
async function stillMissing() {
  const response = await fetch('building.json', { cache: 'no-store' }).catch(() => undefined);
  if (!response) return undefined;
  const isList = response.ok && response.headers.get('content-type')?.includes('json');
  return isList ? response.json() : [];
}
