// node --test: the decoder against messages made by hand, whole and damaged.
import assert from "node:assert/strict";
import { test } from "node:test";
import { DecodeError, decodeColors, decodeFrame, decodeMessage, Frame, headOn } from "../src/decode";
import { numberText, quantityText, tickTexts, unitText } from "../src/words";
import { pickBall, pickRegion, Plane } from "../src/picking";
import { Axes, distanceToFit, usualAxes } from "../src/viewpoint";
import { Pace } from "../src/pace";
import { farthestFirst } from "../src/depth_order";
import { Eye, seenBalls } from "../src/hidden_balls";
import { magnitudes, rangeOf, showsPoints } from "../src/field";

type Typed = Float32Array | Uint32Array | Int32Array | Int16Array;
interface Entry {
  set: string;
  name: string;
  components: number;
  values: Typed;
  unit?: string;
}

const TYPES = new Map<unknown, string>([[Float32Array, "f32"], [Uint32Array, "u32"], [Int32Array, "i32"], [Int16Array, "i16"]]);

function pack(header: Record<string, unknown>, entries: Entry[]): ArrayBuffer {
  let offset = 0;
  const arrays = entries.map(({ set, name, components, values, unit }) => {
    const entry = { set, name, unit: unit ?? "-", type: TYPES.get(values.constructor), components, count: values.length / components, offset };
    offset += Math.ceil(values.byteLength / 4) * 4;
    return entry;
  });
  let text = JSON.stringify({ ...header, arrays });
  text = text.padEnd(Math.ceil(text.length / 4) * 4);
  const bytes = new Uint8Array(16 + text.length + offset);
  bytes.set(new TextEncoder().encode("LMLA"));
  new DataView(bytes.buffer).setUint32(4, 1, true);
  new DataView(bytes.buffer).setUint32(8, text.length, true);
  new DataView(bytes.buffer).setUint32(12, offset, true);
  bytes.set(new TextEncoder().encode(text), 16);
  entries.forEach(({ values }, i) => bytes.set(new Uint8Array(values.buffer, values.byteOffset, values.byteLength), 16 + text.length + (arrays[i]?.offset ?? 0)));
  return bytes.buffer;
}

const HEADER = { solver: "test", time: 0.5, time_unit: "s", step: 3, box: null, triangles: { shown: 1, all: 4 }, points: { shown: 0, all: 0 }, scalars: [{ name: "energy", unit: "J", value: null, text: "" }] };

// One triangle in the plane z = 0; its normal points up, into region 2.
const triangle = (): Entry[] => [
  { set: "vertices", name: "position", components: 3, values: Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0), unit: "m" },
  { set: "vertices", name: "normal", components: 4, values: Int16Array.of(0, 0, 32767, 0, 0, 0, 32767, 0, 0, 0, 32767, 0) },
  { set: "vertices", name: "regions", components: 2, values: Int32Array.of(0, 2, 0, 2, 0, 2) },
  { set: "triangles", name: "corners", components: 3, values: Uint32Array.of(0, 1, 2) },
  { set: "borders", name: "segment", components: 6, values: new Float32Array(0) },
  { set: "wires", name: "segment", components: 6, values: Float32Array.of(0, 0, 0, 1, 0, 0) },
  { set: "vertex_fields", name: "velocity", components: 3, values: Float32Array.of(3, 4, 0, 0, 0, 0, 1, 2, 2), unit: "m/s" },
];

const replaced = (set: string, name: string, values: Typed): Entry[] => triangle().map((e) => (e.set === set && e.name === name ? { ...e, values } : e));

test("a frame comes out as it went in", () => {
  const frame = decodeFrame(pack(HEADER, triangle()));
  assert.equal(frame.time, 0.5);
  assert.deepEqual(frame.triangles, { shown: 1, all: 4 });
  assert.deepEqual([...(frame.films?.corners ?? [])], [0, 1, 2]);
  assert.equal(frame.films?.wires.length, 6);
  assert.equal(frame.points, null);
  assert.equal(frame.scalars[0]?.value, null);
  const [velocity] = frame.fields;
  assert.equal(velocity?.unit, "m/s");
  assert.deepEqual([...magnitudes(velocity!)], [5, 0, 3]);
});

