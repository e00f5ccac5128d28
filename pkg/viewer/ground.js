/**
 * The shadow that meshes throw on the ground under them: how much of them is near the ground, seen from below and blurred. It is drawn
 * anew only when what stands there has changed.
 */
import {
  Box3, DoubleSide, LinearFilter, Mesh, MeshBasicMaterial, MeshDepthMaterial, OrthographicCamera, PlaneGeometry, Scene, ShaderMaterial, Vector2, Vector3,
  WebGLRenderTarget,
} from 'three';

/** @import { Stage } from './stage.js' */

const SIZE = 256;
/** How much wider than the mesh the ground is, for the blur to end on it. */
const WIDER = 1.5;
/** What is higher than this share of its size throws no shadow. */
const HIGH = 0.5;
/** Standard deviations of the blur in pixels, one pass after the other. */
const BLURS = [13, 7];
const DARKEST = 0.6;

export class Ground {
  /** From 0, none, to 1. */
  #strength = 0;
  #stale = true;
  #camera = new OrthographicCamera();
  #targets = [0, 1].map(() => new WebGLRenderTarget(SIZE, SIZE, { minFilter: LinearFilter, magFilter: LinearFilter }));
  /** Near the ground it is dark, at the top not at all. */
  #depth = darkness();
  #blur = new ShaderMaterial({
    uniforms: { picture: { value: null }, step: { value: new Vector2() } },
    depthTest: false,
    depthWrite: false,
    vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy * 2.0, 0.0, 1.0); }',
    fragmentShader: /* glsl */ `
      uniform sampler2D picture;
      uniform vec2 step;
      varying vec2 at;
      void main() {
        vec4 sum = vec4(0.0);
        float weights = 0.0;
        for (int k = -12; k <= 12; k++) {
          float weight = exp(-0.5 * float(k * k) / 16.0);
          sum += weight * texture2D(picture, at + step * float(k));
          weights += weight;
        }
        gl_FragColor = sum / weights;
      }`,
  });

  #screen = new Mesh(new PlaneGeometry(1, 1), this.#blur);
  #scene = new Scene();
  plane = new Mesh(
    new PlaneGeometry(1, 1),
    new MeshBasicMaterial({ transparent: true, depthWrite: false, toneMapped: false, map: this.#targets[0].texture }),
  );

  constructor() {
    this.#screen.frustumCulled = false;
    this.#scene.add(this.#screen);
    this.plane.visible = false;
    this.plane.rotation.x = -Math.PI / 2;
    this.plane.renderOrder = -1;
  }

  get strength() {
    return this.#strength;
  }

  set strength(strength) {
    this.#strength = strength;
    this.plane.material.opacity = Math.min(1, strength) * DARKEST;
  }

  /** Something else stands there, or the pictures are lost. */
  stale() {
    this.#stale = true;
  }

  free() {
    for (const one of [...this.#targets, this.plane.geometry, this.plane.material, this.#screen.geometry, this.#blur, this.#depth]) one.dispose();
    this.stale();
  }

  /**
   * @param {import('three').WebGLRenderer} renderer
   * @param {Scene} scene
   * @param {Stage} stage
   */
  ready(renderer, scene, stage) {
    if (!this.#stale || this.#strength <= 0) return;
    const meshes = [...stage.layers.values()].filter(({ points, streamed }) => !points && !streamed);
    if (meshes.length === 0) return;
    this.#stale = false;
    const box = new Box3();
    for (const { objects } of meshes) for (const object of objects) box.expandByObject(object, true);
    this.#place(box);
    this.#camera.layers.mask = meshes.reduce((mask, { bit }) => mask | (1 << bit), 0);
    scene.overrideMaterial = this.#depth;
    this.plane.visible = false;
    const [first, second] = this.#targets;
    renderer.setRenderTarget(first);
    renderer.clear();
    renderer.render(scene, this.#camera);
    scene.overrideMaterial = null;
    for (const blur of BLURS) {
      this.#pass(renderer, first, second, blur / 4 / SIZE, 0);
      this.#pass(renderer, second, first, 0, blur / 4 / SIZE);
    }
    renderer.setRenderTarget(null);
  }

  /** The ground under a box, and the camera that looks up at it. @param {Box3} box */
  #place(box) {
    const size = box.getSize(new Vector3());
    const center = box.getCenter(new Vector3());
    const side = WIDER * Math.max(size.x, size.z, 1e-6);
    this.plane.position.set(center.x, box.min.y, center.z);
    this.plane.scale.set(side, side, 1);
    const height = Math.max(1e-6, HIGH * Math.max(size.x, size.y, size.z));
    Object.assign(this.#camera, { left: -side / 2, right: side / 2, top: side / 2, bottom: -side / 2, near: 0, far: height });
    this.#camera.position.set(center.x, box.min.y - 1e-3 * height, center.z);
    this.#camera.up.set(0, 0, 1); // the picture's upper edge is the plane's lower one, as one looks from the other side
    this.#camera.lookAt(center.x, box.max.y + 1, center.z);
    this.#camera.updateProjectionMatrix();
    this.#camera.updateMatrixWorld();
  }

  /**
   * @param {import('three').WebGLRenderer} renderer
   * @param {WebGLRenderTarget} from
   * @param {WebGLRenderTarget} to
   * @param {number} x the step between the pixels of the sum
   * @param {number} y
   */
  #pass(renderer, from, to, x, y) {
    this.#blur.uniforms.picture.value = from.texture;
    this.#blur.uniforms.step.value.set(x, y);
    renderer.setRenderTarget(to);
    renderer.render(this.#scene, this.#camera);
  }
}

/** Black, the more opaque the lower. */
function darkness() {
  const material = new MeshDepthMaterial({ side: DoubleSide });
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(/gl_FragColor = [^;]+;/, 'gl_FragColor = vec4(vec3(0.0), 1.0 - fragCoordZ);');
  };
  return material;
}
