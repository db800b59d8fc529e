// Which balls can be seen at all: in a foam of a hundred thousand, all but a few thousand lie behind others. Where there is no
// graphics card, drawing those that nobody sees is what takes time.
import { Plane } from "./picking";
import { Vector } from "./viewpoint";

/// A camera without roll: unit axes in the world, `back` to the eye; `focus`: pixels per unit of length at distance 1.
export interface Eye {
  position: Vector;
  right: Vector;
  up: Vector;
  back: Vector;
  focus: number;
  width: number; // [px]
  height: number;
}

const DEPTHS = 4096; // that balls are sorted into
const FEW = 4; // cells that a ball of middling size covers from its middle to its rim
const GRID = 2048; // cells along a side, at most

/// How large balls look, the middle of some of them.
function middlingSize(radius: Float32Array, depth: Float32Array, focus: number): number {
  const step = Math.max(1, Math.floor(radius.length / 999));
  const sizes: number[] = [];
  for (let i = 0; i < radius.length; i += step) if (depth[i]! > 0) sizes.push((focus * radius[i]!) / depth[i]!);
  sizes.sort((a, b) => a - b);
  return sizes[Math.floor(sizes.length / 2)] ?? 1;
}

/// Numbers of the balls, those with the smallest depth first; a counting sort, balls of nearly the same depth as they come.
function nearestFirst(depth: Float32Array): Uint32Array {
  let low = Infinity;
  let high = -Infinity;
  for (const d of depth) {
    if (d < low) low = d;
    if (d > high) high = d;
  }
  const scale = (DEPTHS - 1) / Math.max(high - low, 1e-30);
  const bucket = (d: number): number => Math.min(DEPTHS - 1, Math.floor((d - low) * scale));
  const starts = new Uint32Array(DEPTHS + 1);
  for (const d of depth) ++starts[bucket(d) + 1]!;
  for (let b = 0; b < DEPTHS; ++b) starts[b + 1]! += starts[b]!;
  const order = new Uint32Array(depth.length);
  for (let i = 0; i < depth.length; ++i) order[starts[bucket(depth[i]!)]!++] = i;
  return order;
}

/// Depths of the nearest balls that fill the cells of a grid over the picture.
class Cover {
  private readonly across: number;
  private readonly down: number;
  private readonly nearest: Float32Array;

  constructor(private readonly eye: Eye, private readonly cell: number) {
    this.across = Math.ceil(eye.width / cell);
    this.down = Math.ceil(eye.height / cell);
    this.nearest = new Float32Array(this.across * this.down).fill(Infinity);
  }

  /// Whether a ball whose middle the eye sees at (x, y, z) lies behind others wherever it is seen, or beside the picture.
  hides(x: number, y: number, z: number, r: number): boolean {
    const { eye, cell, across, nearest } = this;
    // Around the outline of the ball, which is an ellipse.
    const scale = eye.focus / (z * z - r * r);
    const wide = r * Math.sqrt(x * x + z * z - r * r);
    const tall = r * Math.sqrt(y * y + z * z - r * r);
    const left = Math.max(0, Math.floor((0.5 * eye.width + scale * (x * z - wide)) / cell));
    const right = Math.min(across - 1, Math.floor((0.5 * eye.width + scale * (x * z + wide)) / cell));
    const bottom = Math.max(0, Math.floor((0.5 * eye.height + scale * (y * z - tall)) / cell));
    const top = Math.min(this.down - 1, Math.floor((0.5 * eye.height + scale * (y * z + tall)) / cell));
    for (let row = bottom; row <= top; ++row) {
      const end = row * across + right;
      for (let at = row * across + left; at <= end; ++at) if (nearest[at]! > z - r) return false;
    }
    return true;
  }

  /// Notes the cells in a circle well within the outline; all of the ball that is seen there is nearer than half a radius
  /// behind its middle.
  add(x: number, y: number, z: number, r: number): void {
    const { eye, cell, across, nearest } = this;
    const inner = (eye.focus * (r / z) * (1 - (2 * r) / z)) / cell;
    const px = (0.5 * eye.width + (eye.focus * x) / z) / cell;
    const py = (0.5 * eye.height + (eye.focus * y) / z) / cell;
    const behind = z + 0.5 * r;
    const top = Math.min(this.down, Math.floor(py + inner));
    for (let row = Math.max(0, Math.ceil(py - inner)); row < top; ++row) {
      const height = Math.max(Math.abs(row - py), Math.abs(row + 1 - py));
      if (height >= inner) continue;
      const half = Math.sqrt(inner * inner - height * height);
      const end = row * across + Math.min(across, Math.floor(px + half));
      for (let at = row * across + Math.max(0, Math.ceil(px - half)); at < end; ++at) if (behind < nearest[at]!) nearest[at] = behind;
    }
  }
}

/// The balls of which something may be seen, nearest first. Left out is what lies beyond the plane (which is not drawn), what lies
/// beside the picture, and what lies behind nearer balls everywhere.
export function seenBalls(center: Float32Array, radius: Float32Array, eye: Eye, plane: Plane): Uint32Array {
  const count = radius.length;
  const across = new Float32Array(count); // as the eye has it
  const up = new Float32Array(count);
  const depth = new Float32Array(count);
  const [ex, ey, ez] = eye.position;
  const [rx, ry, rz] = eye.right;
  const [ux, uy, uz] = eye.up;
  const [bx, by, bz] = eye.back;
  for (let i = 0; i < count; ++i) {
    const x = center[3 * i]! - ex;
    const y = center[3 * i + 1]! - ey;
    const z = center[3 * i + 2]! - ez;
    across[i] = rx * x + ry * y + rz * z;
    up[i] = ux * x + uy * y + uz * z;
    depth[i] = -(bx * x + by * y + bz * z);
  }
  const cell = Math.max(middlingSize(radius, depth, eye.focus) / FEW, Math.max(eye.width, eye.height) / GRID);
  const cover = new Cover(eye, cell);
  const [a, b, c, d] = plane;
  const seen = new Uint32Array(count);
  let found = 0;
  for (const i of nearestFirst(depth)) {
    const r = radius[i]!;
    const z = depth[i]!;
    if (z + r <= 0 || a * center[3 * i]! + b * center[3 * i + 1]! + c * center[3 * i + 2]! > d) continue;
    const isNear = z < 1.05 * r; // the eye is in it, or nearly
    if (!isNear && cover.hides(across[i]!, up[i]!, z, r)) continue;
    seen[found++] = i;
    if (!isNear) cover.add(across[i]!, up[i]!, z, r);
  }
  return seen.subarray(0, found);
}
