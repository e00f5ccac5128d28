/** The materials of layers. */
import { Color, DoubleSide, LineBasicMaterial, MeshMatcapMaterial, ShaderMaterial, UniformsLib, UniformsUtils } from 'three';
import { studioMatcap } from './matcap.js';

/** What is known of a cloud's normals. @typedef {'none' | 'oriented' | 'unoriented'} Normals */

/**
 * A mesh: the studio's light, tinted by the theme or by colours of its own; where these are measured values, the light only hints
 * at the shape. Its inner side is darker and warmer, so that one sees which side is which. Triangles that only just turn away, as
 * at every outline, do not count as inner: they would be specks along the rim. It lies behind the edges that may be drawn on it.
 * @param {import('three').MeshMatcapMaterialParameters} [look]
 */
export function meshMaterial(look) {
  const material = new MeshMatcapMaterial({
    ...look, matcap: studioMatcap(), toneMapped: false, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
  });
  const measured = { value: 0 };
  material.userData.measured = measured;
  material.onBeforeCompile = (shader) => {
    shader.uniforms.measured = measured;
    // Those of `aoMap`, which a matcap has not by itself.
    Object.assign(shader.uniforms, UniformsUtils.clone(UniformsLib.aomap));
    shader.fragmentShader = shader.fragmentShader
      .replace('void main() {', /* glsl */ `
        uniform float measured;
        #include <aomap_pars_fragment>
        void main() {`)
      .replace('#include <normal_fragment_begin>', /* glsl */ `
        vec3 normal = normalize(vNormal);
        bool inner = !gl_FrontFacing && dot(normal, normalize(vViewPosition)) < -0.06;
        if (inner) normal = -normal;
        #ifdef USE_TANGENT
          mat3 tbn = mat3(normalize(vTangent), normalize(vBitangent), normal);
        #endif
        vec3 nonPerturbedNormal = normal;`)
      .replace('#include <opaque_fragment>', /* glsl */ `
        #ifdef USE_AOMAP
          outgoingLight *= texture2D(aoMap, vAoMapUv).r;
        #endif
        if (inner) outgoingLight *= vec3(0.8, 0.72, 0.67);
        float light = dot(matcapColor.rgb, vec3(0.2126, 0.7152, 0.0722));
        outgoingLight = mix(outgoingLight, diffuseColor.rgb * (0.78 + 0.3 * light), measured);
        #include <opaque_fragment>`);
  };
  return material;
}

/** Edges of triangles, thin over the surface. */
export function edgeMaterial() {
  return new LineBasicMaterial({ toneMapped: false, transparent: true, opacity: 0.42, depthWrite: false });
}

/** Boxes: opaque, as the depth pass of the clouds wants it. */
export function boxMaterial() {
  return new LineBasicMaterial({ toneMapped: false });
}

/**
 * Points as round dots whose size follows the distance. With normals they are shaded. Where those are oriented, points on the
 * far side are marked for the depth pass (eye-dome.js) to let the background through. Without normals that pass alone gives
 * them shape. Colours go through as the sRGB values that they are; `linear` ones, as in a GLB, are made so. Where they are measured
 * values, they are hardly shaded.
 * @param {{ colored: boolean, linear?: boolean, normals: Normals, diameter: number }} options diameter in the picture's frame
 */
export function pointMaterial({ colored, linear = false, normals, diameter }) {
  return new ShaderMaterial({
    clipping: true,
    defines: {
      ...(colored && { COLORED: '' }),
      ...(linear && { LINEAR: '' }),
      ...(normals !== 'none' && { SHADED: '' }),
      ...(normals === 'oriented' && { ORIENTED: '' }),
    },
    uniforms: {
      tint: { value: new Color() },
      diameter: { value: diameter },
      scale: { value: 1 },
      pixelsPerUnit: { value: 1 },
      smallest: { value: 1 },
      distance: { value: 1 },
      measured: { value: 0 },
    },
    vertexShader: /* glsl */ `
      uniform vec3 tint;
      uniform float diameter, scale, pixelsPerUnit, smallest, distance, measured;
      varying vec3 shown;
      varying float near;
      #include <clipping_planes_pars_vertex>
      #ifdef COLORED
        attribute vec3 color;
      #endif
      void main() {
        vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * mvPosition;
        #include <clipping_planes_vertex>
        bool parallel = projectionMatrix[3][3] == 1.0;
        gl_PointSize = scale * clamp(diameter * pixelsPerUnit / (parallel ? distance : -mvPosition.z), smallest, 96.0);
        #ifdef COLORED
          shown = color;
          #ifdef LINEAR
            shown = mix(12.92 * color, 1.055 * pow(color, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, color));
          #endif
        #else
          shown = tint;
        #endif
        near = 1.0;
        #ifdef SHADED
          vec3 n = normalize(normalMatrix * normal);
          float facing = dot(n, parallel ? vec3(0.0, 0.0, 1.0) : normalize(-mvPosition.xyz));
          #ifdef ORIENTED
            near = smoothstep(-0.15, 0.1, facing);
          #else
            n *= facing < 0.0 ? -1.0 : 1.0;
          #endif
          float light = 0.5 + 0.5 * dot(n, normalize(vec3(-0.45, 0.75, 0.55)));
          shown *= mix(0.8, mix(0.5 + 0.65 * light, 1.0, 0.8 * measured), near);
          gl_PointSize *= 0.65 + 0.35 * near;
        #endif
      }`,
    fragmentShader: /* glsl */ `
      varying vec3 shown;
      varying float near;
      #include <clipping_planes_pars_fragment>
      void main() {
        #include <clipping_planes_fragment>
        vec2 offset = gl_PointCoord - 0.5;
        if (dot(offset, offset) > 0.25) discard;
        gl_FragColor = vec4(shown, 0.5 + 0.5 * near);
      }`,
  });
}
