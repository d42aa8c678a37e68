/** Columns of tables as curves, with a cursor at the time of the frame. */

import { shown, tickTexts, ticks } from "./colours.js";

const SVG = "http://www.w3.org/2000/svg";
const SIZE = { width: 300, height: 150, left: 54, right: 10, top: 10, bottom: 24 };
const STROKES = ["var(--first)", "var(--second)", "var(--third)", "var(--fourth)"];
const ALONG = /^(x|y|along|arc|distance|place|position)\b/;

const AT_PLACE = /^(.*) at (?:[xy] = )?(-?[\d.]+(?:e-?\d+)?) m$/;
const PLACES = 6;

/** An element with attributes and children. */
export function make(tag, attributes = {}, ...children) {
  const found = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) found.addEventListener(key.slice(2), value);
    else if (value !== false && value !== null) found.setAttribute(key, value === true ? "" : value);
  }
  found.append(...children);
  return found;
}

function drawn(tag, attributes, text = "") {
  const found = document.createElementNS(SVG, tag);
  for (const [key, value] of Object.entries(attributes)) found.setAttribute(key, value);
  if (text) found.textContent = text;
  return found;
}

/** Number of the last value of an ascending list that is no larger than `value`, or the nearest. */
export function nearest(list, value) {
  let [low, high] = [0, list.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (list[middle] <= value) low = middle;
    else high = middle;
  }
  return Math.abs(list[high] - value) < Math.abs(list[low] - value) ? high : low;
}

/** Curves over one axis.  go : called with the place on the axis where it is clicked. */
export class Chart {
  constructor({ title, unit = "", axis, go = null }) {
    Object.assign(this, { title, unit, axis, curves: [] });
    this.value = make("span", { class: "value" });
    this.svg = drawn("svg", { viewBox: `0 0 ${SIZE.width} ${SIZE.height}`, role: "img", "aria-label": `${title} over ${axis}` });
    const label = unit ? `${title} (${unit})` : title;
    this.element = make("figure", { class: "chart" }, make("figcaption", {}, make("b", {}, label), this.value), this.svg);
    if (go) {
      this.svg.classList.add("goes");
      const jump = (event) => {
        if (event.type === "pointermove" && !(event.buttons & 1)) return;
        const box = this.svg.getBoundingClientRect();
        go(this.from(((event.clientX - box.left) / box.width) * SIZE.width));
      };
      this.svg.addEventListener("pointerdown", jump);
      this.svg.addEventListener("pointermove", jump);
    }
  }

  /** Show curves {x, y, dots}, and colour and label where given; y may hold nulls.  half : of a band about a curve;
   *  thin : one of many.  all : numbers that the axis must hold besides. */
  set(curves, all = []) {
    this.curves = curves;
    const xs = curves.flatMap((it) => [it.x[0], it.x.at(-1)]).filter(Number.isFinite);
    const ends = (it) => (it.half ? it.y.flatMap((y, k) => [y - it.half[k], y + it.half[k]]) : []);
    const ys = [...curves.flatMap((it) => it.y), ...curves.flatMap(ends), ...all].filter((it) => Number.isFinite(it));
    const low = ys.reduce((a, b) => Math.min(a, b), Infinity);
    const high = ys.reduce((a, b) => Math.max(a, b), -Infinity);
    const flat = !(high - low > 1e-12 * Math.max(Math.abs(low), Math.abs(high)));
    const pad = flat ? 0.5 * (Math.abs(high) || 1) : 0.06 * (high - low);
    this.x = [Math.min(...xs), Math.max(...xs)];
    this.y = ys.length ? [low - pad, high + pad] : [0, 1];
    if (!(this.x[1] > this.x[0])) this.x = [this.x[0] || 0, (this.x[0] || 0) + 1];
    this.draw();
  }

  to(x, y) {
    const wide = SIZE.width - SIZE.left - SIZE.right;
    const high = SIZE.height - SIZE.top - SIZE.bottom;
    return [
      SIZE.left + (wide * (x - this.x[0])) / (this.x[1] - this.x[0]),
      SIZE.top + high - (high * (y - this.y[0])) / (this.y[1] - this.y[0]),
    ];
  }

  from(pixel) {
    const share = (pixel - SIZE.left) / (SIZE.width - SIZE.left - SIZE.right);
    return this.x[0] + Math.min(1, Math.max(0, share)) * (this.x[1] - this.x[0]);
  }

