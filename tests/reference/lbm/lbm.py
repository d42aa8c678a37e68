"""Lattice Boltzmann, slow and obvious: D2Q9, two arrays, every link by itself.

Populations f (9, ny, nx) are whole (not shifted), in the order of Qian, d'Humieres & Lallemand 1992.  Collision: two
relaxation times (Ginzburg, Verhaeghe & d'Humieres 2008), force by Guo, Zheng & Shi 2002.  Sides: half-way bounce-back,
Ladd's moving wall (density at rest 1), free slip, periodic; a plate between two columns turns back the links it cuts.
Velocity sides: Ladd's wall with any velocity, less what convection adds to it.  Pressure sides: equilibrium at the
density of a mirror image, the rest extrapolated (Guo, Zheng & Shi 2002, Phys. Fluids 14).
"""

from dataclasses import dataclass, field

import numpy as np

C = [(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1)]
W = [4 / 9] + [1 / 9] * 4 + [1 / 36] * 4
BACK = [C.index((-cx, -cy)) for cx, cy in C]


def equilibrium(rho, ux, uy):
    """f_i = w_i rho (1 + 3 c.u + 9/2 (c.u)² - 3/2 u²), (9, *shape)."""
    out = []
    for (cx, cy), w in zip(C, W, strict=True):
        cu = cx * ux + cy * uy
        out.append(w * rho * (1 + 3 * cu + 4.5 * cu**2 - 1.5 * (ux**2 + uy**2)))
    return np.array(out)


def guo(ux, uy, fx, fy, even, odd):
    """Source of a force F, its even half times 1 - even/2 and its odd half times 1 - odd/2."""
    out = []
    for (cx, cy), w in zip(C, W, strict=True):
        cu, cf, uf = cx * ux + cy * uy, cx * fx + cy * fy, ux * fx + uy * fy
        out.append(w * ((1 - odd / 2) * 3 * cf + (1 - even / 2) * (9 * cu * cf - 3 * uf)))
    return np.array(out)


def trt(f, feq, even, odd):
    """-even (f+ - feq+) - odd (f- - feq-)."""
    g = f - feq
    return -even * (g + g[BACK]) / 2 - odd * (g - g[BACK]) / 2


