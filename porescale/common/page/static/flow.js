/** Arrows and streamlines of velocities, and chains of contact forces, as lines in metres. */

import { cellAt } from "./values.js";

/** Values (x, y) of a vector at a place, from the cells around it; null outside or where it is no number. */
function between(grid, [u, v], x, y) {
  const [left, , bottom] = grid.extent;
  const [ny, nx] = grid.shape;
  const a = (x - left) / (grid.spacing[0] * grid.every) - 0.5;
  const b = (y - bottom) / (grid.spacing[1] * grid.every) - 0.5;
  if (!(a >= -0.5 && b >= -0.5 && a <= nx - 0.5 && b <= ny - 0.5)) return null;
  const i = Math.min(Math.max(Math.floor(a), 0), nx - 2);
  const j = Math.min(Math.max(Math.floor(b), 0), ny - 2);
  const [s, t] = [Math.min(Math.max(a - i, 0), 1), Math.min(Math.max(b - j, 0), 1)];
  const k = j * nx + i;
  const mean = (w) => (1 - t) * ((1 - s) * w[k] + s * w[k + 1]) + t * ((1 - s) * w[k + nx] + s * w[k + nx + 1]);
  const found = [mean(u), mean(v)];
  return Number.isFinite(found[0]) && Number.isFinite(found[1]) ? found : null;
}

/** Arrows [x, y, u, v] about so many across the box: of the cells of a grid, or of the points nearest to a raster. */
export function arrows(frame, kind, name, view, across) {
  const parts = frame.parts(kind, name, "velocity");
  const block = frame.block(kind, name);
  if (parts.length < 2) return [];
  const step = Math.max(view[1] - view[0], view[3] - view[2]) / across;
  const found = [];
  if (kind === "grids") {
    for (let x = view[0] + 0.5 * step; x < view[1]; x += step) {
      for (let y = view[2] + 0.5 * step; y < view[3]; y += step) {
        const cell = cellAt(block, x, y);
        if (cell >= 0 && Number.isFinite(parts[0][cell])) found.push([x, y, parts[0][cell], parts[1][cell]]);
      }
    }
    return found;
  }
  const [px, py] = frame.parts(kind, name, "position");
  const taken = new Map();
  for (let k = 0; k < block.count; k++) {
    const [i, j] = [Math.floor((px[k] - view[0]) / step), Math.floor((py[k] - view[2]) / step)];
    const off = Math.hypot(px[k] - view[0] - (i + 0.5) * step, py[k] - view[2] - (j + 0.5) * step);
    const old = taken.get(`${i},${j}`);
    if (!old || off < old[0]) taken.set(`${i},${j}`, [off, k]);
  }
  for (const [, k] of taken.values()) found.push([px[k], py[k], parts[0][k], parts[1][k]]);
  return found;
}

/** Streamlines of a grid's velocity: lists of x, y, x, y …, evenly spread (midpoint rule, steps of half a cell). */
export function streamlines(frame, name, view, across = 22) {
  const grid = frame.block("grids", name);
  const parts = grid ? frame.parts("grids", name, "velocity") : [];
  if (parts.length < 2) return [];
  let fastest = 0;
  for (let k = 0; k < parts[0].length; k++) fastest = Math.max(fastest, Math.hypot(parts[0][k], parts[1][k]) || 0);
  const apart = Math.max(view[1] - view[0], view[3] - view[2]) / across;
  const size = 0.5 * grid.every * Math.min(...grid.spacing);
  const step = Math.max(size, apart / 8);
  const taken = new Map();
  const key = (x, y) => `${Math.floor((2 * x) / apart)},${Math.floor((2 * y) / apart)}`;
  const trace = (x, y, sign, number) => {
    const line = [];
    for (let k = 0; k < 400; k++) {
      const first = between(grid, parts, x, y);
      const speed = first && Math.hypot(...first);
      if (!first || speed < 1e-3 * fastest) break;
      const middle = between(grid, parts, x + (0.5 * sign * step * first[0]) / speed, y + (0.5 * sign * step * first[1]) / speed);
      const there = middle && Math.hypot(...middle);
      if (!there) break;
      x += (sign * step * middle[0]) / there;
      y += (sign * step * middle[1]) / there;
      const owner = taken.get(key(x, y));
      if (owner !== undefined && owner !== number) break;
      taken.set(key(x, y), number);
      line.push(x, y);
    }
    return line;
  };
  const found = [];
  let number = 0;
  for (let x = view[0] + 0.5 * apart; x < view[1]; x += apart) {
    for (let y = view[2] + 0.5 * apart; y < view[3]; y += apart) {
      if (taken.has(key(x, y))) continue;
      number += 1;
      taken.set(key(x, y), number);
      const back = trace(x, y, -1, number);
      const turned = [];
      for (let k = back.length - 2; k >= 0; k -= 2) turned.push(back[k], back[k + 1]);
      const line = [...turned, x, y, ...trace(x, y, 1, number)];
      if (line.length > 12) found.push(line);
    }
  }
  return found;
}

/** Chains of a cloud of contacts: [x, y, x, y, force, sliding] along the way between what touches. */
export function chains(frame, name, discs) {
  const contacts = frame.block("clouds", name);
  if (!contacts) return [];
  const [px, py] = frame.parts("clouds", name, "position");
  const [nx, ny] = frame.parts("clouds", name, "normal");
  const column = (array) => frame.parts("clouds", name, array)[0];
  const [first, second, force, overlap, sliding] = ["first", "second", "normal_force", "overlap", "sliding"].map(column);
  const radius = discs.flatMap((it) => Array.from(frame.parts("clouds", it, "radius")[0] ?? []));
  const found = [];
  for (let k = 0; k < contacts.count; k++) {
    if (!(force[k] > 0)) continue;
    const pair = second[k] >= 0;
    const r = radius[first[k]];
    const mean = r - overlap[k] * (pair ? 0.5 : 1);
    const length = r - overlap[k] + (pair ? radius[second[k]] : 0);
    const [x, y] = [px[k] - mean * nx[k], py[k] - mean * ny[k]];
    found.push([x, y, x + length * nx[k], y + length * ny[k], force[k], sliding?.[k] ?? 0]);
  }
  return found;
}
