"""Front of a column of water that is let go at once, inviscid and irrotational, by boundary elements: slow and plain.

The velocity is ∇φ, ∇²φ = 0.  On the surface p = 0, and its points move with the water (Longuet-Higgins & Cokelet, Proc.
R. Soc. A 350 (1976) 1; of this flow: Greco, PhD thesis, NTNU 2001),

    dx/dt = ∇φ,    dφ/dt = |∇φ|²/2 - g y,    φ = 0 at first.

Wall and floor are mirrors: with the images of the surface in x = 0 and y = 0 no other boundary is left, and Green's
identity over it, θ φ = ∮ (φ ∂ln r/∂n - ln r ∂φ/∂n) ds with θ the angle inside, gives ∂φ/∂n.  Straight elements,
φ and ∂φ/∂n linear on each.  Lengths over the column's width a, times over √(a/2g): g = ½.

    python -m tests.reference.continuum.dam_break        prints rows for continuum_sph/validation/water/dam_break.csv
"""

import numpy as np
from scipy.interpolate import CubicSpline

GRAVITY = 0.5
NEAR, FAR, GROWTH = 0.01, 0.04, 0.1
"""Distances of points at the tip and far from it, and how they grow with the distance to it."""
OFTEN = 10
"""Steps between two times that zig-zags are taken out."""


def start(height: float, near: float):
    """Points (n, 2) of the surface of a column 1 wide, from the wall to its foot; the corner is rounded by 0.1."""
    angle = np.linspace(0.5 * np.pi, 0.0, 200)
    round_ = np.column_stack((0.9 + 0.1 * np.cos(angle), height - 0.1 + 0.1 * np.sin(angle)))
    x = np.vstack(([[0.0, height]], round_, [[1.0, 0.0]]))
    arc = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(x, axis=0).T))))
    fine = np.linspace(0.0, arc[-1], 4000)
    return spread(np.column_stack([np.interp(fine, arc, part) for part in x.T]), np.zeros(4000), near)[0]


def along(x):
    """Length of arc up to each of the points (n, 2)."""
    return np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(x, axis=0).T))))


def splines(x, phi):
    """Splines of x, y and φ over the arc, even about the wall at its start and about the floor at its end."""
    arc = along(x)
    flat, free = (1, 0.0), (2, 0.0)
    return (
        arc,
        CubicSpline(arc, x[:, 0], bc_type=(free, flat)),  # odd about the wall, even about the floor
        CubicSpline(arc, x[:, 1], bc_type=(flat, free)),
        CubicSpline(arc, phi, bc_type=(flat, flat)),
    )


def spread(x, phi, near: float):
    """The same surface with points ``near`` apart at the tip, farther as the distance to it grows."""
    arc, of_x, of_y, of_phi = splines(x, phi)
    fine = np.linspace(0.0, arc[-1], 8000)
    apart = np.clip(near + GROWTH * (arc[-1] - fine), near, FAR * near / NEAR)
    number = np.concatenate(([0.0], np.cumsum(np.diff(fine) * 2.0 / (apart[1:] + apart[:-1]))))
    at = np.interp(np.linspace(0.0, number[-1], int(np.ceil(number[-1])) + 1), number, fine)
    made = np.column_stack((of_x(at), of_y(at)))
    made[0, 0] = made[-1, 1] = 0.0
    return made, of_phi(at)


def normal_speed(x, phi):
    """∂φ/∂n (n,) outwards at the points (n, 2) of a surface."""
    count = len(x)
    single, double = np.zeros((count, count)), np.zeros((count, count))
    for mirror in ((1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)):
        images, turned_round = x * mirror, mirror[0] * mirror[1] < 0.0
        first, last = (images[1:], images[:-1]) if turned_round else (images[:-1], images[1:])
        way = last - first
        length = np.hypot(*way.T)
        way = way / length[:, None]
        from_first = x[:, None] - first[None]
        u = np.einsum("ijk,jk->ij", from_first, way)  # along the element
        d = from_first[..., 0] * way[:, 1] - from_first[..., 1] * way[:, 0]  # across, above 0 in the water
        beyond = u - length
        with np.errstate(divide="ignore", invalid="ignore"):
            log_first = np.where(u**2 + d**2 > 0.0, np.log(u**2 + d**2), 0.0)
            log_last = np.where(beyond**2 + d**2 > 0.0, np.log(beyond**2 + d**2), 0.0)
        seen = np.arctan2(u, np.abs(d)) - np.arctan2(beyond, np.abs(d))
        seen = np.where(np.abs(d) < 1e-13, 0.0, seen)
        # ∫ ln r, ∫ s ln r, ∫ ∂ln r/∂n and ∫ s ∂ln r/∂n over the element, s from its first end
        plain = 0.5 * (u * log_first - beyond * log_last) - length + np.abs(d) * seen
        first_moment = u * plain + 0.25 * ((beyond**2 + d**2) * (log_last - 1.0) - (u**2 + d**2) * (log_first - 1.0))
        turned = np.sign(d) * seen
        turned_moment = u * turned + 0.5 * d * (log_last - log_first)
        for at, (a, b) in (
            (single, (plain - first_moment / length, first_moment / length)),
            (double, (turned - turned_moment / length, turned_moment / length)),
        ):
            at[:, :-1] += b if turned_round else a
            at[:, 1:] += a if turned_round else b
    double[np.arange(count), np.arange(count)] -= double.sum(1)  # a uniform φ drives no flow
    return np.linalg.solve(single, double @ phi)


