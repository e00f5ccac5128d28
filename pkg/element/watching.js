/** Who is near the viewport. */
import { Watch } from '../viewer/watching.js';

/** At most one viewport away. */
const NEAR = { rootMargin: '100%', scrollMargin: '100%' };

/** @type {Watch | undefined} */
let near;

export function inReach() {
  return (near ??= new Watch(NEAR));
}
