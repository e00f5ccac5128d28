/** What of a viewer moves: its camera, by hand, by calls and by itself. */
import { MathUtils, PerspectiveCamera } from 'three';
import { FIELD_OF_VIEW } from './look.js';
import { Orbit } from './orbit.js';

/** @import { FirstLook, Frame, Limits, Mover, Side, Stance } from '../viewer.js' */

export class Moved extends EventTarget {
  camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 10);
  /** Of this class and those that extend it. */
  orbit;
  /** What the picture is fitted to. @type {Frame | null} */
  box = null;
  /** @type {FirstLook} */
  #firstLook = {};
  /** @type {Limits} */
  #limits = {};
  #allowed = { zoom: true, pan: true };

  /**
   * @param {import('three').Object3D} root what stands before the camera
   * @param {HTMLElement} element takes the pointer
   * @param {boolean} embedded
   * @param {(by: Mover) => void} changed
   */
  constructor(root, element, embedded, changed) {
    super();
    this.orbit = new Orbit(this.camera, root, element, embedded, changed);
  }

  get interactive() {
    return this.orbit.enabled;
  }

  set interactive(interactive) {
    this.orbit.enable(interactive);
  }

  get autoRotate() {
    return this.orbit.autoRotate;
  }

  set autoRotate(turns) {
    this.orbit.autoRotate = turns;
  }

  /** Milliseconds. */
  get autoRotateDelay() {
    return this.orbit.rest;
  }

  set autoRotateDelay(rest) {
    this.orbit.rest = rest;
  }

  get zoomable() {
    return this.#allowed.zoom;
  }

  set zoomable(zoom) {
    this.#allowed.zoom = zoom;
    this.orbit.allow(this.#allowed);
  }

  get pannable() {
    return this.#allowed.pan;
  }

  set pannable(pan) {
    this.#allowed.pan = pan;
    this.orbit.allow(this.#allowed);
  }

  get parallel() {
    return this.orbit.parallel;
  }

  set parallel(parallel) {
    this.orbit.parallel = parallel;
  }

  get pose() {
    return this.orbit.pose;
  }

  get firstLook() {
    return this.#firstLook;
  }

  /** Goes there, too. @param {FirstLook} look */
  set firstLook(look) {
    this.#firstLook = look;
    this.settle();
    if (this.box) this.orbit.home();
  }

  get limits() {
    return this.#limits;
  }

  set limits(limits) {
    this.#limits = limits;
    this.settle();
    if (this.box) this.orbit.turn(0, 0, 'program');
  }

  /** @returns {Stance} */
  get stance() {
    const { theta, phi, radius, target } = this.orbit.stance;
    const { center, diagonal } = this.box ?? { center: [0, 0, 0], diagonal: 1 };
    return {
      azimuth: MathUtils.radToDeg(theta),
      polar: MathUtils.radToDeg(phi),
      distance: diagonal * radius,
      target: /** @type {[number, number, number]} */ (target.toArray().map((x, axis) => center[axis] + diagonal * x)),
      fieldOfView: this.camera.fov,
    };
  }

  /** @param {number} right @param {number} over radians */
  turn(right, over) {
    this.orbit.turn(right, over, 'program');
  }

  /** @param {number} factor */
  zoom(factor) {
    this.orbit.zoom(factor, 'program');
  }

  home() {
    this.orbit.home();
  }

  fit() {
    this.orbit.fit();
  }

  /** @param {Side} side */
  lookFrom(side) {
    this.orbit.lookFrom(side);
  }

  /** Puts what was asked for in terms of what is shown. */
  settle() {
    this.orbit.settle(this.#firstLook, this.#limits, this.box);
  }
}
