/** The page of a run: openReport(element, source) fills an element with all that a source has. */

import { TableCharts, make, nearest } from "./charts.js";
import { setMaps, shown } from "./colours.js";
import { Controls } from "./controls.js";
import { Picture } from "./draw.js";
import { about, check, section, verdicts } from "./panels.js";
import { Player } from "./player.js";
import { Profile } from "./profile.js";
import { Frame, cellAt, cellInFile } from "./values.js";
import { View } from "./view.js";

const KEPT = 24;
const POINT = "point at the picture for values";

/** A run behind its source, with the frames that were read last. */
class Run {
  constructor(source, meta) {
    Object.assign(this, { source, meta, frames: new Map(), first: null });
  }

  /** Frame i, a promise. */
  frame(i) {
    if (!this.frames.has(i)) {
      this.frames.set(i, this.read(i));
      for (const old of [...this.frames.keys()].slice(0, -KEPT)) if (old !== 0) this.frames.delete(old);
    }
    return this.frames.get(i);
  }

  async read(i) {
    try {
      const first = i ? await this.frame(0) : null;
      return new Frame(await this.source.frame(i), first);
    } catch (error) {
      this.frames.delete(i);
      throw error;
    }
  }
}

export async function openReport(element, source) {
  const runs = [];
  for (const each of [source, ...(source.others ?? [])]) runs.push(new Run(each, await each.meta()));
  setMaps(runs[0].meta.maps);
  const report = new Report(element, runs);
  await report.start();
  element.dataset.state = "ready";
  return report;
}

class Report {
  constructor(element, runs) {
    Object.assign(this, { element, runs, meta: runs[0].meta, tables: [], line: null, drawing: false, pointed: null });
    const names = runs.map((it) => it.meta.name);
    this.names = runs.map(({ meta }) => (names.filter((it) => it === meta.name).length > 1 ? meta.folder : meta.name));
  }