@dataclass
class Lattice:
    """A box of nx by ny cells; ``sides``: kind of left, right, bottom, top, and its number: speed of a wall along
    itself, velocity (ux, uy) or one for each cell, density of a pressure side."""

    nx: int
    ny: int
    tau: float
    magic: float = 3 / 16
    force: tuple[float, float] = (0.0, 0.0)
    sides: dict[str, tuple[str, float]] = field(default_factory=dict)
    plate: int | None = None  # column to the right of the plate
    plate_edge: float = 0.0
    plate_speed: float = 0.0
    tables: dict = field(default_factory=dict)  # where every link leads, until the plate moves

    def __post_init__(self):
        self.f = equilibrium(np.ones((self.ny, self.nx)), 0.0, 0.0)
        self.even = 1 / self.tau
        self.odd = 1 / (0.5 + self.magic / (self.tau - 0.5))

    def side(self, name):
        return self.sides.get(name, ("wall", 0.0))

    def moments(self):
        """Density and first moments, (ny, nx) each."""
        cx, cy = np.array(C).T
        return self.f.sum(0), np.tensordot(cx, self.f, 1), np.tensordot(cy, self.f, 1)

    def collided(self):
        rho, jx, jy = self.moments()
        fx, fy = self.force
        ux, uy = (jx + fx / 2) / rho, (jy + fy / 2) / rho
        return (
            self.f
            + trt(self.f, equilibrium(rho, ux, uy), self.even, self.odd)
            + guo(ux, uy, fx, fy, self.even, self.odd)
        )

    def stream(self, g):
        key = (self.plate, self.plate_edge, self.plate_speed, repr(self.sides))
        if key not in self.tables:
            links = [(i, y, x) for i in range(9) for y in range(self.ny) for x in range(self.nx)]
            arrivals = [self.arrival(x, y, *C[i]) for i, y, x in links]
            self.tables = {key: [np.array(column) for column in zip(*arrivals, strict=True)]}
        out = np.full_like(g, np.nan)
        tx, ty, j, added = self.tables[key]
        out[j, ty, tx] = g.reshape(-1) + added
        self.through_pressure_sides(g, out)
        self.f = out

    def through_pressure_sides(self, g, out):
        for i, (cx, cy) in enumerate(C):
            for y, x in np.ndindex(self.ny, self.nx):
                owners = self.owners(self.crossed(x, y, cx, cy))
                if not owners or self.side(owners[0])[0] != "pressure":
                    continue
                (tx, ty), j = self.continued(x, y, cx, cy)
                f = self.f[:, ty, tx]
                rho = f.sum()
                ux = (f @ np.array(C)[:, 0] + self.force[0] / 2) / rho
                uy = (f @ np.array(C)[:, 1] + self.force[1] / 2) / rho

                def even(density, j=j, ux=ux, uy=uy):
                    e = equilibrium(density, ux, uy)
                    return (e[j] + e[BACK[j]]) / 2

                outside = 2 * np.mean([self.side(name)[1] for name in owners]) - rho
                out[BACK[i], y, x] = g[j, ty, tx] + even(outside) - even(rho)

    def continued(self, x, y, cx, cy):
        """Cell and direction that a link through a pressure side goes on from, as if the outside were like the inside:
        the cell next to the one outside where the link starts, if there is one; if not, its image."""
        sides = {name: self.side(name)[0] for name in self.crossed(x, y, cx, cy)}
        if list(sides.values()) == ["pressure", "pressure"]:
            return (x, y), C.index((-cx, -cy))
        tx = x if "pressure" in (sides.get("left"), sides.get("right")) else x + cx
        ty = y if "pressure" in (sides.get("bottom"), sides.get("top")) else y + cy
        for name, kind in sides.items():
            if kind == "slip":
                flip = (-cx, cy) if name in ("bottom", "top") else (cx, -cy)
                return (x, y), C.index(flip)
        return (tx % self.nx, ty % self.ny), C.index((-cx, -cy))

    def crossed(self, x, y, cx, cy):
        """The sides that a link crosses: left or right, bottom or top."""
        across = ["left"] if x + cx < 0 else ["right"] if x + cx >= self.nx else []
        return across + (["bottom"] if y + cy < 0 else ["top"] if y + cy >= self.ny else [])

    def owners(self, crossed):
        """Of those sides the ones of the kind that comes first."""
        for kind in ("velocity", "wall", "pressure", "slip", "periodic"):
            found = [name for name in crossed if self.side(name)[0] == kind]
            if found:
                return found
        return []

    def step(self):
        self.stream(self.collided())

    def arrival(self, x, y, cx, cy):
        """Where what leaves (x, y) along c ends up: cell, direction, and what is added on the way."""
        tx, ty = x + cx, y + cy
        across = "left" if tx < 0 else "right" if tx >= self.nx else None
        along = "bottom" if ty < 0 else "top" if ty >= self.ny else None
        kinds = {name: self.side(name)[0] for name in (across, along) if name}
        if across and kinds[across] == "periodic":
            tx %= self.nx
        if along and kinds[along] == "periodic":
            ty %= self.ny
        solid = [name for name in kinds if kinds[name] != "periodic"]
        back = C.index((-cx, -cy))
        owners = self.owners(self.crossed(x, y, cx, cy))
        kind = self.side(owners[0])[0] if owners else None
        if kind == "velocity":
            each = [np.broadcast_to(self.side(n)[1], (self.ny + self.nx, 2)) if np.ndim(self.side(n)[1]) == 1 else
                    np.asarray(self.side(n)[1]) for n in owners]  # fmt: skip
            given = []
            for name, velocity in zip(owners, each, strict=True):
                own, to = (y, ty) if name in ("left", "right") else (x, tx)
                if len(solid) == 2:  # a corner: no neighbour there, and nothing along the side into what is closed
                    closed = set(kinds.values()) & {"wall", "slip"}
                    along_x = name in ("bottom", "top")
                    keep = np.array([not (closed and along_x), not (closed and not along_x)])
                    given.append(velocity[own] * keep)
                else:  # where the link crosses the side, midway between its cell and the one that it leads to
                    given.append((velocity[own] + velocity[to]) / 2)
            ux, uy = np.mean(given, 0)
            late = (1 / self.odd - 0.5) * self.turned(owners, each, (x, y), np.array([-cx, -cy]), len(solid) == 2)
            return x, y, back, 6 * W[back] * (-cx * ux - cy * uy - late)
        if kind == "pressure":
            return x, y, back, 0.0  # overwritten
        if not solid:
            if self.cuts(x, x + cx, min(y, ty)):
                return x, y, back, 6 * W[back] * -cy * self.plate_speed
            return tx, ty, C.index((cx, cy)), 0.0
        if len(solid) == 1 and kinds[solid[0]] == "slip":
            if along in solid:
                if self.cuts(x, x + cx, y):
                    return x, y, back, 0.0
                return tx, y, C.index((cx, -cy)), 0.0
            return x, ty, C.index((-cx, cy)), 0.0
        if len(solid) == 2 and {kinds[name] for name in solid} <= {"wall", "slip"}:
            return x, y, back, 0.0
        wall_x = self.side(along)[1] if along in solid and kinds[along] == "wall" else 0.0
        wall_y = self.side(across)[1] if across in solid and kinds[across] == "wall" else 0.0
        return x, y, back, 6 * W[back] * (-cx * wall_x - cy * wall_y)

    def turned(self, owners, each, cell, c, corner):
        """N = 3 (c.u)(c.S.c) - 2 c.S.u of a link that comes in along c from velocity sides, S by differences between
        two cells of the side, u their mean;  none in a corner.  A straight link: the mean over both neighbours."""
        total = 0.0
        for name, velocity in zip(owners, each, strict=True):
            axis = 1 if name in ("left", "right") else 0  # along the side
            own, n = cell[axis], (self.nx, self.ny)[axis]
            wraps = self.side(("left", "bottom")[axis])[0] == "periodic"
            steps = [-c[axis]] if c[axis] else [-1, 1]
            for step in steps:
                if corner or not (wraps or 0 <= own + step < n):
                    continue
                u, slope = (
                    (velocity[own] + velocity[(own + step) % n]) / 2,
                    step * (velocity[(own + step) % n] - velocity[own]),
                )
                strain = np.zeros((2, 2))
                strain[axis, axis], strain[1 - axis, 1 - axis] = slope[axis], -slope[axis]
                strain[0, 1] = strain[1, 0] = slope[1 - axis] / 2
                total += (3 * np.dot(c, u) * (c @ strain @ c) - 2 * (c @ strain @ u)) / len(steps) / len(owners)
        return total

    def cuts(self, x, to, row):
        """Whether a link between columns x and ``to``, whose lower row is ``row``, crosses the plate."""
        return self.plate is not None and {x, to} == {self.plate - 1, self.plate} and row + 0.5 >= self.plate_edge
