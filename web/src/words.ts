// Numbers and names as people read them.

const SUPERSCRIPT: Record<string, string> = { "-": "⁻", "0": "⁰", "1": "¹", "2": "²", "3": "³", "4": "⁴", "5": "⁵", "6": "⁶", "7": "⁷", "8": "⁸", "9": "⁹" };

const raised = (digits: string): string => [...digits].map((c) => SUPERSCRIPT[c] ?? c).join("");

/// "m^2/s" -> "m²/s"; nothing for a pure number.
export function unitText(unit: string): string {
  return unit === "-" ? "" : unit === "deg" ? "°" : unit.replace(/\^(-?\d+)/g, (_, digits: string) => raised(digits)).replace(/ /g, "\u202f");
}

/// Three or four digits, powers of ten where there would be many zeros.
export function numberText(value: number | null, digits = 4): string {
  if (value === null || Number.isNaN(value)) return "unknown";
  if (value === 0) return "0";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  if (Number.isInteger(value) && size < 1e6) return value.toString().replace("-", "−");
  if (size >= 1e-3 && size < 1e5) return String(Number(value.toPrecision(digits))).replace("-", "−");
  const [mantissa = "", exponent = ""] = value.toExponential(digits - 2).split("e");
  return `${String(Number(mantissa)).replace("-", "−")}·10${raised(exponent.replace("+", ""))}`;
}

export function quantityText(value: number | null, unit: string, digits = 4): string {
  const text = numberText(value, digits);
  const itsUnit = unitText(unit);
  if (itsUnit === "" || text === "unknown") return text;
  return itsUnit === "°" ? `${text}°` : `${text}\u202f${itsUnit}`;
}

/// 1008600 -> "1,008,600".
export const countText = (count: number): string => count.toLocaleString("en-US");

/// "mean_radius" -> "mean radius".
export const nameText = (name: string): string => name.replace(/_/g, " ");

/// Labels of an axis with as many digits as its steps need, and the power of ten that they share.
export function tickTexts(ticks: number[], step: number): { texts: string[]; factor: string } {
  const largest = Math.max(...ticks.map(Math.abs));
  const exponent = largest === 0 ? 0 : Math.floor(Math.log10(largest));
  const shared = exponent < -2 || exponent > 4 ? exponent : 0;
  const scaledStep = step / 10 ** shared;
  const decimals = Math.min(Math.max(0, Math.ceil(-Math.log10(scaledStep) - 1e-9)), 8);
  const finer = Math.abs(scaledStep * 10 ** decimals - Math.round(scaledStep * 10 ** decimals)) > 1e-6 ? decimals + 1 : decimals;
  const texts = ticks.map((t) => (t / 10 ** shared).toFixed(finer).replace("-", "−"));
  return { texts, factor: shared === 0 ? "" : `10${raised(String(shared))}` };
}