  async start() {
    const { meta, element } = this;
    element.classList.add("porescale-report");
    element.replaceChildren(this.heading());
    if (meta.times.length) await this.stage();
    element.append(section("charts", "Over time", this.finder(), (this.charts = make("div", { class: "tables" }))));
    await this.fillTables();
    element.append(verdicts(meta.verdicts), check(meta.check), ...about(meta));
    if (meta.times.length) {
      const alone = element.getRootNode() === element.ownerDocument; // else one of many in a notebook
      (alone ? element.ownerDocument : element).addEventListener("keydown", (event) => this.key(event));
      const again = () => this.resize();
      if (window.ResizeObserver) new ResizeObserver(again).observe(this.area.parentElement);
      window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.redraw());
      this.resize();
      await this.player.seek(0);
    }
  }

  heading() {
    const { meta } = this;
    const ended = `${meta.outcome || "run"}${meta.problem ? `: ${meta.problem}` : ""}`;
    const { rows } = meta.verdicts;
    const passed = rows.filter((it) => it.passed).length;
    const facts = [["run", this.names.join(", ")], ["of", `${meta.package} ${meta.card.versions?.porescale ?? ""}`],
      [meta.outcome === "running" ? "is" : "ended", ended], ["frames", String(meta.times.length)], ["took", meta.card.seconds ? `${shown(meta.card.seconds, 3)} s` : ""],
      ["expected", rows.length ? `${passed} of ${rows.length}` : ""]];
    const list = make("dl", { class: "facts" }, ...facts.filter(([, it]) => it).map(([key, it]) =>
      make("div", { class: key === "expected" && passed < rows.length ? "missed" : "" }, make("dt", {}, key), make("dd", {}, it))));
    return make("header", {}, make("h1", {}, meta.title), list);
  }

  /** The picture with its player and controls. */
  async stage() {
    const { meta, runs } = this;
    const sample = await runs[0].frame(0);
    meta.marked = sample.marks.length > 0 || (await runs[0].frame(meta.times.length - 1)).marks.length > 0;
    this.area = make("canvas", { tabindex: 0, role: "img", "aria-label": `${meta.title}: picture of the frame; plus, minus and 0 zoom, shift and arrows point` });
    this.above = make("canvas", { class: "above", "aria-hidden": "true" });
    this.said = make("output", { class: "hover", "aria-live": "polite" }, POINT);
    this.picture = new Picture(this.area, meta);
    this.controls = new Controls(meta, sample, this.names.slice(1), () => this.redraw());
    this.player = new Player(meta.times, (i) => this.show(i));
    this.profile = new Profile((ends) => this.setLine(ends));
    const view = (this.view = new View(this.picture, this.area, this));
    const tool = (text, label, click) => make("button", { type: "button", "aria-label": label, title: label, onclick: click }, text);
    this.draws = make("button", { type: "button", "aria-pressed": "false", title: "values along a line that you draw", onclick: () => this.toggleLine() }, "line");
    const tools = make("div", { class: "tools" }, tool("+", "zoom in", () => view.zoom(1.35)), tool("−", "zoom out", () => view.zoom(1 / 1.35)),
      tool("all", "whole picture", () => view.reset()), this.draws, tool("save", "save the picture as PNG", () => this.save()));
    const left = make("div", { class: "left" }, make("div", { class: "canvas" }, this.area, this.above), this.player.element,
      make("div", { class: "below" }, this.said, tools), this.profile.element);
    this.element.append(section("picture", "Picture", make("div", { class: "stage" }, left, this.controls.element)));
  }

  finder() {
    this.find = make("input", { type: "search", placeholder: "front, energy, force …", "aria-label": "columns to show", oninput: () => this.filter() });
    return make("p", { class: "finder" }, "Columns ", this.find, this.runs.length > 1 ? make("span", { class: "legend" },
      ...this.names.map((name, k) => make("span", { style: `border-color: var(--${["first", "second", "third", "fourth"][k % 4]})` }, name))) : "");
  }

  filter() {
    for (const it of this.tables) it.charts.element.parentElement.hidden = it.charts.charts.length > 0 && !it.charts.filter(this.find.value);
  }

  /** Charts of every table, those over time open. */
  async fillTables() {
    const names = this.meta.tables;
    const [found, elements, before] = [[], [], this.tables];
    if (!names.length) elements.push(make("p", {}, "The run folder holds no table."));
    for (const name of names) {
      const tables = await Promise.all(this.runs.map((it) => (it.meta.tables.includes(name) ? it.source.table(name) : null)));
      const charts = new TableCharts(tables, (time) => this.seekTime(time));
      const [{ kind, rows, every }] = tables;
      const held = every > 1 ? `, one row in ${every} shown` : "";
      const open = before.find((it) => it.name === name)?.charts.element.parentElement.open ?? kind === "series";
      elements.push(make("details", { open }, make("summary", {}, make("b", {}, `${name}.csv`), ` ${rows} rows${held}`), charts.element));
      found.push({ name, charts });
    }
    this.tables = found;
    this.charts.replaceChildren(...elements);
    this.filter();
  }

  /** Read the source again, as after the run has gone on: new frames and rows; stays at the end if it was there. */
  async refresh() {
    const before = this.meta.times.length;
    Object.assign(this.meta, await this.runs[0].source.meta());
    this.element.querySelector("header").replaceWith(this.heading());
    this.element.querySelector("#verdicts").replaceWith(verdicts(this.meta.verdicts));
    await this.fillTables();
    if (!this.player) return;
    this.controls.showBars();
    this.player.times = this.meta.times;
    this.player.slider.max = Math.max(0, this.meta.times.length - 1);
    await this.player.seek(this.player.at >= before - 1 ? this.meta.times.length - 1 : this.player.at);
  }

  /** Show frame i: picture, cursors, profile. */
  async show(i) {
    this.wanted = i;
    const mode = this.controls.mode?.value ?? "";
    const run = this.runs[0];
    const frame = await run.frame(i);
    const second = mode ? this.runs[1 + Number(mode.split(" ")[1])] : null;
    const other = second && second.meta.times.length ? await second.frame(nearest(second.meta.times, frame.time)) : null;
    if (this.wanted !== i) return;
    if (i + 1 < this.meta.times.length) run.frame(i + 1).catch(() => {}); // it is asked for again when it is shown
    Object.assign(this, { frame, other });
    this.redraw();
    for (const it of this.tables) it.charts.at(frame.time);
  }

  /** Draw what is shown anew; another mode of two runs may need another frame. */
  redraw() {
    const mode = this.controls.mode?.value ?? "";
    if (mode !== (this.mode ?? "")) {
      this.mode = mode;
      this.show(this.player.at);
      return;
    }
    if (!this.frame || !this.picture.raster) return;
    const [way] = mode.split(" ");
    const shownFrame = way === "other" && this.other ? this.other : this.frame;
    let choice = this.controls.choice();
    const values = way === "minus" && this.other ? this.difference(choice) : null;
    this.controls.seen = values ?? {
      cells: choice.field ? shownFrame.scalar("grids", choice.grid, choice.field) : null,
      points: choice.colour ? shownFrame.scalar("clouds", choice.cloud, choice.colour) : null,
    };
    if (values) this.controls.showBars();
    choice = { ...this.controls.choice(), values };
    if (this.controls.refused && way !== "minus") {
      this.controls.refused.textContent = this.other ? `the other run is shown at t = ${shown(this.other.time, 6)} s` : "";
    }
    this.choice = choice;
    this.drawn = shownFrame;
    this.picture.draw(shownFrame, choice, way === "over" ? this.other : null);
    this.profile.show(this.line, this.other && way ? [this.frame, this.other] : [this.frame], choice, this.meta);
    this.mark();
    if (this.pointed) this.hover(this.pointed);
  }

  /** Values of this run less those of the other: of cells at the same places, of points by number. */
  difference(choice) {
    const { frame, other } = this;
    const found = { cells: null, points: null };
    const why = [];
    const [one, two] = [frame, other].map((it) => choice.field && it.block("grids", choice.grid));
    if (one && two) {
      const [a, b] = [frame, other].map((it) => it.scalar("grids", choice.grid, choice.field));
      const [ny, nx] = one.shape;
      const [dx, dy] = one.spacing.map((it) => it * one.every);
      found.cells = a.map((value, k) => {
        const cell = cellAt(two, one.extent[0] + ((k % nx) + 0.5) * dx, one.extent[2] + (Math.floor(k / nx) + 0.5) * dy);
        return cell < 0 ? NaN : value - b[cell];
      });
    }
    const [a, b] = [frame, other].map((it) => choice.colour && it.scalar("clouds", choice.cloud, choice.colour));
    if (a && b && a.length === b.length) found.points = a.map((value, k) => value - b[k]);
    else if (a) why.push(`points are not compared: ${a.length} here, ${b?.length ?? 0} there`);
    why.push(`the other run is shown at t = ${shown(other.time, 6)} s`);
    this.controls.refused.textContent = why.join("; ");
    return found;
  }

  /** Say what is at a point of the canvas (CSS pixels), null for none. */
  hover(point) {
    this.pointed = point;
    const found = point && this.drawn && this.picture.find(this.drawn, this.choice, ...point);
    this.mark(found);
    if (!found) {
      this.said.textContent = POINT;
      return;
    }
    const { choice, drawn } = this;
    const parts = [`x ${shown(found.x, 5)} m, y ${shown(found.y, 5)} m`];
    const value = (kind, block, quantity, number, given) => {
      const info = this.meta.quantities[kind][block]?.[quantity];
      const all = given ?? drawn.scalar(kind, block, quantity);
      if (!all || !quantity) return "";
      const error = drawn.error(kind, block, quantity) * (given ? 2 : 1);
      const named = choice.kinds && quantity === choice.kindsOf ? choice.kinds[all[number]]?.[0] : null;
      return ` ${quantity.replaceAll("_", " ")} ${named ?? shown(all[number], 6)}${info?.unit ? ` ${info.unit}` : ""}${error ? ` ± ${shown(error, 2)}` : ""}`;
    };
    if (found.cell >= 0) {
      const [row, column] = cellInFile(drawn.block("grids", choice.grid), found.cell);
      parts.push(`cell (${row}, ${column})${value("grids", choice.grid, choice.field, found.cell, choice.values?.cells)}`);
    }
    if (found.grain >= 0) {
      const radius = drawn.scalar("clouds", choice.cloud, "radius");
      parts.push(`${radius ? "grain" : "particle"} ${found.grain}${value("clouds", choice.cloud, choice.colour, found.grain, choice.values?.points)}`
        + `${radius ? `, radius ${shown(radius[found.grain], 4)} m` : ""}`);
    } else if (found.body) {
      const [cloud, point_] = found.body;
      const number = drawn.parts("clouds", cloud, "body")[0]?.[point_] ?? point_;
      parts.push(`body ${number}${drawn.scalar("clouds", cloud, choice.colour) ? value("clouds", cloud, choice.colour, point_) : ""}`);
    }
    this.said.textContent = parts.join(" · ");
  }

  /** The ring around the grain that is pointed at, and the line of the profile. */
  mark(found = null) {
    const { above, area, picture } = this;
    const ratio = picture.ratio;
    if (above.width !== area.width || above.height !== area.height) Object.assign(above, { width: area.width, height: area.height });
    const context = above.getContext("2d");
    context.reset();
    context.scale(ratio, ratio);
    const { left, top, width, height } = picture.inner;
    context.beginPath();
    context.rect(left / ratio, top / ratio, width / ratio, height / ratio);
    context.clip();
    Object.assign(context, { strokeStyle: "#d0263b", lineWidth: 2 });
    if (found?.grain >= 0) {
      const [x, y] = this.drawn.parts("clouds", this.choice.cloud, "position").map((it) => it[found.grain]);
      const radius = this.drawn.parts("clouds", this.choice.cloud, "radius")[0]?.[found.grain] ?? this.meta.look.dot;
      context.beginPath();
      context.arc(...picture.project(x, y), Math.max(3, (radius * picture.place.scale) / ratio + 1), 0, 7);
      context.stroke();
    }
    if (this.line) {
      const [x0, y0, x1, y1] = this.line;
      context.beginPath();
      context.moveTo(...picture.project(x0, y0));
      context.lineTo(...picture.project(x1, y1));
      context.stroke();
    }
  }

  /** Show values along a line, [x, y, x, y] m; null for none. */
  setLine(ends) {
    this.line = ends;
    this.redraw();
  }

  toggleLine() {
    this.drawing = !this.drawing;
    this.draws.setAttribute("aria-pressed", String(this.drawing));
    this.area.classList.toggle("drawing", this.drawing);
    const [left, right, bottom, top] = this.picture.sight();
    if (this.drawing && !this.line) this.setLine([left, 0.5 * (bottom + top), right, 0.5 * (bottom + top)]);
  }

  seekTime(time) {
    this.player?.seek(nearest(this.meta.times, time));
  }

  save() {
    this.area.toBlob((content) => {
      const link = make("a", { href: URL.createObjectURL(content), download: `${this.meta.name}-${this.frame.step}.png` });
      link.click();
      URL.revokeObjectURL(link.href);
    });
  }

  /** Fit the picture to the width that there is. */
  resize() {
    const [left, right, bottom, top] = this.meta.view;
    const room = Math.max(160, this.area.parentElement.clientWidth);
    const most = Math.max(240, 0.74 * window.innerHeight);
    const shape = (right - left) / (top - bottom);
    const height = Math.round(Math.min(most, Math.max(120, (room - 60) / shape + 44)));
    const width = Math.round(Math.min(room, Math.max(300, (height - 44) * shape + 60)));
    for (const canvas of [this.area, this.above]) Object.assign(canvas.style, { width: `${width}px`, height: `${height}px` });
    if (this.picture.resize(width, height)) this.redraw();
  }

  /** Keys anywhere but in fields: play, step. */
  key(event) {
    const { target } = event;
    if (!this.element.isConnected) return; // another page of the run stands in its place
    if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    if (/^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName) && target.type !== "checkbox" && !(target === this.player.slider && event.key === " ")) return;
    if (event.key === " " && /^(BUTTON|SUMMARY|A|INPUT)$/.test(target.tagName) && target !== this.player.slider) return;
    this.player.key(event);
  }
}
