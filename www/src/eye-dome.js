import { DepthTexture, NearestFilter, ShaderMaterial, UnsignedIntType, WebGLRenderTarget } from 'three';
import { FullScreenQuad } from 'three/addons/postprocessing/Pass.js';

/**
 * Eye-dome lighting (Boucheny, 2009): a point that lies behind its neighbours on the screen gets darker, by
 * how far behind in log depth. It gives shape to clouds without normals, for one pass over the screen.
 * Alpha says how much of it a pixel takes: 1 all, ½ nothing; 0 is background.
 */
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
      near: { value: 0 },
      far: { value: 1 },
      reach: { value: 1 },
      parallel: { value: false },
    },
    depthTest: false,
    depthWrite: false,
    vertexShader: /* glsl */ `
      void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }`,
    fragmentShader: /* glsl */ `
      uniform sampler2D colors, depths;
      uniform float near, far, reach;
      uniform bool parallel;
      const float STRENGTH = 60.0;
      const float LIMIT = 0.012;

      float logDepth(ivec2 pixel) {
        ivec2 size = textureSize(depths, 0);
        float depth = texelFetch(depths, clamp(pixel, ivec2(0), size - 1), 0).r;
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
        float part = 2.0 * color.a - 1.0;
        gl_FragColor = vec4(color.rgb * exp(-STRENGTH * part * behind / 16.0), 1.0);
      }`,
  });

  #quad = new FullScreenQuad(this.#material);

  /** @param {number} width @param {number} height  in device pixels */
  resize(width, height) {
    this.#target.setSize(width, height);
  }

  /**
   * Draws the scene through the pass. What the renderer's scissor leaves out of the canvas stays as it was.
   * @param {import('three').WebGLRenderer} renderer
   * @param {import('three').Scene} scene
   * @param {import('three').PerspectiveCamera} camera
   */
  render(renderer, scene, camera) {
    renderer.setRenderTarget(this.#target);
    renderer.clear();
    renderer.render(scene, camera);
    renderer.setRenderTarget(null);
    const { uniforms } = this.#material;
    uniforms.near.value = camera.near;
    uniforms.far.value = camera.far;
    uniforms.reach.value = renderer.getPixelRatio();
    uniforms.parallel.value = camera.projectionMatrix.elements[15] === 1;
    renderer.clear();
    this.#quad.render(renderer);
  }
}
