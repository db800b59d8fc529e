// The run's texts: its scene, and where it comes from.
import { api } from "./api";
import { byId, dictionary } from "./page";
import { nameText, numberText } from "./words";

export async function showText(id: string, load: () => Promise<string>): Promise<void> {
  try {
    byId(id).textContent = await load();
  } catch (error) {
    byId(id).textContent = (error as Error).message;
  }
}

export async function showProvenance(): Promise<void> {
  const place = byId("provenance-text");
  try {
    const record = JSON.parse(await api.provenance()) as Record<string, unknown>;
    const rows: [string, string][] = [];
    for (const [key, value] of Object.entries(record))
      if (typeof value === "string" || typeof value === "number") rows.push([nameText(key), typeof value === "number" ? numberText(value) : value]);
    place.replaceChildren(dictionary(rows));
  } catch (error) {
    place.textContent = (error as Error).message;
  }
}
