import { Group, PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { toFrame } from './frame.js';
import { cloudLayer, disposeLayer, meshLayer } from './layers.js';
import { EyeDome } from './eye-dome.js';
import { Orbit } from './orbit.js';

/**
 * @import { Frame } from './frame.js'
 * @import { Drawable } from './layers.js'
 * @import { Theme } from './theme.js'
 * @typedef {'points' | 'reduced' | 'mesh'} View
 */

/** Room for what lies over the picture, in CSS pixels. */
const TOP = 72;
const BOTTOM = 76;

/** Draws one layer of the scan at a time, and only when something changed. */
export class Viewer {
  #canvas;
  #renderer;
  #scene = new Scene();
  #root = new Group();
  #camera = new PerspectiveCamera(32, 1, 0.01, 10);
  #eyeDome = new EyeDome();
  #orbit;
  #asked = false;
  /** @type {Frame | null} */
  #frame = null;
  /** @type {Theme | null} */
  #theme = null;
  /** @type {Map<View, import('three').Points | import('three').Mesh>} */
  #layers = new Map();
  /** @type {View} */
  #view = 'points';

  /** @param {HTMLCanvasElement} canvas  throws where there is no WebGL 2 */
  constructor(canvas) {
    this.#canvas = canvas;
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.#renderer.autoClear = false;
    this.#scene.add(this.#root);
    this.#orbit = new Orbit(this.#camera, this.#root, canvas, () => this.#ask());
    new ResizeObserver(() => this.#resize()).observe(canvas);
    canvas.addEventListener('webglcontextrestored', () => this.#clear());
    this.#clear();
  }

  /** The page's own background shows through. A restored context has forgotten that, so it is said again. */
  #clear() {
    this.#renderer.setClearColor(0, 0);
    this.#ask();
  }

  get orbit() {
    return this.#orbit;
  }

  /** Starts over with a new scan: forgets the layers of the old one, shows the points and fits the view. */
  open(/** @type {Drawable} */ cloud, /** @type {Frame} */ frame) {
    for (const view of /** @type {View[]} */ (['points', 'reduced', 'mesh'])) this.set(view, null);
    this.#frame = frame;
    this.set('points', { ...cloud, normals: undefined });
    this.#resize();
    this.#orbit.frame(toFrame(cloud, frame), likelyUp(frame));
  }

  /** Replaces one layer, or removes it. */
  set(/** @type {View} */ view, /** @type {Drawable | null} */ source) {
    const old = this.#layers.get(view);
    if (old) {
      this.#root.remove(old);
      disposeLayer(old);
      this.#layers.delete(view);
    }
    if (source && this.#frame) {
      const layer = source.indices ? meshLayer(source, this.#frame) : cloudLayer(source, this.#frame);
      this.#layers.set(view, layer);
      this.#root.add(layer);
      this.#dress();
    }
    this.show(this.#view);
  }

  show(/** @type {View} */ view) {
    this.#view = view;
    for (const [name, layer] of this.#layers) layer.visible = name === view;
    this.#ask();
  }

  setTheme(/** @type {Theme} */ theme) {
    this.#theme = theme;
    this.#dress();
    this.#ask();
  }

  /** Gives every layer without colours of its own the theme's. */
  #dress() {
    if (!this.#theme) return;
    for (const [name, layer] of this.#layers) {
      const colored = layer.geometry.hasAttribute('color');
      const material = /** @type {any} */ (layer.material);
      if (name === 'mesh') material.color.set(colored ? '#ffffff' : this.#theme.mesh);
      else {
        material.uniforms.tint.value.set(this.#theme[name]).convertLinearToSRGB();
        material.uniforms.background.value.set(this.#theme.background).convertLinearToSRGB();
      }
    }
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    if (!width || !height) return;
    const ratio = Math.min(devicePixelRatio, 2);
    this.#renderer.setPixelRatio(ratio);
    this.#renderer.setSize(width, height, false);
    this.#eyeDome.resize(Math.round(width * ratio), Math.round(height * ratio));
    // The picture is as high as the free part of the canvas, and centred in it.
    const free = Math.max(height / 2, height - TOP - BOTTOM);
    this.#camera.aspect = width / free;
    this.#camera.setViewOffset(width, free, 0, (free - height) / 2 + (BOTTOM - TOP) / 2, width, height);
    this.#ask();
  }

  /** However many things change, the next picture is drawn once. */
  #ask() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => {
      this.#asked = false;
      this.#draw();
    });
  }

  #draw() {
    this.#orbit.update();
    const shown = this.#layers.get(this.#view);
    if (shown && this.#view !== 'mesh') {
      const { uniforms } = /** @type {import('three').ShaderMaterial} */ (shown.material);
      const ratio = this.#renderer.getPixelRatio();
      const perUnit = (this.#camera.projectionMatrix.elements[5] * this.#canvas.height) / 2;
      uniforms.pixelsPerUnit.value = perUnit;
      uniforms.smallest.value = 1.5 * ratio;
      this.#eyeDome.render(this.#renderer, this.#scene, this.#camera);
    } else {
      this.#renderer.clear();
      this.#renderer.render(this.#scene, this.#camera);
    }
  }
}

/** Land and rooms are wide and flat with z up; objects come with y up more often. */
function likelyUp(/** @type {Frame} */ { size: [x, y, z] }) {
  return z < 0.25 * Math.min(x, y) ? 'Z' : 'Y';
}
