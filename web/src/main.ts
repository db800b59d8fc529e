// The page: joins the parts, and what people click, press and touch to them.
import { api, Region, State } from "./api";
import { Charts } from "./charts";
import { Frame } from "./decode";
import { carriesFilms, defaultColoring, fieldKey, FILM_COLORS, findField, hasFilms, magnitudes, Range, rangeOf, thicknessField } from "./field";
import { fieldLegend, filmLegend, thicknessStrip } from "./legend";
import { byId, dictionary, Message } from "./page";
import { Player } from "./player";
import { Look, Pick, Stage } from "./stage";
import { showProvenance, showText } from "./texts";
import { countText, nameText, numberText, quantityText } from "./words";
import "./page.css";

const PLAY = '<svg viewBox="0 0 16 16"><path d="M4 2.5 13.5 8 4 13.5z"/></svg>';
const PAUSE = '<svg viewBox="0 0 16 16"><path d="M3.5 2.5h3.2v11H3.5zm5.8 0h3.2v11H9.3z"/></svg>';
const NM = 1e9;
const LIVE_INTERVAL = 1000; // [ms]
const QUIET_INTERVAL = 5000;

const message = new Message(byId("message"));
const coloring = byId<HTMLSelectElement>("coloring");
const thickness = byId<HTMLInputElement>("thickness");
const opacity = byId<HTMLInputElement>("opacity");
const particles = byId<HTMLInputElement>("particles");
const hold = byId<HTMLInputElement>("hold");
const cutAxis = byId<HTMLSelectElement>("cut-axis");
const cut = byId<HTMLInputElement>("cut");
const scrub = byId<HTMLInputElement>("scrub");

let stage: Stage | null = null;
let strip: HTMLCanvasElement | null = null;
let state: State | null = null;
let frame: Frame | null = null;
let shownIndex = -1;
let range: Range | null = null; // of the colors
let picked: { kind: "region"; region: number } | { kind: "ball"; index: number; id: number | null } | null = null;
let following = false;

// ---- what is shown ----

function look(): Look {
  return { coloring: coloring.value, range, thicknessNm: Number(thickness.value), opacity: Number(opacity.value), particles: particles.checked };
}

/// Of the films' own thickness; of the slider's where they have none.
function thicknessRange(of: Frame): Range {
  const field = thicknessField(of, "vertices") ?? thicknessField(of, "points");
  const known = field ? rangeOf(field.values) : null;
  return known ? { low: NM * known.low, high: NM * known.high } : { low: Number(thickness.value), high: Number(thickness.value) };
}

/// Draws the frame in its colors, and says what they mean.
function redraw(): void {
  if (!frame) return;
  const field = findField(frame, coloring.value);
  const values = field ? magnitudes(field) : null;
  if (!hold.checked || !range) range = values ? rangeOf(values) : null;
  byId("thickness-row").hidden = field !== undefined || !frame.films || thicknessField(frame, "vertices") !== undefined;
  byId("opacity-row").hidden = !field || field.place === "points";
  byId("hold-row").hidden = !field;
  byId("particles-row").hidden = !carriesFilms(frame) || field?.place === "points"; // their field shows them
  byId("thickness-text").textContent = `${thickness.value}\u202fnm`;
  const legend = byId("legend");
  legend.hidden = !field && !hasFilms(frame);
  if (field) fieldLegend(legend, field.name, field.unit, field.components, range);
  else if (strip) filmLegend(legend, strip, thicknessRange(frame));
  stage?.show(frame, look());
  stage?.cut(cutAxis.value === "" ? null : (Number(cutAxis.value) as 0 | 1 | 2), Number(cut.value));
}

/// Films and the particles that carry them often have fields of one name.
function coloringText(of: Frame, key: string): string {
  const [place, name] = key.split(":");
  return nameText(name ?? key) + (place === "points" && carriesFilms(of) ? " of the particles" : "");
}

function offerColorings(of: Frame): void {
  const keys = [...(hasFilms(of) ? [FILM_COLORS] : []), ...of.fields.filter((f) => f.name !== "on_wire").map(fieldKey)];
  if (keys.join() === [...coloring.options].map((o) => o.value).join()) return;
  const before = coloring.value;
  coloring.replaceChildren(
    ...keys.map((key) => new Option(key === FILM_COLORS ? "film colors" : coloringText(of, key), key)),
  );
  coloring.value = keys.includes(before) ? before : defaultColoring(of);
}

