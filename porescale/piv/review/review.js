/** The page of a measured pair: pictures in turn, vectors over them, wrong ones taken out. */

import { css, gradient, paint, setMaps, shown, ticks } from "./colours.js";
import { Vectors } from "./vectors.js";
import { View } from "./view.js";

const COLOURS = { valid: "#ffd54a", invalid: "#4fc3ff", out: "#ffffff" };
const WORDS = { valid: "valid", invalid: "invalid, replaced by what is around", nothing: "invalid", out: "taken out" };
const RATES = [0.5, 0.7, 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10, 12];
const APART = 13;
const CLICK = 5;

/** Show a pair: see review.py for `data`. */
export async function openReview(data) {
  const pictures = await Promise.all(data.pictures.map(loaded));
  setMaps(data.maps);
  return new Review(data, pictures);
}

async function loaded(address) {
  const image = new Image();
  image.src = address;
  await image.decode();
  return image;
}

const get = (id) => document.getElementById(id);

class Review {
  constructor(data, pictures) {
    Object.assign(this, { data, pictures, vectors: new Vectors(data), which: 0, timer: null, chosen: -1, pressed: null });
    [this.width, this.height] = [pictures[0].naturalWidth, pictures[0].naturalHeight];
    this.meta = { view: [-0.5, this.width - 0.5, 0.5 - this.height, 0.5] };  // y up, as the view counts
    this.view = [...this.meta.view];
    this.limits = this.ranges();
    this.facts();
    this.controls();
    this.mover = new View(this, get("area"), this);
    this.keys();
    new ResizeObserver(() => this.redraw()).observe(get("area"));
    this.redraw();
    this.say();
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) this.flicker(true);
  }

  /** Ranges of what colours say, 2 to 98 per cent of the valid vectors. */
  ranges() {
    const { valid, uncertainty, correlation, u, v } = this.vectors;
    const found = {};
    const speed = u.map((it, k) => Math.hypot(it, v[k]));
    this.values = { uncertainty, correlation, speed };
    for (const [name, values] of Object.entries(this.values)) {
      const known = values.filter((it, k) => valid[k] && Number.isFinite(it)).sort();
      const at = (share) => known[Math.round(share * (known.length - 1))] ?? 0;
      found[name] = { low: at(0.02), high: Math.max(at(0.98), at(0.02) + 1e-9), map: name === "correlation" ? "falling" : "rising" };
    }
    this.fast = found.speed.high || 1;
    return found;
  }

  facts() {
    for (const [name, value, bad] of this.data.facts) {
      const row = document.createElement("div");
      row.append(Object.assign(document.createElement("dt"), { textContent: name }), Object.assign(document.createElement("dd"), { textContent: value }));
      if (bad) row.className = "missed";
      get("facts").append(row);
    }
    for (const text of this.data.doubts) get("doubts").append(Object.assign(document.createElement("p"), { className: "warning", textContent: text }));
    get("again").textContent = this.data.again;
    for (const option of get("colour").options) {
      if (["uncertainty", "speed"].includes(option.value)) option.textContent += ` (${this.data.unit})`;
    }
  }

  controls() {
    const click = (id, act) => get(id).addEventListener("click", act);
    click("flicker", () => this.flicker(this.timer === null));
    click("one", () => { this.flicker(false); this.show(0); });
    click("two", () => { this.flicker(false); this.show(1); });
    click("closer", () => this.mover.zoom(1.35));
    click("wider", () => this.mover.zoom(1 / 1.35));
    click("whole", () => this.mover.reset());
    click("undo", () => { this.vectors.undo(); this.changed(); });
    click("clear", () => { this.vectors.clear(); this.changed(); });
    click("save", () => this.save());
    get("rate").addEventListener("input", () => this.rate());
    for (const id of ["colour", "shown", "mean", "wrong", "length"]) get(id).addEventListener("input", () => this.redraw());
    get("light").addEventListener("input", () => this.redraw());
    const area = get("area");
    area.addEventListener("pointerdown", (event) => { this.pressed = [event.clientX, event.clientY]; });
    area.addEventListener("pointerup", (event) => this.click(event));
    this.rate();
    this.changed();
  }

  /** Keys of the page; those of the pictures alone first. */
  keys() {
    const area = get("area");
    area.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      if (way && event.shiftKey) this.mover.shift(0.1 * way[0], -0.1 * way[1]);
      else if (way) this.choose(this.chosen < 0 ? this.middle() : this.vectors.beside(this.chosen, ...way));
      else if (event.key === "n") this.choose(this.vectors.nextInvalid(this.chosen));
      else if (event.key === "Enter" || event.key === "x") this.toggle(this.chosen);
      else return;
      event.preventDefault();
      event.stopImmediatePropagation();
    }, { capture: true });
    const step = (by) => { get("rate").value = Number(get("rate").value) + by; this.rate(); };
    const acts = {
      " ": () => this.flicker(this.timer === null), ".": () => step(1), ",": () => step(-1),
      1: () => get("one").click(), 2: () => get("two").click(), v: () => get("shown").click(),
      c: () => { get("colour").selectedIndex = (get("colour").selectedIndex + 1) % get("colour").length; this.redraw(); },
      u: () => get("undo").click(), s: () => get("save").click(),
    };
    document.addEventListener("keydown", (event) => {
      const typing = event.target.closest("input, select, summary") || (event.target.closest("button") && event.key === " ");
      if (typing || event.ctrlKey || event.altKey || event.metaKey || !(event.key in acts)) return;
      acts[event.key]();
      event.preventDefault();
    });
  }

  /** Changes of picture a second, from the slider. */
  rate() {
    const hertz = RATES[Number(get("rate").value)];
    get("hertz").textContent = `${hertz} a second`;
    get("rate").setAttribute("aria-valuetext", get("hertz").textContent);
    if (this.timer !== null) this.flicker(true);
  }

  /** Start or stop showing the pictures in turn. */
  flicker(on) {
    if (this.timer !== null) clearInterval(this.timer);
    this.timer = on ? setInterval(() => this.show(1 - this.which), 1000 / RATES[Number(get("rate").value)]) : null;
    get("flicker").setAttribute("aria-pressed", String(on));
  }

  /** Show one of the two pictures. */
  show(which) {
    this.which = which;
    get("which").textContent = String(which + 1);
    get("one").setAttribute("aria-pressed", String(which === 0));
    get("two").setAttribute("aria-pressed", String(which === 1));
    this.backdrop();
  }

  /** For the view: place (px, y up) of a point of the area in CSS pixels. */
  locate(x, y) {
    const { scale, x0, y0 } = this.place;
    return { x: (x * this.ratio - x0) / scale, y: (y0 - y * this.ratio) / scale };
  }

  /** For the view, on every change: size, place, and both canvases. */
  redraw() {
    const area = get("area");
    const width = area.clientWidth;
    const high = Math.min((width * this.height) / this.width, Math.max(240, 0.78 * window.innerHeight));
    this.ratio = Math.min(window.devicePixelRatio || 1, 2);
    area.style.height = `${Math.round(high)}px`;
    for (const id of ["picture", "vectors"]) {
      const canvas = get(id);
      const [w, h] = [Math.round(width * this.ratio), Math.round(high * this.ratio)];
      if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
      canvas.style.height = `${Math.round(high)}px`;
    }
    const [left, right, bottom, top] = this.view;
    const { width: w, height: h } = get("picture");
    const scale = Math.min(w / (right - left), h / (top - bottom));
    this.place = { scale, x0: 0.5 * w - (0.5 * scale) * (left + right), y0: 0.5 * h + 0.5 * scale * (bottom + top) };
    this.backdrop();
    this.foreground();
    this.legend();
  }

  /** The picture of the moment. */
  backdrop() {
    const canvas = get("picture");
    const context = canvas.getContext("2d", { alpha: false });
    const { scale, x0, y0 } = this.place;
    context.fillStyle = "#000";
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.imageSmoothingEnabled = scale < 2;
    context.filter = `brightness(${get("light").value})`;
    context.drawImage(this.pictures[this.which], x0 - 0.5 * scale, y0 - 0.5 * scale, scale * this.width, scale * this.height);
    context.filter = "none";
  }

  /** Canvas pixels of a pixel of the picture, y down. */
  device(x, y) {
    return [this.place.x0 + this.place.scale * x, this.place.y0 + this.place.scale * y];
  }

  /** Numbers of the vectors that are drawn: all that are wrong, and of the others as many as have room. */
  drawn() {
    const { vectors, place } = this;
    const thin = Math.max(1, Math.ceil((APART * this.ratio) / (vectors.step * place.scale)));
    const off = thin >> 1;
    const found = [];
    for (let j = 0, k = 0; j < vectors.ny; j++) {
      for (let i = 0; i < vectors.nx; i++, k++) {
        const state = vectors.state(k);
        const kept = state === "valid" ? !get("wrong").checked && j % thin === off % thin && i % thin === off % thin : state !== "solid";
        if (kept) found.push(k);
      }
    }
    this.thin = thin;
    return found;
  }

  /** The vectors, dark rims around them, and a frame around the chosen one. */
  foreground() {
    const canvas = get("vectors");
    const context = canvas.getContext("2d");
    context.clearRect(0, 0, canvas.width, canvas.height);
    if (!get("shown").checked) return;
    const { vectors, ratio } = this;
    const numbers = this.drawn();
    const mean = get("mean").checked ? this.mean() : [0, 0];
    const fast = get("mean").checked ? this.spread(mean) : this.fast;
    const longest = 1.35 * this.thin * vectors.step * this.place.scale * 2 ** (0.5 * Number(get("length").value));
    const groups = new Map();
    const colour = this.colours();
    for (const k of numbers) {
      const style = colour(k);
      if (!groups.has(style)) groups.set(style, new Path2D());
      const path = groups.get(style);
      const [x, y] = this.device(vectors.x[k % vectors.nx], vectors.y[Math.floor(k / vectors.nx)]);
      if (vectors.rejected[k]) {
        const r = 4 * ratio;
        for (const side of [-1, 1]) { path.moveTo(x - r, y - side * r); path.lineTo(x + r, y + side * r); }
        continue;
      }
      const factor = longest / fast;
      const [dx, dy] = [factor * (vectors.u[k] - mean[0]), factor * (vectors.v[k] - mean[1])];
      path.moveTo(x - 0.5 * dx, y - 0.5 * dy);
      const [tx, ty] = [x + 0.5 * dx, y + 0.5 * dy];
      path.lineTo(tx, ty);
      for (const side of [-1, 1]) { path.moveTo(tx, ty); path.lineTo(tx - 0.3 * dx - 0.16 * side * dy, ty - 0.3 * dy + 0.16 * side * dx); }
    }
    Object.assign(context, { lineCap: "round", lineJoin: "round" });
    for (const [style, width] of [["rgba(0,0,0,0.65)", 3.2], [null, 1.4]]) {
      for (const [own, path] of groups) {
        Object.assign(context, { strokeStyle: style ?? own, lineWidth: width * ratio });
        context.stroke(path);
      }
    }
    if (this.chosen >= 0) {
      const [x, y] = this.device(vectors.x[this.chosen % vectors.nx], vectors.y[Math.floor(this.chosen / vectors.nx)]);
      const r = Math.max(8 * ratio, 0.5 * vectors.step * this.place.scale);
      for (const [style, width] of [["#000", 4], ["#fff", 2]]) {
        Object.assign(context, { strokeStyle: style, lineWidth: width * ratio });
        context.strokeRect(x - r, y - r, 2 * r, 2 * r);
      }
    }
  }

  /** Mean of the valid vectors, px. */
  mean() {
    const { u, v, valid, rejected } = this.vectors;
    const sum = [0, 0, 0];
    for (let k = 0; k < u.length; k++) if (valid[k] && !rejected[k]) { sum[0] += u[k]; sum[1] += v[k]; sum[2]++; }
    return [sum[0] / (sum[2] || 1), sum[1] / (sum[2] || 1)];
  }

  /** Distance from a mean, px, that 98 % of the valid vectors stay within. */
  spread(mean) {
    const { u, v, valid } = this.vectors;
    const known = u.map((it, k) => Math.hypot(it - mean[0], v[k] - mean[1])).filter((_, k) => valid[k]).sort();
    return known[Math.round(0.98 * (known.length - 1))] || 1;
  }

  /** A function that gives the colour of a vector. */
  colours() {
    const { vectors } = this;
    const what = get("colour").value;
    if (what === "validity") return (k) => COLOURS[vectors.state(k)];
    const painted = paint(this.values[what], this.limits[what], 0);
    return (k) => (vectors.state(k) === "valid" ? css(painted[k]) : COLOURS[vectors.state(k)]);
  }

  legend() {
    const what = get("colour").value;
    const kinds = what === "validity" ? Object.keys(COLOURS) : ["invalid", "out"];
    get("kinds").replaceChildren(...kinds.map((kind) => {
      const row = document.createElement("li");
      const swatch = Object.assign(document.createElement("span"), { className: "swatch" });
      swatch.style.background = COLOURS[kind];
      row.append(swatch, kind === "out" ? `× ${WORDS[kind]}` : WORDS[kind]);
      return row;
    }));
    get("bar").hidden = what === "validity";
    if (what === "validity") return;
    const { low, high, map } = this.limits[what];
    const factor = what === "correlation" ? 1 : this.data.speed;
    get("paint").style.background = gradient(map);
    get("scale").replaceChildren(...ticks(low * factor, high * factor, 3).map((tick) => {
      const mark = Object.assign(document.createElement("span"), { textContent: shown(tick) });
      mark.style.left = `${(100 * (tick - low * factor)) / ((high - low) * factor)}%`;
      return mark;
    }));
  }

  middle() {
    const { nx, ny } = this.vectors;
    return this.vectors.beside(Math.floor(ny / 2) * nx + Math.floor(nx / 2) - 1, 1, 0);
  }

  /** Choose a vector, bring it into sight, and say what is known of it. */
  choose(k) {
    this.chosen = k;
    const [x, y] = [this.vectors.x[k % this.vectors.nx], -this.vectors.y[Math.floor(k / this.vectors.nx)]];
    const [left, right, bottom, top] = this.view;
    const to = (low, high, at) => (at < low ? at - low - 0.1 * (high - low) : at > high ? at - high + 0.1 * (high - low) : 0);
    const [dx, dy] = [to(left, right, x), to(bottom, top, y)];
    this.view = [left + dx, right + dx, bottom + dy, top + dy];
    if (dx || dy) this.redraw();
    else this.foreground();
    this.say();
  }

  /** For the view: the pointer is at a point of the area, or away. */
  hover(point) {
    if (!point) return;
    const { x, y } = this.locate(...point);
    const k = this.vectors.near(x, -y);
    if (k === this.chosen) return;
    this.chosen = k;
    this.foreground();
    this.say();
  }

  /** What is known of the chosen vector. */
  say() {
    const { vectors, data, chosen: k } = this;
    if (k < 0) {
      get("reading").textContent = "Point at a vector, or go to one with the arrow keys.";
      return;
    }
    const [x, y] = [vectors.x[k % vectors.nx] + vectors.corner[0], vectors.y[Math.floor(k / vectors.nx)] + vectors.corner[1]];
    const parts = [`x ${shown(x)}, y ${shown(y)} px: u ${shown(vectors.u[k])}, v ${shown(vectors.v[k])} px`];
    if (data.scaled) parts[0] += ` (${shown(vectors.u[k] * data.speed)}, ${shown(-vectors.v[k] * data.speed)} ${data.unit})`;
    if (vectors.valid[k]) {
      const own = vectors.uncertainty[k];
      parts.push(`± ${shown(own, 2)} px${data.scaled ? ` (${shown(own * data.speed, 2)} ${data.unit})` : ""}`);
    }
    parts.push(`correlation ${shown(vectors.correlation[k], 3)}`, WORDS[vectors.state(k) === "invalid" && !vectors.replaced[k] ? "nothing" : vectors.state(k)]);
    get("reading").textContent = parts.join(", ");
  }

  /** A press that did not move the pictures takes out what is there, or puts it back. */
  click(event) {
    const [x, y] = this.pressed ?? [NaN, NaN];
    this.pressed = null;
    if (!(Math.hypot(event.clientX - x, event.clientY - y) < CLICK) || event.button) return;
    const box = get("area").getBoundingClientRect();
    const place = this.locate(event.clientX - box.left, event.clientY - box.top);
    this.chosen = this.vectors.near(place.x, -place.y);
    this.toggle(this.chosen);
  }

  toggle(k) {
    if (this.vectors.toggle(k)) this.changed();
  }

  /** What is out has changed. */
  changed() {
    const count = this.vectors.out().length;
    get("count").textContent = count ? `${count} taken out` : "none taken out";
    get("save").disabled = count === 0;
    get("clear").disabled = count === 0;
    get("undo").disabled = this.vectors.done.length === 0;
    if (this.place) { this.foreground(); this.say(); }
  }

  /** Hand the mask to the browser as a PNG of the whole picture's size, white where vectors are out. */
  save() {
    const canvas = document.createElement("canvas");
    [canvas.height, canvas.width] = this.vectors.whole;
    const context = canvas.getContext("2d", { alpha: false });
    context.fillStyle = "#000";
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.fillStyle = "#fff";
    for (const it of this.vectors.rectangles()) context.fillRect(...it);
    canvas.toBlob((blob) => {
      const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(blob), download: "reject.png" });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    }, "image/png");
  }

  /** For the view: nothing is drawn here but vectors. */
  setLine() {}
}