test("balls bring their radius as a field", () => {
  const frame = decodeFrame(
    pack({ ...HEADER, box: { dimension: 2, origin: [0, 0, 0], lengths: [4, 4, 0] } }, [
      { set: "points", name: "position", components: 3, values: Float32Array.of(1, 2, 0, 3, 2, 0), unit: "-" },
      { set: "points", name: "radius", components: 1, values: Float32Array.of(0.5, 0.75), unit: "-" },
    ]),
  );
  assert.equal(frame.box?.dimension, 2);
  assert.deepEqual(frame.fields.map((f) => [f.name, f.place]), [["radius", "points"]]);
});

test("every way of cutting a message short is an error in words", () => {
  const whole = pack(HEADER, triangle());
  for (let length = 0; length < whole.byteLength; ++length) assert.throws(() => decodeFrame(whole.slice(0, length)), DecodeError, `${length} bytes`);
});

test("what contradicts itself is an error in words", () => {
  const damaged: [string, RegExp, ArrayBuffer][] = [
    ["corner", /refers to vertex 7 of 3/, pack(HEADER, replaced("triangles", "corners", Uint32Array.of(0, 1, 7)))],
    ["place", /not at a finite place/, pack(HEADER, replaced("vertices", "position", Float32Array.of(0, NaN, 0, 1, 0, 0, 0, 1, 0)))],
    ["regions", /do not fit together/, pack(HEADER, replaced("vertices", "regions", Int32Array.of(0, 2)))],
    ["field", /velocity has 2 values for 3 vertices/, pack(HEADER, replaced("vertex_fields", "velocity", new Float32Array(6)))],
    ["type", /another shape/, pack(HEADER, replaced("triangles", "corners", Float32Array.of(0, 1, 2)))],
    ["missing", /normal of vertices is missing/, pack(HEADER, triangle().filter((e) => e.name !== "normal"))],
    ["time", /time is no number/, pack({ ...HEADER, time: null }, triangle())],
    ["scalars", /scalars is missing/, pack({ ...HEADER, scalars: undefined }, triangle())],
  ];
  for (const [name, words, buffer] of damaged) assert.throws(() => decodeFrame(buffer), (e) => e instanceof DecodeError && words.test(e.message), name);
});

test("other files, other formats and wrong sizes are refused", () => {
  const bytes = new Uint8Array(pack(HEADER, triangle()));
  const changed = (at: number, value: number): ArrayBuffer => {
    const copy = bytes.slice();
    copy[at] = value;
    return copy.buffer;
  };
  assert.throws(() => decodeMessage(changed(0, 88)), /no message of lamella/);
  assert.throws(() => decodeMessage(changed(4, 2)), /format 2/);
  assert.throws(() => decodeMessage(changed(15, 1)), /bytes came instead of/);
  assert.throws(() => decodeMessage(changed(16, 0x7d)), /header cannot be read/);
});

test("an array that reaches beyond the data is refused", () => {
  const text = new TextDecoder().decode(pack(HEADER, triangle()));
  const at = text.indexOf('"count":3');
  const bytes = new Uint8Array(pack(HEADER, triangle()));
  bytes[at + 8] = "9".charCodeAt(0);
  assert.throws(() => decodeFrame(bytes.buffer), DecodeError);
  const far = text.indexOf('"count":9'); // not there before
  assert.equal(far, -1);
});

