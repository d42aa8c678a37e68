/** The page of a folder of runs: a table of its points that sorts, their curves over each other, a link to each. */

import { TableCharts, make } from "./charts.js";
import { shown } from "./colours.js";
import { again, ago, ask } from "./live.js";
import { section, table } from "./panels.js";

/** Where the page of a served sweep has its data from: what each name says, the page of a point, its small picture. */
const served = {
  json: async (name) => JSON.parse(new TextDecoder().decode(await ask(name))),
  page: (name) => `run/${encodeURIComponent(name)}/`,
  picture: ({ name, state }) => `picture/${encodeURIComponent(name)}?step=${state.steps.at(-1)}`,
};

/** Where a page that is complete in itself has it from: all is in `data`. */
export const held = (data) => ({
  json: async (name) => data.json[name],
  page: (name) => data.pages[name] ?? null,
  picture: ({ name }) => data.pictures[name],
});

/** How a point stands, in words. */
function stateOf({ state, problem }) {
  if (!state) return problem;
  const { outcome, time, end, age } = state;
  const words = outcome !== "running" ? [] : [end && time !== null ? `${Math.min(100, Math.floor((100 * time) / end))} %` : "", `written ${ago(age)} ago`];
  return [outcome || "run", ...words, problem].filter(Boolean).join(" · ");
}

/** The colour of one of many. */
const hue = (at, many) => `var(--curve, hsl(${Math.round(215 + (190 * at) / Math.max(1, many - 1))} 70% var(--curve-light)))`;

export class Sweep {
  constructor(element, title, source = served) {
    Object.assign(this, { element, source, ensembles: [], bands: new Map(), rows: [], series: new Map(), images: new Map(), by: null, down: false });
    this.line = make("p", { class: "live", role: "status" }, "reading the runs …");
    this.list = make("div", { class: "points" });
    this.means = section("ensembles", "Ensembles");
    this.means.hidden = true;
    this.curves = make("div");
    this.find = make("input", { type: "search", placeholder: "front, energy, force …", "aria-label": "columns to show", oninput: () => this.charts?.filter(this.find.value) });
    element.replaceChildren(this.line, make("main", { class: "porescale-report sweep" }, make("h1", {}, title), this.means, section("points", "Points", this.list),
      section("curves", "Over time", make("p", { class: "finder" }, "Columns ", this.find), this.curves)));
  }

  say(text, state = "") {
    this.line.textContent = text;
    this.line.dataset.state = state;
  }

  /** Look at the points again; their curves only where rows were added. */
  async look() {
    const rows = await this.source.json("points");
    let more = rows.length !== this.rows.length;
    for (const { name, state } of rows) {
      const size = state?.tables.series ?? 0;
      if (!size || this.series.get(name)?.size === size) continue;
      this.series.set(name, { size, table: await this.source.json(`run/${encodeURIComponent(name)}/table/series`) });
      more = true;
    }
    this.rows = rows;
    if (await this.lookAtEnsembles()) more = true;
    const count = (outcome) => rows.filter((it) => it.state?.outcome === outcome).length;
    const words = ["finished", "running", "unstable", "failed", "interrupted"].map((it) => [count(it), it]).filter(([it]) => it);
    this.say([`${rows.length} run${rows.length === 1 ? "" : "s"}`, ...words.map((it) => it.join(" "))].join(" · "), count("running") ? "running" : "finished");
    const now = JSON.stringify(rows.map((it) => ({ ...it, state: { ...it.state, age: stateOf(it) } })));
    if (now !== this.told) this.fill();
    this.told = now;
    if (more) this.draw();
    return false;
  }

  /** Look at the ensembles again, at their bands where another member has finished; gives whether one has. */
  async lookAtEnsembles() {
    const found = await this.source.json("ensembles");
    let more = false;
    for (const { name, finished } of found) {
      const key = finished.join(" ");
      if (!finished.length || this.bands.get(name)?.key === key) continue;
      this.bands.set(name, { key, table: await this.source.json(`band/${encodeURIComponent(name)}`) });
      more = true;
    }
    if (JSON.stringify(found) !== JSON.stringify(this.ensembles)) this.tell(found);
    this.ensembles = found;
    return more;
  }

  /** The table of ensembles: means with their intervals. */
  tell(ensembles) {
    this.means.hidden = !ensembles.length;
    const words = (it) => make("li", { style: `border-color: ${hue(ensembles.indexOf(it), ensembles.length)}` }, `${it.name}: ${it.said}`);
    const text = (value) => (value === null ? "" : typeof value === "number" ? shown(value) : String(value));
    const known = ensembles.flatMap(({ name, lines }) => lines.filter((it) => it.n).map((it) => ({
      combination: name, quantity: it.unit ? `${it.quantity} (${it.unit})` : it.quantity, n: it.n, mean: it.mean,
      "± 95 %": it["t high"] === null ? null : it["t high"] - it.mean, "standard error": it["standard error"], "one run ±": it["standard deviation"],
      expected: it.tolerance === null ? "" : `${shown(it.value)} ± ${shown(it.tolerance)}`, verdict: it.verdict, remark: it.remark,
    })));
    const head = Object.keys(known[0] ?? {}).filter((key) => known.some((it) => text(it[key])) && (key !== "combination" || ensembles.length > 1));
    const rows = known.map((it) => make("tr", {}, ...head.map((key) => make("td", {}, text(it[key])))));
    const note = "Over time: members thin, means of those that finished with Student's interval at 95 %.";
    const parts = rows.length ? [table(head, rows, "ensembles")] : [];
    this.means.replaceChildren(this.means.firstElementChild, make("ul", { class: "ensembles" }, ...ensembles.map(words)), ...parts, make("p", {}, note));
  }

