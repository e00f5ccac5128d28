/**
 * Files that come in together: one of them is opened, and each has a part.
 *
 * @typedef {'scan' | 'beside' | 'other'} Kind a scan by its name, what a mesh may name, or neither
 * @typedef {{ file: File, path: string, kind: Kind }} Dropped
 */

const SCAN = /\.(ply|las|laz|e57|ptx|pts|pcd|obj|off|coff|noff|cnoff|stl|glb|3mf|asc|grid|agr|grd|tiff?|splat|spz|xyz|xyzn|xyzrgb|txt|csv|tsv|dat|zip|gz)$/i;
/** A scan where nothing else is. */
const TEXT = /\.(txt|csv|tsv|dat)$/i;
/** A mesh may name its material library and pictures, which come along. */
const BESIDE = /\.(mtl|png|jpe?g|webp)$/i;
/** No more files of a folder are looked at. */
const MOST = 2_000;

/**
 * What each file is for. The first that looks like a scan is opened, else the first that no mesh would name.
 * @param {{ file: File, path: string }[]} files
 * @returns {{ first: Dropped, all: Dropped[] }}
 */
export function sortOut(files) {
  const all = files.map(({ file, path }) => ({ file, path, kind: kindOf(file.name) }));
  const scans = all.filter(({ kind }) => kind === 'scan');
  const first = scans.find(({ file }) => !TEXT.test(file.name)) ?? scans[0] ?? all.find(({ kind }) => kind === 'other') ?? all[0];
  return { first, all };
}

/** @param {string} name @returns {Kind} */
function kindOf(name) {
  return SCAN.test(name) ? 'scan' : BESIDE.test(name) ? 'beside' : 'other';
}

/**
 * All files that were dropped, those in folders too; files that a system hides are left out. To be called in the event itself.
 * @param {DataTransfer} data
 * @returns {Promise<{ file: File, path: string }[]>}
 */
export async function filesOf(data) {
  const items = [...data.items].filter(({ kind }) => kind === 'file').map((item) => ({ entry: item.webkitGetAsEntry?.(), file: item.getAsFile() }));
  /** @type {{ file: File, path: string }[]} */
  const found = [];
  for (const { entry, file } of items) {
    if (entry?.isDirectory) await walk(/** @type {FileSystemDirectoryEntry} */ (entry), found);
    else if (file) found.push({ file, path: file.name });
  }
  return found;
}

/** @param {FileSystemDirectoryEntry} folder @param {{ file: File, path: string }[]} found */
async function walk(folder, found) {
  for (const entry of (await entriesOf(folder)).sort((a, b) => a.name.localeCompare(b.name, 'en', { numeric: true }))) {
    if (found.length >= MOST) return;
    if (entry.name.startsWith('.')) continue;
    if (entry.isDirectory) await walk(/** @type {FileSystemDirectoryEntry} */ (entry), found);
    else found.push({ file: await new Promise((resolve, reject) => /** @type {FileSystemFileEntry} */ (entry).file(resolve, reject)), path: entry.fullPath.slice(1) });
  }
}

/** A browser hands out the entries of a folder in parts. @param {FileSystemDirectoryEntry} folder @returns {Promise<FileSystemEntry[]>} */
async function entriesOf(folder) {
  const reader = folder.createReader();
  const all = [];
  for (;;) {
    const some = await new Promise((/** @type {(entries: FileSystemEntry[]) => void} */ resolve, reject) => reader.readEntries(resolve, reject));
    if (!some.length) return all;
    all.push(...some);
  }
}
