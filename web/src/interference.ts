// What films reflect, as the optics layer's table has it, for shaders.
import * as THREE from "three";
import { ColorTable } from "./decode";

/// A film reflects a few percent of the light: where its color is shown without its reflections, it is this much brighter.
export const BRIGHTER = 9;

/// GLSL: reflected(nm, cosine) is what a film of this thickness reflects of white light, linear sRGB. The table's nodes are at
/// the centers of texels.
export const REFLECTED = /* glsl */ `
uniform sampler2D thin;         // thickness x cosine
uniform sampler2D thick;        // 1 x cosine
uniform vec2 tableSize;
uniform float maxThickness;     // of the table [nm]
uniform float index;            // refractive
vec3 reflected(float nm, float cosine) {
  float counted = max(nm, 0.0) * sqrt(1.0 - (1.0 - cosine * cosine) / (index * index)) / maxThickness;
  float row = (sqrt(cosine) * (tableSize.y - 1.0) + 0.5) / tableSize.y;
  if (counted > 1.0) return texture2D(thick, vec2(0.5, row)).rgb;
  return texture2D(thin, vec2((sqrt(counted) * (tableSize.x - 1.0) + 0.5) / tableSize.x, row)).rgb;
}
bool unknown(float x) { return !(x >= -3.0e38 && x <= 3.0e38); }
`;

function halfTexture(values: Float32Array, width: number, height: number): THREE.DataTexture {
  const halves = new Uint16Array(4 * width * height);
  for (let i = 0; i < width * height; ++i)
    for (let k = 0; k < 4; ++k) halves[4 * i + k] = THREE.DataUtils.toHalfFloat(k < 3 ? (values[3 * i + k] ?? 0) : 1);
  const texture = new THREE.DataTexture(halves, width, height, THREE.RGBAFormat, THREE.HalfFloatType);
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/// The uniforms of REFLECTED.
export function reflectedUniforms(table: ColorTable): Record<string, THREE.IUniform> {
  return {
    thin: { value: halfTexture(table.thin, table.thicknesses, table.cosines) },
    thick: { value: halfTexture(table.thick, 1, table.cosines) },
    tableSize: { value: new THREE.Vector2(table.thicknesses, table.cosines) },
    maxThickness: { value: table.maxThickness },
    index: { value: table.index },
  };
}
