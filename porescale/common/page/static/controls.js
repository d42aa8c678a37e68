/** What is shown of a run, and the controls that change it. */

import { fromHex, gradient, css, mapNames, tickTexts, ticks } from "./colours.js";
import { make } from "./charts.js";
import { robustRange } from "./values.js";

const APART = ["contacts", "bonds"];

export class Controls {
  /** meta : of the run;  sample : its first frame, null where there is none;  others : names of runs to compare with;
   *  changed : called when something else is to be drawn. */
  constructor(meta, sample, others, changed) {
    Object.assign(this, { meta, sample, changed, limits: new Map(), boxes: {} });
    const { look, quantities } = meta;
    this.element = make("div", { class: "controls" });
    const clouds = Object.keys(quantities.clouds).filter((it) => !APART.includes(it));
    this.cells = this.select("Cells", "no cells", quantities.grids, Object.keys(quantities.grids), false);
    this.points = this.select("Grains or particles", "none", quantities.clouds, clouds, true);
    this.cellBar = this.bar("cells");
    this.pointBar = this.bar("points");
    const add = (...parts) => this.element.append(...parts);
    if (Object.keys(quantities.grids).length) add(this.cells.label, this.cellBar.element);
    if (clouds.length) add(this.points.label, this.pointBar.element);
    this.phases = clouds.filter((it) => it !== look.cloud && sample && !sample.clouds[it].arrays.radius);
    const has = (array) => clouds.some((it) => sample?.clouds[it].arrays[array]);
    const checks = make("fieldset", {}, make("legend", {}, "Show"));
    const check = (key, text, there, on = false) => {
      if (!there) return;
      const box = make("input", { type: "checkbox", checked: on, onchange: () => changed() });
      this.boxes[key] = box;
      checks.append(make("label", {}, box, ` ${text}`));
    };
    this.velocity = this.withVelocity(clouds);
    check("marks", "orientation of grains", has("angle") && has("radius"), true);
    check("arrows", "velocity arrows", this.velocity !== null);
    check("streamlines", "streamlines", this.velocity?.[0] === "grids");
    check("chains", "force chains", sample?.clouds.contacts);
    check("bonds", "bonds", sample?.clouds.bonds);
    check("cracks", look.kinds?.["-1"]?.[0] ? `${look.kinds["-1"][0]} line` : "cracks", meta.marked, true);
    check("behind", "other phases behind", this.phases.length > 1, true);
    if (Object.keys(this.boxes).length) add(checks);
    this.mode = null;
    if (others.length) {
      this.mode = make("select", { onchange: () => changed() }, make("option", { value: "" }, "this run alone"));
      others.forEach((name, k) => {
        for (const [way, text] of [["over", "with the grains of"], ["other", "alone:"], ["minus", "difference to"]]) {
          this.mode.append(make("option", { value: `${way} ${k}` }, `${text} ${name}`));
        }
      });
      this.refused = make("p", { class: "refused", role: "status" });
      this.element.prepend(make("label", { class: "field" }, "Runs", this.mode), this.refused);
    }
    this.choose("cells", look.grid && look.field ? `${look.grid}/${look.field}` : "");
    this.choose("points", look.cloud ? `${look.cloud}/${look.colour}` : clouds.length ? `${clouds[0]}/` : "");
  }

  /** Where velocities are: of the cells of a fluid, else of the points of the first cloud that has them. */
  withVelocity(clouds) {
    const { sample, meta } = this;
    if (!sample) return null;
    const grid = [meta.look.grid, ...Object.keys(sample.grids)].find((it) => sample.grids[it]?.arrays.velocity);
    if (grid) return ["grids", grid];
    const cloud = [meta.look.cloud, ...clouds].find((it) => sample.clouds[it]?.arrays.velocity);
    return cloud ? ["clouds", cloud] : null;
  }

  /** A list of quantities, by grid or cloud where there are several. */
  select(title, none, blocks, names, plain) {
    const list = make("select", { onchange: () => { this.showBars(); this.changed(); } }, make("option", { value: "" }, none));
    for (const name of names) {
      const options = Object.entries(blocks[name]).map(([key, it]) =>
        make("option", { value: `${name}/${key}` }, `${names.length > 1 ? `${name}: ` : ""}${key.replaceAll("_", " ")}${it.unit ? ` (${it.unit})` : ""}`));
      if (plain) options.unshift(make("option", { value: `${name}/` }, `${name}, plain`));
      if (names.length > 1) list.append(make("optgroup", { label: name }, ...options));
      else list.append(...options);
    }
    return { list, label: make("label", { class: "field" }, title, list) };
  }

