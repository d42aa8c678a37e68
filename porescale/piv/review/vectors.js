/** A measured pair: where its vectors are, what is known of each, which are taken out. */

const NAMES = { x: Float32Array, y: Float32Array, u: Float32Array, v: Float32Array, uncertainty: Float32Array,
  correlation: Float32Array, valid: Uint8Array, replaced: Uint8Array, solid: Uint8Array, rejected: Uint8Array };

export class Vectors {
  /** data : arrays in base64 under their names, x (nx), y (ny), the rest (ny, nx); corner, step, whole of the page. */
  constructor(data) {
    for (const [name, kind] of Object.entries(NAMES)) {
      const bytes = Uint8Array.from(atob(data[name]), (sign) => sign.charCodeAt(0));
      this[name] = new kind(bytes.buffer);
    }
    Object.assign(this, { nx: this.x.length, ny: this.y.length, corner: data.corner, step: data.step, whole: data.whole });
    this.done = [];
  }

  /** State of a vector: "solid", "out" (taken out by hand), "valid" or "invalid". */
  state(k) {
    return this.solid[k] ? "solid" : this.rejected[k] ? "out" : this.valid[k] ? "valid" : "invalid";
  }

  /** Take a vector out or put it back; false where there is none. */
  toggle(k) {
    if (k < 0 || this.solid[k]) return false;
    this.rejected[k] ^= 1;
    this.done.push([k]);
    return true;
  }

  /** Put back all that are out. */
  clear() {
    const out = this.out();
    for (const k of out) this.rejected[k] = 0;
    if (out.length) this.done.push(out);
  }

  /** Take the last change back. */
  undo() {
    for (const k of this.done.pop() ?? []) this.rejected[k] ^= 1;
  }

  /** Numbers of those that are out. */
  out() {
    return Array.from(this.rejected.keys()).filter((k) => this.rejected[k]);
  }

  /** Number of the vector nearest to a pixel of the picture; -1 where that is further than a grid step or solid. */
  near(x, y) {
    const [i, j] = [closest(this.x, x), closest(this.y, y)];
    const k = j * this.nx + i;
    const far = Math.max(Math.abs(this.x[i] - x), Math.abs(this.y[j] - y)) > Math.max(1, this.step);
    return far || this.solid[k] ? -1 : k;
  }

  /** Number of the vector so many columns and rows on, as far as there are any that are not solid. */
  beside(k, columns, rows) {
    let [i, j] = [k % this.nx, Math.floor(k / this.nx)];
    while (true) {
      [i, j] = [i + columns, j + rows];
      if (i < 0 || j < 0 || i >= this.nx || j >= this.ny) return k;
      if (!this.solid[j * this.nx + i]) return j * this.nx + i;
    }
  }

  /** Number of the next invalid vector that is not out; k where there is none. */
  nextInvalid(k) {
    const count = this.valid.length;
    for (let n = 1; n <= count; n++) if (this.state((k + n) % count) === "invalid") return (k + n) % count;
    return k;
  }

  /** Rectangles [left, top, width, height] of whole pixels, of the whole picture, around vectors that are out.  Each has
   *  the pixel of its own vector in it, and of no other. */
  rectangles() {
    const side = (at, corner) => [Math.ceil(at - 0.5 * this.step) + corner, Math.ceil(at + 0.5 * this.step) + corner];
    return this.out().map((k) => {
      const [left, right] = side(this.x[k % this.nx], this.corner[0]);
      const [top, bottom] = side(this.y[Math.floor(k / this.nx)], this.corner[1]);
      return [left, top, right - left, bottom - top];
    });
  }
}

function closest(list, value) {
  const step = list.length > 1 ? (list[list.length - 1] - list[0]) / (list.length - 1) : 1;
  return Math.min(list.length - 1, Math.max(0, Math.round((value - list[0]) / step)));
}
