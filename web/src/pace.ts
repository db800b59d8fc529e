// How sharp a picture may be that moves: where drawing takes long (no graphics card, a hundred thousand balls), it is drawn
// with fewer pixels until it rests.

const SLOW = 60; // [ms] for one picture
const FAST = 22;
const SHARPNESS = [1, 0.7, 0.5, 0.35, 0.25]; // of width and height
const COARSEST = SHARPNESS.length - 1;
const REST = 300; // [ms] without motion

export class Pace {
  private level = 0;
  private lastMotion = 0;
  private isSharp = true;
  /// Whether any picture took long: then it is worth the while to look for what need not be drawn.
  isSlowHere = false;

  /// Called when there is time for a picture; how sharp to draw now, or null for not at all.
  next(now: number, changed: boolean): number | null {
    if (changed) {
      this.lastMotion = now;
      this.isSharp = this.level === 0;
      return SHARPNESS[this.level] ?? 1;
    }
    if (this.isSharp || now - this.lastMotion < REST) return null;
    this.isSharp = true;
    return 1;
  }

  /// What the last picture took [ms].
  drawn(cost: number, sharpness: number): void {
    if (cost > SLOW) this.isSlowHere = true;
    if (sharpness !== SHARPNESS[this.level]) return; // the sharp one after a motion says nothing about coarse ones
    if (cost > 4 * SLOW) this.level = COARSEST;
    else if (cost > SLOW) this.level = Math.min(this.level + 1, COARSEST);
    else if (cost < FAST) this.level = Math.max(this.level - 1, 0);
  }
}
