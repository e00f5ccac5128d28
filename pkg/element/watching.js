/** Who is near the viewport. */
import { Watch } from '../viewer/watching.js';

/**
 * About one viewport away. Where a browser knows both, the second is a share of what the first has made of the viewport: Chromium takes
 * 0.4 + 0.4 · 1.8 viewports, and of 100 % four.
 */
const NEAR = { rootMargin: '40%', scrollMargin: '40%' };

/** @type {Watch | undefined} */
let near;

export function inReach() {
  return (near ??= new Watch(NEAR));
}