test("the table of colors is looked up where its entries lie", () => {
  // 3 thicknesses at u = 0, 1/2, 1: 0, 100 and 400 nm; the row of cosine 1 is the last.
  const thin = new Float32Array(2 * 3 * 3);
  thin.set([0, 0, 0, 1, 2, 3, 5, 6, 7], 9);
  const table = decodeColors(
    pack({ thicknesses: 3, cosines: 2, max_thickness_nm: 400, reference_index: 1.33 }, [
      { set: "colors", name: "thin", components: 3, values: thin },
      { set: "colors", name: "thick", components: 3, values: new Float32Array(6) },
    ]),
  );
  assert.deepEqual(headOn(table, 0), [0, 0, 0]);
  assert.deepEqual(headOn(table, 100), [1, 2, 3]);
  assert.deepEqual(headOn(table, 400), [5, 6, 7]);
  assert.deepEqual(headOn(table, 25), [0.5, 1, 1.5]);
  assert.throws(() => decodeColors(pack({ thicknesses: 4, cosines: 2, max_thickness_nm: 400, reference_index: 1.33 }, [])), DecodeError);
});

test("a pick finds the bubble behind the film, and not what is cut away", () => {
  const films = decodeFrame(pack(HEADER, triangle())).films!;
  const nothing: Plane = [0, 0, 0, 1e30];
  const up = { origin: [0.2, 0.2, -1] as [number, number, number], direction: [0, 0, 1] as [number, number, number] };
  const down = { origin: [0.2, 0.2, 1] as [number, number, number], direction: [0, 0, -1] as [number, number, number] };
  assert.equal(pickRegion(films, up, nothing), 2);
  assert.equal(pickRegion(films, down, nothing), 2); // behind is the outside: the bubble before
  assert.equal(pickRegion(films, { ...up, origin: [0.9, 0.9, -1] }, nothing), 0);
  assert.equal(pickRegion(films, up, [1, 0, 0, 0.1]), 0);
  const points = { position: Float32Array.of(0, 0, 0, 0, 0, 3), radius: null };
  assert.equal(pickBall(points, Float32Array.of(0.5, 0.5), { origin: [0.1, 0, -5], direction: [0, 0, 1] }, nothing, false), 0);
  assert.equal(pickBall(points, Float32Array.of(0.5, 0.5), { origin: [0.1, 0, 9], direction: [0, 0, -1] }, nothing, false), 1);
  assert.equal(pickBall(points, Float32Array.of(0.5, 0.5), { origin: [0.6, 0, -5], direction: [0, 0, 1] }, nothing, false), -1);
});

test("numbers are written as people read them", () => {
  assert.equal(numberText(0.00001234), "1.23·10⁻⁵");
  assert.equal(numberText(-2.5), "−2.5");
  assert.equal(numberText(12), "12");
  assert.equal(numberText(null), "unknown");
  assert.equal(unitText("kg m/s^2"), "kg\u202fm/s²");
  assert.equal(quantityText(3, "-"), "3");
  assert.deepEqual(tickTexts([1.2e-4, 1.22e-4, 1.24e-4], 2e-6), { texts: ["1.20", "1.22", "1.24"], factor: "10⁻⁴" });
  assert.deepEqual(tickTexts([0, 0.5, 1], 0.5).texts, ["0.0", "0.5", "1.0"]);
  assert.deepEqual(tickTexts([0.975, 1, 1.025], 0.025).texts, ["0.975", "1.000", "1.025"]);
  assert.equal(quantityText(120, "deg"), "120°");
});

test("unknown values do not count in a range", () => {
  assert.deepEqual(rangeOf(Float32Array.of(NaN, 2, -1)), { low: -1, high: 2 });
  assert.equal(rangeOf(Float32Array.of(NaN)), null);
});

test("a run of pictures that take long is coarse, and sharp again at rest", () => {
  const pace = new Pace();
  assert.equal(pace.next(0, false), null);
  assert.equal(pace.next(10, true), 1);
  pace.drawn(4000, 1); // it took this long
  assert.equal(pace.next(4010, true), 0.25);
  pace.drawn(40, 0.25);
  assert.equal(pace.next(4060, false), null);
  assert.equal(pace.next(4500, false), 1);
  pace.drawn(4000, 1);
  assert.equal(pace.next(9000, false), null);
  assert.equal(pace.next(9100, true), 0.25);
  for (let i = 0; i < 5; ++i) pace.drawn(16, pace.next(9100 + 16 * i, true) ?? 0); // a small picture now
  assert.equal(pace.next(9200, true), 1);
});

