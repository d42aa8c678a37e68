"""Where a scene puts its grains: inside the box, clear of each other and of the gate, or an error naming it."""

import math

import numpy as np
from numpy.typing import NDArray

from porescale.builders.checks.packing import check_room
from porescale.builders.checks.rectangle_places import check_rectangles
from porescale.builders.checks.wall_places import across_walls
from porescale.builders.initial.contact_laws import density_of_packing
from porescale.builders.initial.placed import hand_names, packed_count, placed
from porescale.builders.initial.rectangles import beside
from porescale.common.core.constants import EDGE
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.neighbors.placement import DENSEST
from porescale.dem.discs import Discs
from porescale.dem.grains import SKIN
from porescale.dem.prepare.settle import Pile
from porescale.scene.bodies.gate import Gate
from porescale.scene.domain import Domain
from porescale.scene.grains import DEEPEST
from porescale.scene.packing import Packing
from porescale.scene.scene import Scene

TOUCH = 1e-3
"""Overlap, over the smaller diameter, up to which grains placed by hand may start."""
WEAK = 1e-6
"""Gravity, m/s², below which nothing settles in a lifetime."""
LAST_BITS = 1e-12
"""Relative slack of a disc that is as wide as a period."""


def check_grain_places(scene: Scene, sizes: tuple[float, float, float] | None, faults: list[Fault]) -> None:
    """Add a fault for a packing beyond the box or across the gate, and for the first misplaced grain of each kind.

    sizes : smallest, mean and largest diameter, m; None without grains.  A periodic side too short for them is the
    only fault named then: places mean nothing across it.
    """
    names, x, r = placed(scene)
    if scene.rectangle:
        check_rectangles(scene, x, r, names, faults)
    if sizes is None:
        return
    packing = scene.grains.packing if scene.grains else None
    # The skin follows the mean radius; that of a packing is drawn, so its upper bound counts.
    skin = SKIN * (sizes[2] if packing else sizes[1]) / 2
    if held_alone(scene):
        if _wider_than_a_period(scene, faults):
            return
    elif _too_short(scene.domain, sizes[2], skin, faults):
        return
    if packing and not scene.rock and not check_room(packing, packed_count(scene), faults):
        return
    if packing:
        _check_packing(packing, scene.domain, scene.gate, faults)
        if packing.settle:
            _check_settling(scene, faults)
    if not names:
        faults += across_walls(scene, x, r, names, 0.0)
        return
    # as deep as in another of its size: a share of the diameter
    box, inner = np.array([scene.domain.width, scene.domain.height]), r[:, None] * (1 - 2 * _touch(scene))
    periodic, at = _periodic(scene.domain), _middles(scene, x)
    beyond = np.where(periodic, (at < 0) | (at > box), (x < inner) | (x > box - inner)).any(axis=1)
    if beyond.any():
        k = int(beyond.argmax())
        out = np.where(periodic, np.maximum(-at, at - box), np.maximum(r[:, None] - x, x + r[:, None] - box))
        problem = f"reaches out of the box by {float(out[k].max()):.3g} m"
        faults.append(_misplaced(names[k], x[k], problem, "move it inside by its radius"))
    if scene.gate:
        across = np.abs(x[:, 0] - scene.gate.x) < inner[:, 0]
        if across.any():
            k = int(across.argmax())
            problem = f"stands across the gate by {r[k] - abs(float(x[k, 0]) - scene.gate.x):.3g} m"
            faults.append(_misplaced(names[k], x[k], problem, "move one of them"))
    faults += across_walls(scene, x, r, names, _touch(scene))
    _check_overlap(x, r, scene, names, 0, faults)


def _middles(scene: Scene, x: Floats) -> Floats:
    """Centres (n, 2) m, of discs of a clump the mean of them all: some may lie beyond a side that is periodic."""
    at, numbers = x.copy(), np.array(hand_names(scene)[1], int)
    for number in range(numbers.max(initial=-1) + 1):
        own = np.flatnonzero(numbers == number)
        at[own] = x[own].mean(axis=0)
    return at


def require_apart(discs: Discs, scene: Scene, packed: int) -> None:
    """InputError naming the deepest overlap of a disc placed by hand; the first ``packed`` are the packing's.

    Contacts within the packing are checked when it settles.
    """
    faults: list[Fault] = []
    names, _, _ = placed(scene)
    _check_overlap(discs.position, discs.radius, scene, names, packed, faults)
    if faults:
        raise InputError(faults)


