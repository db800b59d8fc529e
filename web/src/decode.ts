// Reads the binary messages of the server (apps/lamella/view/message.h). Everything is checked before it is used: what
// does not fit together throws a DecodeError that says what is wrong in words.

export class DecodeError extends Error {}

export type Values = Float32Array | Uint32Array | Int32Array | Int16Array;

export interface MessageArray {
  set: string;
  name: string;
  unit: string;
  components: number;
  count: number;
  values: Values;
}

export interface Message {
  header: Record<string, unknown>;
  arrays: MessageArray[];
}

const FORMAT = 1;
const INTRO_BYTES = 16;

function wrong(what: string): never {
  throw new DecodeError(`damaged data: ${what}`);
}

function isObject(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function whole(value: unknown, name: string): number {
  if (typeof value !== "number" || !Number.isSafeInteger(value) || value < 0) wrong(`${name} is no whole number`);
  return value;
}

function text(value: unknown, name: string): string {
  if (typeof value !== "string") wrong(`${name} is no text`);
  return value;
}

function view(type: string, buffer: ArrayBuffer, offset: number, length: number, room: number): Values {
  const bytes = type === "i16" ? 2 : 4;
  if (length * bytes > room) wrong("an array reaches beyond the end");
  if (offset % bytes !== 0) wrong("an array is not aligned");
  switch (type) {
    case "f32":
      return new Float32Array(buffer, offset, length);
    case "u32":
      return new Uint32Array(buffer, offset, length);
    case "i32":
      return new Int32Array(buffer, offset, length);
    case "i16":
      return new Int16Array(buffer, offset, length);
    default:
      return wrong(`unknown type ${type}`);
  }
}

export function decodeMessage(buffer: ArrayBuffer): Message {
  if (buffer.byteLength < INTRO_BYTES) wrong("it ends before it begins");
  const intro = new DataView(buffer);
  if (new TextDecoder().decode(new Uint8Array(buffer, 0, 4)) !== "LMLA") wrong("it is no message of lamella");
  const format = intro.getUint32(4, true);
  if (format !== FORMAT) wrong(`format ${format} is not known to this page`);
  const headerBytes = intro.getUint32(8, true);
  const dataBytes = intro.getUint32(12, true);
  const dataStart = INTRO_BYTES + headerBytes;
  if (dataStart + dataBytes !== buffer.byteLength) wrong(`${buffer.byteLength} bytes came instead of ${dataStart + dataBytes}`);

  let header: unknown;
  try {
    header = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(new Uint8Array(buffer, INTRO_BYTES, headerBytes)));
  } catch {
    wrong("its header cannot be read");
  }
  if (!isObject(header) || !Array.isArray(header["arrays"])) wrong("its header has no list of arrays");
  const arrays = header["arrays"].map((entry: unknown): MessageArray => {
    if (!isObject(entry)) wrong("an entry of the list of arrays is none");
    const components = whole(entry["components"], "components");
    const count = whole(entry["count"], "count");
    const offset = whole(entry["offset"], "offset");
    if (components === 0 || offset > dataBytes) wrong("an array lies outside the data");
    const type = text(entry["type"], "type");
    const values = view(type, buffer, dataStart + offset, components * count, dataBytes - offset);
    return { set: text(entry["set"], "set"), name: text(entry["name"], "name"), unit: text(entry["unit"], "unit"), components, count, values };
  });
  return { header, arrays };
}

// ---- frames ----

export type FieldPlace = "vertices" | "triangles" | "points";

export interface Field {
  name: string;
  unit: string;
  place: FieldPlace;
  components: number;
  values: Float32Array;
}

export interface Scalar {
  name: string;
  unit: string;
  value: number | null;
  text: string;
}

export interface Box {
  dimension: number;
  origin: [number, number, number];
  lengths: [number, number, number];
}

export interface Films {
  position: Float32Array; // 3 a vertex
  normal: Int16Array; // 4 a vertex, 32767 being 1
  regions: Int32Array; // 2 a vertex, the smaller first; the normal points into the second
  corners: Uint32Array; // 3 a triangle
  borders: Float32Array; // 6 a segment
  wires: Float32Array;
}

