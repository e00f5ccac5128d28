/** A viewer: a canvas, what it shows, and how one moves around that. */
import { Scene } from 'three';
import { contextOf, expectDrawable } from './checks.js';
import { COLORS } from './colors.js';
import { frameOf } from './frame.js';
import { Ground } from './ground.js';
import { MOVES, listenToKeys } from './keyboard.js';
import { NEUTRAL } from './light.js';
import { NEAREST } from './look.js';
import { sharedPainter } from './painter.js';
import { sectionOf } from './section.js';
import { Size } from './size.js';
import { ALWAYS, Stage } from './stage.js';
import { Streaming } from './streaming.js';
import { likelyUp, nearestAxis } from './upright.js';
import { inSight } from './watching.js';

/**
 * @import { Axis, Drawable, Frame, Insets, LayerColors, Model, Mover, Paint, Placed, Section, Split, Viewer, ViewerOptions } from '../viewer.js'
 * @import { Parts } from './glb.js'
 */

/** How much of the depth pass measured values get: colours are to be read. */
const MEASURED_DOME = 0.3;
/** At least this share of the height, and of the width, is the picture's own. */
const FREE = 0.6;
const NO_INSETS = { top: 0, right: 0, bottom: 0, left: 0 };

/** @param {HTMLCanvasElement} canvas @param {ViewerOptions} [options] @returns {Viewer} */
export function createViewer(canvas, options) {
  return new CanvasViewer(canvas, options);
}

/** @param {Drawable | Model} what @returns {what is Model} */
function isModel(what) {
  return typeof what === 'object' && what !== null && 'kind' in what;
}

class CanvasViewer extends Streaming {
  scene = new Scene();
  context;
  #canvas;
  #painter = sharedPainter();
  #stage;
  #size;
  #ground = new Ground();
  /** @type {import('three').Texture | typeof NEUTRAL} */
  #surroundings = /** @type {typeof NEUTRAL} */ (NEUTRAL);
  #exposure = 1;
  /** Of what was shown first: what says which way is up. @type {Pick<Drawable, 'up' | 'seenFromAbove' | 'origin'>} */
  #first = {};
  /** @type {string | Split} */
  #view = 'points';
  /** @type {Axis | [number, number, number] | 'auto'} */
  #up;
  /** @type {Insets} */
  #insets = NO_INSETS;
  #seen = true;
  #awake = false;
  #pointSize = 1;
  /** Who has moved since the last frame. @type {Mover | null} */
  #moved = null;

