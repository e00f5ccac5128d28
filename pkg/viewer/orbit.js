/** How one moves around: gestures, calls, a slow turn of its own, straight looks at the sides, and back to the first look. */
import { MathUtils, Quaternion, Spherical, Vector3 } from 'three';
import { Gestures } from './gestures.js';
import { NEAREST, POLE, boundsOf, lookOf, reached, within } from './look.js';
import { calm } from './watching.js';

/** @import { Axis, Mover, Pose, Side } from '../viewer.js' */

const MARGIN = 1.1;
const FLIGHT_MS = 420;
/** A slow turn: once around in half a minute. */
const TURN_PER_MS = (2 * Math.PI) / 30_000;
/** It rests a while after a hand was on it. */
const REST_MS = 3000;
/** What a pointer has moved is followed by this share a millisecond (a twentieth a frame), so that it glides to rest. */
const FOLLOW = -Math.log(0.95) / (1000 / 60);
/** @typedef {{ right: number, over: number, x: number, y: number }} Lag */
/** Less than this is at rest. */
const STILL = 1e-4;
const NO_LAG = { right: 0, over: 0, x: 0, y: 0 };
/** From so many sides what turns is looked at, to know whether it fits. */
const VIEWS = 12;

const quarter = (/** @type {number} */ x, /** @type {number} */ z, turns = 1) =>
  new Quaternion().setFromAxisAngle(new Vector3(x, 0, z), (turns * Math.PI) / 2);

/** What brings each axis up. @type {Record<Axis, Quaternion>} */
const STAND = { y: new Quaternion(), z: quarter(-1, 0), '-y': quarter(1, 0, 2), '-z': quarter(1, 0), x: quarter(0, 1), '-x': quarter(0, -1) };

const UPWARDS = new Vector3(0, 1, 0);

/** The camera's angles: around the upright axis, and down from it. @type {Record<Side, [number, number]>} */
const SIDES = {
  front: [0, Math.PI / 2],
  back: [Math.PI, Math.PI / 2],
  right: [Math.PI / 2, Math.PI / 2],
  left: [-Math.PI / 2, Math.PI / 2],
  top: [0, POLE],
  bottom: [0, Math.PI - POLE],
};

/** A move under way. @typedef {{ from: Spherical, to: Spherical, target: Vector3, goal: Vector3, start: number, by: Mover }} Flight */

export class Orbit {
  #camera;
  #root;
  #element;
  #embedded;
  #changed;
  /** What a pointer may do. */
  gestures;
  #target = new Vector3();
  #turning = false;
  /** Lines that are parallel look parallel: an orthographic projection. */
  #parallel = false;
  /** A few points of what is shown, in the frame. */
  #outline = /** @type {Float32Array} */ (new Float32Array());
  /** Where the camera was put so that all is seen. */
  #fitted = new Spherical();
  /** How far that is, once the picture has another shape. @type {(place: Spherical) => number} */
  #measure = (place) => this.#distanceFrom(place);
  /** From where all was seen at last. */
  #whole = 1;
  #first = lookOf({}, null);
  #bounds = boundsOf({}, null);
  /** Milliseconds that it rests after a hand was on it. */
  rest = REST_MS;
  /** Nobody has moved since something new came. */
  #untouched = true;
  /** @type {Flight | null} */
  #flight = null;
  /** What a pointer has moved and the camera has not followed yet: radians, and shares of the picture's height. */
  #lag = NO_LAG;
  #last = 0;
  #restUntil = 0;

