/** Zoom, pan and hover over a picture, by mouse, fingers and keys. */

const STEP = 1.35;

export class View {
  /** picture : a Picture;  area : the element that takes the pointer;  report : told what changes. */
  constructor(picture, area, report) {
    Object.assign(this, { picture, area, report, pointers: new Map(), line: null });
    area.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    area.addEventListener("pointerdown", (event) => this.down(event));
    area.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) area.addEventListener(name, (event) => this.up(event));
    area.addEventListener("pointerleave", () => report.hover(null));
    area.addEventListener("keydown", (event) => this.key(event));
    area.addEventListener("dblclick", () => this.reset());
  }

  place(event) {
    const box = this.area.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** Zoom by a factor about a point of the canvas, its middle if none is given. */
  zoom(factor, point = [0.5 * this.area.clientWidth, 0.5 * this.area.clientHeight]) {
    const { picture } = this;
    const { x, y } = picture.locate(...point);
    const whole = picture.meta.view;
    const [left, right, bottom, top] = picture.view;
    const width = right - left;
    if ((whole[1] - whole[0]) / (width / factor) > 4000 || (whole[1] - whole[0]) / (width / factor) < 0.5) return;
    const near = (value, at) => at + (value - at) / factor;
    picture.view = [near(left, x), near(right, x), near(bottom, y), near(top, y)];
    this.changed();
  }

  /** Shift by shares of what is in sight. */
  shift(x, y) {
    const [left, right, bottom, top] = this.picture.view;
    const [dx, dy] = [x * (right - left), y * (top - bottom)];
    this.picture.view = [left + dx, right + dx, bottom + dy, top + dy];
    this.changed();
  }

  reset() {
    this.picture.view = [...this.picture.meta.view];
    this.changed();
  }

  changed() {
    const [left, right] = this.picture.view;
    const [first, last] = this.picture.meta.view;
    this.area.style.touchAction = right - left < 0.99 * (last - first) ? "none" : "pan-y";
    this.report.redraw();
  }

  wheel(event) {
    if (!event.ctrlKey && document.activeElement !== this.area) return;
    event.preventDefault();
    this.zoom(event.deltaY < 0 ? STEP : 1 / STEP, this.place(event));
  }

  down(event) {
    this.pointers.set(event.pointerId, this.place(event));
    if (this.report.drawing) {
      const { x, y } = this.picture.locate(...this.place(event));
      this.line = [x, y];
      event.preventDefault();
    }
    this.area.setPointerCapture(event.pointerId);
  }

  move(event) {
    const now = this.place(event);
    const before = this.pointers.get(event.pointerId);
    if (this.line) {
      const { x, y } = this.picture.locate(...now);
      this.report.setLine([...this.line, x, y]);
    } else if (before && this.pointers.size === 2) {
      const other = [...this.pointers].find(([id]) => id !== event.pointerId)[1];
      const span = (point) => Math.hypot(point[0] - other[0], point[1] - other[1]);
      const middle = [0.5 * (now[0] + other[0]), 0.5 * (now[1] + other[1])];
      this.pointers.set(event.pointerId, now);
      if (span(before) > 0) this.zoom(span(now) / span(before), middle);
    } else if (before && event.pointerType !== "touch" ? true : before && this.area.style.touchAction === "none") {
      const { scale } = this.picture.place;
      const factor = this.picture.ratio / scale;
      const [left, right, bottom, top] = this.picture.view;
      const [dx, dy] = [(before[0] - now[0]) * factor, (now[1] - before[1]) * factor];
      this.pointers.set(event.pointerId, now);
      if (dx || dy) {
        this.picture.view = [left + dx, right + dx, bottom + dy, top + dy];
        this.changed();
      }
    }
    this.report.hover(now);
  }

  up(event) {
    this.pointers.delete(event.pointerId);
    this.line = null;
  }

  key(event) {
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const way = arrows[event.key];
    if (event.key === "+" || event.key === "=") this.zoom(STEP);
    else if (event.key === "-") this.zoom(1 / STEP);
    else if (event.key === "0") this.reset();
    else if (way && event.shiftKey) {
      const [x, y] = this.report.pointed ?? [0.5 * this.area.clientWidth, 0.5 * this.area.clientHeight];
      this.report.hover([x + 8 * way[0], y - 8 * way[1]]);
    } else if (way && (event.ctrlKey || way[1])) this.shift(0.1 * way[0], 0.1 * way[1]);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
