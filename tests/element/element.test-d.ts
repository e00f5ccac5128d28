// Never run: `tsc` checks that the element's types say what its documentation does, and that the class agrees.

import { PointWeaveElement, type LoadDetail, type View } from 'pointweave/element';
import type * as written from '../../pkg/element/element.js';

type Written = typeof written.PointWeaveElement;
/** What the element adds to others. */
type Own<Element> = Omit<Element, keyof HTMLElement>;

/** The class has what is declared. */
export function conform(element: InstanceType<Written>, made: Written): [Own<PointWeaveElement>, Pick<typeof PointWeaveElement, 'words' | 'wasmUrl' | 'workerUrl'>] {
  return [element, made];
}

export function use() {
  const element = document.createElement('point-weave');
  element.ratio = 0.3;
  element.count = null;
  element.threads = 'auto';
  element.orientation = 'inward';
  element.flip = true;
  console.log(element.report?.doubts.map(({ code, message, share = 1 }) => [code, message, share]));
  element.addEventListener('progress', ({ detail }) => console.log(detail.stage, detail.overall.toFixed(2)));
  element.addEventListener('load', ({ detail }: CustomEvent<LoadDetail>) => console.log(detail.view satisfies View, detail.report?.outputPoints));
  element.addEventListener('error', ({ detail }) => console.log(detail.error.code));
  element.addEventListener('stream', ({ detail: { points, bytes } }) => console.log(points + bytes));
  element.addEventListener('abort', ({ detail }) => console.log(detail.reason));
  element.addEventListener('click', (event) => event.clientX);
  PointWeaveElement.wasmUrl = 'https://example.org/wasm/';
  PointWeaveElement.workerUrl = new URL('https://example.org/worker.js');
  PointWeaveElement.words = { ...PointWeaveElement.words, cancel: 'Abbrechen' };
  // @ts-expect-error no such view
  element.view = 'solid';
  // @ts-expect-error it is read only
  element.loaded = true;
  return document.querySelector('point-weave')?.toBlob('image/webp', 0.8);
}
