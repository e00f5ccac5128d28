import { isSample } from '../controls/samples.js';
import { entriesOf } from '../controls/settings.js';
import { recipeOf, recipeWord } from '../tidy/recipe.js';

/**
 * @import { Value } from '../state/shown.js'
 *
 * The part of the address after #: the sample, the recipe that tidies it, the settings that were chosen, and what is shown. A file of the
 * person's is never in it. `?src=` before it names a file beside the page.
 */

/** What an address asks for. */
export function readAddress() {
  const words = new URLSearchParams(location.hash.slice(1));
  const sample = words.get('sample');
  return {
    words,
    sample: isSample(sample) ? sample : null,
    recipe: recipeOf(words.get('prepare')),
    src: new URLSearchParams(location.search).get('src'),
    view: words.get('view'),
    paint: words.get('colors'),
  };
}

/** The address that shows the same again. @param {Value} value */
export function addressOf({ scan, edits: { recipe }, settings, look: { view, paint } }) {
  const words = new URLSearchParams();
  if (scan && 'model' in scan) words.set('sample', scan.model);
  if (recipe?.length) words.set('prepare', recipeWord(recipe));
  for (const [key, value] of entriesOf(settings)) words.set(key, value);
  if (view !== 'mesh') words.set('view', view);
  if (paint !== 'natural') words.set('colors', paint);
  const url = new URL(location.href);
  url.search = scan && 'src' in scan ? new URLSearchParams({ src: scan.src }).toString() : '';
  url.hash = words.toString();
  return url.href;
}
