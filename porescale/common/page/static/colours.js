/** Colours of values, and numbers as text. */

export const GRAIN = "#ece3cf";
export const RIM = "#3b352b";
export const CRACK = "#d0263b";

let maps = {};

/** Take the colour maps of a page: name -> 256 RGB bytes in base64. */
export function setMaps(given) {
  maps = Object.fromEntries(
    Object.entries(given).map(([name, text]) => {
      const bytes = Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));
      return [name, Array.from({ length: 256 }, (_, k) => pixel(bytes[3 * k], bytes[3 * k + 1], bytes[3 * k + 2]))];
    }),
  );
}

/** Names of the maps. */
export const mapNames = () => Object.keys(maps);

/** A colour as a 32-bit pixel of ImageData (little endian). */
export function pixel(red, green, blue) {
  return ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
}

/** "#rrggbb" as a pixel. */
export function fromHex(text) {
  const value = parseInt(text.slice(1), 16);
  return pixel(value >> 16, (value >> 8) & 255, value & 255);
}

/** A pixel as a CSS colour. */
export const css = (value) => `rgb(${value & 255},${(value >> 8) & 255},${(value >> 16) & 255})`;

/** Pixels of values between limits: an Uint32Array; what is no number gets `none`. */
export function paint(values, limits, none) {
  const table = Uint32Array.from(maps[limits.map] ?? maps.viridis);
  const found = new Uint32Array(values.length);
  const factor = 255 / (limits.high - limits.low || 1);
  for (let k = 0; k < values.length; k++) {
    const place = (values[k] - limits.low) * factor;
    found[k] = place !== place ? none : table[place <= 0 ? 0 : place >= 255 ? 255 : place | 0];
  }
  return found;
}

/** Pixels of whole numbers that stand for kinds: value -> [label, "#rrggbb"]. */
export function paintKinds(values, kinds, none) {
  const table = new Map(Object.entries(kinds).map(([key, [, colour]]) => [Number(key), fromHex(colour)]));
  return Uint32Array.from(values, (value) => table.get(value) ?? none);
}

/** A map as a CSS gradient from left to right. */
export function gradient(name) {
  const table = maps[name] ?? maps.viridis;
  const stops = Array.from({ length: 17 }, (_, k) => css(table[Math.min(255, 16 * k)]));
  return `linear-gradient(to right, ${stops.join(", ")})`;
}

/** A number with so many digits, without what says nothing. */
export function shown(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) {
    return value.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e");
  }
  return String(Number(value.toPrecision(digits)));
}

/** Round numbers in a range, about so many. */
export function ticks(low, high, about = 4) {
  const span = high - low;
  if (!(span > 0) || !Number.isFinite(span)) return [low];
  const rough = span / about;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 2.5, 5, 10].map((it) => it * power).find((it) => it >= rough * 0.999) ?? 10 * power;
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * span; k++) found.push(k * step);
  return found.length ? found : [low];
}

/** Ticks as texts, with as many digits as tell them apart. */
export function tickTexts(list) {
  const largest = Math.max(...list.map(Math.abs));
  const step = list.length > 1 ? Math.abs(list[1] - list[0]) : largest || 1;
  if (largest >= 1e6 || (largest < 1e-3 && largest > 0)) {
    const digits = Math.max(0, Math.ceil(Math.log10(largest / step) - 1e-9));
    return list.map((it) => (it === 0 || Math.abs(it) < 1e-9 * step ? "0" : it.toExponential(digits).replace("e+", "e")));
  }
  let decimals = Math.min(9, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
  if (list.length > 1 && Math.abs(step * 10 ** decimals - Math.round(step * 10 ** decimals)) > 1e-6) decimals += 1;
  return list.map((it) => (Math.abs(it) < 1e-9 * step ? "0" : it.toFixed(decimals)));
}

/** Factor and unit in which a box is measured. */
export function lengthUnit(view, plain) {
  if (plain) return [1, ""];
  const longest = Math.max(view[1] - view[0], view[3] - view[2]);
  return longest < 0.02 ? [1e3, "mm"] : longest < 5 ? [1e2, "cm"] : [1, "m"];
}
