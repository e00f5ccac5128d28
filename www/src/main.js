import { App } from './app.js';

new App().openSample('duck');
