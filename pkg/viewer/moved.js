/** What of a viewer moves: its camera, by hand, by calls and by itself. */
import { MathUtils, PerspectiveCamera } from 'three';
import { ITSELF } from './frame.js';
import { FIELD_OF_VIEW, NEAREST } from './look.js';
import { Orbit } from './orbit.js';

/** @import { FirstLook, Frame, Limits, Mover, Side, Stance } from '../viewer.js' */

export class Moved extends EventTarget {
  camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 10);
  /** Of this class and those that extend it. */
  orbit;
  /** What the picture is fitted to. @type {Frame | null} */
  box = null;
  /** How near one may come, in the frame. */
  nearest = NEAREST;
  #root;
  /** @type {FirstLook} */
  #firstLook = {};
  /** @type {Limits} */
  #limits = {};

  /**
   * @param {import('three').Object3D} root what stands before the camera
   * @param {HTMLElement} element takes the pointer
   * @param {boolean} embedded
   * @param {(by: Mover) => void} changed
   */
  constructor(root, element, embedded, changed) {
    super();
    this.#root = root;
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
    return this.orbit.gestures.zooms;
  }

  set zoomable(zoom) {
    this.orbit.gestures.zooms = zoom;
  }

  get pannable() {
    return this.orbit.gestures.pans;
  }

  set pannable(pan) {
    this.orbit.gestures.pans = pan;
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
  }

  /** @returns {Stance} */
  get stance() {
    const { theta, phi, radius, target } = this.orbit.stance;
    return {
      azimuth: MathUtils.radToDeg(theta),
      polar: MathUtils.radToDeg(phi),
      distance: this.frameNow.diagonal * radius,
      target: this.unplaced(target),
      fieldOfView: this.camera.fov,
    };
  }

  /** That of the data; without any, the picture's own. */
  get frameNow() {
    return this.box ?? ITSELF;
  }

  /** The coordinates in the data of a point before the camera. @param {import('three').Vector3} point @returns {[number, number, number]} */
  unplaced(point) {
    const { center, diagonal } = this.frameNow;
    const { x, y, z } = point.clone().applyQuaternion(this.#root.quaternion.clone().invert());
    return [center[0] + diagonal * x, center[1] + diagonal * y, center[2] + diagonal * z];
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
    this.orbit.settle(this.#firstLook, this.#limits, this.box, this.nearest);
  }
}
