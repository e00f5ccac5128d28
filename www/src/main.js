import { App } from './app.js';
import { showBuilding } from './building.js';
import { byId } from './dom.js';
import { workOffline } from './offline.js';
import { canCompute } from './support.js';
import { translatePage } from './words/page-words.js';

translatePage();

if (canCompute()) new App().start();
else {
  byId('app', HTMLElement).dataset.state = 'unsupported';
  byId('no-engine', HTMLElement).hidden = false;
}
workOffline();
if (import.meta.env.BUILDING.length) showBuilding(import.meta.env.BUILDING);
