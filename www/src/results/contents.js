import { say } from '../words/say.js';
import * as format from './format.js';

/** What a scan holds, and what of its file was no point. @param {import('../session/session.js').Scan} scan @param {number} [all] points before something was cut off */
export function contentsOf({ model, count, cloud, kept }, all = count) {
  const { faces = 0, sampled = 0 } = cloud.file ?? {};
  const out = Object.values(cloud.skipped ?? {}).reduce((sum, count) => sum + count, 0);
  const points = kept && count < all ? say('{count} of {points}', { count: format.count(count), points: format.points(all) }) : format.points(count);
  const parts = [model ? say('simulated scan') : '', points];
  if (sampled) parts.push(say('taken from {faces} faces', { faces: format.count(faces) }));
  else if (faces) parts.push(say('the corners of {faces} faces', { faces: format.count(faces) }));
  if (out) parts.push(say('{count} without a place left out', { count: format.count(out) }));
  return parts.filter(Boolean).join(', ');
}
