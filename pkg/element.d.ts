/**
 * `<point-weave>`: importing this defines the element. It needs three.js (an optional peer of the package).
 */
import type { Axis, Pose } from './viewer.js';
import type { Doubt, EngineOptions, ErrorCode, Orientation, PointweaveError, ReduceReport, Stage as EngineStage, SurfaceReport } from './types.js';

export type { Axis, Pose } from './viewer.js';

export type View = 'points' | 'reduced' | 'mesh';
export type Loading = 'lazy' | 'eager';
export type Up = 'auto' | Axis;
/** `'fetch'` and `'read'`, then those of the engine. */
export type Stage = 'fetch' | 'read' | EngineStage;

export interface ProgressDetail {
  src: string;
  stage: Stage;
  /** Share of the whole that is done; never decreases and ends at 1. */
  overall: number;
}

export interface LoadDetail {
  src: string;
  /** A GLB is shown as it is, a scan is computed. */
  kind: 'glb' | 'scan';
  /** The view that is shown: the one asked for, or of a GLB what it holds. */
  view: View;
  points: number;
  triangles: number;
  /** Of the reduced cloud or the mesh; null for points and for a GLB. */
  report: ReduceReport | SurfaceReport | null;
}

export interface ErrorDetail {
  src: string;
  error: PointweaveError;
}

/** Another `src`, another `ratio`, `count`, `orientation` or `flip`, the element was removed, or `abort()` was called. */
export type AbortReason = 'src' | 'target' | 'removed' | 'called';

export interface AbortDetail {
  src: string;
  reason: AbortReason;
}

/** None of them bubbles. */
export interface PointWeaveEventMap {
  progress: CustomEvent<ProgressDetail>;
  /** The view asked for is shown, after `src`, `ratio`, `count`, `orientation`, `flip` or `view` has asked for work. */
  load: CustomEvent<LoadDetail>;
  error: CustomEvent<ErrorDetail>;
  /** The job under way was stopped; nothing of it will be shown. */
  abort: CustomEvent<AbortDetail>;
}

/** Every sentence that people see or hear. */
export interface Words {
  /** The name of what has no `alt`. */
  untitled: string;
  /** How to use the keyboard. */
  keys: string;
  views: Record<View, string>;
  viewsLabel: string;
  reset: string;
  pause: string;
  play: string;
  fullscreen: string;
  cancel: string;
  retry: string;
  stopped: string;
  stages: Record<Stage, string>;
  /** Titles, by the error's code; `other` for those that are not there. */
  errors: Partial<Record<ErrorCode, string>> & { other: string };
  progress: (stage: string, percent: number) => string;
  shown: (what: { view: View; points: number; triangles: number }) => string;
  /** What may be wrong with what is shown: the title of the picture. */
  doubt: (doubt: Doubt) => string;
  pose: (pose: Pose) => string;
}

export class PointWeaveElement extends HTMLElement {
  /** What people see and hear; assign other words, before elements are made, for another language. */
  static words: Words;
  /** As that of `createEngine`, for wasm files that are elsewhere. */
  static wasmUrl: EngineOptions['wasmUrl'];
  /** As that of `createEngine`, where the worker's script is elsewhere. */
  static workerUrl: EngineOptions['workerUrl'];

  /** A GLB, or a scan of a format that `read` takes. */
  src: string;
  /** What it shows, in words. `alt=""` says that it is decoration, where there are no `controls`. */
  alt: string;
  /** Share of the points to keep, (0, 1]. Default `null`: the package's, 1/3. */
  ratio: number | null;
  /** Points to keep, at least 1; goes before `ratio`. Default `null`. */
  count: number | null;
  /** Default `'mesh'`. Of a GLB, what it holds is shown. */
  view: View;
  /** An image to show until the view is there. */
  poster: string;
  /** Of the engine, 1 to 64 or `'auto'` (default); elements of the same number share one. */
  threads: number | 'auto';
  /** Turns slowly, unless the person prefers less motion. */
  autoRotate: boolean;
  /** Pointer, keyboard and toolbar. Without, it is a picture. */
  controls: boolean;
  /** `'lazy'` (default) begins when at most one viewport away, `'eager'` at once. */
  loading: Loading;
  /** Which axis of the file points up. Default `'auto'`: z of what is wide and flat, else y. */
  up: Up;

  /** What decides which side of a scan's mesh is out, as for `reconstruct`. Default `'auto'`. */
  orientation: Orientation;
  /** Turns a scan's mesh to its other side. */
  flip: boolean;

  /** Whether the view that is asked for is shown. */
  readonly loaded: boolean;
  /** Of the reduced cloud or the mesh that is shown, with what may be wrong with it: `report.doubts`; null for points and for a GLB. */
  readonly report: LoadDetail['report'];
  /** Stops the job under way, if there is one. */
  abort(): void;
  /** Fetches `src` and computes everything once more. */
  reload(): void;
  /** Back to the first look. */
  resetCamera(): void;
  /** The picture as it is shown, without background: to make a poster of. */
  toBlob(type?: string, quality?: number): Promise<Blob | null>;

  addEventListener<Type extends keyof PointWeaveEventMap>(
    type: Type, listener: (this: PointWeaveElement, event: PointWeaveEventMap[Type]) => unknown, options?: boolean | AddEventListenerOptions): void;
  addEventListener<Type extends keyof HTMLElementEventMap>(
    type: Type, listener: (this: PointWeaveElement, event: HTMLElementEventMap[Type]) => unknown, options?: boolean | AddEventListenerOptions): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}

declare global {
  interface HTMLElementTagNameMap {
    'point-weave': PointWeaveElement;
  }
}
