/** Frames as numbers: the arrays of grids and clouds by name, decoded when they are first asked for. */

const PARTS = ["x", "y"];

export class Frame {
  /** buffer : as the Python module frames.py writes it;  first : the first frame, to which unchanged arrays refer. */
  constructor(buffer, first = null) {
    const length = new DataView(buffer).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
    Object.assign(this, head);
    this.buffer = buffer;
    this.start = 4 + length;
    this.first = first;
    this.cache = new Map();
  }

  /** The grid or cloud of a kind ("grids", "clouds"), or undefined. */
  block(kind, name) {
    return this[kind][name];
  }

  /** How an array is stored, in the frame that stores it: [frame, spec]; undefined where there is none. */
  spec(kind, name, array) {
    const spec = this.block(kind, name)?.arrays[array];
    return spec?.same ? this.first.spec(kind, name, array) : spec && [this, spec];
  }

  /** Components of an array, each a Float32Array (Float64Array where whole numbers need it). */
  parts(kind, name, array) {
    const found = this.spec(kind, name, array);
    if (!found) return [];
    const [owner, spec] = found;
    const block = owner.block(kind, name);
    return owner.decoded(`${kind}/${name}/${array}`, spec, kind === "grids" ? block.shape[0] * block.shape[1] : block.count);
  }

  /** Whole numbers of a cloud: "lines", "offsets" or "corners". */
  links(name, what) {
    const block = this.block("clouds", name);
    if (!block?.[what]) return [];
    const count = { lines: block.line_count, offsets: block.loop_count + 1, corners: block.corner_count }[what];
    return this.decoded(`${name}/${what}`, block[what], count);
  }

  decoded(key, spec, count) {
    if (!this.cache.has(key)) this.cache.set(key, decode(this.buffer, this.start, spec, count));
    return this.cache.get(key);
  }

  /** A quantity, as a page offers it: an array, the length of a vector ("speed" of a velocity), or a part of it. */
  scalar(kind, name, quantity) {
    const key = `scalar/${kind}/${name}/${quantity}`;
    if (this.cache.has(key)) return this.cache.get(key);
    const [array, part] = this.array(kind, name, quantity);
    const parts = array === null ? [] : this.parts(kind, name, array);
    let values = parts[part] ?? null;
    if (part < 0) {
      const [x, y] = parts;
      values = new Float32Array(x.length);
      for (let k = 0; k < x.length; k++) values[k] = Math.sqrt(x[k] * x[k] + y[k] * y[k]);
    }
    this.cache.set(key, values);
    return values;
  }

  /** The array of a quantity and which part of it: -1 for the length, [null, 0] where there is none. */
  array(kind, name, quantity) {
    const arrays = this.block(kind, name)?.arrays ?? {};
    const whole = quantity === "speed" && "velocity" in arrays ? "velocity" : quantity;
    if (whole in arrays) return [whole, this.spec(kind, name, whole)[1].width > 1 ? -1 : 0];
    const cut = quantity.lastIndexOf("_");
    const base = quantity.slice(0, cut);
    return base in arrays ? [base, PARTS.indexOf(quantity.slice(cut + 1))] : [null, 0];
  }

  /** Largest error of a quantity in this frame; of a length, that of both parts together. */
  error(kind, name, quantity) {
    const [array, part] = this.array(kind, name, quantity);
    if (array === null) return 0;
    const { error } = this.spec(kind, name, array)[1];
    return part < 0 ? Math.SQRT2 * error : error;
  }
}

/** The components of an array that starts at `start + spec.at` of a buffer. */
export function decode(buffer, start, spec, count) {
  const total = count * spec.width;
  const at = start + spec.at;
  const parts = Array.from({ length: spec.width });
  if (spec.type === "f4") {
    return parts.map((_, part) => new Float32Array(buffer.slice(at + 4 * part * count, at + 4 * (part + 1) * count)));
  }
  const size = Number(spec.type[1]);
  const bytes = new Uint8Array(buffer, at, total * size);
  const none = 2 ** (8 * size) - 1;
  return parts.map((_, part) => {
    const low = spec.low[part];
    const step = spec.step[part];
    const values = size > 2 || spec.whole ? new Float64Array(count) : new Float32Array(count);
    const at0 = part * count;
    if (size === 2 && !spec.across && !spec.whole) {
      for (let k = 0; k < count; k++) {
        const code = bytes[at0 + k] + 256 * bytes[total + at0 + k];
        values[k] = code === none ? NaN : low + step * code;
      }
      return values;
    }
    let left = 0;
    for (let k = 0; k < count; k++) {
      const place = at0 + k;
      let code = bytes[place];
      if (size > 1) code += bytes[total + place] * 256;
      if (size > 2) code += bytes[2 * total + place] * 65536 + bytes[3 * total + place] * 16777216;
      if (spec.across) {
        if (k % spec.across === 0) left = 0;
        left = ((left + code) & none) >>> 0; // of four bytes & gives a signed number
        code = left;
      }
      values[k] = code === none && !spec.whole ? NaN : low + step * code;
    }
    return values;
  });
}

/** Number of the cell of a grid that holds a place (m), in the frame's own rows; -1 outside. */
export function cellAt(grid, x, y) {
  const [left, right, bottom, top] = grid.extent;
  if (!(x >= left && x < right && y >= bottom && y < top)) return -1;
  const [ny, nx] = grid.shape;
  const column = Math.min(nx - 1, Math.floor((x - left) / (grid.spacing[0] * grid.every)));
  const row = Math.min(ny - 1, Math.floor((y - bottom) / (grid.spacing[1] * grid.every)));
  return row * nx + column;
}

/** Row and column in the run's files of a cell of a frame. */
export function cellInFile(grid, cell) {
  const nx = grid.shape[1];
  return [Math.floor(cell / nx), cell % nx].map((k) => k * grid.every + grid.first);
}

/** The range that holds all but a half per cent of the numbers at either end, zero in it where it is near. */
export function robustRange(values) {
  const known = Float64Array.from(values.filter?.(Number.isFinite) ?? []).sort();
  if (!known.length) return [0, 1];
  let low = known[Math.floor(0.005 * (known.length - 1))];
  let high = known[Math.ceil(0.995 * (known.length - 1))];
  if (low < 0 && high > 0) [low, high] = [-Math.max(-low, high), Math.max(-low, high)];
  else if (low >= 0 && low < 0.5 * high) low = 0;
  return high > low ? [low, high] : [low, low + (Math.abs(low) || 1) * 1e-3];
}