function showNumbers(of: Frame): void {
  const rows: [string, string][] = [
    ["time", quantityText(of.time, of.timeUnit)],
    ["step", numberText(of.step)],
    ...of.scalars.map((s): [string, string] => [nameText(s.name), quantityText(s.value, s.unit)]),
  ];
  if (of.triangles.all > 0) rows.push(["triangles", countText(of.triangles.all)]);
  if (of.pointCount.all > 0) rows.push(["balls and particles", countText(of.pointCount.all)]);
  byId("numbers-text").replaceChildren(dictionary(rows));
}

/// What was left out so that the picture stays fluent is said.
function subtitle(of: Frame): string {
  const parts = [state?.solver ?? of.solver, state?.folder ?? ""];
  if (of.triangles.shown < of.triangles.all) parts.push(`${countText(of.triangles.shown)} of ${countText(of.triangles.all)} triangles shown`);
  if (of.pointCount.shown < of.pointCount.all) parts.push(`${countText(of.pointCount.shown)} of ${countText(of.pointCount.all)} points shown`);
  return parts.filter((p) => p !== "").join(" · ");
}

/// Films that come to rest do so at one time: first there is how they began, last how they are at rest.
const isRelaxation = (of: State): boolean => of.frame_times.length > 1 && of.frame_times[0] === of.frame_times[of.frame_times.length - 1];

function showTime(index: number, of: Frame): void {
  const text = byId("time");
  const strong = document.createElement("b");
  if (state && isRelaxation(state)) strong.textContent = index === 0 ? "the start" : `step ${countText(of.step)}`;
  else strong.textContent = of.timeUnit === "-" ? `time ${numberText(of.time)}` : quantityText(of.time, of.timeUnit);
  text.replaceChildren(strong, ` · frame ${index} of ${Math.max(player.count - 1, 0)}`);
  scrub.setAttribute("aria-valuetext", `${strong.textContent}, frame ${index}`);
}

const player = new Player(
  api.frame,
  (index, loaded) => {
    frame = loaded;
    shownIndex = index;
    document.body.dataset["frame"] = String(index);
    byId("waiting").hidden = true;
    for (const id of ["look", "picked", "numbers"]) byId(id).hidden = false; // they are about a frame
    message.clear("frame");
    offerColorings(loaded);
    redraw();
    showNumbers(loaded);
    scrub.value = String(index);
    showTime(index, loaded);
    byId("subtitle").textContent = subtitle(loaded);
    charts.setTime(loaded.time);
    void showPicked();
  },
  (index, error) => {
    byId("waiting").hidden = true;
    message.show("frame", `Frame ${index} cannot be shown: ${error.message}`);
  },
  (playing) => {
    byId("play").innerHTML = playing ? PAUSE : PLAY;
    byId("play").setAttribute("aria-label", playing ? "Pause" : "Play");
  },
);

function goTo(index: number): void {
  following = false;
  showFollowing();
  player.pause();
  scrub.value = String(index);
  void player.show(index);
}

const charts = new Charts(byId("chart-list"), (time) => {
  const times = state?.frame_times ?? [];
  let best = 0;
  times.forEach((t, i) => {
    if (Math.abs(t - time) < Math.abs((times[best] ?? 0) - time)) best = i;
  });
  goTo(best);
});

// ---- the bubble that was clicked ----

let regionsOf: { index: number; regions: Region[] } | null = null;

const idsOf = (of: Frame): Float32Array | undefined => of.fields.find((f) => f.place === "points" && f.name === "id")?.values;

/// Where the ball is among this frame's, or -1: balls that have ids are followed by them, others by their place in the list.
function ballOf(of: Frame, ball: { index: number; id: number | null }): number {
  const ids = idsOf(of);
  if (ids && ball.id !== null) return ids.indexOf(ball.id);
  return ball.index < (of.points?.position.length ?? 0) / 3 ? ball.index : -1;
}

