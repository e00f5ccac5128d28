/** What is inside an element: its shadow tree, built node by node, so that no policy about markup or styles stands in its way. */
import { sharedSheet } from './sheet.js';

/** @import { View } from '../element.js' */

const ICONS = {
  reset: 'M4 4v6h6M4.6 10a8 8 0 1 1-.4 4.5',
  pause: 'M9 5v14M15 5v14',
  play: 'M8 5l11 7-11 7z',
  hand: 'M9 11V5a1.5 1.5 0 0 1 3 0v6m0-1.5a1.5 1.5 0 0 1 3 0V12m0-1a1.5 1.5 0 0 1 3 0v4a6 6 0 0 1-6 6h-1a5 5 0 0 1-4-2l-3.6-4.8a1.5 1.5 0 0 1 2.3-1.9L9 14',
  ar: 'M12 3l8 4.5v9L12 21l-8-4.5v-9zM4 7.5l8 4.5 8-4.5M12 12v9',
  fullscreen: 'M9 4H4v5M15 4h5v5M9 20H4v-5M15 20h5v-5',
};

/** In the order of the pipeline, which is the order of the keys 1, 2 and 3. */
export const VIEWS = /** @type {const} */ (['points', 'reduced', 'mesh']);

/**
 * @param {ShadowRoot} root
 */
export function buildParts(root) {
  root.adoptedStyleSheets = [sharedSheet()];

  const canvas = make('canvas', { part: 'canvas' });
  const keys = make('p', { id: 'keys', hidden: '' });

  const image = make('img', { part: 'poster-image', alt: '', decoding: 'async', hidden: '' });
  const poster = make('div', { class: 'poster', part: 'poster' }, slot('poster', image));

  const progressText = make('span', { id: 'stage', class: 'progress-text', part: 'progress-text' });
  const bar = make('progress', { part: 'progress-bar', max: '1', 'aria-labelledby': 'stage' });
  const cancel = make('button', { class: 'button cancel', part: 'button cancel', type: 'button' });
  const progressCard = make('div', { class: 'progress-card', part: 'progress-card' }, progressText, cancel, bar);
  const progress = make('div', { class: 'progress', part: 'progress', hidden: '' }, slot('progress', progressCard));

  const errorTitle = make('p', { class: 'error-title', part: 'error-title' });
  const errorMore = make('summary', { part: 'error-summary' });
  const errorText = make('p', { class: 'error-text', part: 'error-text' });
  const errorDetails = make('details', { class: 'error-details', part: 'error-details' }, errorMore, errorText);
  const retry = make('button', { class: 'button retry', part: 'button retry', type: 'button' });
  const errorCard = make('div', { class: 'error-card', part: 'error-card' }, errorTitle, errorDetails, retry);
  const error = make('div', { class: 'error', part: 'error', role: 'alert', hidden: '' }, slot('error', errorCard));

  const legend = make('legend', {});
  const choices = VIEWS.map((view) => choice(view));
  const views = make('fieldset', { class: 'views', part: 'views' }, legend, ...choices.map(({ label }) => label));
  const reset = make('button', { class: 'button reset', part: 'button reset', type: 'button' }, icon('reset'));
  const pause = make('button', { class: 'button', part: 'button pause', type: 'button' }, icon('pause'));
  const fullscreen = make('button', { class: 'button fullscreen', part: 'button fullscreen', type: 'button' }, icon('fullscreen'));
  const tools = make('div', { class: 'tools', part: 'tools' }, pause, reset, fullscreen);
  const toolbar = make('div', { class: 'toolbar', part: 'toolbar', hidden: '' }, slot('toolbar', views, tools));

  const ar = make('button', { class: 'button', part: 'button ar-button', type: 'button' }, icon('ar'));
  const arBox = make('div', { class: 'ar', part: 'ar', hidden: '' }, slot('ar-button', ar));

  const spoken = make('div', { class: 'spoken', role: 'status' });

  const hotspots = make('div', { class: 'hotspots', part: 'hotspots' });
  const prompt = make('div', { class: 'prompt', part: 'prompt', 'aria-hidden': 'true', hidden: '' }, slot('interaction-prompt', icon('hand')));

  const frame = make('div', { class: 'frame', part: 'frame' }, canvas, hotspots, prompt, poster, progress, error, toolbar, arBox, keys, spoken);
  root.append(frame);
  return {
    canvas, keys, image, poster, progress, progressText, bar, cancel, error, errorTitle, errorMore, errorText, errorDetails, retry,
    legend, choices, views, reset, pause, fullscreen, tools, toolbar, spoken, frame, hotspots, prompt, ar,
  };
}

/** @param {'pause' | 'play'} name @param {HTMLElement} button */
export function setIcon(button, name) {
  button.replaceChildren(icon(name));
}

/** @param {View} view */
function choice(view) {
  const input = make('input', { type: 'radio', name: 'view', value: view });
  const words = make('span', { part: 'view' });
  return { view, input, words, label: make('label', {}, input, words) };
}

/** @param {string} name @param {...Node} fallback */
function slot(name, ...fallback) {
  return make('slot', { name }, ...fallback);
}

/**
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Record<string, string>} attributes
 * @param {...Node} children
 */
function make(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** @param {keyof typeof ICONS} name */
function icon(name) {
  const namespace = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(namespace, 'svg');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS(namespace, 'path');
  path.setAttribute('d', ICONS[name]);
  svg.append(path);
  return svg;
}
