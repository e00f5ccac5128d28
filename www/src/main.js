import { App } from './app.js';
import { showBuilding } from './building.js';
import { page } from './page.js';
import { workOffline } from './offline.js';
import { Streamed, isTileset } from './streaming/streamed.js';
import { canCompute } from './support.js';
import { translatePage } from './words/page-words.js';

translatePage();

const src = new URLSearchParams(location.search).get('src');
if (isTileset(src)) new Streamed(src).start();
else if (canCompute()) new App().start();
else {
  page.app.dataset.state = 'unsupported';
  page.noEngine.hidden = false;
}
workOffline();
if (import.meta.env.BUILDING.length) showBuilding(import.meta.env.BUILDING);
