// From where a frame is looked at, and from how far.
import { Films, Frame } from "./decode";

export type Vector = [number, number, number];

/// Axes of the picture in the world, unit lengths. `back` points to the eye.
export interface Axes {
  right: Vector;
  up: Vector;
  back: Vector;
}

const RADIANS = Math.PI / 180;

function axesFrom(azimuth: number, elevation: number): Axes {
  const [c, s, ce, se] = [Math.cos(azimuth * RADIANS), Math.sin(azimuth * RADIANS), Math.cos(elevation * RADIANS), Math.sin(elevation * RADIANS)];
  return { right: [-s, c, 0], up: [-se * c, -se * s, ce], back: [ce * c, ce * s, se] };
}

/// The normal of films that all lie in one plane; null for others.
function commonNormal(films: Films): Vector | null {
  const [x, y, z] = [0, 1, 2].map((k) => films.normal[k]! / 32767) as Vector;
  for (let i = 0; i < films.normal.length; i += 4)
    if (Math.abs(x * films.normal[i]! + y * films.normal[i + 1]! + z * films.normal[i + 2]!) < 0.998 * 32767) return null;
  return [x, y, z];
}

/// From the front, a little from the side and above, z upwards. What is flat and two-dimensional from straight above, y upwards; a
/// film in a plane, which would be seen from its edge, so that one looks on it. As pictures have it (src/lamella/render/camera.h).
export function usualAxes(frame: Frame): Axes {
  if (frame.box?.dimension === 2) return { right: [1, 0, 0], up: [0, 1, 0], back: [0, 0, 1] };
  const [azimuth, elevation, oblique] = [-62, 16, 40];
  const normal = frame.films && !frame.points?.radius ? commonNormal(frame.films) : null;
  if (!normal) return axesFrom(azimuth, elevation);
  if (Math.abs(normal[2]) > 0.7) return axesFrom(-90, 58);
  const apart = Math.atan2(normal[1], normal[0]) / RADIANS - azimuth;
  const turned = apart - 180 * Math.round(apart / 180);
  return axesFrom(Math.abs(turned) > oblique ? azimuth + turned - Math.sign(turned) * oblique : azimuth, elevation);
}

const dot = (a: Vector, x: number, y: number, z: number): number => a[0] * x + a[1] * y + a[2] * z;

/// How far from `center` the eye must be to see all of the frame: films, balls and solids with their radius, the box. `wide`, `tall`:
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
  const solids = frame.solids?.position ?? [];
  for (let i = 0; i < solids.length; i += 3) include(solids[i]!, solids[i + 1]!, solids[i + 2]!, frame.solids?.radius[i / 3] ?? 0);
  const box = frame.box;
  for (let corner = 0; box && corner < 8; ++corner) {
    const [x, y, z] = box.origin.map((o, k) => o + ((corner >> k) & 1) * (box.lengths[k] ?? 0)) as Vector;
    include(x, y, z, 0);
  }
  return distance;
}
