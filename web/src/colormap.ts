// Colors of fields: viridis, as matplotlib has it (CC0), by 17 of its colors, and distinct hues for labels.
import * as THREE from "three";

// prettier-ignore
const VIRIDIS = [
  [68, 1, 84], [72, 24, 106], [71, 45, 123], [66, 64, 134], [59, 82, 139], [51, 99, 141], [44, 114, 142], [38, 130, 142],
  [33, 145, 140], [31, 160, 136], [40, 174, 128], [63, 188, 115], [94, 201, 98], [132, 212, 75], [173, 220, 48], [216, 226, 25], [253, 231, 37],
] as const;

export const MAP_SIZE = 256;

export function viridis(x: number): [number, number, number] {
  const at = Math.min(Math.max(x, 0), 1) * (VIRIDIS.length - 1);
  const low = VIRIDIS[Math.min(Math.floor(at), VIRIDIS.length - 2)] ?? VIRIDIS[0];
  const high = VIRIDIS[Math.min(Math.floor(at) + 1, VIRIDIS.length - 1)] ?? VIRIDIS[0];
  const t = at - Math.min(Math.floor(at), VIRIDIS.length - 2);
  return [0, 1, 2].map((k) => (low[k] ?? 0) * (1 - t) + (high[k] ?? 0) * t) as [number, number, number];
}

/// A texture whose lookup gives linear colors.
export function mapTexture(): THREE.DataTexture {
  const bytes = new Uint8Array(4 * MAP_SIZE);
  for (let i = 0; i < MAP_SIZE; ++i) bytes.set([...viridis(i / (MAP_SIZE - 1)), 255], 4 * i);
  const texture = new THREE.DataTexture(bytes, MAP_SIZE, 1, THREE.RGBAFormat);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.minFilter = texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

export function cssGradient(): string {
  const stops = VIRIDIS.map(([r, g, b], i) => `rgb(${r} ${g} ${b}) ${(100 * i) / (VIRIDIS.length - 1)}%`);
  return `linear-gradient(to right, ${stops.join(", ")})`;
}
