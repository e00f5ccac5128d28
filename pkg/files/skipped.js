/** Points that were left out, in words. */

/** @type {Record<string, string>} */
const WHY = {
  'not-finite': 'not finite',
  invalid: 'marked as invalid',
  'no-data': 'without data (such as -9999)',
  'no-return': 'without a return (at 0 0 0 or at the sensor)',
  'unused-vertices': 'vertices that no face names',
  'broken-faces': 'faces with a corner that there is not',
};

/**
 * Nothing where none was left out.
 * @param {Record<string, number>} skipped
 */
export function skippedInWords(skipped) {
  return Object.entries(skipped)
    .map(([why, count]) => `${count.toLocaleString('en-US')} ${WHY[why] ?? why}`)
    .join(', ');
}
