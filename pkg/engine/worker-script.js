/** A browser's worker, wherever its script lies. */

/** @param {string | URL} [given] the script's URL; default: the package's own */
export function startScript(given) {
  if (given) return startFrom(new URL(given, location.href));
  const here = new URL(import.meta.url);
  if (isElsewhere(here)) return startFrom(new URL('../worker.js', here));
  return new Worker(new URL('../worker.js', import.meta.url), { type: 'module', name: 'pointweave' }); // as bundlers look for it
}

/**
 * Browsers start workers from scripts of the page's own origin alone. From elsewhere, such as a CDN, the script is
 * imported by a line of its own, and the page's security policy has to allow `worker-src blob:`.
 * @param {URL} script
 */
function startFrom(script) {
  const address = isElsewhere(script)
    ? URL.createObjectURL(new Blob([`import ${JSON.stringify(script.href)};`], { type: 'text/javascript' }))
    : script.href;
  const worker = new Worker(address, { type: 'module', name: 'pointweave' });
  if (address.startsWith('blob:')) worker.addEventListener('message', () => URL.revokeObjectURL(address), { once: true });
  return worker;
}

/** @param {URL} url */
function isElsewhere(url) {
  return url.protocol.startsWith('http') && url.origin !== location.origin;
}
