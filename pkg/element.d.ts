/**
 * `<point-weave>`: importing this defines the element. It needs three.js (an optional peer of the package).
 */
import type { Axis, Pose, StreamState } from './viewer.js';
import type { Doubt, EngineOptions, ErrorCode, Orientation, PointweaveError, ReduceReport, Stage as EngineStage, SurfaceReport } from './types.js';

export type { Axis, Pose, StreamState } from './viewer.js';

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
  /** A GLB is shown as it is, a tileset streams, a scan is computed. */
  kind: 'glb' | 'tiles' | 'scan';
  /** The view that is shown: the one asked for, or of a GLB or a tileset what it holds. */
  view: View;
  points: number;
  triangles: number;
  /** Of the reduced cloud or the mesh; null for points, a GLB and a tileset. */
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
  /** Of a tileset, other tiles are shown or held; once a frame. */
  stream: CustomEvent<StreamState>;
  /** The camera has moved; once a frame. */
  'camera-change': CustomEvent<CameraChangeDetail>;
  /** It could not be shown in the room: there is no Scene Viewer, or no file for Quick Look could be made. */
  'ar-status': CustomEvent<{ status: 'failed' }>;
}

/** In the coordinates and the unit of the file, which glTF says are metres. As text, `0.1m 0.2m 0.3m`. */
export interface Vector {
  x: number;
  y: number;
  z: number;
  toString(): string;
}

export interface CameraChangeDetail {
  /** A person, or the program and what turns by itself. */
  source: 'user-interaction' | 'none';
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
  /** The button that shows it in the room. */
  ar: string;
  cancel: string;
  retry: string;
  /** What opens the message of an error under its title. */
  details: string;
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

  /** A GLB, a tileset (`tileset.json` of 3D Tiles), or a scan of a format that `read` takes. */
  src: string;
  /** What it shows, in words. `alt=""` says that it is decoration, where there are no `controls`. */
  alt: string;
  /** Share of the points to keep, (0, 1]. Default `null`: as many as suit the scan and the device, as `target: 'auto'`. */
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
  /** The same, as model-viewer calls it. */
  cameraControls: boolean;
  /** `'lazy'` (default) begins when at most one viewport away, `'eager'` at once. */
  loading: Loading;
  /** Which axis of the file points up. Default `'auto'`: z of what is wide and flat, else y. */
  up: Up;

  /** What decides which side of a scan's mesh is out, as for `reconstruct`. Default `'auto'`. */
  orientation: Orientation;
  /** Turns a scan's mesh to its other side. */
  flip: boolean;

  /**
   * The following are those of `<model-viewer>`, in its syntax; `''` where they are not given. Where the first look is from: the angle
   * around, the angle from the top, and the distance, such as `30deg 75deg 110%`; at 100 % it reaches to the edges. Each can be `auto`.
   */
  cameraOrbit: string;
  /** What is looked at, such as `0m 0.1m 0m` or `auto auto auto`, in the coordinates of the file. */
  cameraTarget: string;
  /** Vertical, such as `30deg` or `auto`, which is 32. */
  fieldOfView: string;
  /** How far one may turn, come near and go, as `cameraOrbit`. */
  minCameraOrbit: string;
  maxCameraOrbit: string;
  minFieldOfView: string;
  maxFieldOfView: string;
  disableZoom: boolean;
  disablePan: boolean;
  /** Milliseconds that `autoRotate` rests after a hand was on it. Default 3000. */
  autoRotateDelay: number;
  /** The address of an equirectangular picture, `.hdr` or one that the browser reads, or `neutral` (default), a studio. */
  environmentImage: string;
  /** Of a GLB's materials. Default 1. */
  exposure: number;
  /** Of the shadow on the ground under a mesh, 0 (default) to 1. */
  shadowIntensity: number;
  /** Shows a button on devices that can show it in the room: Android's Scene Viewer for a GLB, Quick Look of iPhone and iPad for all. */
  ar: boolean;
  /** Which are taken, the first that there is: `'webxr scene-viewer quick-look'` where it is `''`. There is no WebXR. */
  arModes: string;
  /** Whether a visitor can change its size there (`'auto'`, default). */
  arScale: 'auto' | 'fixed';
  /** Where Scene Viewer puts it. Default `'floor'`. */
  arPlacement: 'floor' | 'wall';
  /** The address of a USDZ file for Quick Look; `''`: one is made of what is shown. */
  iosSrc: string;
  /** `'auto'` (default) takes the poster away when the view is there, `'manual'` when `dismissPoster` says so. */
  reveal: 'auto' | 'manual';
  /** `'auto'` (default) shows how to move it after three seconds, where it has `controls` and nobody has. */
  interactionPrompt: 'auto' | 'none';

  /**
   * Resolves with what `load` tells as soon as the view that is asked for is shown; rejects with what the next `error` tells, and with an
   * `AbortError` where `abort()` was called or the element removed.
   */
  whenLoaded(): Promise<LoadDetail>;
  /** Whether `ar` is set, and this device can show it in the room. */
  readonly canActivateAR: boolean;
  /** What the button does; at a click alone. */
  activateAR(): Promise<void>;
  /** Sends the poster away, and begins to load. */
  dismissPoster(): void;
  /** Puts the poster back. */
  showPoster(): void;
  /** Angles in radians. */
  getCameraOrbit(): { theta: number; phi: number; radius: number; toString(): string };
  getCameraTarget(): Vector;
  /** Degrees. */
  getFieldOfView(): number;
  /** Edge lengths of the box of what is shown; 0 for nothing. */
  getDimensions(): Vector;
  /** The mesh at a place of the viewport, as `clientX` and `clientY` say it: where it is, and the normal of the plane around that. */
  positionAndNormalFromPoint(x: number, y: number): { position: Vector; normal: Vector } | null;
  /** As `toBlob`, as an address. */
  toDataURL(type?: string, quality?: number): string;

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
