/** Values along a line that is drawn over the picture. */

import { Chart, make } from "./charts.js";
import { cellAt } from "./values.js";

const SAMPLES = 240;

export class Profile {
  /** changed : called with the ends [x, y, x, y] (m) when they are typed, and with null when the line is removed. */
  constructor(changed) {
    this.inputs = ["x from", "y from", "x to", "y to"].map((name) =>
      make("input", { type: "number", step: "any", "aria-label": `${name} (m)`, onchange: () => this.typed() }));
    const [a, b, c, d] = this.inputs;
    this.remove = make("button", { type: "button", onclick: () => changed(null) }, "remove");
    this.charts = make("div", { class: "charts" });
    this.element = make("div", { class: "profile", hidden: true },
      make("div", { class: "ends" }, make("b", {}, "Line"), " from x ", a, " y ", b, " to x ", c, " y ", d, " m ", this.remove),
      this.charts);
    this.changed = changed;
  }

  typed() {
    const ends = this.inputs.map((it) => Number(it.value));
    if (ends.every(Number.isFinite)) this.changed(ends);
  }

  /** Show the values along `ends` of frames of one run or two, of what is chosen. */
  show(ends, frames, choice, meta) {
    this.element.hidden = !ends;
    if (!ends) return;
    this.inputs.forEach((it, k) => {
      if (it !== document.activeElement) it.value = Number(ends[k].toPrecision(5));
    });
    const charts = [];
    if (choice.field) charts.push(this.chart(meta.quantities.grids[choice.grid], choice.field, choice.grid,
      frames.map((it) => alongCells(it, choice, ends))));
    if (choice.cloud && choice.colour) charts.push(this.chart(meta.quantities.clouds[choice.cloud], choice.colour, choice.cloud,
      frames.map((it) => alongPoints(it, choice, ends, meta.look.dot))));
    this.charts.replaceChildren(...charts);
  }

  chart(quantities, key, block, curves) {
    const chart = new Chart({ title: `${block}: ${key.replaceAll("_", " ")}`, unit: quantities?.[key]?.unit ?? "", axis: "along (m)" });
    chart.set(curves.filter((it) => it.x.length));
    return chart.element;
  }
}

/** Values of cells at places along a line: {x: way along it, y}. */
export function alongCells(frame, choice, [x0, y0, x1, y1]) {
  const grid = frame.block("grids", choice.grid);
  const values = grid && frame.scalar("grids", choice.grid, choice.field);
  const found = { x: [], y: [] };
  const length = Math.hypot(x1 - x0, y1 - y0);
  for (let k = 0; values && k <= SAMPLES; k++) {
    const share = k / SAMPLES;
    const cell = cellAt(grid, x0 + share * (x1 - x0), y0 + share * (y1 - y0));
    found.x.push(share * length);
    found.y.push(cell < 0 ? null : values[cell]);
  }
  return found;
}

/** Values of the points that a line passes through, in the order along it. */
export function alongPoints(frame, choice, [x0, y0, x1, y1], dot) {
  const values = frame.scalar("clouds", choice.cloud, choice.colour);
  const [px, py] = values ? frame.parts("clouds", choice.cloud, "position") : [[], []];
  const [radius] = frame.parts("clouds", choice.cloud, "radius");
  const length = Math.hypot(x1 - x0, y1 - y0) || 1;
  const [u, v] = [(x1 - x0) / length, (y1 - y0) / length];
  const found = [];
  for (let k = 0; k < px.length; k++) {
    const along = (px[k] - x0) * u + (py[k] - y0) * v;
    const off = Math.abs((py[k] - y0) * u - (px[k] - x0) * v);
    if (along >= 0 && along <= length && off <= (radius ? radius[k] : 1.1 * dot)) found.push([along, values[k]]);
  }
  found.sort((a, b) => a[0] - b[0]);
  return { x: found.map((it) => it[0]), y: found.map((it) => it[1]), dots: true };
}
