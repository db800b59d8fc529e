// Films that let light through are drawn from the farthest to the nearest.

const DEPTHS = 4096; // that triangles are sorted into

/// Writes the triangles `corners` (three numbers each) into `sorted`, the farthest in direction `forward` first. `middles`:
/// three coordinates a triangle. A counting sort: triangles of nearly the same depth stay as they are.
export function farthestFirst(corners: Uint32Array, middles: Float32Array, forward: { x: number; y: number; z: number }, sorted: Uint32Array): void {
  const count = middles.length / 3;
  const depth = new Float32Array(count);
  let low = Infinity;
  let high = -Infinity;
  for (let i = 0; i < count; ++i) {
    depth[i] = forward.x * middles[3 * i]! + forward.y * middles[3 * i + 1]! + forward.z * middles[3 * i + 2]!;
    const d = depth[i]!; // as it is kept: rounding may not carry it beyond the ends
    if (d < low) low = d;
    if (d > high) high = d;
  }
  const scale = (DEPTHS - 1) / Math.max(high - low, 1e-30);
  const bucket = (i: number): number => Math.min(DEPTHS - 1, Math.floor((high - depth[i]!) * scale));
  const starts = new Uint32Array(DEPTHS + 1);
  for (let i = 0; i < count; ++i) ++starts[bucket(i) + 1]!;
  for (let b = 0; b < DEPTHS; ++b) starts[b + 1]! += starts[b]!;
  for (let i = 0; i < count; ++i) {
    const at = 3 * starts[bucket(i)]!++;
    for (let k = 0; k < 3; ++k) sorted[at + k] = corners[3 * i + k]!;
  }
}
