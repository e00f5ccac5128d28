/**
 * Eye-dome lighting (Boucheny, 2009): a point that lies behind its neighbours on the screen gets darker, by how far behind in
 * log depth. It gives shape to clouds without normals, for one pass over the screen. The alpha of what was drawn says how much a
 * pixel faces us: 1 wholly; ½ not at all, so it takes no shade and lets the background through; 0 is background.
 */
import { BufferAttribute, BufferGeometry, DepthTexture, Mesh, NearestFilter, ShaderMaterial, UnsignedIntType, Vector2, WebGLRenderTarget } from 'three';

/** A triangle that covers the screen. */
const SCREEN = Float32Array.of(-1, -1, 0, 3, -1, 0, -1, 3, 0);

export class EyeDome {
  #target = new WebGLRenderTarget(1, 1, {
    minFilter: NearestFilter,
    magFilter: NearestFilter,
    depthTexture: new DepthTexture(1, 1, UnsignedIntType),
  });

  #material = new ShaderMaterial({
    uniforms: {
      colors: { value: this.#target.texture },
      depths: { value: this.#target.depthTexture },
      size: { value: new Vector2() },
      near: { value: 0 },
      far: { value: 1 },
      reach: { value: 1 },
      strength: { value: 1 },
      parallel: { value: false },
    },
    depthTest: false,
    depthWrite: false,
    vertexShader: /* glsl */ `
      void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }`,
    fragmentShader: /* glsl */ `
      uniform sampler2D colors, depths;
      uniform vec2 size;
      uniform float near, far, reach, strength;
      uniform bool parallel;
      const float STRENGTH = 60.0;
      const float LIMIT = 0.012;
      const float FAR_SIDE = 0.14;

      float logDepth(ivec2 pixel) {
        float depth = texelFetch(depths, clamp(pixel, ivec2(0), ivec2(size) - 1), 0).r;
        // In parallel projection, as much as at the usual distance of two diagonals.
        return parallel ? 0.7 * depth * (far - near) : log2(near * far / (far - depth * (far - near)));
      }

      void main() {
        ivec2 here = ivec2(gl_FragCoord.xy);
        vec4 color = texelFetch(colors, here, 0);
        if (color.a == 0.0) discard;
        float depth = logDepth(here);
        float behind = 0.0;
        for (int k = 0; k < 16; k++) {
          float angle = 0.785398 * float(k);
          float distance = k < 8 ? 1.5 : 7.0; // the outlines of points, then the shape that they make
          ivec2 there = here + ivec2(round(reach * distance * vec2(cos(angle), sin(angle))));
          behind += clamp(depth - logDepth(there), 0.0, LIMIT);
        }
        float facing = 2.0 * color.a - 1.0;
        float solid = mix(FAR_SIDE, 1.0, facing);
        gl_FragColor = vec4(solid * color.rgb * exp(-strength * STRENGTH * facing * behind / 16.0), solid);
      }`,
  });

  #screen = new Mesh(new BufferGeometry().setAttribute('position', new BufferAttribute(SCREEN, 3)), this.#material);

  constructor() {
    this.#screen.frustumCulled = false;
  }

  /** At least so large, in pixels. @param {number} width @param {number} height */
  grow(width, height) {
    if (width > this.#target.width || height > this.#target.height) {
      this.#target.setSize(Math.max(width, this.#target.width), Math.max(height, this.#target.height));
    }
  }

  /**
   * Draws the scene through the pass, into the lower left part of the canvas of that size. What the renderer's scissor leaves out
   * of the canvas stays as it was.
   * @param {import('three').WebGLRenderer} renderer
   * @param {import('three').Scene} scene
   * @param {import('three').PerspectiveCamera} camera
   * @param {{ width: number, height: number, ratio: number }} size
   * @param {number} strength how much of it, 1 is all
   */
  render(renderer, scene, camera, { width, height, ratio }, strength) {
    this.#target.viewport.set(0, 0, width, height);
    this.#target.scissor.set(0, 0, width, height);
    this.#target.scissorTest = true;
    renderer.setRenderTarget(this.#target);
    renderer.clear();
    renderer.render(scene, camera);
    renderer.setRenderTarget(null);
    const { uniforms } = this.#material;
    uniforms.size.value.set(width, height);
    uniforms.near.value = camera.near;
    uniforms.far.value = camera.far;
    uniforms.reach.value = ratio;
    uniforms.strength.value = strength;
    uniforms.parallel.value = camera.projectionMatrix.elements[15] === 1;
    renderer.clear();
    renderer.render(this.#screen, camera);
  }
}
