// How sharp a picture may be that moves: where drawing takes long (no graphics card, a hundred thousand balls), it is drawn
// with fewer pixels until it rests.

const SLOW = 60; // [ms] between two pictures
const FAST = 22;
const SHARPNESS = [1, 0.7, 0.5, 0.35, 0.25]; // of width and height
const REST = 300; // [ms] without motion

export class Pace {
  private interval = 0; // [ms] between pictures of a motion, smoothed
  private lastTick = 0;
  private lastMotion = 0;
  private moving = false; // at the last tick
  private level = 0;
  private isSharp = true;

  /// Called at every tick of the screen; how sharp to draw now, or null for not at all.
  next(now: number, changed: boolean): number | null {
    const wasMoving = this.moving;
    this.moving = changed;
    if (!changed) {
      this.lastTick = now;
      if (this.isSharp || now - this.lastMotion < REST) return null;
      this.isSharp = true;
      return 1;
    }
    if (wasMoving) this.adapt(now - this.lastTick);
    this.lastTick = this.lastMotion = now;
    const sharpness = wasMoving ? (SHARPNESS[this.level] ?? 1) : 1;
    this.isSharp = sharpness === 1;
    return sharpness;
  }

  private adapt(interval: number): void {
    this.interval = this.interval === 0 ? interval : 0.5 * this.interval + 0.5 * interval;
    const coarsest = SHARPNESS.length - 1;
    if (this.interval > 4 * SLOW && this.level < coarsest) this.level = coarsest;
    else if (this.interval > SLOW && this.level < coarsest) ++this.level;
    else if (this.interval < FAST && this.level > 0) --this.level;
    else return;
    this.interval = 0; // the next pictures tell anew
  }
}
