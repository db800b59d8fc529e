// The films: their interference colors times what they reflect, or a field.
import * as THREE from "three";
import { Films } from "./decode";
import { farthestFirst } from "./depth_order";
import { REFLECTED } from "./interference";
import { STUDIO } from "./studio";

const VERTEX = /* glsl */ `
attribute float value;
attribute vec2 regions;
varying vec3 vWorld;
varying vec3 vNormal;
varying float vValue;
varying float vPicked;
uniform float picked;
void main() {
  vWorld = position;
  vNormal = normal;
  vValue = value;
  vPicked = picked > 0.5 && (abs(regions.x - picked) < 0.5 || abs(regions.y - picked) < 0.5) ? 1.0 : 0.0;
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
}
`;

const FRAGMENT = /* glsl */ `
uniform bool byField;
uniform bool hasThickness;      // value is a thickness [nm]
uniform float thickness;        // where there is none [nm]
uniform sampler2D map;
uniform vec2 range;
uniform float opacity;
uniform vec4 clip;
varying vec3 vWorld;
varying vec3 vNormal;
varying float vValue;
varying float vPicked;
${STUDIO}
${REFLECTED}

void main() {
  if (dot(vWorld, clip.xyz) > clip.w) discard;
  vec3 toEye = normalize(cameraPosition - vWorld);
  vec3 n = normalize(vNormal);
  float cosine = dot(n, toEye);
  if (cosine < 0.0) { n = -n; cosine = -cosine; }
  if (byField) {
    float x = clamp((vValue - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0);
    vec3 color = unknown(vValue) ? vec3(0.12) : texture2D(map, vec2(x * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb;
    color = color * (0.7 + 0.3 * cosine) + vPicked * 0.12;
    gl_FragColor = vec4(color * opacity, opacity);
    return;
  }
  float nm = hasThickness && !unknown(vValue) ? vValue : thickness;
  vec3 r = reflected(nm, cosine);
  vec3 light = r * studio(mat3(viewMatrix) * reflect(-toEye, n)) + vPicked * vec3(0.05, 0.07, 0.10) * (1.2 - cosine);
  float covered = clamp(dot(r, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0);
  gl_FragColor = vec4(light, covered);
}
`;

function middles(films: Films): Float32Array {
  const result = new Float32Array(films.corners.length);
  for (let i = 0; i < result.length; i += 3)
    for (let c = 0; c < 3; ++c)
      for (let k = 0; k < 3; ++k) result[i + k]! += films.position[3 * films.corners[i + c]! + k]! / 3;
  return result;
}

export class FilmMesh {
  private middles: Float32Array = new Float32Array(0); // of the triangles
  private corners: Uint32Array = new Uint32Array(0); // of the triangles, in the frame's order
  readonly object: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>;

  constructor(reflected: Record<string, THREE.IUniform>, map: THREE.Texture, clip: THREE.Vector4) {
    const material = new THREE.ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: THREE.DoubleSide,
      transparent: true,
      depthWrite: false,
      // Premultiplied: what the film reflects is added, what it covers is taken away from what lies behind.
      blending: THREE.CustomBlending,
      blendSrc: THREE.OneFactor,
      blendDst: THREE.OneMinusSrcAlphaFactor,
      uniforms: {
        byField: { value: false },
        hasThickness: { value: false },
        thickness: { value: 400 },
        ...reflected,
        map: { value: map },
        range: { value: new THREE.Vector2(0, 1) },
        opacity: { value: 1 },
        clip: { value: clip },
        picked: { value: 0 },
      },
    });
    this.object = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 2;
  }

  private uniform(name: string): THREE.IUniform {
    const uniform = this.object.material.uniforms[name];
    if (!uniform) throw new Error(`no uniform ${name}`);
    return uniform;
  }

  /// Values of the triangles need vertices of their own for each triangle; those of the vertices, and none, do not.
  show(films: Films | null, values: Float32Array | null, perTriangle: boolean): void {
    this.object.geometry.dispose();
    const geometry = new THREE.BufferGeometry();
    this.object.geometry = geometry;
    this.object.visible = films !== null;
    if (!films) return;
    const vertices = films.position.length / 3;
    let shared: THREE.BufferGeometry = geometry;
    if (perTriangle) shared = new THREE.BufferGeometry();
    shared.setAttribute("position", new THREE.BufferAttribute(films.position, 3));
    const normals = new THREE.InterleavedBuffer(films.normal, 4);
    shared.setAttribute("normal", new THREE.InterleavedBufferAttribute(normals, 3, 0, true));
    shared.setAttribute("regions", new THREE.BufferAttribute(Float32Array.from(films.regions), 2));
    this.corners = films.corners;
    this.middles = middles(films);
    if (!perTriangle) {
      geometry.setIndex(new THREE.BufferAttribute(films.corners.slice(), 1));
      geometry.setAttribute("value", new THREE.BufferAttribute(values ?? new Float32Array(vertices), 1));
      return;
    }
    shared.setIndex(new THREE.BufferAttribute(films.corners, 1));
    const own = shared.toNonIndexed();
    this.corners = Uint32Array.from({ length: films.corners.length }, (_, i) => i);
    geometry.setIndex(new THREE.BufferAttribute(this.corners.slice(), 1));
    for (const name of ["position", "normal", "regions"]) geometry.setAttribute(name, own.getAttribute(name));
    const spread = new Float32Array(films.corners.length);
    for (let i = 0; i < spread.length; ++i) spread[i] = values?.[Math.floor(i / 3)] ?? 0;
    geometry.setAttribute("value", new THREE.BufferAttribute(spread, 1));
  }

  /// Films that let light through are drawn from the farthest to the nearest. `forward`: where the eye looks.
  sort(forward: THREE.Vector3): void {
    const index = this.object.geometry.index;
    if (!index || this.object.material.depthWrite) return;
    farthestFirst(this.corners, this.middles, forward, index.array as Uint32Array);
    index.needsUpdate = true;
  }

  colorByFilm(hasThickness: boolean, thicknessNm: number): void {
    this.uniform("byField").value = false;
    this.uniform("hasThickness").value = hasThickness;
    this.uniform("thickness").value = thicknessNm;
    this.object.material.depthWrite = false;
  }

  colorByField(low: number, high: number, opacity: number): void {
    this.uniform("byField").value = true;
    (this.uniform("range").value as THREE.Vector2).set(low, high);
    this.uniform("opacity").value = opacity;
    this.object.material.depthWrite = opacity >= 1;
  }

  pick(region: number): void {
    this.uniform("picked").value = region;
  }
}