def rates(x, phi):
    """(dx/dt (n, 2), dφ/dt (n,)) of the points of a surface."""
    arc, of_x, of_y, of_phi = splines(x, phi)
    tangent = np.column_stack((of_x(arc, 1), of_y(arc, 1)))
    tangent /= np.hypot(*tangent.T)[:, None]
    outwards = np.column_stack((-tangent[:, 1], tangent[:, 0]))  # the water lies on the right of the way to the tip
    v = of_phi(arc, 1)[:, None] * tangent + normal_speed(x, phi)[:, None] * outwards
    v[0, 0] = v[-1, 1] = 0.0
    return v, 0.5 * (v**2).sum(1) - GRAVITY * x[:, 1]


def smooth(values, odd_at_wall: bool, odd_at_floor: bool):
    """``values`` (n,) without zig-zags, by five points (Longuet-Higgins & Cokelet), mirrored at both ends."""
    before = 2.0 * values[0] - values[2:0:-1] if odd_at_wall else values[2:0:-1]
    after = 2.0 * values[-1] - values[-2:-4:-1] if odd_at_floor else values[-2:-4:-1]
    f = np.concatenate((before, values, after))
    return (-f[:-4] + 4.0 * f[1:-3] + 10.0 * f[2:-2] + 4.0 * f[3:-1] - f[4:]) / 16.0


def advanced(x, phi, step: float):
    """Points and potential a ``step`` later, by Runge and Kutta's method of fourth order."""
    v1, c1 = rates(x, phi)
    v2, c2 = rates(x + 0.5 * step * v1, phi + 0.5 * step * c1)
    v3, c3 = rates(x + 0.5 * step * v2, phi + 0.5 * step * c2)
    v4, c4 = rates(x + step * v3, phi + step * c3)
    return x + step / 6.0 * (v1 + 2.0 * (v2 + v3) + v4), phi + step / 6.0 * (c1 + 2.0 * (c2 + c3) + c4)


def area(x):
    """Area of the water below the points (n, 2) of a surface."""
    return 0.5 * float(abs(np.sum(x[:-1, 0] * x[1:, 1] - x[1:, 0] * x[:-1, 1])))


def reach(x, depth: float):
    """How far water ``depth`` deep goes below the points (n, 2) of a surface; 0: its tip."""
    last = np.flatnonzero(x[:, 1] >= depth)[-1]
    if last == len(x) - 1:
        return float(x[-1, 0])
    (x0, y0), (x1, y1) = x[last], x[last + 1]
    return float(x0 + (x1 - x0) * (y0 - depth) / (y0 - y1))


def front(height: float, until: float, near: float = NEAR, depths=(0.0,)):
    """(k, 2 + depths): time, area of the water (that of the start, if nothing is wrong), how far it is so deep;  near:
    the distance of points at the tip."""
    x = start(height, near)
    phi, time, step, found = np.zeros(len(x)), 0.0, 0.3 * near, []
    while True:
        found.append((time, area(x), *(reach(x, depth) for depth in depths)))
        if time >= until:
            return np.array(found)
        x, phi = spread(*advanced(x, phi, step), near)
        if len(found) % OFTEN == 0:
            x = np.column_stack((smooth(x[:, 0], True, False), smooth(x[:, 1], False, True)))
            phi = smooth(phi, False, False)
        time += step


if __name__ == "__main__":
    NAMES = {0.0: "potential_flow", 0.025: "potential_flow_0.025a_deep", 0.05: "potential_flow_0.05a_deep"}
    rows = front(2.0, 2.9, 0.005, tuple(NAMES))
    for column, name in enumerate(NAMES.values(), 2):
        for time in np.arange(0.2, 2.81, 0.2):
            print(f"{name},{time:.1f},{np.interp(time, rows[:, 0], rows[:, column]):.3f}")
