/** What stands before the camera: layers, the edges of their triangles, and boxes. */
import { Group } from 'three';
import { rgb } from './colors.js';
import { joined, thinned } from './frame.js';
import { boxesOf, edgesOf, free, layerOf, paint, tint } from './layers.js';

/**
 * @import { LineSegments, Mesh, Object3D, Points } from 'three'
 * @import { Drawable, Frame, LayerColors, Paint, Placed } from '../viewer.js'
 *
 * What belongs together. Each layer has a bit of three.js, which the camera sees or not: the objects of a GLB stay in the tree that
 * they have.
 * @typedef {{ bit: number, objects: (Points | Mesh)[], points: boolean, outline: Float32Array, streamed?: true }} Layer `streamed`: its
 *   objects come and go with the camera, and are freed by who brings them
 */

/** The bit of what is seen with every layer. */
export const ALWAYS = 0;
/** three.js has 32 bits. */
const BITS = Array.from({ length: 31 }, (_, i) => i + 1);

export class Stage {
  root = new Group();
  /** @type {Map<string, Layer>} */
  layers = new Map();
  /** Of the triangles of objects, once they were asked for. @type {Map<Object3D, LineSegments>} */
  #edges = new Map();
  #edgesShown = false;
  /** @type {LineSegments | null} */
  #boxes = null;
  #colors;

  /** @param {LayerColors} colors */
  constructor(colors) {
    this.#colors = colors;
  }

  get colors() {
    return this.#colors;
  }

  /** @param {LayerColors} colors */
  set colors(colors) {
    this.#colors = colors;
    this.#tint();
  }

  /** A few points of all. */
  get outline() {
    return joined([...this.layers.values()].map(({ outline }) => outline));
  }

  /** Replaces a layer, or removes it. @param {string} name @param {Drawable | null} what @param {Frame} frame @param {() => void} changed */
  set(name, what, frame, changed) {
    for (const object of this.layers.get(name)?.objects ?? []) this.#remove(object);
    this.layers.delete(name);
    if (!what) return;
    const object = layerOf(what, frame, changed);
    this.add(name, [object], thinned(/** @type {Float32Array} */ (object.geometry.getAttribute('position').array)));
    this.root.add(object);
  }

  /** Makes a layer of objects. @param {string} name @param {(Points | Mesh)[]} objects @param {Float32Array} outline */
  add(name, objects, outline) {
    const bit = this.#freeBit();
    this.layers.set(name, { bit, objects, points: objects[0].type === 'Points', outline });
    for (const object of objects) {
      object.layers.set(bit);
      this.#addEdges(object);
    }
    this.#tint();
  }

  /** Makes a layer of what streams. @param {string} name @param {Float32Array} outline */
  open(name, outline) {
    this.layers.set(name, { bit: this.#freeBit(), objects: [], points: name === 'points', outline, streamed: true });
  }

  /** An object of what streams is seen from now on. @param {string} name @param {Points | Mesh} object */
  enter(name, object) {
    const layer = /** @type {Layer} */ (this.layers.get(name));
    layer.objects.push(object);
    object.layers.set(layer.bit);
    this.#tint();
  }

  /** It is not seen any more. @param {string} name @param {Points | Mesh} object */
  leave(name, object) {
    const objects = this.layers.get(name)?.objects ?? [];
    const at = objects.indexOf(object);
    if (at >= 0) objects.splice(at, 1);
  }

  clear() {
    for (const { objects } of this.layers.values()) for (const object of objects) this.#remove(object);
    this.layers.clear();
    this.#removeBoxes();
    this.root.clear();
  }

  /** Nothing stays on the GPU. It comes back with the next frame. */
  free() {
    for (const { objects, streamed } of this.layers.values()) if (!streamed) objects.forEach(free);
    this.#edges.forEach(free);
    if (this.#boxes) free(this.#boxes);
  }

  /** @param {string} name @param {Paint} how */
  paint(name, { colors, legend }) {
    const { objects = [], streamed } = this.layers.get(name) ?? {};
    const painted = streamed ? [] : objects.filter(({ userData }) => 'themed' in userData);
    for (const object of painted) paint(object, colors, Boolean(legend));
    this.#tint();
  }

  /** @param {boolean} shown */
  showEdges(shown) {
    this.#edgesShown = shown;
    for (const { objects, streamed } of this.layers.values()) if (!streamed) for (const object of objects) this.#addEdges(object);
    for (const edges of this.#edges.values()) edges.visible = shown;
    this.#tint();
  }

  /** @param {Placed | null} corners @param {Frame} frame */
  showBoxes(corners, frame) {
    this.#removeBoxes();
    if (!corners) return;
    this.#boxes = boxesOf(corners, frame);
    this.root.add(this.#boxes);
    this.#tint();
  }

  #freeBit() {
    const taken = [...this.layers.values()].map(({ bit }) => bit);
    const bit = BITS.find((one) => !taken.includes(one));
    if (!bit) throw new RangeError(`a viewer has at most ${BITS.length} layers`);
    return bit;
  }

  /** Over its object, and seen with it. @param {Points | Mesh} object */
  #addEdges(object) {
    if (!this.#edgesShown || this.#edges.has(object) || !object.geometry.index) return;
    const edges = edgesOf(/** @type {Mesh} */ (object));
    edges.layers.mask = object.layers.mask;
    object.add(edges);
    this.#edges.set(object, edges);
  }

  #removeBoxes() {
    if (this.#boxes) this.#remove(this.#boxes);
    this.#boxes = null;
  }

  /** @param {Object3D} object */
  #remove(object) {
    const edges = this.#edges.get(object);
    if (edges) free(edges);
    this.#edges.delete(object);
    object.removeFromParent();
    free(object);
  }

  /** What has no colours of its own gets ours. */
  #tint() {
    const { mesh, points, edges, boxes, plain = '#ffffff' } = this.#colors;
    const own = /** @type {Record<string, string>} */ (/** @type {unknown} */ (this.#colors));
    for (const [name, layer] of this.layers) {
      const color = rgb(own[name] ?? (layer.points ? points : mesh));
      for (const object of layer.objects) tint(object, color, rgb(plain));
    }
    this.#edges.forEach((object) => tint(object, rgb(edges)));
    if (this.#boxes) tint(this.#boxes, rgb(boxes));
  }
}
