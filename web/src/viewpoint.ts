// From where a frame is looked at, and from how far.
import { Frame } from "./decode";

export type Vector = [number, number, number];

/// Axes of the picture in the world, unit lengths. `back` points to the eye.
export interface Axes {
  right: Vector;
  up: Vector;
  back: Vector;
}

const AZIMUTH = (-62 * Math.PI) / 180;
const ELEVATION = (16 * Math.PI) / 180;

/// From the front, a little from the side and above, z upwards; flat frames from straight above, y upwards.
export function defaultAxes(flat: boolean): Axes {
  if (flat) return { right: [1, 0, 0], up: [0, 1, 0], back: [0, 0, 1] };
  const [c, s, ce, se] = [Math.cos(AZIMUTH), Math.sin(AZIMUTH), Math.cos(ELEVATION), Math.sin(ELEVATION)];
  return { right: [-s, c, 0], up: [-se * c, -se * s, ce], back: [ce * c, ce * s, se] };
}

const dot = (a: Vector, x: number, y: number, z: number): number => a[0] * x + a[1] * y + a[2] * z;

/// How far from `center` the eye must be to see all of the frame: films, balls with their radius, the box. `wide`, `tall`:
/// half of the picture at distance 1.
export function distanceToFit(frame: Frame, radius: Float32Array, center: Vector, axes: Axes, wide: number, tall: number): number {
  let distance = 0;
  const include = (px: number, py: number, pz: number, r: number): void => {
    const [x, y, z] = [px - center[0], py - center[1], pz - center[2]];
    const across = (Math.abs(dot(axes.right, x, y, z)) + r) / wide;
    const along = (Math.abs(dot(axes.up, x, y, z)) + r) / tall;
    distance = Math.max(distance, dot(axes.back, x, y, z) + r + Math.max(across, along));
  };
  const films = frame.films?.position ?? [];
  for (let i = 0; i < films.length; i += 3) include(films[i]!, films[i + 1]!, films[i + 2]!, 0);
  const points = frame.points?.position ?? [];
  for (let i = 0; i < points.length; i += 3) include(points[i]!, points[i + 1]!, points[i + 2]!, radius[i / 3] ?? 0);
  const box = frame.box;
  for (let corner = 0; box && corner < 8; ++corner) {
    const [x, y, z] = box.origin.map((o, k) => o + ((corner >> k) & 1) * (box.lengths[k] ?? 0)) as Vector;
    include(x, y, z, 0);
  }
  return distance;
}
