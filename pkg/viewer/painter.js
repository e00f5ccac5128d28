/**
 * The one WebGL renderer of a page. Browsers give a page few contexts, so all viewers share this one: it draws a picture in its own
 * hidden canvas, and copies it to the viewer's. What a viewer shows stays while the context is lost.
 */
import { LinearToneMapping, REVISION, WebGLRenderer } from 'three';
import { PointweaveError } from '../engine/errors.js';
import { EyeDome } from './eye-dome.js';
import { Lights } from './light.js';

/**
 * What can be painted.
 * @typedef {object} Picture
 * @property {number} width in device pixels
 * @property {number} height
 * @property {number} ratio device pixels in a CSS pixel
 * @property {Side[]} sides from left to right
 * @property {import('three').Scene} scene
 * @property {import('three').PerspectiveCamera} camera
 * @property {CanvasRenderingContext2D} context where it goes
 * @property {boolean} lit whether anything in it has a material that is lit
 * @property {object | 'neutral'} surroundings what lights it: a texture, or the studio
 * @property {import('three').Plane[]} planes what is behind one of them is not drawn
 * @property {number} exposure of materials that are lit; 1 as it is
 * @property {(renderer: WebGLRenderer) => void} readied what has to be drawn elsewhere before: its shadow
 * @property {(layer: string) => number} prepare readies scene and camera for a layer; how strong its depth pass is, 0 for none
 * @property {(now: number) => void} frame moves on to the next frame, and has it painted
 * @property {(lost: boolean) => void} contextChanged the browser has taken WebGL away, or has given it back
 *
 * A part of the picture's width, and what is drawn there.
 * @typedef {{ layer: string, from: number, to: number }} Side
 */

const LOOK = /** @type {const} */ ({ alpha: true, antialias: true, depth: true, stencil: false, premultipliedAlpha: true });

/** The Khronos group's neutral mapping, which keeps the colours of goods; three.js 0.162 or newer has it, by this number. */
const TONE_MAPPING = Number(REVISION) >= 162 ? /** @type {import('three').ToneMapping} */ (7) : LinearToneMapping;

class Painter {
  #canvas = document.createElement('canvas');
  #renderer;
  #eyeDome = new EyeDome();
  #lights;
  /** All that are in the page. @type {Set<Picture>} */
  #pictures = new Set();
  /** Those that want a new frame. @type {Set<Picture>} */
  #asked = new Set();

  constructor() {
    const context = /** @type {any} */ (this.#canvas.getContext('webgl2', LOOK));
    if (!context) throw new PointweaveError({ code: 'no-webgl', message: 'this browser gives the page no WebGL 2', expected: 'webgl2' });
    this.#renderer = new WebGLRenderer({ ...LOOK, canvas: this.#canvas, context });
    this.#renderer.autoClear = false;
    this.#renderer.setPixelRatio(1);
    this.#renderer.toneMapping = TONE_MAPPING;
    this.#lights = new Lights(this.#renderer);
    this.#clear();
    this.#canvas.addEventListener('webglcontextlost', () => this.#tell(true));
    this.#canvas.addEventListener('webglcontextrestored', () => {
      this.#lights.forget();
      this.#clear();
      this.#tell(false);
    });
  }

  /** The page's own background shows through. A restored context has forgotten that, and every picture. */
  #clear() {
    this.#renderer.setClearColor(0, 0);
    for (const picture of this.#pictures) this.ask(picture);
  }

  /** @param {boolean} lost */
  #tell(lost) {
    for (const picture of this.#pictures) picture.contextChanged(lost);
  }

  /** @param {Picture} picture */
  add(picture) {
    this.#pictures.add(picture);
    this.ask(picture);
  }

  /** @param {Picture} picture */
  delete(picture) {
    this.#pictures.delete(picture);
    this.#asked.delete(picture);
  }

  /** However many things change, the next frame is drawn once. @param {Picture} picture */
  ask(picture) {
    if (!this.#pictures.has(picture)) return;
    if (this.#asked.size === 0) requestAnimationFrame((now) => this.#frame(now));
    this.#asked.add(picture);
  }

  /** @param {number} now */
  #frame(now) {
    const asked = [...this.#asked];
    this.#asked.clear();
    for (const picture of asked) picture.frame(now);
  }

  /** Draws a picture and copies it. A lost context leaves the old one where it is. @param {Picture} picture */
  paint(picture) {
    const { width, height, scene, camera, context } = picture;
    if (!width || !height || this.#renderer.getContext().isContextLost()) return;
    this.#grow(width, height);
    if (picture.lit) scene.environment = this.#lights.of(/** @type {import('three').Texture | 'neutral'} */ (picture.surroundings));
    this.#renderer.toneMappingExposure = picture.exposure;
    picture.readied(this.#renderer);
    this.#renderer.setViewport(0, 0, width, height);
    this.#renderer.setScissorTest(true);
    this.#renderer.clippingPlanes = picture.planes;
    for (const { layer, from, to } of picture.sides) {
      this.#renderer.setScissor(from, 0, to - from, height);
      const dome = picture.prepare(layer);
      if (dome) {
        this.#eyeDome.render(this.#renderer, scene, camera, picture, dome);
      } else {
        this.#renderer.clear();
        this.#renderer.render(scene, camera);
      }
    }
    this.#renderer.clippingPlanes = [];
    context.globalCompositeOperation = 'copy';
    context.drawImage(this.#canvas, 0, this.#canvas.height - height, width, height, 0, 0, width, height);
  }

  /** A picture shows them no more; another may. @param {import('three').Texture} surroundings */
  drop(surroundings) {
    if ([...this.#pictures].every((picture) => picture.surroundings !== surroundings)) this.#lights.drop(surroundings);
  }

  /** @param {number} width @param {number} height */
  #grow(width, height) {
    this.#eyeDome.grow(width, height);
    if (width <= this.#canvas.width && height <= this.#canvas.height) return;
    this.#renderer.setSize(Math.max(width, this.#canvas.width), Math.max(height, this.#canvas.height), false);
  }
}

/** @type {Painter | undefined} */
let painter;

export function sharedPainter() {
  return (painter ??= new Painter());
}