  draw() {
    this.svg.replaceChildren();
    const base = SIZE.height - SIZE.bottom;
    const [upward, across] = [ticks(...this.y, 3), ticks(...this.x, 4)];
    const [upwardTexts, acrossTexts] = [upward, across].map(tickTexts);
    for (const [k, tick] of upward.entries()) {
      const [, y] = this.to(0, tick);
      this.svg.append(drawn("line", { x1: SIZE.left, x2: SIZE.width - SIZE.right, y1: y, y2: y, class: "grid" }));
      this.svg.append(drawn("text", { x: SIZE.left - 5, y: y + 4, "text-anchor": "end" }, upwardTexts[k]));
    }
    for (const [k, tick] of across.entries()) {
      const [x] = this.to(tick, 0);
      this.svg.append(drawn("line", { x1: x, x2: x, y1: base, y2: base + 4, class: "tick" }));
      if (x < SIZE.width - SIZE.right - 6.2 * this.axis.length - 3 * acrossTexts[k].length) this.svg.append(drawn("text", { x, y: base + 16, "text-anchor": "middle" }, acrossTexts[k]));
    }
    const axis = { x: SIZE.width - SIZE.right, y: base + 16, "text-anchor": "end" };
    this.svg.append(drawn("text", axis, this.axis));
    this.curves.forEach(({ x, y, dots = false, colour, label = "", half = null, thin = false }, k) => {
      if (half) this.band({ x, y, half, colour, label });
      let path = "";
      let pen = "M";
      for (let i = 0; i < x.length; i++) {
        if (!Number.isFinite(y[i])) {
          pen = "M";
          continue;
        }
        const [a, b] = this.to(x[i], y[i]);
        path += `${pen}${a.toFixed(1)},${b.toFixed(1)}${dots ? "h0" : ""}`;
        pen = dots ? "M" : "L";
      }
      const dashes = k && !dots && !colour ? { "stroke-dasharray": "5 3" } : {};
      this.svg.append(drawn("path", { d: path, class: `curve${dots ? " dots" : ""}${thin ? " thin" : ""}`, "data-label": label, style: `stroke: ${colour ?? STROKES[k % 4]}`, ...dashes }));
    });
    this.cursor = drawn("line", { y1: SIZE.top, y2: base, class: "cursor", visibility: "hidden" });
    this.svg.append(this.cursor);
  }

  /** What lies within `half` of a curve, where both are numbers. */
  band({ x, y, half, colour, label }) {
    const there = [...x.keys()].filter((i) => Number.isFinite(y[i]) && Number.isFinite(half[i]));
    if (!there.length) return;
    const points = (sign) => there.map((i) => this.to(x[i], y[i] + sign * half[i]).map((it) => it.toFixed(1)).join(","));
    const path = `M${[...points(1), ...points(-1).reverse()].join("L")}Z`;
    this.svg.append(drawn("path", { d: path, class: "band", "data-label": label, style: `fill: ${colour}` }));
  }

  /** Put the cursor at a place, and say the values there. */
  at(place) {
    if (!this.cursor) return;
    const [x] = this.to(Math.min(this.x[1], Math.max(this.x[0], place)), 0);
    this.cursor.setAttribute("x1", x);
    this.cursor.setAttribute("x2", x);
    this.cursor.setAttribute("visibility", "visible");
    this.place = place;
    const values = this.curves.map((it) => it.y[nearest(it.x, place)]);
    const gap = values.length === 2 ? ` (Δ ${shown(values[0] - values[1])})` : "";
    this.value.textContent = values.map((it) => shown(it)).join(" | ") + gap;
  }
}

/** The charts of one table of several runs, in an element. */
export class TableCharts {
  /** tables : of the runs, null where one has none of that name;  go : called with a time. */
  constructor(tables, go) {
    const [table] = tables;
    this.tables = tables;
    this.charts = [];
    this.element = make("div", { class: "charts" });
    if (table.kind === "list") this.list(table);
    else if (table.kind === "series") this.series(tables.filter(Boolean), go);
    else this.places(table);
  }

