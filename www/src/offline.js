/**
 * Once loaded, the page works without a connection: a service worker keeps its files. Only what is built as a whole has one,
 * so that development always sees the files as they are.
 */
export function workOffline() {
  if (!import.meta.env.PROD || import.meta.env.BUILDING.length || !('serviceWorker' in navigator)) return;
  navigator.serviceWorker.register('./service-worker.js').catch((error) => {
    console.info('Pointweave will not work offline here:', error.message);
  });
}