test("films are drawn from the farthest to the nearest, and none is lost", () => {
  const count = 1000;
  const middles = new Float32Array(3 * count);
  for (let i = 0; i < middles.length; ++i) middles[i] = Math.sin(12.9898 * i) * (i % 3 === 0 ? 1 : 0.01);
  const corners = Uint32Array.from({ length: 3 * count }, (_, i) => i);
  for (let turn = 0; turn < 12; ++turn) {
    const forward = { x: 0.8 * Math.cos(turn), y: 0.8 * Math.sin(turn), z: 0.6 };
    const sorted = new Uint32Array(3 * count);
    farthestFirst(corners, middles, forward, sorted);
    assert.deepEqual([...sorted].sort((a, b) => a - b), [...corners]);
    let before = Infinity;
    for (let i = 0; i < 3 * count; i += 3) {
      const at = sorted[i]!;
      const depth = forward.x * middles[at]! + forward.y * middles[at + 1]! + forward.z * middles[at + 2]!;
      assert.ok(depth < before + 2e-3, `${depth} after ${before}`);
      before = depth;
    }
  }
});

test("the whole frame fits into the view, from near as from far", () => {
  const box = { dimension: 3, origin: [0, 0, 0], lengths: [2, 2, 2] };
  const frame = decodeFrame(pack({ ...HEADER, box }, [{ set: "points", name: "position", components: 3, values: Float32Array.of(1, 1, 1) }]));
  const front: Axes = { right: [1, 0, 0], up: [0, 0, 1], back: [0, -1, 0] };
  // The near face of the box is one unit nearer than its middle; half of the picture at distance 1 is 0.5 wide, 0.25 tall.
  assert.equal(distanceToFit(frame, Float32Array.of(0), [1, 1, 1], front, 0.5, 0.25), 1 + 1 / 0.25);
  assert.equal(distanceToFit(frame, Float32Array.of(3), [1, 1, 1], front, 0.5, 0.25), 3 + 3 / 0.25);
});

test("one looks on films in a plane, and on others from the side", () => {
  const film = (...normals: [number, number, number][]): Frame =>
    decodeFrame(pack(HEADER, replaced("vertices", "normal", Int16Array.from(normals.flatMap((n) => [...n.map((x) => Math.round(32767 * x)), 0])))));
  const along = (axes: Axes, n: [number, number, number]): number => Math.abs(n.reduce((sum, x, k) => sum + x * axes.back[k]!, 0));
  for (const n of [[0, 0, 1], [1, 0, 0], [0, 1, 0], [0.6, -0.8, 0]] as [number, number, number][]) assert.ok(along(usualAxes(film(n, n, n)), n) > 0.7, String(n));
  const usual = usualAxes(film([0, 0, 1], [0, 1, 0], [1, 0, 0]));
  assert.ok(Math.abs(usual.back[2] - Math.sin((16 * Math.PI) / 180)) < 1e-12);
  for (const { right, up, back } of [usual, usualAxes(film([0, 0, 1], [0, 0, 1], [0, 0, -1]))]) {
    const cross = [up[1] * back[2] - up[2] * back[1], up[2] * back[0] - up[0] * back[2], up[0] * back[1] - up[1] * back[0]];
    cross.forEach((x, k) => assert.ok(Math.abs(x - right[k]!) < 1e-15));
  }
});

test("solids come as balls, and damaged ones are refused", () => {
  const solids = (position: Typed, radius: Typed): Entry[] => [
    { set: "solids", name: "position", components: 3, values: position, unit: "m" },
    { set: "solids", name: "radius", components: 1, values: radius, unit: "m" },
  ];
  assert.equal(decodeFrame(pack(HEADER, triangle())).solids, null);
  const frame = decodeFrame(pack(HEADER, [...triangle(), ...solids(Float32Array.of(1, 2, 3), Float32Array.of(5))]));
  assert.deepEqual(frame.solids?.position, Float32Array.of(1, 2, 3));
  assert.deepEqual(frame.solids?.radius, Float32Array.of(5));
  const axes: Axes = { right: [1, 0, 0], up: [0, 1, 0], back: [0, 0, 1] };
  assert.equal(distanceToFit(frame, new Float32Array(0), [1, 2, 3], axes, 1, 1), 10); // all of it fits into the picture
  for (const [position, radius] of [[Float32Array.of(1, 2, 3), new Float32Array(0)], [Float32Array.of(1, NaN, 3), Float32Array.of(5)]] as const)
    assert.throws(() => decodeFrame(pack(HEADER, [...triangle(), ...solids(position, radius)])), DecodeError);
});

