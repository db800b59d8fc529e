// What lies under the pointer.
import { Films, Points } from "./decode";

export interface Ray {
  origin: [number, number, number];
  direction: [number, number, number]; // unit length
}

/// A plane: what has dot(position, normal) > offset is cut away.
export type Plane = [number, number, number, number];

const isCut = (x: number, y: number, z: number, plane: Plane): boolean => plane[0] * x + plane[1] * y + plane[2] * z > plane[3];

/// Distance along the ray to a triangle, or Infinity. [MollerTrumbore97]
function hitTriangle(p: Float32Array, a: number, b: number, c: number, ray: Ray): number {
  const [ox, oy, oz] = ray.origin;
  const [dx, dy, dz] = ray.direction;
  const ax = p[a]!, ay = p[a + 1]!, az = p[a + 2]!;
  const ux = p[b]! - ax, uy = p[b + 1]! - ay, uz = p[b + 2]! - az;
  const vx = p[c]! - ax, vy = p[c + 1]! - ay, vz = p[c + 2]! - az;
  const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx;
  const det = ux * px + uy * py + uz * pz;
  if (det === 0) return Infinity;
  const tx = ox - ax, ty = oy - ay, tz = oz - az;
  const s = (tx * px + ty * py + tz * pz) / det;
  if (s < 0 || s > 1) return Infinity;
  const qx = ty * uz - tz * uy, qy = tz * ux - tx * uz, qz = tx * uy - ty * ux;
  const t = (dx * qx + dy * qy + dz * qz) / det;
  if (t < 0 || s + t > 1) return Infinity;
  const distance = (vx * qx + vy * qy + vz * qz) / det;
  return distance > 0 ? distance : Infinity;
}

/// The bubble that a ray enters first; the one it leaves where there is none behind the film; 0 for no film at all.
export function pickRegion(films: Films, ray: Ray, plane: Plane): number {
  let nearest = Infinity;
  let region = 0;
  const p = films.position;
  for (let i = 0; i < films.corners.length; i += 3) {
    const first = films.corners[i]!;
    const distance = hitTriangle(p, 3 * first, 3 * films.corners[i + 1]!, 3 * films.corners[i + 2]!, ray);
    if (distance >= nearest) continue;
    const [x, y, z] = ray.origin.map((o, k) => o + distance * ray.direction[k]!) as [number, number, number];
    if (isCut(x, y, z, plane)) continue;
    nearest = distance;
    // The normal points into the second region.
    const facing = [0, 1, 2].reduce((sum, k) => sum + films.normal[4 * first + k]! * ray.direction[k]!, 0);
    const behind = films.regions[2 * first + (facing > 0 ? 1 : 0)]!;
    const before = films.regions[2 * first + (facing > 0 ? 0 : 1)]!;
    region = behind > 0 ? behind : before;
  }
  return region;
}

/// The ball that a ray meets first, or -1.
export function pickBall(points: Points, radius: Float32Array, ray: Ray, plane: Plane, flat: boolean): number {
  let nearest = Infinity;
  let picked = -1;
  for (let i = 0; i < radius.length; ++i) {
    const x = points.position[3 * i]!, y = points.position[3 * i + 1]!, z = points.position[3 * i + 2]!;
    if (isCut(x, y, z, plane)) continue;
    const r = radius[i]!;
    if (flat) {
      const t = (z - ray.origin[2]) / ray.direction[2];
      const dx = ray.origin[0] + t * ray.direction[0] - x, dy = ray.origin[1] + t * ray.direction[1] - y;
      const d = Math.hypot(dx, dy);
      if (d < r && d < nearest) (nearest = d), (picked = i);
      continue;
    }
    const cx = x - ray.origin[0], cy = y - ray.origin[1], cz = z - ray.origin[2];
    const along = cx * ray.direction[0] + cy * ray.direction[1] + cz * ray.direction[2];
    const half = r * r - (cx * cx + cy * cy + cz * cz - along * along);
    if (half <= 0) continue;
    const distance = along - Math.sqrt(half);
    if (distance > 0 && distance < nearest) (nearest = distance), (picked = i);
  }
  return picked;
}