  series(tables, go) {
    const [table] = tables;
    const places = table.columns.map(({ name }) => AT_PLACE.exec(name));
    const [first] = places.filter(Boolean);
    if (first && places.filter((it) => it?.[1] === first[1]).length >= PLACES) this.alongPlaces(tables, places, first[1]);
    table.columns.slice(1).forEach(({ name, unit }, k) => {
      const chart = new Chart({ title: name, unit, axis: "t (s)", go });
      const found = tables.map((it) => [it, it.columns.findIndex((c) => c.name === name && c.unit === unit)]);
      chart.set(found.filter(([, at]) => at >= 0).map(([it, at]) => ({ ...it, x: it.data[0], y: it.data[at], half: it.half?.[at] })));
      this.add(chart, `${name} ${unit}`);
      chart.column = k + 1;
    });
  }

  /** Columns "height at x = 0.1 m" and so on: one curve over the places at the time of the frame; each of them by itself
   *  is folded away. */
  alongPlaces(tables, places, title) {
    const numbers = places.flatMap((it, k) => (it?.[1] === title ? [k] : []));
    const chart = new Chart({ title, unit: tables[0].columns[numbers[0]].unit, axis: "place (m)" });
    chart.tables = tables.filter((it) => it.columns.length === tables[0].columns.length);
    chart.numbers = numbers;
    const values = chart.tables.flatMap((it) => numbers.flatMap((k) => it.data[k])).filter(Number.isFinite);
    chart.fixed = [values.reduce((a, b) => Math.min(a, b), Infinity), values.reduce((a, b) => Math.max(a, b), -Infinity)];
    chart.where = numbers.map((k) => Number(places[k][2]));
    this.add(chart, title);
    this.folded = make("div", { class: "charts" });
    this.element.append(make("details", { class: "wide" }, make("summary", {}, "each place over time"), this.folded));
  }

  /** A table with a row for each time and place: curves over a column of places, at the time of the frame. */
  places(table) {
    const columns = table.columns.map((it) => it.name);
    const at = columns.findIndex((name, k) => k > 0 && ALONG.test(name));
    const along = at < 0 ? 1 : at;
    table.columns.forEach(({ name, unit }, k) => {
      if (k === 0 || k === along) return;
      const over = table.columns[along];
      const chart = new Chart({ title: name, unit, axis: over.unit ? `${over.name} (${over.unit})` : over.name });
      chart.table = { table, along, k };
      this.add(chart, `${name} ${unit}`);
    });
    this.times = [...new Set(table.data[0])];
  }

  list(table) {
    const head = make("tr", {}, ...table.columns.map((it) => make("th", { scope: "col" }, it.unit ? `${it.name} (${it.unit})` : it.name)));
    const rows = Array.from({ length: table.data[0]?.length ?? 0 }, (_, k) =>
      make("tr", {}, ...table.data.map((column) => make("td", {}, column[k]))));
    this.element.append(make("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": table.name },
      make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows))));
    if (table.rows > rows.length) this.element.append(make("p", {}, `The first ${rows.length} of ${table.rows} rows.`));
  }

  add(chart, words) {
    chart.words = words.toLowerCase();
    this.charts.push(chart);
    (this.folded ?? this.element).append(chart.element);
  }

  /** Show the time of the frame. */
  at(time) {
    for (const chart of this.charts) {
      if (chart.tables) {
        const rows = chart.tables.map((it) => nearest(it.data[0], time));
        chart.set(chart.tables.map((it, n) => ({ x: chart.where, y: chart.numbers.map((k) => it.data[k][rows[n]]) })), chart.fixed);
        chart.value.textContent = `t = ${shown(chart.tables[0].data[0][rows[0]])} s`;
      } else if (chart.table) {
        const { table, along, k } = chart.table;
        const now = this.times[nearest(this.times, time)];
        const rows = table.data[0].flatMap((it, row) => (it === now ? [row] : []));
        rows.sort((a, b) => table.data[along][a] - table.data[along][b]);
        chart.set([{ x: rows.map((row) => table.data[along][row]), y: rows.map((row) => table.data[k][row]) }]);
        chart.value.textContent = `t = ${shown(now)} s`;
      } else chart.at(time);
    }
  }

  /** Show the charts whose names hold the words; gives how many. */
  filter(words) {
    let count = 0;
    for (const chart of this.charts) {
      chart.element.hidden = !chart.words.includes(words.toLowerCase());
      count += !chart.element.hidden;
    }
    return count;
  }
}