  /** @param {HTMLCanvasElement} canvas @param {ViewerOptions} [options] */
  constructor(canvas, { interactive = true, keys = true, embedded = true, autoRotate = false, up = 'auto', colors = {}, insets = {} } = {}) {
    const context = contextOf(canvas);
    const stage = new Stage({ ...COLORS, ...colors });
    super(stage, canvas, embedded, (by) => {
      // What turns by itself does not hide that somebody moved it.
      if (by !== 'program' || !this.#moved) this.#moved = by;
      this.ask();
    });
    this.#canvas = canvas;
    this.context = context;
    this.#stage = stage;
    this.scene.add(stage.root, this.#ground.plane);
    this.#size = new Size(canvas, (size) => this.#resize(size));
    this.#up = up;
    this.#insets = { ...NO_INSETS, ...insets };
    this.interactive = interactive;
    this.autoRotate = autoRotate;
    if (keys) {
      if (interactive && !canvas.hasAttribute('tabindex')) canvas.tabIndex = 0;
      /** @type {import('./keyboard.js').Hands} */
      const hands = {
        turn: (right, over) => this.orbit.turn(right, over, 'keys'),
        zoom: (factor) => this.zoomable && this.orbit.zoom(factor, 'keys'),
        home: () => this.orbit.home({ by: 'keys' }),
      };
      listenToKeys(canvas, MOVES, () => (this.interactive && this.box ? hands : undefined));
    }
    this.resume();
  }

  /** Shows a cloud, a mesh or a GLB alone, whole, from the first look. @param {Drawable | Model} what @param {{ frame?: Frame }} [options] */
  show(what, { frame } = {}) {
    const model = isModel(what);
    if (!model) expectDrawable(what);
    this.clear();
    this.lit = false;
    if (model) {
      const { scene, layers, outline, frame: own } = /** @type {Model & Parts} */ (what);
      this.lit = Object.values(layers).flat().some(({ material }) => [material].flat().some((one) => 'roughness' in one));
      this.box = own;
      this.#first = { up: [0, 1, 0] };
      this.settle();
      this.#stage.root.add(scene);
      Object.entries(layers).forEach(([name, objects], i) => this.#stage.add(name, objects, i ? new Float32Array() : outline));
      this.#view = 'mesh' in layers ? 'mesh' : 'points';
      this.#divide();
      this.orbit.frame(outline, this.#standing);
      this.#ground.stale();
    } else {
      this.box = frame ?? null;
      this.set(what.indices ? 'mesh' : 'points', what);
    }
  }

  /** Looks at what begins to stream, from the first look. @param {import('./tiles.js').Tiles} tiles */
  begin({ frame, outline, up, nearest, kind = 'points' }) {
    this.box = frame;
    this.nearest = nearest;
    this.#first = { up };
    this.settle();
    this.orbit.frame(outline, this.#standing);
    this.view = kind;
  }

  /** Replaces a layer, or removes it. The first of all is shown. @param {string} name @param {Drawable | null} what */
  set(name, what) {
    if (!what && !this.box) return;
    if (what) expectDrawable(what);
    const first = this.#stage.layers.size === 0;
    this.box ??= frameOf(/** @type {Drawable} */ (what));
    this.#stage.set(name, what, this.box, () => this.ask());
    this.#ground.stale();
    if (what && first) {
      const { up, seenFromAbove, origin } = what;
      this.#first = { up, seenFromAbove, origin };
      this.settle();
      this.orbit.frame(this.#stage.outline, this.#standing);
      this.view = name;
    } else this.orbit.widen(this.#stage.outline);
    this.ask();
  }

  /** @param {string} name */
  has(name) {
    return this.#stage.layers.has(name);
  }

  get layers() {
    return [...this.#stage.layers.keys()];
  }

  /** @param {string} name */
  size(name) {
    const { objects = [], points: bare = true } = this.#stage.layers.get(name) ?? {};
    let [points, triangles] = [0, 0];
    for (const { geometry } of objects) {
      const vertices = geometry.getAttribute('position');
      points += vertices.count;
      if (!bare) triangles += Math.floor((geometry.index ?? vertices).count / 3);
    }
    return { points, triangles };
  }

  get view() {
    return this.#view;
  }

  set view(view) {
    this.#view = view;
    this.#divide();
    this.ask();
  }

  /** @param {string} name @param {Paint} how */
  paint(name, how) {
    this.#stage.paint(name, how);
    this.ask();
  }

  /** @param {boolean} shown */
  showEdges(shown) {
    this.#stage.showEdges(shown);
    this.ask();
  }

  /** @param {Placed | null} corners the lowest and the highest of each box */
  showBoxes(corners) {
    if (!this.box) return;
    this.#stage.showBoxes(corners, this.box);
    this.ask();
  }

  /** @returns {LayerColors} */
  get colors() {
    return this.#stage.colors;
  }

  /** @param {Partial<LayerColors>} colors */
  set colors(colors) {
    this.#stage.colors = { ...this.#stage.colors, ...colors };
    this.ask();
  }

  /** @returns {Insets} */
  get insets() {
    return this.#insets;
  }

  /** @param {Partial<Insets>} insets */
  set insets(insets) {
    const asked = { ...this.#insets, ...insets };
    if (/** @type {(keyof Insets)[]} */ (Object.keys(asked)).every((side) => this.#insets[side] === asked[side])) return;
    this.#insets = asked;
    this.#reshape();
  }

  get up() {
    return this.#up;
  }

  set up(up) {
    this.#up = up;
    if (!this.box) return;
    this.orbit.stand(this.#standing);
    this.#ground.stale();
    this.orbit.fit();
  }

  get upright() {
    if (this.#up === 'auto') return likelyUp(this.#first, this.frameNow.size);
    return typeof this.#up === 'string' ? this.#up : nearestAxis(this.#up);
  }

  /** What is up now: an axis, or a direction between them. */
  get #standing() {
    const up = this.#up === 'auto' ? this.#first.up : this.#up;
    return Array.isArray(up) && up.filter((x) => Math.abs(x) > 1e-6 * Math.hypot(...up)).length > 1 ? up : this.upright;
  }

  get pointSize() {
    return this.#pointSize;
  }

  set pointSize(scale) {
    this.#pointSize = scale;
    this.ask();
  }

  get section() {
    return sectionOf(this.cut);
  }

  /** @param {Section | null} section */
  set section(section) {
    this.cut = sectionOf(section);
    this.ask();
  }

  /** @returns {[number, number, number] | null} */
  get dimensions() {
    return this.box && [...this.box.size];
  }

  /** @returns {object | typeof NEUTRAL} */
  get surroundings() {
    return this.#surroundings;
  }

  set surroundings(surroundings) {
    if (surroundings === this.#surroundings) return;
    const before = this.#surroundings;
    this.#surroundings = /** @type {import('three').Texture | typeof NEUTRAL} */ (surroundings);
    if (before !== NEUTRAL) this.#painter.drop(before);
    this.ask();
  }

  get exposure() {
    return this.#exposure;
  }

  set exposure(exposure) {
    this.#exposure = exposure;
    this.ask();
  }

  get shadow() {
    return this.#ground.strength;
  }

  set shadow(strength) {
    this.#ground.strength = strength;
    this.ask();
  }

  /** Draws the shadow, where it is not what it was. @param {import('three').WebGLRenderer} renderer */
  readied(renderer) {
    this.#ground.ready(renderer, this.scene, this.#stage);
  }

  /** @param {string} [type] @param {number} [quality] */
  toBlob(type, quality) {
    this.draw();
    return new Promise((/** @type {(blob: Blob | null) => void} */ resolve) => this.#canvas.toBlob(resolve, type, quality));
  }

  /** At once, whether it is seen or not. */
  draw() {
    this.#draw(performance.now());
  }

  clear() {
    this.endStream();
    this.#stage.clear();
    this.#ground.stale();
    this.box = null;
    this.nearest = NEAREST;
    this.context.clearRect(0, 0, this.width, this.height);
    this.ask();
  }

  suspend() {
    this.#awake = false;
    this.#painter.delete(this);
    this.orbit.listen(false);
    this.#size.stop();
    inSight().delete(this.#canvas);
    this.#stage.free();
    this.tiles?.free();
    this.#ground.free();
    if (this.#surroundings !== NEUTRAL) this.#painter.drop(this.#surroundings);
  }

  resume() {
    if (this.#awake) return;
    this.#awake = true;
    this.#painter.add(this);
    this.orbit.listen(true);
    this.#size.follow();
    inSight().add(this.#canvas, (seen) => {
      this.#seen = seen;
      if (seen) this.ask();
    });
  }

  dispose() {
    this.suspend();
    this.clear();
  }

  /** One frame of the painter's loop. @param {number} now */
  frame(now) {
    if (this.#seen) this.#draw(now);
  }

  /** Readies scene and camera for a layer; says how strong its depth pass is. @param {string} name */
  prepare(name) {
    const layer = this.#stage.layers.get(name);
    this.camera.layers.set(layer?.bit ?? ALWAYS);
    this.camera.layers.enable(ALWAYS);
    this.#ground.plane.visible = this.#ground.strength > 0 && layer?.points === false && !layer.streamed;
    if (!layer?.points) return 0;
    const { parallel, distance } = this.orbit;
    const perUnit = (this.camera.projectionMatrix.elements[5] * this.height) / 2;
    let dome = 1;
    for (const { material } of layer.objects) {
      const { uniforms } = /** @type {import('three').ShaderMaterial} */ (material);
      uniforms.pixelsPerUnit.value = parallel ? perUnit * distance : perUnit;
      uniforms.distance.value = distance;
      uniforms.scale.value = this.#pointSize;
      uniforms.smallest.value = 1.5 * this.ratio;
      if (uniforms.measured.value) dome = MEASURED_DOME;
    }
    return dome;
  }

  /** @param {boolean} lost */
  contextChanged(lost) {
    this.#ground.stale();
    this.dispatchEvent(new Event(lost ? 'contextlost' : 'contextrestored'));
  }

  /** @param {number} now */
  #draw(now) {
    this.orbit.update(now);
    this.advance();
    if (this.sides.some(({ layer }) => this.has(layer))) this.#painter.paint(this);
    this.dispatchEvent(new Event('draw'));
    if (!this.#moved) return;
    const by = this.#moved;
    this.#moved = null;
    this.dispatchEvent(new CustomEvent('move', { detail: { by } }));
  }

  ask() {
    this.#painter.ask(this);
  }

  /** @param {import('./size.js').Pixels} size */
  #resize({ width, height, ratio }) {
    if (width === this.width && height === this.height && ratio === this.ratio) return;
    Object.assign(this, { width, height, ratio });
    this.#reshape();
  }

  /** The picture is as large as the free part of the canvas, and centred in it. */
  #reshape() {
    const { width, height, ratio } = this;
    if (!width || !height) return;
    const [left, right] = this.#kept(this.#insets.left, this.#insets.right, width);
    const [top, bottom] = this.#kept(this.#insets.top, this.#insets.bottom, height);
    const [across, free] = [width - left - right, height - top - bottom];
    this.orbit.reshape(() => {
      this.camera.aspect = across / free;
      this.camera.setViewOffset(across, free, -left, -top, width, height);
    });
    this.#divide();
    this.draw();
  }

  /** Insets in device pixels, less where they would take too much. @param {number} before @param {number} after @param {number} whole */
  #kept(before, after, whole) {
    const share = Math.min(this.ratio, ((1 - FREE) * whole) / (before + after || 1));
    return [before * share, after * share];
  }

  /** What is drawn where. */
  #divide() {
    const { width } = this;
    if (typeof this.#view === 'string') {
      this.sides = [{ layer: this.#view, from: 0, to: width }];
      return;
    }
    const { left, right, at } = this.#view;
    const border = Math.round(width * Math.min(1, Math.max(0, at)));
    this.sides = [{ layer: left, from: 0, to: border }, { layer: right, from: border, to: width }];
  }
}