  /** A colour bar with its limits and map. */
  bar(what) {
    const low = make("input", { type: "number", step: "any", "aria-label": `lower limit of ${what}` });
    const high = make("input", { type: "number", step: "any", "aria-label": `upper limit of ${what}` });
    const map = make("select", { "aria-label": `colour map of ${what}` }, ...mapNames().map((it) => make("option", {}, it)));
    const auto = make("button", { type: "button", title: "limits of this frame" }, "auto");
    const paint = make("div", { class: "paint" });
    const scale = make("div", { class: "scale", "aria-hidden": "true" });
    const kinds = make("ul", { class: "kinds" });
    const limits = make("div", { class: "limits" }, low, high, map, auto);
    const element = make("div", { class: "bar" }, paint, scale, limits, kinds);
    const take = () => {
      const [a, b] = [Number(low.value), Number(high.value)];
      if (low.value !== "" && high.value !== "" && b > a) this.setLimits(what, { low: a, high: b, map: map.value });
    };
    for (const input of [low, high, map]) input.addEventListener("change", take);
    auto.addEventListener("click", () => {
      const values = this.seen?.[what];
      if (values) this.setLimits(what, Object.fromEntries(robustRange(values).map((it, k) => [["low", "high"][k], it])));
    });
    return { element, low, high, map, paint, scale, kinds, limits };
  }

  /** Show a quantity, "grid/quantity". */
  choose(what, value) {
    const { list } = what === "cells" ? this.cells : this.points;
    list.value = value;
    if (list.selectedIndex < 0) list.value = "";
    this.showBars();
  }

  setLimits(what, limits) {
    const key = this.key(what);
    this.limits.set(key, { ...this.limitsOf(what), ...limits });
    this.showBars();
    this.changed();
  }

  key(what) {
    const kind = what === "cells" ? "grids" : "clouds";
    return `${this.minus() ? "minus " : ""}${kind}/${(what === "cells" ? this.cells : this.points).list.value}`;
  }

  minus() {
    return Boolean(this.mode?.value.startsWith("minus"));
  }

  limitsOf(what) {
    const key = this.key(what);
    if (this.limits.has(key)) return this.limits.get(key);
    if (this.minus()) {
      const [low, high] = robustRange([...(this.seen?.[what] ?? []), ...Array.from(this.seen?.[what] ?? [], (it) => -it)]);
      const found = { low: Math.min(low, -high), high, map: "RdBu_r" };
      if (this.seen?.[what]) this.limits.set(key, found);
      return found;
    }
    const [kind, name, quantity] = key.split("/");
    return this.meta.quantities[kind]?.[name]?.[quantity] ?? { low: 0, high: 1, map: "viridis" };
  }

  /** What is shown, as `Picture.draw` takes it. */
  choice() {
    const on = (key) => Boolean(this.boxes[key]?.checked);
    const [grid = "", field = ""] = this.cells.list.value.split("/");
    const [cloud = "", colour = ""] = this.points.list.value.split("/");
    const { look } = this.meta;
    const kinds = look.kinds && Object.keys(look.kinds).length ? look.kinds : null;
    const numbered = ["grains", "frames"].filter((it) => this.sample?.clouds[it]);
    const own = this.phases.includes(cloud);
    const velocity = own && this.velocity?.[0] === "clouds" ? ["clouds", cloud] : this.velocity;
    return {
      grid, field, cloud, colour, kinds: this.minus() ? null : kinds, kindsOf: look.colour, numbered, phases: this.phases,
      limits: { cells: this.limitsOf("cells"), points: this.limitsOf("points") }, meanRadius: this.meanRadius(),
      marks: on("marks"), chains: on("chains"), bonds: on("bonds"), cracks: on("cracks"), behind: own && on("behind"),
      arrows: on("arrows") ? velocity : null, streamlines: on("streamlines") ? this.velocity[1] : "",
    };
  }

  meanRadius() {
    if (!this.boxes.chains) return 0;
    const values = this.sample?.clouds.grains ? this.sample.parts("clouds", "grains", "radius")[0] : [];
    return values.length ? values.reduce((a, b) => a + b, 0) / values.length : this.meta.look.dot || 0;
  }

  /** Colour bars of what is shown. */
  showBars() {
    const { kinds } = this.choice();
    for (const [what, bar, list] of [["cells", this.cellBar, this.cells.list], ["points", this.pointBar, this.points.list]]) {
      const [, quantity] = list.value.split("/");
      const named = what === "points" && kinds && quantity === this.meta.look.colour;
      bar.element.hidden = !quantity;
      if (!quantity) continue;
      for (const part of [bar.paint, bar.scale, bar.limits]) part.hidden = Boolean(named);
      const there = Object.entries(named ? kinds : {}).filter(([key]) => Number(key) >= 0);
      bar.kinds.replaceChildren(...there.map(([, [label, colour]]) =>
        make("li", {}, make("span", { class: "swatch", style: `background: ${css(fromHex(colour))}` }), label)));
      if (named) continue;
      const limits = this.limitsOf(what);
      bar.paint.style.background = gradient(limits.map);
      const marks = ticks(limits.low, limits.high, 5);
      const texts = tickTexts(marks);
      bar.scale.replaceChildren(...marks.map((it, k) => {
        const share = (100 * (it - limits.low)) / (limits.high - limits.low);
        return make("span", { style: `left: ${Math.min(96, Math.max(4, share)).toFixed(1)}%` }, texts[k]);
      }));
      bar.low.value = Number(limits.low.toPrecision(4));
      bar.high.value = Number(limits.high.toPrecision(4));
      bar.map.value = limits.map;
    }
  }
}