  /**
   * @param {import('three').PerspectiveCamera} camera
   * @param {import('three').Object3D} root what stands before the camera
   * @param {HTMLElement} element takes the pointer
   * @param {boolean} embedded wheel and vertical swipes are the page's until the element has the focus
   * @param {(by: Mover) => void} changed asks for a new frame
   */
  constructor(camera, root, element, embedded, changed) {
    this.#camera = camera;
    this.#root = root;
    this.#element = element;
    this.#embedded = embedded;
    this.#changed = changed;
    this.gestures = new Gestures(element, {
      begin: () => this.#rest(),
      drag: (x, y) => this.#follow({ right: -2 * Math.PI * x, over: -2 * Math.PI * y }),
      shift: (x, y) => this.#follow({ x, y }),
      pinch: (factor) => this.zoom(factor, 'pointer'),
    }, embedded);
    camera.position.setFromSphericalCoords(2, this.#first.phi, this.#first.theta);
  }

  /**
   * Where home is, and how far one may go from it.
   * @param {import('../viewer.js').FirstLook} first
   * @param {import('../viewer.js').Limits} limits
   * @param {import('../viewer.js').Frame | null} frame
   * @param {number} nearest how near one may come in the frame, where the limits do not say
   */
  settle(first, limits, frame, nearest) {
    this.#first = lookOf(first, frame);
    this.#bounds = boundsOf(limits, frame, nearest);
    this.#camera.fov = within(this.#first.fov, this.#bounds.fov);
    this.#put(this.#place, this.#target);
  }

  /** Where the camera stands, and what it turns around, in the frame. */
  get stance() {
    const { theta, phi, radius } = this.#place;
    return { theta, phi, radius, target: this.#target };
  }

  /** Listens to the pointer, or no longer. @param {boolean} on */
  listen(on) {
    this.gestures.listen(on);
  }

  /** Whether the pointer moves it. @param {boolean} on */
  enable(on) {
    this.gestures.enabled = on;
    this.#element.style.touchAction = on ? (this.#embedded ? 'pan-y' : 'none') : '';
  }

  get enabled() {
    return this.gestures.enabled;
  }

  get autoRotate() {
    return this.#turning;
  }

  set autoRotate(turns) {
    if (turns === this.#turning) return;
    this.#turning = turns;
    this.#changed('program');
  }

  get turning() {
    return this.#turning && !calm().wanted;
  }

  get parallel() {
    return this.#parallel;
  }

  /** Perspective, or parallel lines; what is at the centre keeps its size. */
  set parallel(parallel) {
    this.#parallel = parallel;
    this.#changed('program');
  }

  /** From the camera to what it turns around. */
  get distance() {
    return this.#camera.position.distanceTo(this.#target);
  }

  /** Takes something new to look at. @param {Float32Array} outline a few points of it @param {Axis | [number, number, number]} up */
  frame(outline, up) {
    this.#outline = outline;
    this.stand(up);
    this.home({ animated: false });
    this.#untouched = true;
  }

  /** @param {Axis | [number, number, number]} up */
  stand(up) {
    if (typeof up === 'string') this.#root.quaternion.copy(STAND[up]);
    else this.#root.quaternion.setFromUnitVectors(new Vector3(...up).normalize(), UPWARDS);
    this.#root.updateMatrixWorld();
    this.#changed('program');
  }

  /** Back to the first look, from which everything is seen. */
  home({ animated = true, by = /** @type {Mover} */ ('program') } = {}) {
    const { theta, phi, reach, target } = this.#first;
    const goal = new Vector3(...target).applyQuaternion(this.#root.quaternion);
    this.#fit(new Spherical(1, phi, theta), animated, by, goal, (place) => reached(reach, this.#distanceFrom(place)));
  }

  /** Along the line of sight to where everything is seen, centred. */
  fit({ animated = true } = {}) {
    this.#fit(this.#place, animated);
  }

  /** Straight at one side, in parallel projection, to where everything is seen. @param {Side} side */
  lookFrom(side) {
    this.#parallel = true;
    const [theta, phi] = SIDES[side];
    this.#fit(new Spherical(1, phi, theta), true);
    this.#untouched = false;
  }

  /** Turns around another place from now on, from as far away. @param {Vector3} place @param {Mover} by */
  pivot(place, by) {
    const to = this.#place;
    const { radius } = to;
    this.#fit(to, true, by, place, () => radius);
    this.#untouched = false;
  }

  /** There is something else to look at. What would be cut off is fitted in, unless somebody has looked around. @param {Float32Array} outline */
  widen(outline) {
    this.#outline = outline;
    if (!this.#untouched || this.#measure(this.#place) <= MARGIN * this.distance) return;
    this.#fit(this.#place, false, 'program', this.#target.clone(), this.#measure);
  }

  /** The picture has another shape now. Fits again, unless somebody has come nearer or gone farther. @param {() => void} reshape */
  reshape(reshape) {
    const place = this.#place;
    const fitted = Math.abs(place.radius - this.#fitted.radius) < 1e-6;
    reshape();
    this.#whole = this.#distanceFrom(this.#fitted);
    this.#fitted.radius = this.#measure(this.#fitted);
    this.#confine(this.#fitted);
    if (!fitted) return;
    place.radius = this.#fitted.radius;
    this.#put(place, this.#target);
  }

  /** Turns around it. @param {number} right @param {number} over radians @param {Mover} by */
  turn(right, over, by) {
    this.#rest();
    const place = this.#place;
    place.theta += right;
    place.phi -= over;
    this.#put(place, this.#target, by);
  }

  /** @param {number} factor under 1 comes nearer @param {Mover} by */
  zoom(factor, by) {
    if (by !== 'pointer') this.#rest(); // who holds it has made it rest
    const place = this.#place;
    place.radius *= factor;
    this.#put(place, this.#target, by);
  }

  /** @returns {Pose} */
  get pose() {
    const { theta, phi, radius } = this.#place;
    return { azimuth: MathUtils.radToDeg(theta), elevation: 90 - MathUtils.radToDeg(phi), zoom: this.#fitted.radius / radius };
  }

  /** Goes on with a movement under way; once before each frame. @param {number} now */
  update(now) {
    const passed = Math.min(100, now - this.#last);
    this.#last = now;
    if (this.#flight) this.#fly(this.#flight);
    else if (this.turning) this.#drift(passed);
    this.#glide(calm().wanted ? 1 : 1 - Math.exp(-FOLLOW * passed));
    const distance = this.#camera.position.length();
    this.#camera.near = this.#parallel ? distance - 1 : Math.max(Math.min(distance * 0.005, this.distance * 0.25), distance - 1);
    this.#camera.far = distance + 1;
    this.#camera.updateProjectionMatrix();
    if (this.#parallel) flatten(this.#camera, this.distance);
  }

  /** A pointer has moved it. @param {Partial<Lag>} way */
  #follow(way) {
    const { right, over, x, y } = this.#lag;
    this.#lag = { right: right + (way.right ?? 0), over: over + (way.over ?? 0), x: x + (way.x ?? 0), y: y + (way.y ?? 0) };
    this.#changed('pointer');
  }

  /** The camera follows the pointer. @param {number} share of the way */
  #glide(share) {
    if (this.#lag === NO_LAG) return;
    const { right, over, x, y } = this.#lag;
    if (Math.hypot(right, over, x, y) < STILL) share = 1;
    const place = this.#place;
    const height = 2 * place.radius * Math.tan(MathUtils.degToRad(this.#camera.fov) / 2);
    const move = new Vector3(-x, y, 0).multiplyScalar(share * height).applyQuaternion(this.#camera.quaternion);
    place.theta += share * right;
    place.phi += share * over;
    const left = 1 - share;
    this.#lag = left ? { right: left * right, over: left * over, x: left * x, y: left * y } : NO_LAG;
    this.#put(place, move.add(this.#target), 'pointer');
  }

  /** @param {number} passed milliseconds */
  #drift(passed) {
    const place = this.#place;
    if (performance.now() >= this.#restUntil) place.theta += TURN_PER_MS * passed;
    this.#put(place, this.#target);
  }

  /**
   * Moves the camera to where everything is seen from there, or as far as is measured.
   * @param {Spherical} to
   * @param {boolean} animated
   * @param {Mover} by
   * @param {Vector3} goal what it looks at
   * @param {(place: Spherical) => number} measure
   */
  #fit(to, animated, by = 'program', goal = new Vector3(), measure = (place) => this.#distanceFrom(place)) {
    this.#measure = measure;
    this.#confine(to);
    this.#whole = this.#distanceFrom(to);
    to.radius = measure(to);
    this.#fitted = this.#confine(to).clone();
    this.#flight = null;
    this.#lag = NO_LAG;
    if (!animated || calm().wanted) return this.#put(to, goal, by);
    this.#restUntil = performance.now() + this.rest;
    const from = this.#place;
    to.theta += 2 * Math.PI * Math.round((from.theta - to.theta) / (2 * Math.PI)); // the short way
    this.#flight = { from, to, target: this.#target.clone(), goal, start: performance.now(), by };
    this.#changed(by);
  }

  /** @param {Flight} flight */
  #fly({ from, to, target, goal, start, by }) {
    const t = Math.min(1, (performance.now() - start) / FLIGHT_MS);
    const eased = 1 - (1 - t) ** 3;
    const between = (/** @type {'radius' | 'phi' | 'theta'} */ part) => MathUtils.lerp(from[part], to[part], eased);
    const place = new Spherical(between('radius'), between('phi'), between('theta'));
    if (t === 1) this.#flight = null;
    this.#put(place, target.clone().lerp(goal, eased), by);
  }

  /** A hand is on it: what moves by itself rests. */
  #rest() {
    this.#flight = null;
    this.#lag = NO_LAG;
    this.#untouched = false;
    this.#restUntil = performance.now() + this.rest;
  }

  get #place() {
    return new Spherical().setFromVector3(this.#camera.position.clone().sub(this.#target));
  }

  /** Moves a place to where the camera may be. @param {Spherical} place */
  #confine(place) {
    const { theta, phi, near, far } = this.#bounds;
    // An angle is one of many that are whole turns apart: the one nearest to the middle of the bounds counts.
    const middle = (theta[0] + theta[1]) / 2;
    if (Number.isFinite(middle)) place.theta -= 2 * Math.PI * Math.round((place.theta - middle) / (2 * Math.PI));
    place.theta = within(place.theta, theta);
    place.phi = within(place.phi, phi);
    place.radius = within(place.radius, [reached(near, this.#whole), reached(far, this.#whole)]);
    return place;
  }

  /** @param {Spherical} place @param {Vector3} target @param {Mover} [by] */
  #put(place, target, by = 'program') {
    this.#confine(place);
    this.#target.copy(target);
    this.#camera.position.setFromSpherical(place).add(target);
    this.#camera.lookAt(target);
    this.#changed(by);
  }

  /** From where everything is seen; of what turns, all its sides. @param {Spherical} place */
  #distanceFrom({ theta, phi }) {
    let distance = NEAREST;
    for (let k = 0; k < (this.turning ? VIEWS : 1); k++) {
      const direction = new Vector3().setFromSphericalCoords(1, phi, theta + (2 * Math.PI * k) / VIEWS);
      distance = Math.max(distance, this.#distanceToFit(direction));
    }
    return distance;
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
    const depth = this.#parallel ? 0 : 1; // in parallel projection nearness makes nothing larger
    let distance = NEAREST;
    for (let i = 0; i < this.#outline.length; i += 3) {
      point.fromArray(this.#outline, i).applyQuaternion(toEye);
      const needed = depth * point.z + Math.max(Math.abs(point.x) / tanX, Math.abs(point.y) / tanY);
      if (needed > distance) distance = needed;
    }
    return distance;
  }
}

/**
 * Turns a perspective projection into the parallel one that shows what is `distance` away at the same size. The camera stays what
 * it is to everything that moves it.
 * @param {import('three').PerspectiveCamera} camera
 * @param {number} distance
 */
function flatten({ near, far, projectionMatrix, projectionMatrixInverse }, distance) {
  const e = projectionMatrix.elements;
  // x and y are divided by the distance instead of the depth; an off-centre view shifts by as much.
  e[0] /= distance;
  e[5] /= distance;
  [e[12], e[13]] = [-e[8], -e[9]];
  e[8] = e[9] = 0;
  e[10] = -2 / (far - near);
  e[14] = -(far + near) / (far - near);
  e[11] = 0;
  e[15] = 1;
  projectionMatrixInverse.copy(projectionMatrix).invert();
}
