/** What of a viewer says where things are: what lies under a place of the picture, and where in it something is. */
import { Matrix4, Vector3 } from 'three';
import { Moved } from './moved.js';
import { pointAt, triangleAt } from './pick.js';
import { planeOf } from './section.js';

/** @import { Mover, Section } from '../viewer.js' */
/** @import { Stage } from './stage.js' */

/** A point is meant by who comes this near, in CSS pixels. */
const NEAR = 12;

export class Aimed extends Moved {
  width = 0;
  height = 0;
  ratio = 1;
  /** @type {import('./painter.js').Side[]} */
  sides = [];
  /** What is before it is not drawn. @type {Section | null} */
  cut = null;
  #stage;

  /**
   * @param {Stage} stage
   * @param {HTMLElement} element takes the pointer
   * @param {boolean} embedded
   * @param {(by: Mover) => void} changed
   */
  constructor(stage, element, embedded, changed) {
    super(stage.root, element, embedded, changed);
    this.#stage = stage;
  }

  /** Planes before the camera, in front of which nothing is drawn. */
  get planes() {
    return this.cut ? [planeOf(this.cut, this.frameNow, this.#stage.root.quaternion)] : [];
  }

  /** @param {number} x @param {number} y */
  pick(x, y) {
    const { side, layer } = this.#under(x);
    if (!side || !layer) return null;
    const { width, height, ratio } = this;
    const found = triangleAt(layer, this.camera, this.planes, (2 * x * ratio) / width - 1, 1 - (2 * y * ratio) / height);
    if (!found) return null;
    const { triangle, normal, point } = found;
    const direction = normal.applyQuaternion(this.#stage.root.quaternion.clone().invert());
    return { layer: side.layer, triangle, normal: direction.toArray(), position: this.unplaced(point) };
  }

  /** @param {number} x @param {number} y @param {number} [reach] */
  pickPoint(x, y, reach = NEAR) {
    const { side, layer } = this.#under(x);
    if (!side || !layer) return null;
    const { width, height, ratio } = this;
    const found = pointAt(layer, this.camera, this.planes, { x: x * ratio, y: y * ratio, width, height, reach: reach * ratio });
    return found && { layer: side.layer, index: found.index, position: this.unplaced(found.point) };
  }

  /** @param {[number, number, number]} position */
  pivot(position) {
    this.orbit.pivot(this.#placed(position), 'program');
  }

  /** @param {[number, number, number]} position @param {[number, number, number]} [normal] */
  project(position, normal) {
    const { root } = this.#stage;
    this.camera.updateMatrixWorld();
    const at = this.#placed(position);
    const facing = normal && new Vector3(...normal).applyQuaternion(root.quaternion).dot(this.camera.position.clone().sub(at)) > 0;
    const { x, y, z } = at.project(this.camera);
    const { width, height, ratio } = this;
    return { x: ((1 + x) * width) / 2 / ratio, y: ((1 - y) * height) / 2 / ratio, visible: Math.abs(z) <= 1 && facing !== false };
  }

  /** @param {[number, number, number]} [origin] */
  sight([x, y, z] = [0, 0, 0]) {
    const { center, diagonal } = this.frameNow;
    this.#ready();
    const { projectionMatrix, matrixWorldInverse } = this.camera;
    const placed = new Matrix4().makeScale(1 / diagonal, 1 / diagonal, 1 / diagonal)
      .multiply(new Matrix4().makeTranslation(x - center[0], y - center[1], z - center[2]));
    return new Matrix4().multiplyMatrices(projectionMatrix, matrixWorldInverse).multiply(this.#stage.root.matrixWorld).multiply(placed).toArray();
  }

  /** Where a position of the data is before the camera. @param {[number, number, number]} position */
  #placed(position) {
    const { center, diagonal } = this.frameNow;
    return new Vector3(...position).sub(new Vector3(...center)).divideScalar(diagonal).applyQuaternion(this.#stage.root.quaternion);
  }

  /** What is drawn at this distance from the left, in CSS pixels. @param {number} x */
  #under(x) {
    const side = this.sides.find(({ from, to }) => x * this.ratio >= from && x * this.ratio < to);
    this.#ready();
    return { side, layer: side && this.#stage.layers.get(side.layer) };
  }

  /** The camera stands where the next picture is seen from. */
  #ready() {
    this.orbit.update(performance.now());
    this.camera.updateMatrixWorld();
  }
}