async function showPicked(): Promise<void> {
  const place = byId("picked-text");
  const ball = picked?.kind === "ball" && frame ? ballOf(frame, picked) : -1;
  stage?.highlight(picked?.kind === "region" ? picked.region : 0, ball);
  if (!picked || !frame) {
    const hint = document.createElement("p");
    hint.className = "hint";
    hint.textContent = "Click or tap a bubble to see its size, pressure and neighbors.";
    place.replaceChildren(hint);
    return;
  }
  if (picked.kind === "ball") {
    if (ball < 0) {
      place.textContent = "This bubble is not there at this time.";
      return;
    }
    const rows = frame.fields
      .filter((f) => f.place === "points")
      .map((f): [string, string] => [nameText(f.name) + (f.components > 1 ? " (magnitude)" : ""), quantityText(magnitudes(f)[ball] ?? null, f.unit)]);
    place.replaceChildren(dictionary(rows));
    return;
  }
  if (player.playing) return; // too fast to read
  const wanted = picked.region;
  const index = shownIndex;
  try {
    if (regionsOf?.index !== index) regionsOf = { index, regions: await api.regions(index) };
  } catch (error) {
    message.show("regions", (error as Error).message);
    return;
  }
  if (shownIndex !== index || picked?.kind !== "region" || picked.region !== wanted) return;
  const region = regionsOf.regions.find((r) => r.id === wanted);
  if (!region) {
    place.textContent = `Region ${wanted} is not closed, so it has no volume.`;
    return;
  }
  const rows: [string, string][] = [
    ["bubble", String(region.id)],
    ["volume", quantityText(region.volume, "m^3")],
    ["pressure above the outside", quantityText(region.pressure, "Pa")],
    ["area of its films", quantityText(region.area, "m^2")],
    ...region.neighbors.map((n): [string, string] => [n.id === 0 ? "film to the outside" : `film to bubble ${n.id}`, quantityText(n.area, "m^2")]),
  ];
  place.replaceChildren(dictionary(rows));
}

// ---- the run ----

function showFollowing(): void {
  byId("live").setAttribute("aria-pressed", String(following));
}

function showRun(of: State): void {
  const going = of.state === "running" || of.state === "starting";
  const words = of.paused ? "The run is paused." : going ? "The run is going on." : of.state === "finished" ? `The run is finished: ${of.stop_reason}.` : `The run is ${of.state}${of.stop_reason ? `: ${of.stop_reason}` : ""}.`;
  byId("run").hidden = false;
  byId("run-state").textContent = words + (of.note ? ` (${of.note})` : "");
  byId("run-buttons").hidden = !(of.controlled && api.canControl);
  byId("run-pause").textContent = of.paused ? "Resume the run" : "Pause the run";
  byId("live").hidden = !going;
}

let failed = false;

async function poll(): Promise<void> {
  try {
    const before = state;
    const now = await api.state();
    if (failed) message.clear("server");
    failed = false;
    const first = before === null;
    const anew = !first && (now.frame_times.length < before.frame_times.length || now.frame_times[0] !== before.frame_times[0]);
    state = now;
    if (anew) player.clear();
    byId("title").textContent = now.title || now.folder;
    document.title = `${now.title || now.folder} · lamella`;
    showRun(now);
    player.count = now.frame_times.length;
    scrub.max = String(Math.max(player.count - 1, 0));
    const going = now.state === "running" || now.state === "starting";
    if (first) {
      following = going;
      showFollowing();
      byId<HTMLDetailsElement>("numbers").open = isRelaxation(now); // instead of charts
      if (now.thickness !== null) thickness.value = String(Math.round(NM * now.thickness));
      if (!going && player.count === 0) byId("waiting").textContent = "This run has written no frames.";
    }
    if (player.count > 0 && (first || anew)) void player.show(going || isRelaxation(now) ? player.count - 1 : 0);
    else if (following && !player.playing && player.count - 1 !== player.index) void player.show(player.count - 1);
    else if (player.count > 0 && shownIndex < 0 && first === false && !message.visible) void player.show(0);
    if (frame) showTime(shownIndex, frame);
    charts.add(await api.series(anew ? 0 : charts.rows));
    byId("charts").hidden = charts.rows === 0 || !charts.hasTime;
  } catch (error) {
    failed = true;
    message.show("server", (error as Error).message);
  }
  const going = state?.state === "running" || state?.state === "starting";
  window.setTimeout(() => void poll(), going ? LIVE_INTERVAL : QUIET_INTERVAL);
}