export interface Points {
  position: Float32Array;
  radius: Float32Array | null;
}

/// Balls that films run around.
export interface Solids {
  position: Float32Array;
  radius: Float32Array;
}

export interface Frame {
  solver: string;
  time: number;
  timeUnit: string;
  step: number;
  box: Box | null;
  scalars: Scalar[];
  triangles: { shown: number; all: number };
  pointCount: { shown: number; all: number };
  films: Films | null;
  points: Points | null;
  solids: Solids | null;
  fields: Field[];
  lengthUnit: string;
  bytes: number;
}

function number(value: unknown, name: string): number {
  if (typeof value !== "number" || !Number.isFinite(value)) wrong(`${name} is no number`);
  return value;
}

function find<T extends Values>(message: Message, set: string, name: string, components: number, type: abstract new (...a: never[]) => T): T | null {
  const array = message.arrays.find((a) => a.set === set && a.name === name);
  if (!array) return null;
  if (array.components !== components || !(array.values instanceof type)) wrong(`${name} of ${set} has another shape`);
  return array.values;
}

function need<T extends Values>(message: Message, set: string, name: string, components: number, type: abstract new (...a: never[]) => T): T {
  return find(message, set, name, components, type) ?? wrong(`${name} of ${set} is missing`);
}

function checkFinite(values: Float32Array, what: string): void {
  for (const value of values) if (!Number.isFinite(value)) wrong(`${what} is not at a finite place`);
}

function films(message: Message): Films | null {
  const position = find(message, "vertices", "position", 3, Float32Array);
  if (!position) return null;
  const count = position.length / 3;
  const result: Films = {
    position,
    normal: need(message, "vertices", "normal", 4, Int16Array),
    regions: need(message, "vertices", "regions", 2, Int32Array),
    corners: need(message, "triangles", "corners", 3, Uint32Array),
    borders: need(message, "borders", "segment", 6, Float32Array),
    wires: need(message, "wires", "segment", 6, Float32Array),
  };
  if (result.normal.length !== 4 * count || result.regions.length !== 2 * count) wrong("vertices, normals and regions do not fit together");
  for (const corner of result.corners) if (corner >= count) wrong(`a triangle refers to vertex ${corner} of ${count}`);
  checkFinite(position, "a vertex");
  checkFinite(result.borders, "a border");
  checkFinite(result.wires, "a wire");
  return result;
}

function points(message: Message): Points | null {
  const position = find(message, "points", "position", 3, Float32Array);
  if (!position) return null;
  const radius = find(message, "points", "radius", 1, Float32Array);
  if (radius && 3 * radius.length !== position.length) wrong("points and radii do not fit together");
  checkFinite(position, "a point");
  return { position, radius };
}

function solids(message: Message): Solids | null {
  const position = find(message, "solids", "position", 3, Float32Array);
  const radius = find(message, "solids", "radius", 1, Float32Array);
  if (!position && !radius) return null;
  if (!position || !radius || 3 * radius.length !== position.length) wrong("solids and their radii do not fit together");
  checkFinite(position, "a solid");
  return { position, radius };
}

const FIELD_SETS: Record<string, FieldPlace> = { vertex_fields: "vertices", face_fields: "triangles", point_fields: "points" };

function fields(message: Message, counts: Record<FieldPlace, number>): Field[] {
  const result: Field[] = [];
  for (const array of message.arrays) {
    const place = FIELD_SETS[array.set];
    if (!place) continue;
    if (!(array.values instanceof Float32Array)) wrong(`field ${array.name} has no real numbers`);
    if (array.count !== counts[place]) wrong(`field ${array.name} has ${array.count} values for ${counts[place]} ${place}`);
    result.push({ name: array.name, unit: array.unit, place, components: array.components, values: array.values });
  }
  return result;
}

function scalars(list: unknown): Scalar[] {
  if (!Array.isArray(list)) wrong("the list of scalars is missing");
  return list.map((entry: unknown) => {
    if (!isObject(entry)) wrong("a scalar is none");
    const value = entry["value"];
    return { name: text(entry["name"], "name"), unit: text(entry["unit"], "unit"), value: typeof value === "number" ? value : null, text: text(entry["text"], "text") };
  });
}

