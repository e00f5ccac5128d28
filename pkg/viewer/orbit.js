/** How one moves around: pointer, keys, a slow turn of its own, and back to the first look. */
import { MathUtils, Quaternion, Spherical, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { calm } from './watching.js';

/** @import { Pose, Up } from '../element.js' */

/** First look: from the front, a little from the right and above. */
const FIRST_LOOK = new Vector3(0.55, 0.38, 1).normalize();
const MARGIN = 1.1;
const NEAREST = 0.02;
const FARTHEST = 12;
const HOME_MS = 420;
const SIDES = 12;
/** A slow turn: once around in half a minute; it rests a while after a hand was on it. */
const TURN_PER_MS = (2 * Math.PI) / 30_000;
const REST_MS = 3000;

const quarter = (/** @type {number} */ x, /** @type {number} */ z, turns = 1) =>
  new Quaternion().setFromAxisAngle(new Vector3(x, 0, z), (turns * Math.PI) / 2);

/** What brings each axis up. @type {Record<Exclude<Up, 'auto'>, Quaternion>} */
const STAND = { y: new Quaternion(), z: quarter(-1, 0), '-y': quarter(1, 0, 2), '-z': quarter(1, 0), x: quarter(0, 1), '-x': quarter(0, -1) };

/** A move back under way. @typedef {{ from: Spherical, to: Spherical, target: Vector3, start: number }} Flight */

export class Orbit {
  #camera;
  #root;
  #element;
  #changed;
  /** @type {OrbitControls | undefined} */
  #controls;
  #target = new Vector3();
  #enabled = false;
  #turning = false;
  /** A few points of what is shown, in the picture's frame. */
  #outline = /** @type {Float32Array} */ (new Float32Array());
  /** @type {Flight | null} */
  #flight = null;
  #last = 0;
  #restUntil = 0;

  /**
   * @param {import('three').PerspectiveCamera} camera
   * @param {import('three').Object3D} root what stands before the camera
   * @param {HTMLElement} element takes the pointer
   * @param {() => void} changed asks for a new frame
   */
  constructor(camera, root, element, changed) {
    this.#camera = camera;
    this.#root = root;
    this.#element = element;
    this.#changed = changed;
    camera.position.copy(FIRST_LOOK).multiplyScalar(2);
  }

  /** Listens to the pointer, or no longer. @param {boolean} on */
  listen(on) {
    if (on === Boolean(this.#controls)) return;
    if (on) {
      this.#controls = this.#connect();
      this.#element.addEventListener('wheel', this.#allowZoom, { capture: true, passive: true });
    } else {
      this.#target.copy(/** @type {OrbitControls} */ (this.#controls).target);
      this.#element.removeEventListener('wheel', this.#allowZoom, { capture: true });
      this.#controls?.dispose();
      this.#controls = undefined;
    }
    this.enable(this.#enabled);
  }

  #connect() {
    const controls = new OrbitControls(this.#camera, this.#element);
    controls.target.copy(this.#target);
    controls.minDistance = NEAREST;
    controls.maxDistance = FARTHEST;
    controls.zoomSpeed = 1.4;
    controls.addEventListener('start', () => this.#rest());
    controls.addEventListener('change', this.#changed);
    return controls;
  }

  /** A wheel over the picture scrolls the page, unless one has taken hold of the picture, or pinches. */
  #allowZoom = (/** @type {WheelEvent} */ event) => {
    const root = /** @type {ShadowRoot} */ (this.#element.getRootNode());
    if (this.#controls) this.#controls.enableZoom = event.ctrlKey || root.activeElement === this.#element;
  };

  /** Whether the pointer moves it. A finger that moves up or down still scrolls the page. @param {boolean} on */
  enable(on) {
    this.#enabled = on;
    if (this.#controls) this.#controls.enabled = on;
    this.#element.style.touchAction = on ? 'pan-y' : '';
    this.#element.style.cursor = '';
  }

  /** @param {boolean} on */
  turnSlowly(on) {
    this.#turning = on;
    this.#changed();
  }

  get turning() {
    return this.#turning && !calm().wanted;
  }

  /** Takes something new to look at. @param {Float32Array} points a few of it @param {Exclude<Up, 'auto'>} up */
  frame(points, up) {
    this.#outline = points;
    this.stand(up);
    this.home({ animated: false });
  }

  /** @param {Exclude<Up, 'auto'>} up */
  stand(up) {
    this.#root.quaternion.copy(STAND[up]);
    this.#root.updateMatrixWorld();
    this.#changed();
  }

  /** Back to the first look, from which everything is seen. */
  home({ animated = true } = {}) {
    const to = this.#firstLook();
    this.#flight = null;
    if (!animated || calm().wanted) return this.#place(to, new Vector3());
    this.#rest();
    const from = this.#spherical();
    to.theta += 2 * Math.PI * Math.round((from.theta - to.theta) / (2 * Math.PI)); // the short way
    this.#flight = { from, to, target: this.#aim().clone(), start: performance.now() };
    this.#changed();
  }

  /** There is more to look at. @param {Float32Array} points a few of it */
  widen(points) {
    this.keepFitted(() => {
      const both = new Float32Array(this.#outline.length + points.length);
      both.set(this.#outline);
      both.set(points, this.#outline.length);
      this.#outline = both;
    });
  }

  /** The picture or what is in it has another shape now: fits again, if nobody has moved since. @param {() => void} reshape */
  keepFitted(reshape) {
    const before = this.#firstLook().radius;
    reshape();
    const place = this.#spherical();
    if (Math.abs(place.radius - before) > 1e-6) return;
    place.radius = this.#firstLook().radius;
    this.#place(place, this.#aim());
  }

  /** Turns around it. @param {number} right @param {number} over radians */
  turn(right, over) {
    this.#rest();
    const place = this.#spherical();
    place.theta += right;
    place.phi = MathUtils.clamp(place.phi - over, 0.01, Math.PI - 0.01);
    this.#place(place, this.#aim());
  }

  /** @param {number} factor under 1 comes nearer */
  zoom(factor) {
    this.#rest();
    const place = this.#spherical();
    place.radius = MathUtils.clamp(place.radius * factor, NEAREST, FARTHEST);
    this.#place(place, this.#aim());
  }

  /** @returns {Pose} */
  get pose() {
    const { theta, phi, radius } = this.#spherical();
    return { azimuth: MathUtils.radToDeg(theta), elevation: 90 - MathUtils.radToDeg(phi), zoom: this.#firstLook().radius / radius };
  }

  /** Goes on with a movement under way; once before each frame. @param {number} now */
  update(now) {
    const passed = Math.min(100, now - this.#last);
    this.#last = now;
    if (this.#flight) this.#fly(this.#flight);
    else if (this.turning) this.#drift(passed);
    if (this.#controls) {
      this.#controls.enableDamping = !calm().wanted;
      this.#controls.update();
    }
    const distance = this.#camera.position.length();
    this.#camera.near = Math.max(distance * 0.005, distance - 1);
    this.#camera.far = distance + 1;
    this.#camera.updateProjectionMatrix();
  }

  /** @param {number} passed milliseconds */
  #drift(passed) {
    const place = this.#spherical();
    if (performance.now() >= this.#restUntil) place.theta += TURN_PER_MS * passed;
    this.#place(place, this.#aim());
  }

  /** @param {Flight} flight */
  #fly({ from, to, target, start }) {
    const t = Math.min(1, (performance.now() - start) / HOME_MS);
    const eased = 1 - (1 - t) ** 3;
    const between = (/** @type {'radius' | 'phi' | 'theta'} */ part) => MathUtils.lerp(from[part], to[part], eased);
    const place = new Spherical(between('radius'), between('phi'), between('theta'));
    if (t === 1) this.#flight = null;
    this.#place(place, target.clone().multiplyScalar(1 - eased));
  }

  /** A hand is on it: what moves by itself rests. */
  #rest() {
    this.#flight = null;
    this.#restUntil = performance.now() + REST_MS;
  }

  #aim() {
    return this.#controls?.target ?? this.#target;
  }

  #spherical() {
    return new Spherical().setFromVector3(this.#camera.position.clone().sub(this.#aim()));
  }

  /** @param {Spherical} place @param {Vector3} target */
  #place(place, target) {
    this.#aim().copy(target);
    this.#camera.position.setFromSpherical(place).add(target);
    this.#camera.lookAt(target);
    this.#changed();
  }

  /** What turns has to fit from all sides. */
  #firstLook() {
    const first = new Spherical().setFromVector3(FIRST_LOOK);
    first.radius = NEAREST;
    const sides = this.turning ? SIDES : 1;
    for (let k = 0; k < sides; k++) {
      const direction = new Vector3().setFromSphericalCoords(1, first.phi, first.theta + (2 * Math.PI * k) / sides);
      first.radius = Math.max(first.radius, this.#distanceToFit(direction));
    }
    return first;
  }

  /** The smallest distance from which every point of the outline is inside the picture. @param {Vector3} direction */
  #distanceToFit(direction) {
    const tanY = Math.tan(MathUtils.degToRad(this.#camera.fov) / 2) / MARGIN;
    const tanX = tanY * this.#camera.aspect;
    const look = this.#camera.clone();
    look.position.copy(direction);
    look.lookAt(0, 0, 0);
    const toEye = look.quaternion.invert().multiply(this.#root.quaternion.clone());
    const point = new Vector3();
    let distance = NEAREST;
    for (let i = 0; i < this.#outline.length; i += 3) {
      point.fromArray(this.#outline, i).applyQuaternion(toEye);
      const needed = point.z + Math.max(Math.abs(point.x) / tanX, Math.abs(point.y) / tanY);
      if (needed > distance) distance = needed;
    }
    return distance;
  }
}
