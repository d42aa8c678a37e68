/** Texts of a run below its pictures: verdicts, what check said, the command, how exact the page is, the card. */

import { make } from "./charts.js";
import { shown } from "./colours.js";

/** A section with a heading that can be linked to. */
export function section(id, title, ...children) {
  return make("section", { id, "aria-labelledby": `${id}-title` }, make("h2", { id: `${id}-title` }, title), ...children);
}

/** A table that scrolls; head : texts or elements;  rows : its tr. */
export function table(head, rows, label) {
  const top = make("tr", {}, ...head.map((it) => make("th", { scope: "col" }, it)));
  return make("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": label },
    make("table", {}, make("thead", {}, top), make("tbody", {}, ...rows)));
}

const cells = (values) => values.map((it) => make("td", {}, it));

/** Verdicts of expected.toml. */
export function verdicts({ note, rows }) {
  const text = note ? [make("p", {}, note)] : [];
  if (!rows.length) return section("verdicts", "Expected", ...text);
  const words = { true: "✓ as expected", false: "✗ missed", null: "– not measured" };
  const found = rows.map((it) => make("tr", { class: it.passed === null ? "open" : it.passed ? "passed" : "missed" },
    make("th", { scope: "row" }, it.name), make("td", { class: "verdict" }, words[String(it.passed)]),
    ...cells([`${shown(it.value)} ${it.unit}`, `${shown(it.expected)} ± ${shown(it.tolerance)} ${it.unit}`, it.because])));
  const passed = rows.filter((it) => it.passed).length;
  return section("verdicts", "Expected", make("p", {}, `${passed} of ${rows.length} as expected.toml says.`), ...text,
    table(["quantity", "verdict", "this run", "expected", "because"], found, "verdicts"));
}

/** What check said. */
export function check({ note, groups = {}, warnings = [] }) {
  const parts = note ? [make("p", {}, note)] : [];
  parts.push(...warnings.map((it) => make("p", { class: "warning" }, make("b", {}, "warning: "), it)));
  const found = Object.entries(groups).map(([name, rows]) => make("div", { class: "group" }, make("h3", {}, name || "scene"),
    table(["name", "value", "unit", "note"], rows.map((it) => make("tr", {}, make("th", { scope: "row" }, it.name),
      ...cells([typeof it.value === "number" ? shown(it.value, 6) : asText(it.value), it.unit, it.note]))), name || "scene")));
  return section("check", "What check says", ...parts, make("div", { class: "groups" }, ...found));
}

const asText = (value) => (value === true ? "yes" : value === false ? "no" : Array.isArray(value) ? value.join(", ") : String(value ?? "–"));

/** The command, the exactness of the page, and the card. */
export function about(meta) {
  const { precision, quantities, errors = {} } = meta;
  const held = [];
  if (precision.full) held.push("Numbers are held in single precision (float32).");
  else held.push(`Numbers in cells are held in ${precision.bits} bits of the range of their frame, those of grains and particles in 16: `
    + "the largest errors of all frames are in the table. Whole numbers are exact.");
  if (precision.every > 1) held.push(`Of the cells one in ${precision.every} is held in either direction, the middle one of those that it stands for.`);
  if (precision.thin > 1) held.push(`Of ${precision.snapshots} snapshots one in ${precision.thin} is held, and the last.`);
  const rows = [];
  for (const [kind, blocks] of Object.entries(quantities)) {
    for (const [block, list] of Object.entries(blocks)) {
      for (const [key, error] of Object.entries(errors)) {
        const [owner, array] = key.split("/");
        if (owner !== block) continue;
        const unit = array === "position" ? "m" : (list[array] ?? list[array === "velocity" ? "speed" : array])?.unit ?? "";
        rows.push(make("tr", {}, make("th", { scope: "row" }, `${block}: ${array}`),
          ...cells([kind === "grids" ? "cells" : "points", error ? `± ${shown(error, 3)} ${unit}` : "exact"])));
      }
    }
  }
  const copy = make("button", { type: "button", onclick: () => navigator.clipboard?.writeText(meta.again) }, "copy");
  const parts = [section("again", "Make it again", make("div", { class: "command" }, make("code", {}, meta.again || "The card does not say how."), copy))];
  parts.push(section("exactness", "How exact this page is", make("p", {}, held.join(" ")),
    ...(rows.length ? [make("details", {}, make("summary", {}, "Largest error of each array"), table(["array", "of", "error"], rows, "errors"))] : [])));
  parts.push(section("card", "Card", make("details", {}, make("summary", {}, "card.json: scene with all defaults, versions, machine"),
    make("pre", { tabindex: 0 }, JSON.stringify(meta.card, null, 1)))));
  return parts;
}
