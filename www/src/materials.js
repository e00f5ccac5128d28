import { Color, DoubleSide, MeshMatcapMaterial, ShaderMaterial } from 'three';
import { studioMatcap } from './matcap.js';

/**
 * The mesh: a matcap, tinted by the theme or by the scan's own colours. Its inner side is darker and warmer, so
 * that one sees which side is which. Triangles that only just turn away, as at every outline, do not count as
 * inner: they would be specks along the rim.
 * @param {{ colored: boolean }} options
 */
export function meshMaterial({ colored }) {
  const material = new MeshMatcapMaterial({ matcap: studioMatcap(), side: DoubleSide, vertexColors: colored });
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <normal_fragment_begin>', /* glsl */ `
        vec3 normal = normalize(vNormal);
        bool inner = !gl_FrontFacing && dot(normal, normalize(vViewPosition)) < -0.06;
        if (inner) normal = -normal;
        vec3 nonPerturbedNormal = normal;`)
      .replace('#include <opaque_fragment>', /* glsl */ `
        if (inner) outgoingLight *= vec3(0.8, 0.72, 0.67);
        #include <opaque_fragment>`);
  };
  return material;
}

/**
 * Points as round dots whose size follows the distance. With oriented normals they are shaded, and those on
 * the far side fade into the background; without, the depth pass (eye-dome.js) gives them shape. Colours go
 * through as the sRGB values that they are.
 * @param {{ colored: boolean, shaded: boolean, diameter: number }} options  diameter in the viewer's frame
 */
export function pointMaterial({ colored, shaded, diameter }) {
  return new ShaderMaterial({
    defines: { ...(colored && { COLORED: '' }), ...(shaded && { SHADED: '' }) },
    uniforms: {
      tint: { value: new Color() },
      background: { value: new Color() },
      diameter: { value: diameter },
      pixelsPerUnit: { value: 1 },
      smallest: { value: 1 },
    },
    vertexShader: /* glsl */ `
      uniform vec3 tint, background;
      uniform float diameter, pixelsPerUnit, smallest;
      varying vec3 shown;
      varying float near;
      #ifdef COLORED
        attribute vec3 color;
      #endif
      void main() {
        vec4 eye = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * eye;
        gl_PointSize = clamp(diameter * pixelsPerUnit / -eye.z, smallest, 96.0);
        #ifdef COLORED
          shown = color;
        #else
          shown = tint;
        #endif
        near = 1.0;
        #ifdef SHADED
          vec3 n = normalize(normalMatrix * normal);
          float light = 0.5 + 0.5 * dot(n, normalize(vec3(-0.45, 0.75, 0.55)));
          float facing = dot(n, normalize(-eye.xyz));
          near = smoothstep(-0.15, 0.1, facing);
          shown = mix(mix(shown, background, 0.88), shown * (0.5 + 0.65 * light), near);
          gl_PointSize *= 0.65 + 0.35 * near;
        #endif
      }`,
    fragmentShader: /* glsl */ `
      varying vec3 shown;
      varying float near;
      void main() {
        vec2 offset = gl_PointCoord - 0.5;
        if (dot(offset, offset) > 0.25) discard;
        gl_FragColor = vec4(shown, 0.5 + 0.5 * near); // how much the depth pass may darken it
      }`,
  });
}
