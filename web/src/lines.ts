// Plateau borders and wires: one thin tube a segment, instanced.
import * as THREE from "three";
import { STUDIO } from "./studio";

const VERTEX = /* glsl */ `
attribute vec3 start;
attribute vec3 end;
uniform float radius;
varying vec3 vWorld;
varying vec3 vNormal;
void main() {
  vec3 axis = end - start;
  vec3 z = normalize(axis + vec3(0.0, 0.0, 1e-20));
  vec3 x = normalize(cross(abs(z.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), z));
  vec3 y = cross(z, x);
  vNormal = x * position.x + y * position.y;
  // Half a radius longer at both ends, so that no gap opens where two tubes meet at an angle.
  vWorld = start + axis * position.z + z * radius * (position.z - 0.5) + radius * vNormal;
  gl_Position = projectionMatrix * viewMatrix * vec4(vWorld, 1.0);
}
`;

const FRAGMENT = /* glsl */ `
uniform vec4 clip;
uniform vec3 tint;
uniform float gloss;
varying vec3 vWorld;
varying vec3 vNormal;
${STUDIO}
void main() {
  if (dot(vWorld, clip.xyz) > clip.w) discard;
  vec3 toEye = normalize(cameraPosition - vWorld);
  vec3 n = normalize(vNormal);
  float cosine = clamp(dot(n, toEye), 0.0, 1.0);
  float edge = pow(1.0 - cosine, 3.0);
  // The window in a thin tube is smaller than a pixel: as bright as it is, it would only sparkle.
  vec3 room = min(studio(mat3(viewMatrix) * reflect(-toEye, n)), vec3(2.5));
  vec3 light = tint * (0.25 + 0.25 * (mat3(viewMatrix) * n).y) + gloss * (0.15 + edge) * room * tint;
  gl_FragColor = vec4(light, 1.0);
}
`;

const SIDES = 8;

export class Tubes {
  readonly object: THREE.Mesh<THREE.InstancedBufferGeometry, THREE.ShaderMaterial>;

  constructor(tint: THREE.Color, gloss: number, clip: THREE.Vector4) {
    const material = new THREE.ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: THREE.DoubleSide,
      uniforms: { radius: { value: 1 }, clip: { value: clip }, tint: { value: tint }, gloss: { value: gloss } },
    });
    this.object = new THREE.Mesh(new THREE.InstancedBufferGeometry(), material);
    this.object.frustumCulled = false;
  }

  show(segments: Float32Array | null, radius: number): void {
    this.object.geometry.dispose();
    this.object.visible = segments !== null && segments.length > 0;
    if (!segments || segments.length === 0) return;
    const geometry = new THREE.InstancedBufferGeometry();
    const tube: number[] = [];
    const corners: number[] = [];
    for (let i = 0; i < SIDES; ++i) {
      const angle = (2 * Math.PI * i) / SIDES;
      for (const z of [0, 1]) tube.push(Math.cos(angle), Math.sin(angle), z);
      const [a, b, c, d] = [2 * i, 2 * i + 1, (2 * i + 2) % (2 * SIDES), (2 * i + 3) % (2 * SIDES)];
      corners.push(a, c, b, b, c, d);
    }
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(tube, 3));
    geometry.setIndex(corners);
    const ends = new THREE.InstancedInterleavedBuffer(segments, 6);
    geometry.setAttribute("start", new THREE.InterleavedBufferAttribute(ends, 3, 0));
    geometry.setAttribute("end", new THREE.InterleavedBufferAttribute(ends, 3, 3));
    geometry.instanceCount = segments.length / 6;
    this.object.geometry = geometry;
    const uniform = this.object.material.uniforms["radius"];
    if (uniform) uniform.value = radius;
  }
}
