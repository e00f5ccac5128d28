/**
 * Files of the person's, kept by the browser on this device (IndexedDB), so that a reload and Back find them again. Where the browser
 * keeps nothing, they are found as long as the page is open.
 *
 * @typedef {{ file: File, beside: File[] }} Kept
 */

const NAME = 'pointweave scans';
const TABLE = 'scans';
/** Older ones make room. */
const MOST = 4;

/** Of this visit: these cost no storage. @type {Map<string, Kept>} */
const open = new Map();

/** Under which key a file is kept. @param {File} file */
export function keyOf({ name, size, lastModified }) {
  return `${name} ${size} ${lastModified}`;
}

/** Keeps a file, unless it is kept already. @param {File} file @param {File[]} beside what its mesh may name, and the other parts of its scan @param {string} [key] */
export async function keep(file, beside, key = keyOf(file)) {
  if (open.get(key)?.beside.length === beside.length) return;
  open.set(key, { file, beside });
  try {
    await store((table) => table.put({ file, beside, at: Date.now() }, key));
    await makeRoom();
  } catch (error) {
    console.info('Pointweave cannot keep the scan for a reload:', /** @type {any} */ (error)?.message);
  }
}

/** @param {string} key @returns {Promise<Kept | undefined>} undefined where it is kept no more */
export async function kept(key) {
  return open.get(key) ?? store((table) => table.get(key)).catch(() => undefined);
}

/** Forgets all files that are kept. */
export async function forget() {
  open.clear();
  await store((table) => table.clear());
}

/** Whether a file is kept. */
export async function keepsSome() {
  return (await store((table) => table.count()).catch(() => 0)) > 0;
}

async function makeRoom() {
  const [keys, all] = [await store((table) => table.getAllKeys()), await store((table) => table.getAll())];
  const newest = all.map(({ at }, i) => ({ at, key: keys[i] })).sort((a, b) => b.at - a.at);
  for (const { key } of newest.slice(MOST)) await store((table) => table.delete(key));
}

/**
 * @template Result
 * @param {(table: IDBObjectStore) => IDBRequest<Result>} ask
 * @returns {Promise<Result>}
 */
async function store(ask) {
  const base = await new Promise((/** @type {(base: IDBDatabase) => void} */ resolve, reject) => {
    const opening = indexedDB.open(NAME, 1);
    opening.onupgradeneeded = () => opening.result.createObjectStore(TABLE);
    opening.onsuccess = () => resolve(opening.result);
    opening.onerror = () => reject(opening.error);
  });
  try {
    const doing = base.transaction(TABLE, 'readwrite');
    const request = ask(doing.objectStore(TABLE));
    await new Promise((resolve, reject) => {
      doing.oncomplete = resolve;
      doing.onabort = doing.onerror = () => reject(doing.error);
    });
    return request.result;
  } finally {
    base.close();
  }
}
