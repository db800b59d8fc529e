// Balls, discs and particles: one square each that faces the eye, on which the fragment shader finds the ball, round at any
// distance. What differs from ball to ball lies in textures and the corners of the squares number themselves: a hundred
// thousand instances of a square are slow where there is no graphics card (3.5 s a picture with SwiftShader).
import * as THREE from "three";
import { Range } from "./field";
import { BRIGHTER, REFLECTED } from "./interference";
import { STUDIO } from "./studio";

const VERTEX = /* glsl */ `
uniform highp sampler2D balls;   // center, radius
uniform highp sampler2D values;
uniform bool flat2d;
uniform vec4 clip;
varying vec2 vAt;
varying vec3 vWorld;
varying vec3 vCenter;
varying float vRadius;
varying float vValue;
varying float vPicked;
uniform int picked;
void main() {
  int ball = gl_VertexID / 4;
  ivec2 texel = ivec2(ball % WIDTH, ball / WIDTH);
  vec4 its = texelFetch(balls, texel, 0);
  vec3 center = its.xyz;
  vec2 corner = vec2((gl_VertexID & 1) * 2 - 1, (gl_VertexID & 2) - 1);
  vPicked = ball == picked ? 1.0 : 0.0;
  vAt = corner;
  vCenter = center;
  vRadius = its.w;
  vValue = texelFetch(values, texel, 0).r;
  vec3 right = vec3(1.0, 0.0, 0.0);
  vec3 up = vec3(0.0, 1.0, 0.0);
  float reach = 1.0;
  if (!flat2d) {
    // The outline of a ball seen from near is larger than its radius.
    vec3 toEye = cameraPosition - center;
    float distance = length(toEye);
    vec3 z = toEye / distance;
    right = normalize(cross(abs(z.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), z));
    up = cross(z, right);
    float ratio = min(vRadius / distance, 0.95);
    reach = 1.0 / sqrt(1.0 - ratio * ratio);
  }
  vWorld = center + vRadius * reach * (right * corner.x + up * corner.y);
  gl_Position = projectionMatrix * viewMatrix * vec4(vWorld, 1.0);
  if (dot(center, clip.xyz) > clip.w) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // outside of what is drawn
}
`;

const FRAGMENT = /* glsl */ `
uniform sampler2D map;
uniform vec2 range;
uniform bool flat2d;
uniform bool byField;
uniform bool byThickness;       // the values are [nm]
uniform mat4 viewProjection;
varying vec2 vAt;
varying vec3 vWorld;
varying vec3 vCenter;
varying float vRadius;
varying float vValue;
varying float vPicked;
${STUDIO}
${REFLECTED}

vec3 base() {
  if (!byField) return vec3(0.35, 0.5, 0.6);
  if (unknown(vValue)) return vec3(0.12);
  if (byThickness) return ${BRIGHTER.toFixed(1)} * reflected(vValue, 1.0);
  float x = clamp((vValue - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0);
  return texture2D(map, vec2(x * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb;
}

void main() {
  vec3 color = base();
  if (flat2d) {
    float r = length(vAt);
    float soft = fwidth(r);
    float inside = 1.0 - smoothstep(1.0 - soft, 1.0, r);
    if (inside <= 0.0) discard;
    float rim = smoothstep(0.86 - soft, 0.96, r);
    vec3 edge = mix(color * 0.45, vec3(1.0), vPicked);
    gl_FragColor = vec4(mix(color, edge, rim) * inside, inside);
    gl_FragDepth = gl_FragCoord.z;
    return;
  }
  vec3 ray = normalize(vWorld - cameraPosition);
  vec3 toCenter = vCenter - cameraPosition;
  float along = dot(ray, toCenter);
  vec3 miss = toCenter - along * ray;
  float half2 = vRadius * vRadius - dot(miss, miss);
  if (half2 <= 0.0) discard;
  vec3 hit = cameraPosition + (along - sqrt(half2)) * ray;
  vec3 n = (hit - vCenter) / vRadius;
  float cosine = clamp(-dot(n, ray), 0.0, 1.0);
  float edge = pow(1.0 - cosine, 4.0);
  float up = (mat3(viewMatrix) * n).y;
  vec3 light = color * (0.42 + 0.38 * up + 0.35 * cosine) + (0.025 + 0.22 * edge) * studio(mat3(viewMatrix) * reflect(ray, n));
  light += vPicked * (0.08 + 0.9 * smoothstep(0.55, 0.25, cosine));
  gl_FragColor = vec4(light, 1.0);
  vec4 projected = viewProjection * vec4(hit, 1.0);
  gl_FragDepth = 0.5 + 0.5 * projected.z / projected.w;
}
`;