  /** Columns that any of the points has, of what they set those in which they differ: [title, group, key]. */
  columns() {
    const keys = (group) => [...new Set(this.rows.flatMap((it) => Object.keys(it[group])))];
    const least = (group) => (group === "values" && this.rows.length > 1 ? 2 : 1);
    const kinds = (group, key) => new Set(this.rows.map((it) => it[group][key] ?? null));
    const told = (group) => keys(group).filter((key) => kinds(group, key).size >= least(group) && !(kinds(group, key).size === 1 && kinds(group, key).has(null)));
    return ["values", "numbers", "cost"].flatMap((group) => told(group).map((key) => [key, group, key]));
  }

  value(row, [, group, key]) {
    if (group === "name") return row.name;
    if (group === "state") return row.state?.outcome === "running" && row.state.end ? row.state.time / row.state.end : (row.state?.outcome ?? "");
    return row[group][key] ?? null;
  }

  sorted() {
    if (!this.by) return this.rows;
    const known = this.rows.map((row) => [row, this.value(row, this.by)]);
    const order = (a, b) => (a === null) - (b === null) || (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b)));
    known.sort(([, a], [, b]) => (this.down && a !== null && b !== null ? -order(a, b) : order(a, b)));
    return known.map(([row]) => row);
  }

  /** The colour of a point, that of its ensemble where it is in one. */
  colour(name) {
    const of = this.ensembles.findIndex((it) => it.members.includes(name));
    if (of >= 0) return hue(of, this.ensembles.length);
    return hue(this.rows.findIndex((it) => it.name === name), this.rows.length);
  }

  /** A small picture, asked for once. */
  image(src) {
    if (!this.images.has(src)) this.images.set(src, make("img", { src, alt: "" }));
    return this.images.get(src);
  }

  /** The table. */
  fill() {
    const held = document.activeElement?.dataset?.column;
    const columns = [["point", "name"], ["state", "state"], ...this.columns()];
    const head = columns.map((column) => {
      const mine = this.by?.[0] === column[0];
      const click = () => {
        this.down = mine && !this.down;
        this.by = column;
        this.fill();
      };
      return make("button", { type: "button", "data-column": column[0], "aria-label": `sort by ${column[0]}`, onclick: click }, `${column[0]}${mine ? (this.down ? " ▼" : " ▲") : ""}`);
    });
    const rows = this.sorted().map((row) => {
      const { name, state } = row;
      const image = row.picture ? this.image(this.source.picture(row)) : "";
      const link = make("a", { href: this.source.page(name) }, image, make("span", { style: `border-color: ${this.colour(name)}` }, name));
      const said = make("td", { class: "state", "data-state": state?.outcome ?? "failed" }, stateOf(row),
        state?.end && state.outcome === "running" ? make("progress", { max: state.end, value: state.time ?? 0, "aria-label": `progress of ${name}` }) : "");
      const made = make("tr", {}, make("th", { scope: "row" }, link), said, ...columns.slice(2).map((column) => {
        const value = this.value(row, column);
        return make("td", {}, value === null ? "" : typeof value === "number" ? shown(value) : String(value));
      }));
      for (const [event, on] of [["pointerenter", true], ["pointerleave", false], ["focusin", true], ["focusout", false]]) made.addEventListener(event, () => this.point(on ? name : null));
      return made;
    });
    const found = table(head, rows, "points");
    found.querySelectorAll("thead th").forEach((it, k) => {
      if (this.by?.[0] === columns[k][0]) it.setAttribute("aria-sort", this.down ? "descending" : "ascending");
    });
    this.list.replaceChildren(found);
    if (held) this.list.querySelector(`[data-column="${CSS.escape(held)}"]`)?.focus();
  }

  /** The curves of all points over each other, a chart for each column of their series. */
  draw() {
    const there = this.rows.map((it) => it.name).filter((name) => this.series.get(name)?.table.data[0]?.length);
    if (!there.length) return;
    const members = new Set(this.ensembles.flatMap((it) => it.members));
    const curves = there.map((name) => ({ ...this.series.get(name).table, colour: this.colour(name), label: name, thin: members.has(name) }));
    const means = this.ensembles.map(({ name }, k) => ({ ...this.bands.get(name)?.table, colour: hue(k, this.ensembles.length), label: name })).filter((it) => it.data);
    this.charts = new TableCharts([...curves, ...means], null);
    this.curves.replaceChildren(this.charts.element);
    this.charts.filter(this.find.value);
  }

  /** Make the curve of a point stand out, of none where it is null. */
  point(name) {
    for (const curve of this.curves.querySelectorAll("path.curve")) {
      curve.classList.toggle("faded", name !== null && curve.dataset.label !== name);
    }
  }
}

export async function openSweep(element, title, source = null) {
  const sweep = new Sweep(element, title, source ?? served);
  window.sweep = sweep;
  if (source) {
    await sweep.look();
    return;
  }
  await again(() => sweep.look(), (text, state) => sweep.say(text, state));
}
