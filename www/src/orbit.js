import { MathUtils, Quaternion, Spherical, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

/** First look at a scan: from the front, a little from the right and above. */
const FIRST_LOOK = new Vector3(0.55, 0.38, 1).normalize();
const FIT_MARGIN = 1.1;
const FIT_MS = 420;
const quarter = (/** @type {number} */ x, /** @type {number} */ z, turns = 1) =>
  new Quaternion().setFromAxisAngle(new Vector3(x, 0, z), (turns * Math.PI) / 2);

/**
 * The ways to stand a scan upright, in the order in which the button goes through them: toys and statues, land
 * and rooms, depth cameras (whose y points down), and the rest.
 */
const UPS = [
  { name: 'Y', rotation: new Quaternion() },
  { name: 'Z', rotation: quarter(-1, 0) },
  { name: '−Y', rotation: quarter(1, 0, 2) },
  { name: '−Z', rotation: quarter(1, 0) },
  { name: 'X', rotation: quarter(0, 1) },
  { name: '−X', rotation: quarter(0, -1) },
];

/** Sides to look at straight, with the camera's angles around the upright axis and down from it. */
const SIDES = {
  front: [0, Math.PI / 2],
  back: [Math.PI, Math.PI / 2],
  right: [Math.PI / 2, Math.PI / 2],
  left: [-Math.PI / 2, Math.PI / 2],
  top: [0, 1e-4],
  bottom: [0, Math.PI - 1e-4],
};

/** @typedef {keyof typeof SIDES} Side */

/** A camera move under way. @typedef {{ from: Spherical, to: Spherical, target: Vector3, start: number }} Flight */

/** How the person moves around the scan: pointer, keys, and the moves of the buttons. */
export class Orbit {
  #camera;
  #root;
  #changed;
  #controls;
  #calm = matchMedia('(prefers-reduced-motion: reduce)');
  #up = 0;
  /** Whether lines that are parallel look parallel: an orthographic projection instead of perspective. */
  #parallel = false;
  /** @type {Float32Array} a few points of the scan and of its mesh, in the viewer's frame */
  #outline = new Float32Array();
  /** @type {Float32Array} those of the scan */
  #scan = new Float32Array();
  /** Nobody has moved the camera since the scan came. */
  #untouched = true;
  /** @type {Flight | null} */
  #flight = null;
  #updating = false;

  /**
   * @param {import('three').PerspectiveCamera} camera
   * @param {import('three').Object3D} root  holds the scan; it is turned to stand upright
   * @param {HTMLElement} element  takes the pointer
   * @param {() => void} changed  asks for a new picture
   */
  constructor(camera, root, element, changed) {
    this.#camera = camera;
    this.#root = root;
    this.#changed = changed;
    this.#controls = new OrbitControls(camera, element);
    this.#controls.minDistance = 0.02;
    this.#controls.maxDistance = 12;
    this.#controls.zoomSpeed = 1.4;
    this.#controls.addEventListener('start', () => {
      this.#flight = null;
      this.#untouched = false;
    });
    // What moves while a picture is made is in that picture; only a movement that dies away needs another.
    this.#controls.addEventListener('change', () => {
      if (!this.#updating || this.#controls.enableDamping) changed();
    });
    const follow = () => (this.#controls.enableDamping = !this.#calm.matches);
    this.#calm.addEventListener('change', follow);
    follow();
    camera.position.copy(FIRST_LOOK).multiplyScalar(2);
  }

  /** Takes a new scan: its points, and which axis is most likely up. */
  frame(/** @type {Float32Array} */ points, /** @type {'Y' | 'Z'} */ up) {
    this.#scan = this.#outline = someOf(points);
    this.#stand(UPS.findIndex(({ name }) => name === up));
    this.#camera.position.copy(FIRST_LOOK);
    this.#controls.target.set(0, 0, 0);
    this.fit({ animated: false });
    this.#untouched = true;
  }

  /** Takes the mesh of the scan. One that is larger than the picture is fitted in, unless the person has looked around. */
  include(/** @type {Float32Array} */ vertices) {
    this.#outline = Float32Array.of(...this.#scan, ...someOf(vertices));
    const direction = this.#camera.position.clone().sub(this.#controls.target).normalize();
    if (this.#untouched && this.#distanceToFit(direction) > FIT_MARGIN * this.distance) this.fit({ animated: false });
  }

  /** Stands the scan on its next side and says which axis is up now. */
  nextUp() {
    this.#stand((this.#up + 1) % UPS.length);
    this.fit();
    return UPS[this.#up].name;
  }

  /** Moves the camera along its line of sight until the whole scan is seen, centred. */
  fit({ animated = true } = {}) {
    const direction = this.#camera.position.clone().sub(this.#controls.target).normalize();
    const to = new Spherical().setFromVector3(direction.multiplyScalar(this.#distanceToFit(direction)));
    this.#go(to, animated);
  }

  get parallel() {
    return this.#parallel;
  }

  /** From the camera to what it turns around. */
  get distance() {
    return this.#controls.getDistance();
  }

  /** Perspective, or parallel lines; what is at the centre keeps its size. */
  setParallel(/** @type {boolean} */ parallel) {
    this.#parallel = parallel;
    this.#changed();
  }

  /** Looks straight at one side, in parallel projection, with the whole scan in the picture. */
  look(/** @type {Side} */ side) {
    this.#untouched = false;
    const [theta, phi] = SIDES[side];
    this.#parallel = true;
    const from = this.#spherical();
    // The shorter way round.
    const turn = ((((theta - from.theta) % (2 * Math.PI)) + 3 * Math.PI) % (2 * Math.PI)) - Math.PI;
    const to = new Spherical(1, phi, from.theta + turn);
    to.radius = this.#distanceToFit(new Vector3().setFromSpherical(to));
    this.#go(to);
  }

  /** Turns around the scan. @param {number} right @param {number} over  radians */
  turn(right, over) {
    this.#untouched = false;
    const place = this.#spherical();
    place.theta += right;
    place.phi = MathUtils.clamp(place.phi - over, 0.01, Math.PI - 0.01);
    this.#place(place, this.#controls.target);
  }

  /** @param {number} factor  under 1 comes nearer */
  zoom(factor) {
    this.#untouched = false;
    const place = this.#spherical();
    place.radius = MathUtils.clamp(place.radius * factor, this.#controls.minDistance, this.#controls.maxDistance);
    this.#place(place, this.#controls.target);
  }

  /** Goes on with a movement under way; called once before each picture. */
  update() {
    if (this.#flight) this.#fly(this.#flight);
    this.#updating = true;
    this.#controls.update();
    this.#updating = false;
    const distance = this.#camera.position.length();
    this.#camera.near = this.#parallel ? distance - 1 : Math.max(distance * 0.005, distance - 1);
    this.#camera.far = distance + 1;
    this.#camera.updateProjectionMatrix();
    if (this.#parallel) flatten(this.#camera, this.distance);
  }

  /** Moves the camera to a place from which it looks at the middle. */
  #go(/** @type {Spherical} */ to, animated = true) {
    if (!animated || this.#calm.matches) return this.#place(to, new Vector3());
    this.#flight = { from: this.#spherical(), to, target: this.#controls.target.clone(), start: performance.now() };
    this.#changed();
  }

  #fly(/** @type {Flight} */ { from, to, target, start }) {
    const t = Math.min(1, (performance.now() - start) / FIT_MS);
    const eased = 1 - (1 - t) ** 3;
    const mix = (/** @type {'radius' | 'phi' | 'theta'} */ part) => MathUtils.lerp(from[part], to[part], eased);
    const place = new Spherical(mix('radius'), mix('phi'), mix('theta'));
    if (t === 1) this.#flight = null;
    this.#place(place, target.clone().multiplyScalar(1 - eased));
  }

  #spherical() {
    this.#flight = null;
    return new Spherical().setFromVector3(this.#camera.position.clone().sub(this.#controls.target));
  }

  #place(/** @type {Spherical} */ place, /** @type {Vector3} */ target) {
    this.#controls.target.copy(target);
    this.#camera.position.setFromSpherical(place).add(target);
    this.#camera.lookAt(target);
    this.#changed();
  }

  #stand(/** @type {number} */ up) {
    this.#up = up;
    this.#root.quaternion.copy(UPS[up].rotation);
    this.#root.updateMatrixWorld();
  }

  /** The smallest distance along `direction` from which every point of the outline is inside the picture. */
  #distanceToFit(/** @type {Vector3} */ direction) {
    const tanY = Math.tan(MathUtils.degToRad(this.#camera.fov) / 2) / FIT_MARGIN;
    const tanX = tanY * this.#camera.aspect;
    const look = this.#camera.clone();
    look.position.copy(direction);
    look.lookAt(0, 0, 0);
    const toEye = look.quaternion.invert().multiply(new Quaternion().copy(this.#root.quaternion));
    const point = new Vector3();
    let distance = this.#controls.minDistance;
    const depth = this.#parallel ? 0 : 1; // in parallel projection nearness makes nothing larger
    for (let i = 0; i < this.#outline.length; i += 3) {
      point.fromArray(this.#outline, i).applyQuaternion(toEye);
      distance = Math.max(distance, depth * point.z + Math.max(Math.abs(point.x) / tanX, Math.abs(point.y) / tanY));
    }
    return distance;
  }
}

/** So many points that their outline is that of all. */
function someOf(/** @type {Float32Array} */ points) {
  const stride = 3 * Math.max(1, Math.floor(points.length / 3 / 4096));
  const picked = [];
  for (let i = 0; i < points.length; i += stride) picked.push(points[i], points[i + 1], points[i + 2]);
  return Float32Array.from(picked);
}

/**
 * Turns a perspective projection into the parallel one that shows what is `distance` away at the same size. The
 * camera stays what it is to everything that moves it.
 * @param {import('three').PerspectiveCamera} camera
 * @param {number} distance
 */
function flatten(camera, distance) {
  const { near, far, projectionMatrix, projectionMatrixInverse } = camera;
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
