/** A frame as a picture: cells, grains or particles to scale, and lines over them. */

import { CRACK, GRAIN, RIM, css, fromHex, lengthUnit, paint, paintKinds, tickTexts, ticks } from "./colours.js";
import { arrows, chains, streamlines } from "./flow.js";
import { Raster, images } from "./raster.js";
import { cellAt } from "./values.js";

const MARGIN = { left: 52, right: 8, top: 8, bottom: 36 };
const MOST_PIXELS = 2.6e6;

export class Picture {
  /** canvas : to draw in;  meta : of the run. */
  constructor(canvas, meta) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { alpha: false });
    this.meta = meta;
    this.raster = null;
    this.view = [...meta.view];
    this.place = { x0: 0, y0: 0, scale: 1, period: meta.look.period };
    this.kept = new Map();
  }

  /** Fit to so many CSS pixels; true where that changed anything. */
  resize(width, height) {
    let ratio = Math.min(window.devicePixelRatio || 1, 2);
    ratio = Math.min(ratio, Math.sqrt(MOST_PIXELS / (width * height)));
    const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
    this.ratio = ratio;
    if (this.canvas.width === w && this.canvas.height === h && this.raster) return false;
    Object.assign(this.canvas, { width: w, height: h });
    this.inner = {
      left: Math.round(MARGIN.left * ratio), top: Math.round(MARGIN.top * ratio),
      width: Math.max(8, w - Math.round((MARGIN.left + MARGIN.right) * ratio)),
      height: Math.max(8, h - Math.round((MARGIN.top + MARGIN.bottom) * ratio)),
    };
    this.raster = new Raster(this.inner.width, this.inner.height);
    return true;
  }

  /** Scale and shift so that the view fills the picture. */
  fit() {
    const [left, right, bottom, top] = this.view;
    const { width, height } = this.inner;
    const scale = Math.min(width / (right - left), height / (top - bottom));
    const x0 = 0.5 * (width - scale * (right - left)) - scale * left;
    const y0 = 0.5 * (height + scale * (top - bottom)) + scale * bottom;
    this.place = { x0, y0, scale, period: this.meta.look.period };
  }

  /** What is in sight, m. */
  sight() {
    const { x0, y0, scale } = this.place;
    return [-x0 / scale, (this.inner.width - x0) / scale, (y0 - this.inner.height) / scale, y0 / scale];
  }

  /** Place (m) of a point of the canvas in CSS pixels, and the number of its pixel in the raster (-1 outside). */
  locate(x, y) {
    const [i, j] = [x * this.ratio - this.inner.left, y * this.ratio - this.inner.top];
    const within = i >= 0 && j >= 0 && i < this.inner.width && j < this.inner.height;
    const at = within ? Math.floor(j) * this.inner.width + Math.floor(i) : -1;
    return { x: (i - this.place.x0) / this.place.scale, y: (this.place.y0 - j) / this.place.scale, at };
  }

  /** CSS pixels of a place (m). */
  project(x, y) {
    return [
      (this.inner.left + this.place.x0 + x * this.place.scale) / this.ratio,
      (this.inner.top + this.place.y0 - y * this.place.scale) / this.ratio,
    ];
  }

  /** Draw a frame as `choice` says (see controls.js);  other : the frame of another run over it, or null. */
  draw(frame, choice, other = null) {
    this.fit();
    const style = getComputedStyle(this.canvas);
    this.ink = style.getPropertyValue("--ink").trim() || "#1d2126";
    this.faint = style.getPropertyValue("--faint").trim() || "#8a8f98";
    const paper = style.getPropertyValue("--paper").trim() || "#ffffff";
    this.paper = fromHex(paper);
    this.raster.clear(this.paper);
    this.cells(frame, choice);
    if (choice.cloud) this.points(frame, choice);
    if (other && choice.cloud) this.outlines(other, choice);
    const { context, inner } = this;
    context.fillStyle = paper;
    context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    context.putImageData(this.raster.image, inner.left, inner.top);
    context.save();
    context.beginPath();
    context.rect(inner.left, inner.top, inner.width, inner.height);
    context.clip();
    this.bodies(frame, choice);
    this.over(frame, choice);
    context.restore();
    this.axes();
  }

  /** Cells, with what is solid in grey. */
  cells(frame, choice) {
    const grid = choice.field && frame.block("grids", choice.grid);
    const values = grid && (choice.values?.cells ?? frame.scalar("grids", choice.grid, choice.field));
    if (!values) return;
    const colours = paint(values, choice.limits.cells, this.paper);
    const solid = this.meta.look.walls && frame.scalar("grids", choice.grid, this.meta.look.walls);
    const wall = fromHex("#565a61");
    if (solid) for (let k = 0; k < colours.length; k++) if (solid[k] > 0.5) colours[k] = wall;
    this.raster.cells(grid, colours, this.place);
  }

  /** Colours of the points of a cloud: pixels, or one pixel for all. */
  colours(frame, choice) {
    const values = choice.values?.points ?? (choice.colour && frame.scalar("clouds", choice.cloud, choice.colour));
    if (!values) return fromHex(GRAIN);
    if (choice.kinds && choice.colour === choice.kindsOf) return paintKinds(values, choice.kinds, fromHex("#9aa0a8"));
    return paint(values, choice.limits.points, fromHex("#9aa0a8"));
  }

  /** Discs to scale, or dots, of the chosen cloud; other phases faint behind them. */
  points(frame, choice) {
    const { look } = this.meta;
    if (choice.behind) {
      for (const name of choice.phases.filter((it) => it !== choice.cloud)) {
        if (!frame.block("clouds", name)) continue;
        const [x, y] = frame.parts("clouds", name, "position");
        this.raster.discs({ x, y, radius: look.dot, colours: mixedHex(this.paper), owned: false }, this.place);
      }
    }
    const cloud = frame.block("clouds", choice.cloud);
    if (!cloud || cloud.lines || cloud.offsets) return;
    const [x, y] = frame.parts("clouds", choice.cloud, "position");
    const radius = frame.parts("clouds", choice.cloud, "radius")[0];
    this.raster.discs({
      x, y, radius: radius ?? look.dot, colours: this.colours(frame, choice),
      angle: choice.marks && radius ? (frame.parts("clouds", choice.cloud, "angle")[0] ?? null) : null,
      rim: radius ? fromHex(RIM) : null,
    }, this.place);
  }

  /** Rims of the grains of another run. */
  outlines(other, choice) {
    if (!other.block("clouds", choice.cloud)) return;
    const [x, y] = other.parts("clouds", choice.cloud, "position");
    const radius = other.parts("clouds", choice.cloud, "radius")[0] ?? this.meta.look.dot;
    const rim = fromHex("#d0263b");
    this.raster.discs({ x, y, radius, colours: rim, rim, hollow: true, owned: false }, this.place);
  }

  /** Polygons and segments of clouds that have them, but bonds. */
  bodies(frame, choice) {
    for (const [name, cloud] of Object.entries(frame.clouds)) {
      if (name === "bonds" || !(cloud.offsets || cloud.lines)) continue;
      const own = { ...choice, cloud: name, values: null };
      const tinted = choice.colour && frame.scalar("clouds", name, choice.colour);
      const colours = tinted ? this.colours(frame, own) : null;
      const [x, y] = frame.parts("clouds", name, "position");
      const thick = frame.parts("clouds", name, "radius")[0];
      const driven = frame.parts("clouds", name, "driven")[0];
      const colour = (k) => (driven?.[k] ? "#c3c8d0" : colours ? css(colours[k]) : GRAIN);
      let [sx, sy] = [0, 0];
      const path = (points, closed) => {
        this.context.beginPath();
        points.forEach((k, n) => this.context[n ? "lineTo" : "moveTo"](...this.device(x[k] + sx, y[k] + sy)));
        if (closed) this.context.closePath();
      };
      const [offsets] = frame.links(name, "offsets");
      const [corners] = frame.links(name, "corners");
      Object.assign(this.context, { lineJoin: "round", lineCap: "round" });
      const seen = x.length ? Array.from(x).flatMap((_, k) => images(x[k], y[k], thick?.[k] ?? 0, ...this.place.period)) : [];
      for ([sx, sy] of new Map(seen.map((it) => [String(it), it])).values()) {
        for (let k = 0; offsets && k + 1 < offsets.length; k++) {
          const own = Array.from(corners.subarray(offsets[k], offsets[k + 1]));
          path(own, true);
          const width = 2 * (thick?.[own[0]] ?? 0) * this.place.scale;
          this.stroke(RIM, width + 2);
          if (width > 1) this.stroke(colour(own[0]), width);
          this.context.fillStyle = colour(own[0]);
          this.context.fill();
        }
        const [from, to] = frame.links(name, "lines");
        for (const wider of from ? [2, 0] : []) {
          for (let k = 0; k < from.length; k++) {
            path([from[k], to[k]], false);
            const width = Math.max(1.5, 2 * (thick?.[from[k]] ?? 0) * this.place.scale);
            this.stroke(wider ? RIM : colour(from[k]), width + wider);
          }
        }
      }
    }
  }

  /** Lines of walls and gates, bonds, cracks, force chains, streamlines, arrows. */
  over(frame, choice) {
    const { context } = this;
    const sight = this.sight();
    if (choice.chains) {
      const found = this.once(frame, "chains", () => chains(frame, "contacts", choice.numbered));
      const forces = found.map((it) => it[4]).sort((a, b) => a - b);
      const strong = forces[Math.floor(0.99 * (forces.length - 1))] || 1;
      const thickest = 0.9 * choice.meanRadius * this.place.scale;
      context.lineCap = "round";
      for (const [x0, y0, x1, y1, force, sliding] of found) {
        this.line([[x0, y0], [x1, y1]], sliding ? "#e2893b" : "#8c1c2f", Math.max(0.4, Math.min(2, force / strong) * thickest));
      }
    }
    if (choice.bonds && frame.clouds.bonds) {
      const [x, y] = frame.parts("clouds", "bonds", "position");
      const [whole] = frame.parts("clouds", "bonds", "whole");
      for (let k = 0; k + 1 < x.length; k += 2) {
        if (whole[k]) this.line([[x[k], y[k]], [x[k + 1], y[k + 1]]], "#2f6fb0", 1.2 * this.ratio);
      }
    }
    if (choice.streamlines) {
      for (const it of this.once(frame, "streamlines", () => streamlines(frame, choice.streamlines, this.meta.view))) {
        this.line(pairs(it), choice.field ? "rgba(255,255,255,0.75)" : this.faint, 1.1 * this.ratio);
      }
    }
    if (choice.arrows) this.arrows(arrows(frame, ...choice.arrows, sight, 34), choice.field ? "#ffffff" : this.ink);
    for (const [x0, y0, x1, y1] of frame.lines) this.line([[x0, y0], [x1, y1]], this.ink, 2 * this.ratio);
    if (choice.cracks) for (const [x0, y0, x1, y1] of frame.marks) this.line([[x0, y0], [x1, y1]], CRACK, 2 * this.ratio);
  }

  /** Arrows as long as a raster's step at the fastest. */
  arrows(found, colour) {
    const fastest = Math.max(...found.map((it) => Math.hypot(it[2], it[3])).filter(Number.isFinite), 0);
    if (!(fastest > 0)) return;
    const longest = (1.3 * Math.max(this.inner.width, this.inner.height)) / 34;
    for (const [x, y, u, v] of found) {
      const speed = Math.hypot(u, v);
      const length = (longest * speed) / fastest;
      if (!(length > 1.5 * this.ratio)) continue;
      const [i, j] = this.device(x, y);
      const [dx, dy] = [(length * u) / speed, (-length * v) / speed];
      this.context.beginPath();
      this.context.moveTo(i - 0.5 * dx, j - 0.5 * dy);
      this.context.lineTo(i + 0.5 * dx, j + 0.5 * dy);
      for (const side of [-1, 1]) {
        this.context.moveTo(i + 0.5 * dx, j + 0.5 * dy);
        this.context.lineTo(i + 0.2 * dx - 0.16 * side * dy, j + 0.2 * dy + 0.16 * side * dx);
      }
      this.stroke(colour, 1.1 * this.ratio);
    }
  }

  /** Ticks and labels of both axes. */
  axes() {
    const { context, inner, ratio } = this;
    const [factor, unit] = lengthUnit(this.meta.view, this.meta.look.plain);
    const [left, right, bottom, top] = this.sight().map((it) => it * factor);
    context.font = `${12 * ratio}px system-ui, sans-serif`;
    Object.assign(context, { fillStyle: this.ink, strokeStyle: this.faint, lineWidth: ratio });
    context.strokeRect(inner.left - 0.5, inner.top - 0.5, inner.width + 1, inner.height + 1);
    const [right_, base] = [inner.left + inner.width, inner.top + inner.height];
    Object.assign(context, { textAlign: "center", textBaseline: "top" });
    const across = ticks(left, right, Math.max(2, inner.width / (90 * ratio)));
    const upward = ticks(bottom, top, Math.max(2, inner.height / (60 * ratio)));
    const [acrossTexts, upwardTexts] = [across, upward].map(tickTexts);
    for (const [k, tick] of across.entries()) {
      const x = inner.left + (inner.width * (tick - left)) / (right - left);
      context.fillRect(x, base, ratio, 4 * ratio);
      if (x < right_ - 8 * ratio) context.fillText(acrossTexts[k], x, base + 6 * ratio);
    }
    context.fillText(`x${unit && ` (${unit})`}`, inner.left + 0.5 * inner.width, base + 21 * ratio);
    Object.assign(context, { textAlign: "right", textBaseline: "middle" });
    for (const [k, tick] of upward.entries()) {
      const y = base - (inner.height * (tick - bottom)) / (top - bottom);
      context.fillRect(inner.left - 4 * ratio, y, 4 * ratio, ratio);
      context.fillText(upwardTexts[k], inner.left - 7 * ratio, Math.max(y, 8 * ratio));
    }
    context.save();
    context.translate(10 * ratio, inner.top + 0.5 * inner.height);
    context.rotate(-0.5 * Math.PI);
    context.textAlign = "center";
    context.fillText(`y${unit && ` (${unit})`}`, 0, 0);
    context.restore();
  }

  /** What is at a point of the canvas (CSS pixels): {x, y, grain (-1 none), cell (-1 none)}, or null outside. */
  find(frame, choice, x, y) {
    const there = this.locate(x, y);
    if (there.at < 0) return null;
    const grid = choice.field && frame.block("grids", choice.grid);
    const body = this.bodyAt(frame, there.x, there.y);
    return { ...there, grain: this.raster.owner[there.at] - 1, cell: grid ? cellAt(grid, there.x, there.y) : -1, body };
  }

  /** The polygon around a place: [cloud, first corner's point], or null. */
  bodyAt(frame, x, y) {
    for (const [name, cloud] of Object.entries(frame.clouds)) {
      if (!cloud.offsets || name === "bonds") continue;
      const [px, py] = frame.parts("clouds", name, "position");
      const [offsets] = frame.links(name, "offsets");
      const [corners] = frame.links(name, "corners");
      for (let k = 0; k + 1 < offsets.length; k++) {
        const own = corners.subarray(offsets[k], offsets[k + 1]);
        let inside = false;
        for (let a = 0, b = own.length - 1; a < own.length; b = a++) {
          const [xa, ya, xb, yb] = [px[own[a]], py[own[a]], px[own[b]], py[own[b]]];
          if (ya > y !== yb > y && x < xa + ((xb - xa) * (y - ya)) / (yb - ya)) inside = !inside;
        }
        if (inside) return [name, own[0]];
      }
    }
    return null;
  }

  device(x, y) {
    return [this.inner.left + this.place.x0 + x * this.place.scale, this.inner.top + this.place.y0 - y * this.place.scale];
  }

  line(points, colour, width) {
    this.context.beginPath();
    points.forEach((it, k) => this.context[k ? "lineTo" : "moveTo"](...this.device(...it)));
    this.stroke(colour, width);
  }

  stroke(colour, width) {
    Object.assign(this.context, { strokeStyle: colour, lineWidth: width });
    this.context.stroke();
  }

  /** What takes long to find of a frame, found once. */
  once(frame, what, find) {
    if (!frame.cache.has(what)) frame.cache.set(what, find());
    return frame.cache.get(what);
  }
}

const pairs = (flat) => Array.from({ length: flat.length / 2 }, (_, k) => [flat[2 * k], flat[2 * k + 1]]);

/** The colour of phases behind: between that of the paper and grey. */
const mixedHex = (paper) => ((paper & 255) > 127 ? fromHex("#e3e6ea") : fromHex("#30353c"));