const WIDTH = 1024; // of the textures

function dataTexture(values: Float32Array<ArrayBuffer>, height: number, format: THREE.PixelFormat): THREE.DataTexture {
  const texture = new THREE.DataTexture(values, WIDTH, height, format, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}

export class Balls {
  readonly object: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>;
  private readonly viewProjection = new THREE.Matrix4();

  constructor(reflected: Record<string, THREE.IUniform>, map: THREE.Texture, clip: THREE.Vector4) {
    const material = new THREE.ShaderMaterial({
      defines: { WIDTH },
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: THREE.DoubleSide,
      blending: THREE.CustomBlending,
      blendSrc: THREE.OneFactor,
      blendDst: THREE.OneMinusSrcAlphaFactor,
      transparent: true,
      uniforms: {
        balls: { value: null },
        values: { value: null },
        flat2d: { value: false },
        ...reflected,
        byField: { value: false },
        byThickness: { value: false },
        picked: { value: -1 },
        clip: { value: clip },
        map: { value: map },
        range: { value: new THREE.Vector2(0, 1) },
        viewProjection: { value: this.viewProjection },
      },
    });
    this.object = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 1;
    this.object.onBeforeRender = (_renderer, _scene, camera) => {
      this.viewProjection.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
      material.uniformsNeedUpdate = true;
    };
  }

  private count = -1;

  /// Two triangles a ball; the number of a corner says whose it is and which.
  private setCount(count: number): void {
    this.count = count;
    const corners = new Uint32Array(6 * count);
    for (let i = 0; i < count; ++i) corners.set([4 * i, 4 * i + 1, 4 * i + 3, 4 * i, 4 * i + 3, 4 * i + 2], 6 * i);
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry();
    this.object.geometry.setIndex(new THREE.BufferAttribute(corners, 1));
  }

  pick(index: number): void {
    const uniform = this.object.material.uniforms["picked"];
    if (uniform) uniform.value = index;
  }

  /// Without a range the values are thicknesses of films [nm], in their colors.
  show(position: Float32Array | null, radius: Float32Array, values: Float32Array | null, range: Range | null, flat: boolean): void {
    const uniforms = this.object.material.uniforms;
    const set = (name: string, value: unknown): void => {
      const uniform = uniforms[name];
      if (uniform?.value instanceof THREE.Texture && uniform.value !== value && name !== "map") uniform.value.dispose();
      if (uniform) uniform.value = value;
    };
    this.object.visible = position !== null;
    if (!position) return;
    const count = radius.length;
    const height = Math.max(1, Math.ceil(count / WIDTH));
    const balls = new Float32Array(4 * WIDTH * height);
    for (let i = 0; i < count; ++i) {
      for (let k = 0; k < 3; ++k) balls[4 * i + k] = position[3 * i + k]!;
      balls[4 * i + 3] = radius[i]!;
    }
    const shown = new Float32Array(WIDTH * height);
    if (values) shown.set(values);
    set("balls", dataTexture(balls, height, THREE.RGBAFormat));
    set("values", dataTexture(shown, height, THREE.RedFormat));
    if (this.count !== count) this.setCount(count);
    set("flat2d", flat);
    set("byField", values !== null);
    set("byThickness", range === null);
    set("range", new THREE.Vector2(range?.low ?? 0, range?.high ?? 1));
  }
}
