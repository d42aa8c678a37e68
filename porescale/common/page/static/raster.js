/** Cells and discs as pixels, drawn by the processor: a picture costs as much as it has pixels, however many discs. */

const HERE = [[0, 0]];

/** Shifts (m) under which what reaches `size` about a place is seen: none first, then images over periodic sides. */
export function images(x, y, size, wide, high) {
  if (!wide && !high) return HERE;
  const over = (at, length) => [0, ...(length && at < size ? [length] : []), ...(length && at > length - size ? [-length] : [])];
  return over(x, wide).flatMap((sx) => over(y, high).map((sy) => [sx, sy]));
}

export class Raster {
  /** A picture of so many pixels: colours, and which disc is where (number + 1, 0 for none). */
  constructor(width, height) {
    this.width = width;
    this.height = height;
    this.image = new ImageData(width, height);
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.owner = new Int32Array(width * height);
  }

  clear(colour) {
    this.pixels.fill(colour);
    this.owner.fill(0);
  }

  /** Cells of a grid in their colours;  place : {x0, y0 (pixels of the origin of lengths), scale (pixels a metre)}. */
  cells(grid, colours, place) {
    const [ny, nx] = grid.shape;
    const [left, right, bottom, top] = grid.extent;
    const [dx, dy] = grid.spacing.map((it) => it * grid.every);
    const columns = new Int32Array(this.width);
    for (let i = 0; i < this.width; i++) {
      const x = (i + 0.5 - place.x0) / place.scale;
      columns[i] = x >= left && x < right ? Math.min(nx - 1, Math.floor((x - left) / dx)) : -1;
    }
    for (let j = 0; j < this.height; j++) {
      const y = (place.y0 - j - 0.5) / place.scale;
      if (y < bottom || y >= top) continue;
      const row = nx * Math.min(ny - 1, Math.floor((y - bottom) / dy));
      const at = j * this.width;
      for (let i = 0; i < this.width; i++) if (columns[i] >= 0) this.pixels[at + i] = colours[row + columns[i]];
    }
  }

  /** Discs in their colours.  x, y, radius : m, one radius for all if it is a number;  colours : one each, or one;
   *  angle : rad, of a mark from the middle to the rim, or null;  rim : its colour, null for none;
   *  hollow : the rim alone;  owned : whether they can be found by `owner`;  place : as of cells, with the period of the
   *  box in x and y, m, 0 where there is none. */
  discs({ x, y, radius, colours, angle = null, rim = null, hollow = false, owned = true }, place) {
    const { width, height, pixels, owner } = this;
    const one = typeof radius === "number";
    const several = typeof colours !== "number";
    const [wide, high] = one ? [0, 0] : place.period;
    for (let k = 0; k < x.length; k++) {
      for (const [sx, sy] of images(x[k], y[k], one ? 0 : radius[k], wide, high)) {
        const cx = place.x0 + (x[k] + sx) * place.scale - 0.5;
        const cy = place.y0 - (y[k] + sy) * place.scale - 0.5;
        const r = Math.max(0.75, (one ? radius : radius[k]) * place.scale);
        if (!(cx > -r - 1 && cx < width + r + 1 && cy > -r - 1 && cy < height + r + 1)) continue;
        const fill = several ? colours[k] : colours;
        const band = rim === null || r < 2 ? 0 : Math.min(hollow ? 2 : 1.2, 0.3 * r);
        const inner = r - band;
        const outside = (r + 0.5) * (r + 0.5);
        const solid = Math.max(0, inner - 0.5) ** 2;
        const marked = angle !== null && r >= 4;
        const cosine = marked ? Math.cos(angle[k]) : 0;
        const sine = marked ? Math.sin(angle[k]) : 0;
        const thick = Math.max(0.5, 0.09 * r);
        const last = Math.min(height - 1, Math.floor(cy + r + 0.5));
        for (let j = Math.max(0, Math.ceil(cy - r - 0.5)); j <= last; j++) {
          const dy = j - cy;
          const reach = Math.sqrt(Math.max(0, outside - dy * dy));
          const end = Math.min(width - 1, Math.floor(cx + reach));
          for (let i = Math.max(0, Math.ceil(cx - reach)); i <= end; i++) {
            const dx = i - cx;
            const square = dx * dx + dy * dy;
            if (square >= outside) continue;
            const at = j * width + i;
            if (owned && square < r * r) owner[at] = k + 1;
            if (square < solid) {
              if (hollow) continue;
              const along = dx * cosine - dy * sine;
              const across = dx * sine + dy * cosine;
              pixels[at] = marked && along > 0.4 * r && Math.abs(across) < thick ? rim : fill;
              continue;
            }
            const distance = Math.sqrt(square);
            const cover = Math.min(1, Math.max(0, r + 0.5 - distance));
            const edge = band ? Math.min(1, Math.max(0, distance - inner + 0.5)) : 0;
            const own = hollow ? rim : edge ? mixed(fill, rim, edge) : fill;
            pixels[at] = mixed(pixels[at], own, hollow ? cover * edge : cover);
          }
        }
      }
    }
  }
}

/** A pixel between two: share of the second, in 256ths; red and blue at once. */
function mixed(first, second, share) {
  if (share >= 1) return second;
  const b = (share * 256) | 0;
  const a = 256 - b;
  const outer = (((first & 0xff00ff) * a + (second & 0xff00ff) * b) >>> 8) & 0xff00ff;
  const green = (((first & 0xff00) * a + (second & 0xff00) * b) >>> 8) & 0xff00;
  return (0xff000000 | outer | green) >>> 0;
}
