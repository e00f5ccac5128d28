/**
 * The picture of one element: what it has to show, how one moves around it, and the canvas it is painted to. Everything that
 * needs three.js is reached from here, and this file is only loaded when the first element nears the viewport.
 */
import { Group, PerspectiveCamera, SRGBColorSpace, Scene } from 'three';
import { frameOf, toFrame } from './frame.js';
import { placedPositions, readGlb } from './glb.js';
import { cloudLayer, meshLayer } from './layers.js';
import { Orbit } from './orbit.js';
import { sharedPainter } from './painter.js';

/** @import { Colors } from './colors.js' */
/** @import { Frame } from './frame.js' */
/** @import { Drawable } from './layers.js' */
/** @import { Up, View } from '../element.js' */

/** Each view has a layer of three.js, which the camera sees or not; the objects of a GLB stay in the tree that they have. */
const LAYERS = { points: 1, reduced: 2, mesh: 3 };
/** Room for the toolbar, in CSS pixels. */
const TOOLBAR = 64;
/** Enough to know how large something looks. */
const OUTLINE = 4096;

export class Picture {
  width = 0;
  height = 0;
  ratio = 1;
  scene = new Scene();
  camera = new PerspectiveCamera(32, 1, 0.01, 10);
  context;
  #canvas;
  #root = new Group();
  #painter = sharedPainter();
  #orbit;
  /** What can be shown, by view. @type {Map<View, import('three').Object3D[]>} */
  #layers = new Map();
  /** @type {Frame | null} */
  #frame = null;
  /** @type {View} */
  #shown = 'mesh';
  /** @type {Up} */
  #up = 'auto';
  #seen = false;
  #inset = 0;
  /** @type {Colors | null} */
  #colors = null;

