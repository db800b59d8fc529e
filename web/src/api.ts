// Talks to the server. Whatever goes wrong becomes an Error whose message a person can read.
import { ColorTable, decodeColors, decodeFrame, Frame } from "./decode";

export interface State {
  folder: string;
  title: string;
  solver: string;
  state: string; // starting, running, finished, interrupted, failed
  stop_reason: string;
  time_unit: string;
  frame_times: number[];
  thickness: number | null; // [m]
  note: string;
  controlled: boolean;
  paused: boolean;
}

export interface Region {
  id: number;
  volume: number | null;
  pressure: number | null;
  area: number | null;
  neighbors: { id: number; area: number | null }[];
}

export interface SeriesPart {
  columns: { name: string; unit: string }[];
  first: number;
  rows: (number | null)[][];
}

/// The token stands behind # in the address, so it is in no request but those that need it.
function takeToken(): string {
  const match = /token=([0-9a-f]+)/.exec(location.hash);
  if (match?.[1]) {
    sessionStorage.setItem("lamella-token", match[1]);
    history.replaceState(null, "", location.pathname);
  }
  return sessionStorage.getItem("lamella-token") ?? "";
}

const token = takeToken();

async function request(path: string, options: RequestInit = {}): Promise<Response> {
  let response: Response;
  try {
    response = await fetch(path, { ...options, cache: "no-store" });
  } catch {
    throw new Error("lamella view does not answer any more; start it again in the terminal");
  }
  if (response.ok) return response;
  let words = `the server answered ${response.status}`;
  try {
    const body: unknown = await response.json();
    if (typeof body === "object" && body !== null && "error" in body) words = String(body.error);
  } catch {
    // the status is all there is
  }
  throw new Error(words);
}

export const api = {
  canControl: token !== "",
  state: async (): Promise<State> => (await request("/api/state")).json() as Promise<State>,
  frame: async (index: number): Promise<Frame> => decodeFrame(await (await request(`/api/frames/${index}`)).arrayBuffer()),
  regions: async (index: number): Promise<Region[]> =>
    ((await (await request(`/api/frames/${index}/regions`)).json()) as { regions: Region[] }).regions,
  colors: async (): Promise<ColorTable> => decodeColors(await (await request("/api/colors")).arrayBuffer()),
  series: async (from: number): Promise<SeriesPart> => (await request(`/api/series?from=${from}`)).json() as Promise<SeriesPart>,
  scene: async (): Promise<string> => (await request("/api/scene")).text(),
  provenance: async (): Promise<string> => (await request("/api/provenance")).text(),
  control: async (action: "pause" | "resume" | "stop"): Promise<void> => {
    await request(`/api/run/${action}`, { method: "POST", headers: { "X-Lamella-Token": token } });
  },
};