async function control(action: "pause" | "resume" | "stop"): Promise<void> {
  try {
    await api.control(action);
    state = await api.state();
    showRun(state);
  } catch (error) {
    message.show("control", (error as Error).message);
  }
}

// ---- what people do ----

async function savePicture(): Promise<void> {
  if (!stage) return;
  try {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(await stage.picture());
    link.download = `${state?.folder ?? "lamella"}-${String(Math.max(shownIndex, 0)).padStart(6, "0")}.png`;
    link.click();
    URL.revokeObjectURL(link.href);
  } catch (error) {
    message.show("picture", (error as Error).message);
  }
}

function setCut(axis: string): void {
  cutAxis.value = axis;
  cut.hidden = axis === "";
  redraw();
}

const keys: Record<string, () => void> = {
  " ": () => player.toggle(),
  ArrowLeft: () => goTo(player.index - 1),
  ArrowRight: () => goTo(player.index + 1),
  Home: () => goTo(0),
  End: () => goTo(player.count - 1),
  f: () => stage?.fit(),
  s: () => void savePicture(),
  c: () => setCut(cutAxis.value === "" ? "2" : ""),
  "?": () => byId<HTMLDialogElement>("keys").showModal(),
  Escape: () => {
    picked = null;
    void showPicked();
  },
};

function listen(): void {
  byId("play").innerHTML = PLAY;
  byId("play").addEventListener("click", () => player.toggle());
  byId("back").addEventListener("click", () => goTo(player.index - 1));
  byId("forward").addEventListener("click", () => goTo(player.index + 1));
  byId("fit").addEventListener("click", () => stage?.fit());
  byId("picture").addEventListener("click", () => void savePicture());
  byId("help").addEventListener("click", () => byId<HTMLDialogElement>("keys").showModal());
  byId("live").addEventListener("click", () => {
    following = !following;
    showFollowing();
    if (following) void player.show(player.count - 1);
  });
  scrub.addEventListener("input", () => goTo(Number(scrub.value)));
  coloring.addEventListener("change", () => {
    hold.checked = false;
    range = null;
    redraw();
  });
  for (const input of [thickness, opacity, cut]) input.addEventListener("input", redraw);
  for (const input of [hold, particles]) input.addEventListener("change", redraw);
  cutAxis.addEventListener("change", () => setCut(cutAxis.value));
  byId("run-pause").addEventListener("click", () => void control(state?.paused ? "resume" : "pause"));
  byId("run-stop").addEventListener("click", () => void control("stop"));
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || byId<HTMLDialogElement>("keys").open) return;
    const target = event.target as HTMLElement;
    if (target.closest("select, pre, summary, input[type=range]:not(#scrub)")) return;
    if (event.key === " " && target.closest("button, input")) return;
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
  listenToPicks();
  byId("scene").addEventListener("toggle", () => void showText("scene-text", api.scene));
  byId("provenance").addEventListener("toggle", () => void showProvenance());
}

/// A click is a press that did not move: what moves turns the view.
function listenToPicks(): void {
  const canvas = byId("view");
  let from: { x: number; y: number } | null = null;
  canvas.addEventListener("pointerdown", (event) => (from = event.isPrimary ? { x: event.clientX, y: event.clientY } : null));
  canvas.addEventListener("pointerup", (event) => {
    if (!from || Math.hypot(event.clientX - from.x, event.clientY - from.y) > 5) return;
    const hit: Pick = stage?.pick(event.clientX, event.clientY) ?? null;
    picked = hit?.kind === "ball" ? { ...hit, id: (frame && idsOf(frame)?.[hit.index]) ?? null } : hit;
    void showPicked();
  });
}

async function start(): Promise<void> {
  listen();
  try {
    const table = await api.colors();
    strip = thicknessStrip(table);
    stage = new Stage(byId<HTMLCanvasElement>("view"), table, () => message.show("picture", "The graphics card gave up the picture; load the page again."));
  } catch (error) {
    message.show("picture", (error as Error).message);
  }
  await poll();
}

void start();
