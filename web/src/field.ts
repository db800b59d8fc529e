// From a field to one number an item: a number as it is, a vector's or tensor's length.
import { Field, FieldPlace, Frame } from "./decode";

/// The choice "film colors" beside the fields.
export const FILM_COLORS = "film colors";

export const fieldKey = (field: { place: FieldPlace; name: string }): string => `${field.place}:${field.name}`;

export function findField(frame: Frame, key: string): Field | undefined {
  return frame.fields.find((field) => fieldKey(field) === key);
}

export function magnitudes(field: Field): Float32Array {
  if (field.components === 1) return field.values;
  const n = field.values.length / field.components;
  const result = new Float32Array(n);
  for (let i = 0; i < n; ++i) {
    let sum = 0;
    for (let k = 0; k < field.components; ++k) sum += (field.values[i * field.components + k] ?? 0) ** 2;
    result[i] = Math.sqrt(sum);
  }
  return result;
}

export interface Range {
  low: number;
  high: number;
}

/// Of the values that are known; nothing when none is.
export function rangeOf(values: Float32Array): Range | null {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (value < low) low = value;
    if (value > high && value !== Infinity) high = value;
  }
  return low <= high ? { low, high } : null;
}

/// How thick the films are at each vertex, or at each particle of those that carry the film; nothing where it is one number.
export function thicknessField(frame: Frame, place: "vertices" | "points"): Field | undefined {
  return frame.fields.find((f) => f.name === "thickness" && f.place === place && f.components === 1 && f.unit === "m");
}

/// Whether there is anything that has the colors of films.
export const hasFilms = (frame: Frame): boolean => frame.films !== null || thicknessField(frame, "points") !== undefined;

/// Whether the points are particles that carry the films which are drawn anyway, not bubbles.
export const carriesFilms = (frame: Frame): boolean => frame.films !== null && frame.points !== null && frame.points.radius === null;

/// Particles that lie on films hide them: they are drawn where somebody wants them, or a field of theirs.
export const showsPoints = (frame: Frame, coloring: string, wanted: boolean): boolean =>
  frame.points !== null && (!carriesFilms(frame) || wanted || findField(frame, coloring)?.place === "points");

/// What a frame looks best in when nobody has chosen: films in their own colors, balls by their size.
export function defaultColoring(frame: Frame): string {
  if (hasFilms(frame)) return FILM_COLORS;
  const best = ["radius", "pressure", "volume"].map((name) => frame.fields.find((f) => f.name === name));
  const field = best.find((f) => f !== undefined) ?? frame.fields[0];
  return field ? fieldKey(field) : FILM_COLORS;
}