test("balls that any ray meets first are drawn, most of the hidden ones are not", () => {
  let state = 7;
  const random = (): number => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
  const count = 20000;
  const side = Math.cbrt(count);
  const position = Float32Array.from({ length: 3 * count }, () => side * random());
  const radius = Float32Array.from({ length: count }, () => 0.1 + 0.9 * random() ** 3);
  const plane: Plane = [1, 0, 0, 0.8 * side];
  // From far, from near with balls at the edge of the picture, and from within.
  for (const away of [2.2, 0.75, 0.1]) {
    const [c, s] = [Math.cos(0.4), Math.sin(0.4)];
    const eye: Eye = { position: [side * (0.5 + c * away), side * (0.5 + s * away), side / 2], right: [-s, c, 0], up: [0, 0, 1], back: [c, s, 0], focus: 700, width: 500, height: 360 };
    const seen = seenBalls(position, radius, eye, plane);
    const drawn = new Set(seen);
    assert.equal(drawn.size, seen.length);
    if (away > 1) assert.ok(seen.length < 0.4 * count, `${seen.length} of ${count} are drawn`);
    let met = 0;
    for (let i = 0; i < 600; ++i) {
      const [x, y] = [(random() - 0.5) * eye.width, (random() - 0.5) * eye.height];
      const d = [0, 1, 2].map((k) => eye.right[k]! * x + eye.up[k]! * y - eye.back[k]! * eye.focus) as [number, number, number];
      const length = Math.hypot(...d);
      const ray = { origin: eye.position, direction: d.map((v) => v / length) as [number, number, number] };
      const first = pickBall({ position, radius }, radius, ray, plane, false);
      if (first < 0) continue;
      ++met;
      assert.ok(drawn.has(first), `ball ${first} of radius ${radius[first]} is seen at ${x}, ${y} and not drawn`);
    }
    assert.ok(met > 100);
  }
  const last = seenBalls(position, radius, { position: [side / 2, side / 2, 3 * side], right: [1, 0, 0], up: [0, 1, 0], back: [0, 0, -1], focus: 700, width: 500, height: 360 }, plane);
  assert.equal(last.length, 0); // all lie behind the eye
});

test("particles are hidden where films are drawn, unless they or a field of theirs are wanted", () => {
  const particles = (radius: Entry[] = []): Entry[] => [
    { set: "points", name: "position", components: 3, values: Float32Array.of(0, 0, 0, 1, 0, 0), unit: "m" },
    { set: "point_fields", name: "vorticity", components: 1, values: Float32Array.of(1, 2), unit: "1/s" },
    ...radius,
  ];
  const both = decodeFrame(pack(HEADER, [...triangle(), ...particles()]));
  assert.equal(showsPoints(both, "film colors", false), false);
  assert.equal(showsPoints(both, "vertices:velocity", false), false);
  assert.equal(showsPoints(both, "film colors", true), true);
  assert.equal(showsPoints(both, "points:vorticity", false), true);
  assert.equal(showsPoints(decodeFrame(pack(HEADER, particles())), "film colors", false), true); // nothing else is there
  const radius = { set: "points", name: "radius", components: 1, values: Float32Array.of(1, 2), unit: "m" };
  assert.equal(showsPoints(decodeFrame(pack(HEADER, [...triangle(), ...particles([radius])])), "film colors", false), true); // bubbles
  assert.equal(showsPoints(decodeFrame(pack(HEADER, triangle())), "film colors", true), false);
});
