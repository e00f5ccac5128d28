import { Group, PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { EyeDome } from './eye-dome.js';
import { toFrame } from './frame.js';
import { boxLayer, cloudLayer, disposeLayer, edgeLayer, isPainted, meshLayer, paint } from './layers.js';
import { Orbit } from './orbit.js';

/**
 * @import { Frame } from './frame.js'
 * @import { Drawable, Layer } from './layers.js'
 * @import { Paint } from './look/paints.js'
 * @import { Theme } from './look/theme.js'
 * @typedef {'points' | 'reduced' | 'mesh'} View
 *
 * What the picture shows: one view, or two beside each other that meet at a share of its width.
 * @typedef {{ view: View } | { left: View, right: View, at: number }} Shown
 */

/** Room for what lies over the picture, in CSS pixels. */
const TOP = 72;
const BOTTOM = 76;
/** On narrow screens the tools stand at the right. */
const NARROW = 620;
const TOOLS = 48;

/** Draws layers of the scan, one draw call each, and only when something changed. */
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
  /** @type {Map<View, Layer>} */
  #layers = new Map();
  /** Edges of the mesh's triangles, once they were asked for. @type {import('three').LineSegments | null} */
  #edges = null;
  #edgesShown = false;
  /** Boxes over every view. @type {import('three').LineSegments | null} */
  #boxes = null;
  /** @type {Shown} */
  #shown = { view: 'points' };

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

  /** Starts over with a new scan: forgets the layers of the old one, and fits the view. */
  open(/** @type {Drawable} */ cloud, /** @type {Frame} */ frame, /** @type {'Y' | 'Z'} */ up) {
    for (const view of /** @type {View[]} */ (['points', 'reduced', 'mesh'])) this.set(view, null);
    this.showBoxes(null);
    this.#frame = frame;
    this.set('points', { ...cloud, normals: undefined });
    this.#resize();
    this.#orbit.frame(toFrame(cloud, frame), up);
  }

  /** Replaces one layer, or removes it. */
  set(/** @type {View} */ view, /** @type {Drawable | null} */ source) {
    const old = this.#layers.get(view);
    if (old) {
      if (view === 'mesh') this.#removeEdges();
      this.#root.remove(old);
      disposeLayer(old);
      this.#layers.delete(view);
    }
    if (source && this.#frame) {
      const layer = source.indices ? meshLayer(source, this.#frame) : cloudLayer(source, this.#frame);
      this.#layers.set(view, layer);
      this.#root.add(layer);
      if (view === 'mesh') this.#orbit.include(/** @type {Float32Array} */ (layer.geometry.getAttribute('position').array));
    }
    this.#addEdges();
    this.#dress();
    this.#ask();
  }

  show(/** @type {Shown} */ shown) {
    this.#shown = shown;
    this.#ask();
  }

  /** Colours a layer; without colours it has the theme's. */
  paint(/** @type {View} */ view, /** @type {Paint} */ { colors, legend }) {
    const layer = this.#layers.get(view);
    if (!layer) return;
    paint(layer, colors, Boolean(legend));
    this.#dress();
    this.#ask();
  }

  /** Draws the edges of the mesh's triangles over it, or no longer. */
  showEdges(/** @type {boolean} */ shown) {
    this.#edgesShown = shown;
    this.#addEdges();
    this.#dress();
    this.#ask();
  }

  /** Draws boxes over all views, given by their lowest and highest corners, or no longer. */
  showBoxes(/** @type {import('./frame.js').Placed | null} */ corners) {
    if (this.#boxes) {
      this.#root.remove(this.#boxes);
      disposeLayer(this.#boxes);
    }
    this.#boxes = corners && this.#frame && boxLayer(corners, this.#frame);
    if (this.#boxes) this.#root.add(this.#boxes);
    this.#dress();
    this.#ask();
  }

  setTheme(/** @type {Theme} */ theme) {
    this.#theme = theme;
    this.#dress();
    this.#ask();
  }

  #addEdges() {
    const mesh = this.#layers.get('mesh');
    if (!mesh || !this.#edgesShown || this.#edges) return;
    this.#edges = edgeLayer(mesh);
    this.#root.add(this.#edges);
  }

  #removeEdges() {
    if (!this.#edges) return;
    this.#root.remove(this.#edges);
    disposeLayer(this.#edges);
    this.#edges = null;
  }

  /** Gives every layer without colours of its own the theme's. */
  #dress() {
    if (!this.#theme) return;
    for (const [name, layer] of this.#layers) {
      const material = /** @type {any} */ (layer.material);
      if (name === 'mesh') material.color.set(isPainted(layer) ? '#ffffff' : this.#theme.mesh);
      else {
        material.uniforms.tint.value.set(this.#theme[name]).convertLinearToSRGB();
        material.uniforms.background.value.set(this.#theme.background).convertLinearToSRGB();
      }
    }
    if (this.#edges) /** @type {any} */ (this.#edges.material).color.set(this.#theme.edges);
    if (this.#boxes) /** @type {any} */ (this.#boxes.material).color.set(this.#theme.boxes);
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    if (!width || !height) return;
    const ratio = Math.min(devicePixelRatio, 2);
    this.#renderer.setPixelRatio(ratio);
    this.#renderer.setSize(width, height, false);
    this.#eyeDome.resize(Math.round(width * ratio), Math.round(height * ratio));
    // The picture is as large as the free part of the canvas, and centred in it.
    const free = Math.max(height / 2, height - TOP - BOTTOM);
    const across = matchMedia(`(max-width: ${NARROW}px)`).matches ? width - TOOLS : width;
    this.#camera.aspect = across / free;
    this.#camera.setViewOffset(across, free, 0, (free - height) / 2 + (BOTTOM - TOP) / 2, width, height);
    this.#ask();
  }

  /** However many things change, the next picture is drawn once. */
  #ask() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(this.#frameDue);
  }

  #frameDue = () => {
    this.#asked = false;
    this.#orbit.update();
    if ('view' in this.#shown) return this.#draw(this.#shown.view);
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    const border = Math.round(width * this.#shown.at);
    this.#renderer.setScissorTest(true);
    this.#renderer.setScissor(0, 0, border, height);
    this.#draw(this.#shown.left);
    this.#renderer.setScissor(border, 0, width - border, height);
    this.#draw(this.#shown.right);
    this.#renderer.setScissorTest(false);
  };

  #draw(/** @type {View} */ view) {
    for (const [name, layer] of this.#layers) layer.visible = name === view;
    if (this.#edges) this.#edges.visible = this.#edgesShown && view === 'mesh';
    const shown = this.#layers.get(view);
    if (shown && view !== 'mesh') {
      const { uniforms } = /** @type {import('three').ShaderMaterial} */ (shown.material);
      uniforms.pixelsPerUnit.value = (this.#camera.projectionMatrix.elements[5] * this.#canvas.height) / 2;
      if (this.#orbit.parallel) uniforms.pixelsPerUnit.value *= this.#orbit.distance;
      uniforms.distance.value = this.#orbit.distance;
      uniforms.smallest.value = 1.5 * this.#renderer.getPixelRatio();
      this.#eyeDome.render(this.#renderer, this.#scene, this.#camera);
    } else {
      this.#renderer.clear();
      this.#renderer.render(this.#scene, this.#camera);
    }
  }
}
