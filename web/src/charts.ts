// The series over time, with a line at the time that is shown; a click goes to the frame that is nearest.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { SeriesPart } from "./api";
import { nameText, tickTexts, unitText } from "./words";

const FAVORITES = ["energy", "mean_radius", "energy_kinetic", "energy_surface", "surface_energy", "total_area", "bubbles", "volume_error"];
const CHARTS = 2;
const HEIGHT = 126;
const COLORS = ["#8fc7e8", "#f0b775"];

export class Charts {
  private columns: SeriesPart["columns"] = [];
  private data: (number | null)[][] = []; // per column
  private readonly plots: { select: HTMLSelectElement; place: HTMLElement; caption: HTMLElement; plot: uPlot | null; color: string }[] = [];
  private time = 0;

  constructor(list: HTMLElement, private readonly onTime: (time: number) => void) {
    for (let i = 0; i < CHARTS; ++i) {
      const block = document.createElement("div");
      block.className = "chart";
      const select = document.createElement("select");
      select.setAttribute("aria-label", `What chart ${i + 1} shows`);
      const place = document.createElement("div");
      const caption = document.createElement("div");
      caption.className = "caption";
      block.append(select, caption, place);
      list.append(block);
      const chart = { select, place, caption, plot: null, color: COLORS[i] ?? "#fff" };
      this.plots.push(chart);
      select.addEventListener("change", () => this.rebuild());
    }
    new ResizeObserver(() => {
      if (this.plots.some(({ plot }) => plot === null)) this.rebuild(); // there was no room for them before
      for (const { plot, place } of this.plots) if (plot && place.clientWidth > 0) plot.setSize({ width: place.clientWidth, height: HEIGHT });
    }).observe(list);
  }

  get rows(): number {
    return this.data[0]?.length ?? 0;
  }

  /// Whether there is anything to be seen over time: a relaxation has its start and its end at the same time.
  get hasTime(): boolean {
    const times = this.data[0] ?? [];
    return times.length === 1 || times[0] !== times[times.length - 1];
  }

  /// Rows of the server; those from `first` on are new. A run that was started anew has other rows: all are replaced.
  add(part: SeriesPart): void {
    const names = part.columns.map((c) => c.name).join();
    const isSame = names === this.columns.map((c) => c.name).join();
    if (isSame && part.rows.length === 0 && part.first === this.rows) return;
    if (!isSame) {
      this.columns = part.columns;
      this.offer();
    }
    this.data = part.columns.map((_, k) => [...(isSame ? (this.data[k] ?? []).slice(0, part.first) : []), ...part.rows.map((row) => row[k] ?? null)]);
    if (isSame && this.plots.every(({ plot }) => plot)) this.plots.forEach((chart) => chart.plot?.setData(this.values(chart.select)));
    else this.rebuild();
  }

  private offer(): void {
    const favorites = FAVORITES.map((name) => this.columns.findIndex((c) => c.name === name)).filter((k) => k > 0);
    this.plots.forEach(({ select }, i) => {
      select.replaceChildren(...this.columns.slice(1).map((column, k) => new Option(nameText(column.name), String(k + 1))));
      select.value = String(favorites[i] ?? Math.min(i + 1, this.columns.length - 1));
    });
  }

  private values(select: HTMLSelectElement): uPlot.AlignedData {
    const x = (this.data[0] ?? []) as number[];
    return [x, this.data[Number(select.value)] ?? []];
  }

  private rebuild(): void {
    for (const chart of this.plots) {
      chart.plot?.destroy();
      chart.plot = null;
      const column = this.columns[Number(chart.select.value)];
      const width = chart.place.clientWidth;
      if (!column || width === 0 || this.rows === 0) continue;
      const axis = { stroke: "#9aa4b5", grid: { stroke: "#232a36", width: 1 }, ticks: { show: false }, font: "11px system-ui" };
      chart.plot = new uPlot(
        {
          width,
          height: HEIGHT,
          cursor: { y: false, drag: { x: false, y: false }, sync: { key: "lamella" } },
          scales: { x: { time: false } },
          axes: [
            { ...axis, values: (_, ticks, _axis, _space, step) => tickTexts(ticks, step).texts, size: 26 },
            {
              ...axis,
              size: 58,
              space: 22,
              values: (_, ticks, _axis, _space, step) => {
                const { texts, factor } = tickTexts(ticks, step);
                chart.caption.textContent = [factor, unitText(column.unit)].filter((part) => part !== "").join(" ") || "\u00a0";
                return texts;
              },
            },
          ],
          series: [{}, { stroke: chart.color, width: 1.6, points: { show: this.rows < 30, size: 4 } }],
          hooks: { draw: [(plot) => this.drawTime(plot)] },
        },
        this.values(chart.select),
        chart.place,
      );
      const plot = chart.plot;
      plot.over.addEventListener("click", (event) => this.onTime(plot.posToVal(event.offsetX, "x")));
    }
  }

  private drawTime(plot: uPlot): void {
    const x = Math.round(plot.valToPos(this.time, "x", true));
    if (!Number.isFinite(x)) return;
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.strokeStyle = "#e6e9efb0";
    ctx.lineWidth = window.devicePixelRatio;
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  }

  setTime(time: number): void {
    this.time = time;
    for (const { plot } of this.plots) plot?.redraw(false);
  }
}
