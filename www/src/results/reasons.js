import { say } from '../words/say.js';

/** What the package says of an engine's choice and of a reduction, as it says it; `{…}` stands for a number or a message. */
export const REASONS = [
  'one thread was asked for',
  'threads need a worker',
  'there is one processor core',
  'the page is cross-origin isolated',
  'the page is not cross-origin isolated',
  'the threads build did not start: {why}',
  'memory is limited to {size} MiB here',
  'the points are at {places} places: each is kept once',
  'noise of {noise} hides a surface within {asked}: the tolerance was taken as {taken}',
  '{dropped} points, more than half, are isolated: none was dropped',
];

const PATTERNS = REASONS.map((text) => ({ text, pattern: new RegExp(`^${text.replace(/[.*+?^$()|[\]\\]/g, '\\$&').replace(/\{(\w+)\}/g, '(?<$1>.+)')}$`) }));

/** Reasons as sentences in the person's language; what nobody knows stays as it is. @param {string} reasons one after the other, with semicolons between */
export function reasonWords(reasons) {
  return reasons.split('; ').filter(Boolean).map(sentence).join(' ');
}

/** @param {string} reason */
function sentence(reason) {
  const known = PATTERNS.find(({ pattern }) => pattern.test(reason));
  const words = known ? say(known.text, known.pattern.exec(reason)?.groups) : reason;
  return `${words[0].toUpperCase()}${words.slice(1)}.`;
}
