/** How a surface is painted: by elevation, slope, aspect, cut and fill or plain, with contours. */

import { Color, DataTexture, DoubleSide, LinearFilter, RGBAFormat, ShaderMaterial, SRGBColorSpace, Vector3 } from "three";

import type { Colors } from "./payload";

export const TINTS = ["elevation", "slope", "aspect", "difference", "plain", "ortho", "given"] as const;
export type Tint = (typeof TINTS)[number];

/** Light from the northwest at 45 degrees, as on printed maps. */
const LIGHT = new Vector3(-1, 1, Math.SQRT2).normalize();

const VERTEX = /* glsl */ `
attribute float change;
attribute vec3 given;
uniform float elevationScale;
varying vec3 ground;
varying vec3 lit;
varying float changed;
varying vec3 painted;
#include <common>
#include <logdepthbuf_pars_vertex>
void main() {
  ground = vec3(position.xy, position.z * elevationScale);
  changed = change;
  painted = given;
  lit = normal;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  #include <logdepthbuf_vertex>
}`;

const FRAGMENT = /* glsl */ `
uniform sampler2D ramp;
uniform int tint;
uniform vec2 range;
uniform float elevationScale;
uniform float interval;
uniform float base;
uniform vec3 light;
uniform vec3 plain;
uniform vec3 ink;
uniform float shading;
uniform sampler2D ortho;
uniform vec3 across;
uniform vec3 down;
varying vec3 ground;
varying vec3 lit;
varying float changed;
varying vec3 painted;
#include <common>
#include <logdepthbuf_pars_fragment>

// How much of the pixel a contour covers whose lines are this many steps apart.
float contour(float steps, float width) {
  float distance = abs(fract(steps + 0.5) - 0.5);
  float pixel = fwidth(steps);
  return pixel > 0.5 ? 0.0 : 1.0 - smoothstep(pixel * (width - 0.5), pixel * (width + 0.5), distance);
}

void main() {
  #include <logdepthbuf_fragment>
  vec3 face = normalize(cross(dFdx(ground), dFdy(ground)));
  if (face.z < 0.0) face = -face;
  float elevation = ground.z / elevationScale;
  float place;
  if (tint == 0 || tint == 5) place = (elevation - range.x) / (range.y - range.x);
  else if (tint == 1) place = degrees(acos(clamp(face.z, -1.0, 1.0))) / range.y;
  else if (tint == 2) place = fract(degrees(atan(face.x, face.y)) / 360.0);
  else if (tint == 3) place = 0.5 + 0.5 * changed / range.y;
  else place = 0.0;
  vec3 color = tint == 4 ? plain : tint == 6 ? painted : texture2D(ramp, vec2(clamp(place, 0.0, 1.0), 0.5)).rgb;
  float shade = max(dot(normalize(lit), light), 0.0) / light.z;
  float brightness = mix(1.0, mix(0.42, 1.0, clamp(shade, 0.0, 1.35)), shading);
  vec2 at = vec2(dot(across, vec3(ground.xy, 1.0)), dot(down, vec3(ground.xy, 1.0)));
  vec4 pixel = texture2D(ortho, at);
  if (tint == 5 && all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, vec2(1.0))))
    // A photograph has shadows of its own: the light adds half as much.
    color = mix(brightness * color, vec3(0.0), pixel.a) + mix(1.0, brightness, 0.5) * pixel.rgb;
  else color *= brightness;
  if (interval > 0.0) {
    float steps = (elevation + base) / interval;
    float line = max(0.75 * contour(steps, 0.6), contour(steps / 5.0, 1.1));
    color = mix(color, ink, 0.8 * line);
  }
  gl_FragColor = vec4(color, 1.0);
  #include <colorspace_fragment>
}`;

/** Return a row of colours as a texture. */
export function makeRamp(colors: string[]): DataTexture {
  const data = new Uint8Array(4 * colors.length);
  colors.forEach((text, k) => {
    const value = parseInt(text.slice(1), 16);
    data.set([value >> 16, (value >> 8) & 255, value & 255, 255], 4 * k);
  });
  const texture = new DataTexture(data, colors.length, 1, RGBAFormat);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = LinearFilter;
  texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

export function makeTerrainMaterial(elevationScale: number, colors: Colors, base: number): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side: DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    uniforms: {
      ramp: { value: null },
      tint: { value: 0 },
      range: { value: [0, 1] },
      elevationScale: { value: elevationScale },
      interval: { value: 0 },
      base: { value: base },
      light: { value: LIGHT },
      plain: { value: new Color(colors.plain) },
      ink: { value: new Color(colors.contours) },
      shading: { value: 1 },
      ortho: { value: null },
      across: { value: new Vector3() },
      down: { value: new Vector3() },
    },
  });
}