function triple(value: unknown, name: string): [number, number, number] {
  if (!Array.isArray(value) || value.length !== 3) wrong(`${name} is no vector`);
  return [number(value[0], name), number(value[1], name), number(value[2], name)];
}

function box(value: unknown): Box | null {
  if (value === null || value === undefined) return null;
  if (!isObject(value)) wrong("the box is none");
  return { dimension: whole(value["dimension"], "dimension"), origin: triple(value["origin"], "origin"), lengths: triple(value["lengths"], "lengths") };
}

function counts(value: unknown, name: string): { shown: number; all: number } {
  if (!isObject(value)) wrong(`the number of ${name} is missing`);
  return { shown: whole(value["shown"], name), all: whole(value["all"], name) };
}

export function decodeFrame(buffer: ArrayBuffer): Frame {
  const message = decodeMessage(buffer);
  const header = message.header;
  const itsFilms = films(message);
  const itsPoints = points(message);
  const sizes = {
    vertices: itsFilms ? itsFilms.position.length / 3 : 0,
    triangles: itsFilms ? itsFilms.corners.length / 3 : 0,
    points: itsPoints ? itsPoints.position.length / 3 : 0,
  };
  const itsFields = fields(message, sizes);
  const lengthUnit = message.arrays.find((a) => a.name === "position")?.unit ?? "m";
  if (itsPoints?.radius) itsFields.unshift({ name: "radius", unit: lengthUnit, place: "points", components: 1, values: itsPoints.radius });
  return {
    solver: text(header["solver"], "solver"),
    time: number(header["time"], "time"),
    timeUnit: text(header["time_unit"], "time_unit"),
    step: number(header["step"], "step"),
    box: box(header["box"]),
    scalars: scalars(header["scalars"]),
    triangles: counts(header["triangles"], "triangles"),
    pointCount: counts(header["points"], "points"),
    films: itsFilms,
    points: itsPoints,
    solids: solids(message),
    fields: itsFields,
    lengthUnit,
    bytes: buffer.byteLength,
  };
}

// ---- the colors of films ----

export interface ColorTable {
  thicknesses: number;
  cosines: number;
  maxThickness: number; // [nm]
  index: number; // refractive
  // Rows of cosines v^2, each with linear sRGB colors at u^2 maxThickness, u and v even from 0 to 1: of films with
  // thickness sqrt(1 - (1 - cosine^2) / index^2) = u^2 maxThickness.
  thin: Float32Array;
  thick: Float32Array; // one color a cosine
}

export function decodeColors(buffer: ArrayBuffer): ColorTable {
  const message = decodeMessage(buffer);
  const table: ColorTable = {
    thicknesses: whole(message.header["thicknesses"], "thicknesses"),
    cosines: whole(message.header["cosines"], "cosines"),
    maxThickness: number(message.header["max_thickness_nm"], "max_thickness_nm"),
    index: number(message.header["reference_index"], "reference_index"),
    thin: need(message, "colors", "thin", 3, Float32Array),
    thick: need(message, "colors", "thick", 3, Float32Array),
  };
  if (table.thicknesses < 2 || table.cosines < 2 || table.thin.length !== 3 * table.thicknesses * table.cosines || table.thick.length !== 3 * table.cosines)
    wrong("the table of colors has another shape");
  return table;
}

/// What a film reflects of light that falls on it at right angles, linear sRGB.
export function headOn(table: ColorTable, nm: number): [number, number, number] {
  const row = table.thicknesses * (table.cosines - 1);
  const at = Math.sqrt(Math.min(Math.max(nm / table.maxThickness, 0), 1)) * (table.thicknesses - 1);
  const low = Math.min(Math.floor(at), table.thicknesses - 2);
  const entry = (i: number, k: number): number => table.thin[3 * (row + i) + k] ?? 0;
  return [0, 1, 2].map((k) => entry(low, k) * (low + 1 - at) + entry(low + 1, k) * (at - low)) as [number, number, number];
}
