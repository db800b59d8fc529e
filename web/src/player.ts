// Which frame is shown: fetches frames, keeps the latest ones, plays and scrubs. Only the newest wish is fulfilled.
import { Frame } from "./decode";

const KEPT_BYTES = 256 * 1024 * 1024;
const FRAMES_PER_SECOND = 24;

export class Player {
  private readonly kept = new Map<number, Promise<Frame>>();
  private readonly sizes = new Map<number, number>();
  private wanted = 0;
  private timer = 0;
  count = 0;

  constructor(
    private readonly load: (index: number) => Promise<Frame>,
    private readonly onFrame: (index: number, frame: Frame) => void,
    private readonly onError: (index: number, error: Error) => void,
    private readonly onPlaying: (playing: boolean) => void,
  ) {}

  get index(): number {
    return this.wanted;
  }

  get playing(): boolean {
    return this.timer !== 0;
  }

  private fetch(index: number): Promise<Frame> {
    const known = this.kept.get(index);
    if (known) {
      this.kept.delete(index); // the order of the map is the order of use
      this.kept.set(index, known);
      return known;
    }
    const frame = this.load(index);
    this.kept.set(index, frame);
    frame.then(
      (loaded) => {
        this.sizes.set(index, loaded.bytes);
        this.forget();
      },
      () => this.kept.delete(index),
    );
    return frame;
  }

  private forget(): void {
    let bytes = 0;
    for (const size of this.sizes.values()) bytes += size;
    for (const index of this.kept.keys()) {
      if (bytes <= KEPT_BYTES) return;
      if (index === this.wanted || !this.sizes.has(index)) continue;
      bytes -= this.sizes.get(index) ?? 0;
      this.kept.delete(index);
      this.sizes.delete(index);
    }
  }

  /// The run began anew: what was kept is of another one.
  clear(): void {
    this.kept.clear();
    this.sizes.clear();
  }

  async show(index: number): Promise<void> {
    if (this.count === 0) return;
    this.wanted = Math.min(Math.max(index, 0), this.count - 1);
    const mine = this.wanted;
    try {
      const frame = await this.fetch(mine);
      if (mine !== this.wanted) return;
      this.onFrame(mine, frame);
      if (mine + 1 < this.count) this.fetch(mine + 1).catch(() => undefined); // said when it is wanted
    } catch (error) {
      if (mine === this.wanted) {
        this.pause();
        this.onError(mine, error as Error);
      }
    }
  }

  play(): void {
    if (this.playing || this.count < 2) return;
    if (this.wanted >= this.count - 1) this.wanted = -1;
    const step = async (): Promise<void> => {
      const began = performance.now();
      if (this.wanted >= this.count - 1) return this.pause();
      await this.show(this.wanted + 1);
      if (this.playing) this.timer = window.setTimeout(() => void step(), Math.max(0, 1000 / FRAMES_PER_SECOND - (performance.now() - began)));
    };
    this.timer = window.setTimeout(() => void step(), 0);
    this.onPlaying(true);
  }

  pause(): void {
    window.clearTimeout(this.timer);
    this.timer = 0;
    this.onPlaying(false);
  }

  toggle(): void {
    if (this.playing) this.pause();
    else this.play();
  }
}
