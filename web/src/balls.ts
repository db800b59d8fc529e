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
varying float vSmall;
uniform int picked;
uniform float focus;            // pixels per unit of length at distance 1
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
  vSmall = 0.0;
  if (!flat2d) {
    // The outline of a ball seen from near is larger than its radius.
    vec3 toEye = cameraPosition - center;
    float distance = length(toEye);
    vec3 z = toEye / distance;
    right = normalize(cross(abs(z.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), z));
    up = cross(z, right);
    float ratio = min(vRadius / distance, 0.95);
    vSmall = focus * ratio < SMALL ? 1.0 : 0.0;
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
uniform vec3 tint;              // where there are no values
uniform bool byField;
uniform bool byThickness;       // the values are [nm]
uniform vec2 depthOf;           // of the projection: depth from the distance along the view's axis
uniform vec3 forward;
varying vec2 vAt;
varying vec3 vWorld;
varying vec3 vCenter;
varying float vRadius;
varying float vValue;
varying float vPicked;
varying float vSmall;
${STUDIO}
${REFLECTED}

vec3 base() {
  if (!byField) return tint;
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
  vec3 light = color * (0.42 + 0.38 * up + 0.35 * cosine);
  // What a ball of a few pixels mirrors would only sparkle, and is most of the work.
  if (vSmall < 0.5) light += (0.025 + 0.22 * edge) * studio(mat3(viewMatrix) * reflect(ray, n));
  else light += (0.05 + 0.3 * edge) * (0.8 + 0.6 * up);
  light += vPicked * (0.08 + 0.9 * smoothstep(0.55, 0.25, cosine));
  gl_FragColor = vec4(light, 1.0);
  float far = dot(hit - cameraPosition, forward);
  gl_FragDepth = 0.5 + 0.5 * (depthOf.y / far - depthOf.x);
}
`;

const WIDTH = 1024; // of the textures
const SMALL = 9; // [px]: radius below which balls mirror no room

function dataTexture(values: Float32Array<ArrayBuffer>, height: number, format: THREE.PixelFormat): THREE.DataTexture {
  const texture = new THREE.DataTexture(values, WIDTH, height, format, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}

export class Balls {
  readonly object: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>;

  constructor(tint: THREE.Color, reflected: Record<string, THREE.IUniform>, map: THREE.Texture, clip: THREE.Vector4) {
    const material = new THREE.ShaderMaterial({
      defines: { WIDTH, SMALL: SMALL.toFixed(1) },
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
        tint: { value: tint },
        byField: { value: false },
        byThickness: { value: false },
        picked: { value: -1 },
        clip: { value: clip },
        map: { value: map },
        range: { value: new THREE.Vector2(0, 1) },
        depthOf: { value: new THREE.Vector2() },
        forward: { value: new THREE.Vector3() },
        focus: { value: 1 },
      },
    });
    this.object = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 1;
    this.object.onBeforeRender = (renderer, _scene, camera) => {
      const projection = camera.projectionMatrix.elements;
      const height = renderer.getRenderTarget()?.height ?? 1;
      material.uniforms["depthOf"]!.value.set(projection[10], projection[14]);
      material.uniforms["focus"]!.value = 0.5 * height * projection[5]!;
      camera.getWorldDirection(material.uniforms["forward"]!.value as THREE.Vector3);
      material.uniformsNeedUpdate = true;
    };
  }

  private count = -1;
  private isWhole = true; // all balls are drawn

  /// Two triangles a ball; the number of a corner says whose it is and which.
  private setCount(count: number): void {
    this.count = count;
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry();
    this.object.geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(6 * count), 1));
    this.isWhole = false;
    this.choose(null);
  }

  /// Draws only these, in this order; null: all.
  choose(balls: Uint32Array | null): void {
    const index = this.object.geometry.index;
    if (!index || (balls === null && this.isWhole)) return;
    const corners = index.array as Uint32Array;
    const count = balls?.length ?? this.count;
    for (let i = 0; i < count; ++i) {
      const first = 4 * (balls ? balls[i]! : i);
      const at = 6 * i;
      corners[at] = corners[at + 3] = first;
      corners[at + 1] = first + 1;
      corners[at + 2] = corners[at + 4] = first + 3;
      corners[at + 5] = first + 2;
    }
    index.addUpdateRange(0, 6 * count); // the rest need not travel
    index.needsUpdate = true;
    this.object.geometry.setDrawRange(0, 6 * count);
    this.isWhole = balls === null;
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
