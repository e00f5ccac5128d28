// Keeps the files of the page, so that it works without a connection. vite.config.js puts before it `VERSION`, a hash of
// all that was built, and `FILES`, their addresses: every build has a cache of its own, complete or not there at all.

/* global VERSION, FILES */

const scope = self.registration.scope;
const prefix = `pointweave ${scope} `;
const name = prefix + VERSION;
const kept = new Set(FILES.map((file) => new URL(file, scope).href));

self.addEventListener('install', (event) => {
  event.waitUntil(keepAll());
});

self.addEventListener('activate', (event) => {
  event.waitUntil(forgetOthers());
});

self.addEventListener('fetch', (event) => {
  const address = addressOf(event.request);
  if (address) event.respondWith(answer(address, event.request));
});

async function keepAll() {
  const cache = await caches.open(name);
  // What has a hash in its name may come from the browser's cache, the page itself must be the newest.
  await cache.addAll([...kept].map((address) => new Request(address, { cache: address === scope ? 'reload' : 'default' })));
}

async function forgetOthers() {
  const names = await caches.keys();
  await Promise.all(names.filter((other) => other.startsWith(prefix) && other !== name).map((other) => caches.delete(other)));
}

/** The kept file that a request asks for, whatever follows its `?` or `#`; undefined for all else, such as scans. */
function addressOf(request) {
  if (request.method !== 'GET') return undefined;
  const { origin, pathname } = new URL(request.url);
  const address = (origin + pathname).replace(/index\.html$/, '');
  return kept.has(address) ? address : undefined;
}

/** A kept response has the headers that it came with: an isolated page stays isolated. */
async function answer(address, request) {
  const cache = await caches.open(name);
  return (await cache.match(address)) ?? fetch(request);
}
