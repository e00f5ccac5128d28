import { App } from './app.js';
import { showBuilding } from './building.js';
import { byId } from './dom.js';
import { workOffline } from './offline.js';
import { Streamed, isTileset } from './streaming/streamed.js';
import { canCompute } from './support.js';
import { translatePage } from './words/page-words.js';

translatePage();

const src = new URLSearchParams(location.search).get('src');
if (isTileset(src)) new Streamed(src).start();
else if (canCompute()) new App().start();
else {
  byId('app', HTMLElement).dataset.state = 'unsupported';
  byId('no-engine', HTMLElement).hidden = false;
}
workOffline();
if (import.meta.env.BUILDING.length) showBuilding(import.meta.env.BUILDING);