  /** @param {HTMLCanvasElement} canvas throws where there is no WebGL 2 */
  constructor(canvas) {
    this.#canvas = canvas;
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
    this.scene.add(this.#root);
    this.#orbit = new Orbit(this.camera, this.#root, canvas, () => this.#painter.ask(this));
  }

  get orbit() {
    return this.#orbit;
  }

  get dome() {
    return this.#shown !== 'mesh';
  }

  /** In the page: drawn when something changes. */
  attach() {
    this.#painter.add(this);
    this.#orbit.listen(true);
  }

  /** Out of the page: nothing of it stays on the GPU, and nothing listens. It can come back. */
  detach() {
    this.#painter.delete(this);
    this.#orbit.listen(false);
    for (const objects of this.#layers.values()) objects.forEach(free);
  }

  /** Forgets everything that was shown. */
  clear() {
    for (const view of [...this.#layers.keys()]) this.#remove(view);
    this.#root.clear();
    this.#frame = null;
    this.context.clearRect(0, 0, this.width, this.height);
  }

  /** Starts with the points of a scan. @param {Drawable} cloud */
  openCloud(cloud) {
    this.clear();
    this.#frame = frameOf(cloud);
    this.#add('points', [cloudLayer(cloud, this.#frame, 'none')]);
    this.#orbit.frame(thinned(toFrame(cloud, this.#frame)), this.#upright());
  }

  /**
   * Starts with a GLB.
   * @param {Uint8Array<ArrayBuffer>} bytes
   * @param {AbortSignal} signal
   */
  async openGlb(bytes, signal) {
    const { scene, points, meshes } = await readGlb(bytes);
    if (signal.aborted) {
      [...points, ...meshes].forEach(free);
      throw signal.reason;
    }
    this.clear();
    this.#frame = { center: [0, 0, 0], size: [1, 1, 1], diagonal: 1 };
    this.#root.add(scene);
    if (points.length) this.#add('points', points);
    if (meshes.length) this.#add('mesh', meshes);
    const objects = [...points, ...meshes];
    this.#orbit.frame(joined(objects.map((object) => placedPositions(object, OUTLINE / objects.length))), this.#upright());
  }

  /**
   * Adds what was computed.
   * @param {Drawable} cloud reduced; its normals point outwards when it comes with a mesh
   * @param {Drawable} [mesh]
   */
  addComputed(cloud, mesh) {
    const frame = /** @type {Frame} */ (this.#frame);
    this.forgetComputed();
    this.#add('reduced', [cloudLayer(cloud, frame, mesh ? 'oriented' : 'unoriented')]);
    if (!mesh) return;
    this.#add('mesh', [meshLayer(mesh, frame)]);
    this.#orbit.widen(thinned(toFrame(mesh, frame))); // a surface may reach further than its points
  }

  /** What was computed is no longer so. */
  forgetComputed() {
    this.#remove('reduced');
    this.#remove('mesh');
  }

  /** @param {View} view */
  has(view) {
    return this.#layers.has(view);
  }

  get views() {
    return [...this.#layers.keys()];
  }

  /** @param {View} view */
  show(view) {
    this.#shown = view;
    this.camera.layers.set(LAYERS[view]);
    this.#painter.ask(this);
  }

  /** Points and triangles of a view. @param {View} view */
  size(view) {
    let points = 0;
    let triangles = 0;
    for (const object of this.#layers.get(view) ?? []) {
      const { geometry } = /** @type {import('three').Mesh} */ (object);
      points += geometry.getAttribute('position').count;
      if (view === 'mesh') triangles += Math.floor((geometry.index ?? geometry.getAttribute('position')).count / 3);
    }
    return { points, triangles };
  }

  /** @param {Up} up */
  stand(up) {
    this.#up = up;
    if (!this.#frame) return;
    this.#orbit.stand(this.#upright());
    this.#orbit.home({ animated: false });
  }

  /** @param {Colors} colors */
  paintIn(colors) {
    this.#colors = colors;
    for (const [view, objects] of this.#layers) objects.forEach((object) => this.#tint(view, object));
    this.#painter.ask(this);
  }

  /** Whether any of it is in the viewport: what is not is not drawn. @param {boolean} seen */
  see(seen) {
    this.#seen = seen;
    if (seen) this.#painter.ask(this);
  }

  /**
   * @param {{ width: number, height: number, ratio: number }} size in device pixels
   * @param {boolean} toolbar whether the lower edge is taken
   */
  resize({ width, height, ratio }, toolbar) {
    const inset = toolbar ? Math.min(TOOLBAR * ratio, height / 2.5) : 0;
    if (width === this.width && height === this.height && inset === this.#inset) return;
    this.#inset = inset;
    if (width !== this.width || height !== this.height) {
      this.#canvas.width = width;
      this.#canvas.height = height;
      Object.assign(this, { width, height, ratio });
    }
    if (!width || !height) return;
    this.#orbit.keepFitted(() => {
      const free = height - inset;
      this.camera.aspect = width / free;
      this.camera.setViewOffset(width, free, 0, 0, width, height);
    });
    this.paint();
  }

  /** One frame of the painter's loop. @param {number} now */
  frame(now) {
    if (this.#seen) this.#draw(now);
  }

  /** At once, whether it is seen or not. */
  paint() {
    this.#draw(performance.now());
  }

  /** @param {number} now */
  #draw(now) {
    this.#orbit.update(now);
    if (!this.#layers.has(this.#shown)) return;
    const perUnit = (this.camera.projectionMatrix.elements[5] * this.height) / 2;
    for (const object of this.dome ? /** @type {any[]} */ (this.#layers.get(this.#shown)) : []) {
      object.material.uniforms.pixelsPerUnit.value = perUnit;
      object.material.uniforms.smallest.value = 1.5 * this.ratio;
    }
    this.#painter.paint(this);
  }

  /** Land and rooms are wide and flat with z up; objects come with y up more often. */
  #upright() {
    if (this.#up !== 'auto') return this.#up;
    const [x, y, z] = this.#frame?.size ?? [1, 1, 1];
    return z < 0.25 * Math.min(x, y) ? 'z' : 'y';
  }

  /** @param {View} view @param {import('three').Object3D[]} objects */
  #add(view, objects) {
    this.#layers.set(view, objects);
    for (const object of objects) {
      object.layers.set(LAYERS[view]);
      if (!object.parent) this.#root.add(object);
      this.#tint(view, object);
    }
  }

  /** @param {View} view */
  #remove(view) {
    for (const object of this.#layers.get(view) ?? []) {
      object.removeFromParent();
      free(object);
    }
    this.#layers.delete(view);
  }

  /** What has no colours of its own gets the theme's. @param {View} view @param {any} object */
  #tint(view, object) {
    if (!this.#colors) return;
    const { uniforms } = object.material;
    if (uniforms) uniforms.tint.value.setRGB(...this.#colors[view]);
    else if (object.userData.themed) object.material.color.setRGB(...this.#colors[view], SRGBColorSpace);
  }
}

/** What an object holds on the GPU. three.js makes it anew should the object be drawn again. @param {import('three').Object3D} object */
function free(object) {
  const { geometry, material } = /** @type {import('three').Mesh<import('three').BufferGeometry, import('three').MeshMatcapMaterial>} */ (object);
  geometry.dispose();
  material.map?.dispose();
  material.dispose();
}

/** @param {Float32Array} positions */
function thinned(positions) {
  const count = positions.length / 3;
  const step = Math.max(1, Math.ceil(count / OUTLINE));
  const picked = [];
  for (let i = 0; i < count; i += step) picked.push(...positions.subarray(3 * i, 3 * i + 3));
  return Float32Array.from(picked);
}

/** @param {Float32Array[]} parts */
function joined(parts) {
  const out = new Float32Array(parts.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const part of parts) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}