def deepest(
    x: Floats, r: Floats, domain: Domain, first: int = 0, group: NDArray[np.int64] | None = None
) -> tuple[int, int, float] | None:
    """(i, j, overlap in m) of the deepest overlap, i > j and i >= ``first``, or None; also through periodic sides.

    x : (n, 2) m;  r : (n,) m;  group (n,): discs with the same number from 0 on may overlap.
    Grid search by scipy, outside the time loop.
    """
    from scipy.spatial import cKDTree

    periodic, box = _periodic(domain), np.array([domain.width, domain.height])
    inside = np.where(periodic, x % box, x)
    inside = np.where(periodic & (inside >= box), 0.0, inside)  # a tiny negative number modulo the box is the box
    low = np.where(periodic, 0.0, inside.min(axis=0))  # the search takes coordinates from 0 on a side without period
    pairs = cKDTree(inside - low, boxsize=np.where(periodic, box, 0.0)).query_pairs(
        2 * float(r.max()), output_type="ndarray"
    )
    pairs.sort(axis=1)
    pairs = pairs[pairs[:, 1] >= first]
    if group is not None:
        one, other = group[pairs].T
        pairs = pairs[(one < 0) | (one != other)]
    if len(pairs) == 0:
        return None
    j, i = pairs.T
    apart = x[i] - x[j]
    apart -= np.where(periodic, box * np.round(apart / box), 0.0)
    depth = r[i] + r[j] - np.hypot(*apart.T)
    worst = int(depth.argmax())
    return int(i[worst]), int(j[worst]), float(depth[worst])


def held_alone(scene: Scene) -> bool:
    """Whether all discs are held and nothing that could touch them is free: contacts are none of their business."""
    others = scene.grains, scene.clump, scene.segment, scene.polygon, scene.container, scene.rock, scene.lubrication
    return bool(scene.disc) and not any(others)


def _wider_than_a_period(scene: Scene, faults: list[Fault]) -> bool:
    """Whether a held disc overlaps its own image; it may touch it."""
    before, d = len(faults), scene.domain
    for k, it in enumerate(scene.disc):
        sides = zip(("width", "height"), (d.width, d.height), d.periodic, strict=True)
        for name, length, periodic in sides:
            if periodic and it.diameter > length * (1 + LAST_BITS):
                problem = f"overlaps its own image by {it.diameter - length:.3g} m across the periodic {name}"
                repair = "make it smaller, or the box larger"
                faults.append(Fault(f"disc[{k}].diameter", it.diameter, problem, "m", f"<= {length:g}", repair))
    return len(faults) > before


def _too_short(domain: Domain, largest: float, skin: float, faults: list[Fault]) -> bool:
    """Whether a periodic side is shorter than two cutoffs of the pair search, largest diameter and ``skin`` (m): a
    grain would touch another twice."""
    least = 2 * (largest + skin)
    sides = (("width", domain.width, "wide"), ("height", domain.height, "high"))
    short = [side for side, periodic in zip(sides, domain.periodic, strict=True) if periodic and side[1] < least]
    for name, length, word in short:
        problem = "is periodic and so short that a grain would be in contact with another twice"
        repair = f"make the box {least:.4g} m {word}, or the grains smaller"
        faults.append(Fault(f"domain.{name}", length, problem, "m", f">= {least:.4g}", repair))
    return bool(short)


def _check_packing(packing: Packing, domain: Domain, gate: Gate | None, faults: list[Fault]) -> None:
    right, top = packing.left + packing.width, packing.bottom + packing.height
    for key, value, end, size in (
        ("left", packing.left, right, domain.width),
        ("height", packing.height, top, domain.height),
    ):
        if end > size * (1 + EDGE):
            problem = f"the packing reaches to {end:g} m, out of the box of {size:g} m"
            faults.append(Fault(f"grains.packing.{key}", value, problem, "m", repair="move it inside or shrink it"))
    if not packing.settle and not packing.compress and packing.packing_fraction > DENSEST:
        problem = "is denser than discs can be placed at random"
        key, repair = "grains.packing.packing_fraction", "let it settle, or lower it"
        faults.append(Fault(key, packing.packing_fraction, problem, "", f"<= {DENSEST:g}", repair))
    # Settling starts from a looser placement: as high as dem.settle.Pile.top.
    head = packing.bottom + packing.packing_fraction * packing.height / Pile.fraction + packing.diameter
    if packing.settle and top <= domain.height * (1 + EDGE) < head:
        problem = f"is placed up to {head:.4g} m before it settles, above the box of {domain.height:g} m"
        key, value = "grains.packing.height", packing.height
        if packing.diameter > packing.height and not (packing.sizes or packing.grading):  # a diameter is added on top
            key, value = "grains.packing.diameter", packing.diameter
        repair = f"make the box {head:.4g} m high"
        faults.append(Fault(key, value, problem, "m", repair=repair))
    if gate and packing.left * (1 + EDGE) < gate.x < right * (1 - EDGE):
        problem = f"stands in the packing, which reaches from {packing.left:g} to {right:g} m"
        faults.append(Fault("gate.x", gate.x, problem, "m", repair="move one of them"))


