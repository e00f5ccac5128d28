import { announce } from '../dom.js';
import { page } from '../page.js';
import { say } from '../words/say.js';
import { saveFile } from './files.js';

/** A poster is shown beside much else: smaller files matter more than the last detail. */
const POSTER_QUALITY = 0.85;

/**
 * Saves the picture as it is shown: as PNG, and as a poster for `<point-weave>`.
 * @param {(type: string, quality?: number) => Promise<Blob | null>} picture
 * @param {() => string} stem  what the scan's files are called
 * @param {(name: string) => void} posted  a poster was saved under this name
 * @returns {() => void} saves the picture
 */
export function offerPictures(picture, stem, posted) {
  const save = async () => {
    const blob = await picture('image/png');
    if (!blob) return;
    saveFile(blob, `${stem()}.png`);
    announce(say('{name} saved', { name: `${stem()}.png` }));
  };
  page.picture.addEventListener('click', save);
  page.poster.addEventListener('click', async () => {
    // A browser that writes no WebP gives a PNG.
    const blob = await picture('image/webp', POSTER_QUALITY);
    if (!blob) return;
    const name = `${stem()}-poster.${blob.type.split('/')[1]}`;
    saveFile(blob, name);
    posted(name);
    announce(say('{name} saved', { name }));
  });
  return save;
}
