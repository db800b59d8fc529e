// What the colors mean.
import { cssGradient } from "./colormap";
import { ColorTable, headOn } from "./decode";
import { Range } from "./field";
import { BRIGHTER } from "./interference";
import { nameText, numberText, quantityText, unitText } from "./words";

const encode = (x: number): number => Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));

/// The thickest film of the scale [nm]; beyond, colors are faint.
const SCALE_END = 1500;
const SCALE_PIXELS = 600;

/// A strip of what films of 0 to SCALE_END reflect head-on.
export function thicknessStrip(table: ColorTable): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = SCALE_PIXELS;
  canvas.height = 1;
  canvas.className = "strip";
  const context = canvas.getContext("2d");
  if (!context) return canvas;
  const pixels = context.createImageData(SCALE_PIXELS, 1);
  for (let i = 0; i < SCALE_PIXELS; ++i) {
    const color = headOn(table, (SCALE_END * i) / (SCALE_PIXELS - 1)).map((c) => BRIGHTER * c);
    const gray = 0.2126 * color[0]! + 0.7152 * color[1]! + 0.0722 * color[2]!;
    const lowest = Math.min(...color);
    const highest = Math.max(...color);
    let keep = 1;
    if (lowest < 0) keep = Math.min(keep, gray / (gray - lowest));
    if (highest > 1) keep = Math.min(keep, (1 - gray) / (highest - gray));
    for (let k = 0; k < 3; ++k) pixels.data[4 * i + k] = encode(Math.min(Math.max(gray + keep * (color[k]! - gray), 0), 1));
    pixels.data[4 * i + 3] = 255;
  }
  context.putImageData(pixels, 0, 0);
  return canvas;
}

function line(className: string, ...content: (string | HTMLElement)[]): HTMLElement {
  const element = document.createElement("div");
  element.className = className;
  element.append(...content);
  return element;
}

const span = (text: string): HTMLElement => {
  const element = document.createElement("span");
  element.textContent = text;
  return element;
};

export function filmLegend(place: HTMLElement, strip: HTMLElement, shown: Range): void {
  const mark = document.createElement("i");
  const percent = (nm: number): number => 100 * Math.min(nm / SCALE_END, 1);
  mark.style.left = `calc(${percent(shown.low)}% - 1px)`;
  mark.style.width = `${percent(shown.high) - percent(shown.low)}%`;
  const text = shown.high - shown.low < 0.5 ? numberText(shown.low, 3) : `${numberText(shown.low, 3)} – ${numberText(shown.high, 3)}`;
  place.replaceChildren(
    line("name", `Film thickness ${text} nm`),
    strip,
    line("mark", mark),
    line("ticks", span("0"), span(`${SCALE_END / 2}`), span(`${SCALE_END} nm`)),
  );
}

export function fieldLegend(place: HTMLElement, name: string, unit: string, components: number, range: Range | null): void {
  const what = components > 1 ? `${nameText(name)} (magnitude)` : nameText(name);
  if (!range) {
    place.replaceChildren(line("name", `${what}: unknown everywhere`));
    return;
  }
  const strip = line("strip");
  strip.style.background = cssGradient();
  const middle = 0.5 * (range.low + range.high);
  const head = unitText(unit) === "" ? what : `${what} [${unitText(unit)}]`;
  place.replaceChildren(line("name", head), strip, line("ticks", span(numberText(range.low)), span(numberText(middle)), span(quantityText(range.high, unit))));
}