def _check_settling(scene: Scene, faults: list[Fault]) -> None:
    """A packing settles straight down, only if it sinks, onto a floor, and held on both sides."""
    assert scene.grains
    assert scene.grains.packing
    packing, domain = scene.grains.packing, scene.domain
    (gx, gy), fluid_density = scene.gravity, scene.fluid.density if scene.fluid else 0.0
    otherwise = "or set grains.packing.settle = false"
    if gy > -WEAK:
        problem, repair = "a packing settles straight down", f"give [0, -9.81], {otherwise}"
        allowed = f"[any, {-WEAK:g} or below]"
        faults.append(Fault("gravity", f"[{gx:g}, {gy:g}]", problem, "m/s^2", allowed, repair))
    density = density_of_packing(scene)
    if density <= fluid_density:
        problem, repair = "the grains do not sink, so they do not settle", f"make them heavier, {otherwise}"
        names = [it.name for it in scene.material]
        k = names.index(packing.material) if packing.material in names else 0
        own = bool(names) and scene.material[k].density is not None
        key = f"material[{k}].density" if own else "grains.density"
        faults.append(Fault(key, density, problem, "kg/m^3", f"> {fluid_density:g}", repair))
    if domain.periodic[1]:
        repair = f"give the box a bottom, {otherwise}"
        faults.append(Fault("domain.bottom", domain.bottom.kind, "there is no floor to settle on", repair=repair))
    loose = _loose_sides(scene, packing)
    if loose:
        problem = f"nothing holds the packing on its {loose} while it settles"
        repair = f"put it between walls and gate, {otherwise}"
        faults.append(Fault("grains.packing.left", packing.left, problem, "m", repair=repair))


def _loose_sides(scene: Scene, packing: Packing) -> str:
    """Sides on which no wall or gate stands within a diameter of the packing, in words; a full period holds itself."""
    if scene.domain.periodic[0] and packing.width > scene.domain.width - packing.diameter:
        return ""
    domain, gate, held = scene.domain, scene.gate, beside(scene.rectangle, packing)
    ends = {"left": (packing.left, 0.0), "right": (packing.left + packing.width, domain.width)}
    loose = []
    for (side, (edge, wall)), near_face in zip(ends.items(), held, strict=True):
        near_wall = not domain.periodic[0] and abs(edge - wall) < packing.diameter
        near_gate = gate is not None and abs(edge - gate.x) < packing.diameter
        if not near_wall and not near_gate and not near_face:
            loose.append(side)
    return " and ".join(loose)


def _check_overlap(x: Floats, r: Floats, scene: Scene, names: list[str], packed: int, faults: list[Fault]) -> None:
    """Name the deepest overlap; discs from ``packed`` on have ``names``."""
    group = np.full(len(r), -1)
    own = hand_names(scene)[1]
    group[packed : packed + len(own)] = own
    found = deepest(x, r, scene.domain, packed, group)
    if found is None or found[2] <= _touch(scene) * 2 * min(r[found[0]], r[found[1]]):
        return
    i, j, depth = found
    other = _plain(names[j - packed]) if j >= packed else "a grain of the packing"
    share = math.ceil(1e3 * depth / (2 * min(r[i], r[j]))) / 1e3  # up to three digits
    pressed = f", or raise grains.overlap to {share:g}" if scene.grains and share <= DEEPEST else ""
    repair = f"move one of them{pressed}"
    faults.append(Fault(names[i - packed], None, f"overlaps {other} by {depth:.3g} m", repair=repair))


def _touch(scene: Scene) -> float:
    """Overlap, over the smaller diameter, up to which what is placed may start."""
    return scene.grains.overlap if scene.grains else TOUCH


def _plain(name: str) -> str:
    """grains.grain[0] as "grain 0", disc[0] as "disc 0"."""
    return name.removeprefix("grains.").replace("[", " ").rstrip("]")


def _misplaced(name: str, at: Floats, problem: str, repair: str) -> Fault:
    return Fault(name, f"({at[0]:g}, {at[1]:g})", problem, "m", repair=repair)


def _periodic(domain: Domain) -> NDArray[np.bool_]:
    return np.array(domain.periodic)
