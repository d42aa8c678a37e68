"""How fast body forces and pressures can drive a fluid; and what it cannot do as its sides, gravity and step ask: fill
a box without outlet or a gap that a rectangle opens, flow by a gravity that pressure balances, and begin to flow with
too long a relaxation time."""

import cmath
import math
from typing import NamedTuple

from porescale.analysis.permeability import gebart
from porescale.builders.checks.limits import DENSITY_REFUSE
from porescale.builders.checks.own_laws import impulse, largest_force
from porescale.builders.initial.contact_laws import MaterialPlan, density_of_packing
from porescale.builders.initial.placed import by_hand, controls_by_hand
from porescale.builders.initial.random_polygons import copies_of
from porescale.common.compiled.own import OwnLaw
from porescale.common.core.constants import EDGE
from porescale.common.core.errors import Fault
from porescale.lbm.scales import Scales
from porescale.scene.bodies.rectangle import Rectangle
from porescale.scene.bodies.segments import Points
from porescale.scene.domain import Domain
from porescale.scene.grains import Grains
from porescale.scene.scene import Scene

FILLED_WARN = 0.01
"""Change of the density by what sides let in and none lets out, over the run: a hundredth, that of Mach 0.1."""
LONGEST_ALONE = 3.0
"""Relaxation time of a fluid without solids up to which a flow begins right: the profile of a wall that starts to move,
after a tenth of the time in which it spreads over 30 cells, is off by 0.2 % at 3, 0.8 % at 5, 17 % at 10 with two
relaxation times, and by 1.2, 4.4 and 25 % with one (lbm.begun_couette)."""


GAP_PEAK = 1.5
"""Largest over mean velocity of the parabola in a gap between two solids."""
ENDS = ("left", "right"), ("bottom", "top")
"""The sides at the ends of the x and of the y axis."""


class Solid(NamedTuple):
    """A solid in the fluid: its corners (m), its area (m²), and the radius (m) of the discs that it consists of."""

    lower: tuple[float, float]
    upper: tuple[float, float]
    area: float
    radius: float


def forced_speed(scene: Scene, scales: Scales) -> float:
    """The largest speed (m/s) that the body force can drive: an upper estimate, 0 without a force.

    Along each axis the least of these, with G the component of the force, rho and nu of the fluid:
    G t/rho at the end of the run, and the velocity of the start, as if nothing slowed the fluid down;
    the parabola between the sides across it, G H²/(8 rho nu), which grains in its way only slow down; where one of the
    two has no friction it is the line of symmetry of one twice as wide, and without friction at both there is none;
    the flow past solids that stand (`_past_solids`), or past free grains, whose buoyant weight pulls the fluid too;
    between open ends at a distance of L, sqrt(2 G L/rho).
    A constant force between closed ends drives nothing: pressure balances it.  Of a user's own force, which may change
    sign, the impulse of its mean over the box takes the place of G t in what nothing slows down, beside the parabola.
    """
    assert scene.fluid
    given, d = scene.fluid.body_force, scene.domain
    own, size, speeds = isinstance(given, OwnLaw), (d.width, d.height), []
    for axis in range(2):
        force = largest_force(scene, axis) if isinstance(given, OwnLaw) else abs(given[axis])
        push, start, across = force / scales.density, abs(scene.fluid.velocity[axis]), size[1 - axis]
        ends = [d.side(name).boundary for name in ENDS[axis]]
        if push == 0.0 or (not own and scene.grains is None and all(it.closed for it in ends)):
            continue
        bounds = [start + push * scene.time.end, push * _between_sides(d, axis) / scales.viscosity]
        bounds.append(push * _past_solids(scene, _standing(scene), axis) / scales.viscosity)
        if own:
            bounds.append(start + impulse(scene, axis) / scales.density + push * across**2 / (8 * scales.viscosity))
        else:
            bounds.append(start + _past_free_grains(scene, scales, axis))
        if not ends[0].periodic:
            bounds.append(start + math.sqrt(2 * push * size[axis]))
        speeds.append(min(bounds))
    return math.hypot(*speeds)


def pressed_speed(d: Domain, scales: Scales) -> float:
    """Speed (m/s) that the largest difference of pressure between sides can drive."""
    held = {name: side.pressure or 0.0 for name, side in d.sides.items() if "pressure" in side.boundary.numbers}
    if len(held) < 2:
        return 0.0
    drop = max(held.values()) - min(held.values())
    along, across = (d.width, d.height) if {"left", "right"} <= set(held) else (d.height, d.width)
    parabola = drop / along / scales.density * across**2 / (8 * scales.viscosity)
    return min(parabola, math.sqrt(2 * drop / scales.density))


def _between_sides(d: Domain, axis: int) -> float:
    """H²/8 (m²) of the parabola along ``axis`` between the sides across it, (2 H)²/8 where one has no friction;
    infinite where neither has any."""
    across = (d.height, d.width)[axis]
    rough = sum(_has_friction(d, name) for name in ENDS[1 - axis])
    return (math.inf, (2 * across) ** 2 / 8, across**2 / 8)[rough]


def _has_friction(d: Domain, name: str) -> bool:
    """Whether the fluid has a prescribed velocity along a side."""
    kind = d.side(name).boundary
    return kind.no_slip or kind.prescribes_velocity


def _standing(scene: Scene) -> list[Solid]:
    """Discs and polygons that are held, or that a [[control]] keeps, where they are, turning or not, and rectangles
    that stand, as far as these are in the box; of a packing none."""
    size = scene.domain.width, scene.domain.height
    found = [_disc(it.x, it.y, 0.5 * it.diameter) for it in scene.disc if it.stays]
    ratio = (scene.grains.hydraulic_radius_ratio if scene.grains else None) or 1.0
    kept = zip(by_hand(scene), controls_by_hand(scene), strict=True)
    found += [_disc(it.x, it.y, 0.5 * it.diameter, ratio) for it, by in kept if by and by.stays]
    still = {it.of for it in scene.control if it.stays}
    copies = ((it, copy) for it in scene.polygon for copy in copies_of(it))
    found += [
        _outlined(it.points, *copy)
        for number, (it, copy) in enumerate(copies)
        if it.held or ("polygon", number) in still
    ]
    for it in scene.rectangle:
        lower = max(it.lower[0], 0.0), max(it.lower[1], 0.0)
        upper = min(it.upper[0], size[0]), min(it.upper[1], size[1])
        w, h = upper[0] - lower[0], upper[1] - lower[1]
        if it.fastest == 0.0 and min(w, h) > 0.0:
            found.append(Solid(lower, upper, w * h, 0.5 * max(w, h)))
    return found


def _disc(x: float, y: float, radius: float, ratio: float = 1.0) -> Solid:
    """A disc whose radius (m) in the fluid is ``ratio`` of its own."""
    r = ratio * radius
    return Solid((x - r, y - r), (x + r, y + r), math.pi * r**2, r)


def _outlined(points: Points, at: tuple[float, float], angle: float, size: float) -> Solid:
    """A copy of a polygon: its points (m) turned about the origin and put to ``at`` (m), ``size`` times as large."""
    turn = size * cmath.exp(1j * angle)
    corners = [complex(*at) + turn * complex(*point) for point in points]
    x, y = [it.real for it in corners], [it.imag for it in corners]
    twice = sum((a.conjugate() * b).imag for a, b in zip(corners, [*corners[1:], corners[0]], strict=True))
    longest = max(max(x) - min(x), max(y) - min(y))
    return Solid((min(x), min(y)), (max(x), max(y)), 0.5 * abs(twice), 0.5 * longest)


def _past_solids(scene: Scene, solids: list[Solid], axis: int) -> float:
    """rho nu U/G (m²) of the largest speed U past ``solids`` that a force G drives along ``axis``; infinite of none.

    That in the gaps of a square array of as large a solid fraction, whose permeability (`gebart`) is larger than that
    of sparse or uneven ones; and the parabola in the widest stretch across the flow without a solid, since solids that
    lie in a heap leave the rest of the box free.  What reaches from end to end of the box is a wall of such a stretch.
    """
    if not solids:
        return math.inf
    d = scene.domain
    size, across = (d.width, d.height), 1 - axis
    short = [it for it in solids if it.upper[axis] - it.lower[axis] < size[axis] * (1 - 1e-9)]
    share = sum(it.area for it in short) / (size[0] * size[1])
    past = 0.0
    if 0.0 < share < math.pi / 4:  # at which discs of a square array touch
        gap = 1 - math.sqrt(share / (math.pi / 4))
        past = GAP_PEAK * gebart(share) * max(it.radius for it in short) ** 2 / gap
    return past + _widest(d, [(it.lower[across], it.upper[across]) for it in solids], across) ** 2 / 8


def _widest(d: Domain, spans: list[tuple[float, float]], axis: int) -> float:
    """Longest stretch (m) of an axis of the box that none of ``spans`` (m) covers; twice as long as it is at a side
    without friction."""
    size, periodic = (d.width, d.height)[axis], d.periodic[axis]
    if periodic:
        spans = [(low + shift, high + shift) for low, high in spans for shift in (-size, 0.0, size)]
    reached, widest = (0.0, 0.0) if not periodic else (min(low for low, _ in spans), 0.0)
    first = True
    for low, high in sorted(spans):
        open_side = first and not periodic and not _has_friction(d, ENDS[axis][0])
        widest, reached, first = max(widest, (low - reached) * (2 if open_side else 1)), max(reached, high), False
    if not periodic:
        widest = max(widest, (size - reached) * (1 if _has_friction(d, ENDS[axis][1]) else 2))
    return widest


def _past_free_grains(scene: Scene, scales: Scales, axis: int) -> float:
    """Speed (m/s) that the force drives along ``axis`` where free grains slow it down; infinite without any, and in a
    box with sides, at which grains may come to lie and leave the rest of it free.

    Both together gain speed by what pulls them, the force and the buoyant weight of the grains, which may balance;
    the fluid goes past the grains as if they stood.
    """
    grains = scene.grains
    if grains is None or not all(scene.domain.periodic):
        return math.inf
    assert scene.fluid
    assert not isinstance(scene.fluid.body_force, OwnLaw)
    solids = _free_discs(scene, grains, grains.hydraulic_radius_ratio or 1.0)
    share = sum(it.area for it in solids) / (scene.domain.width * scene.domain.height)
    force = scene.fluid.body_force[axis]
    heavy = _mean_density(scene, solids)
    pull = force + share * (heavy - scales.density) * scene.gravity[axis]
    together = abs(pull) / (scales.density * (1 - share) + heavy * share) * scene.time.end
    return together + abs(force) / scales.density * _past_solids(scene, solids, axis) / scales.viscosity


def _free_discs(scene: Scene, grains: Grains, ratio: float) -> list[Solid]:
    """What ``grains`` are placed by hand, and the packing as one solid, with radii ``ratio`` times their own."""
    packing = grains.packing
    solids = [_disc(it.x, it.y, 0.5 * it.diameter, ratio) for it in by_hand(scene)]
    if packing:
        corners = (packing.left, packing.bottom), (packing.left + packing.width, packing.bottom + packing.height)
        area = ratio**2 * packing.packing_fraction * packing.width * packing.height
        solids.append(Solid(*corners, area, 0.5 * ratio * packing.diameter))
    return solids


def _mean_density(scene: Scene, solids: list[Solid]) -> float:
    """Density (kg/m³) of all ``solids`` (`_free_discs`) together: of each its material's."""
    plan = MaterialPlan.of(scene)
    of_each = [plan.density(it.material) for it in by_hand(scene)]
    of_each += [density_of_packing(scene)] * (len(solids) - len(of_each))
    area = sum(it.area for it in solids)
    return (
        sum(it.area * density for it, density in zip(solids, of_each, strict=True)) / area if area else plan.density()
    )


def check_flows(scene: Scene, scales: Scales, solids: bool, faults: list[Fault], warnings: list[str]) -> None:
    """Refuse or warn of the four;  solids : whether any are in the fluid, whose drag has a limit of its own."""
    _check_filled(scene, faults, warnings)
    _check_gaps(scene, scales, faults, warnings)
    _check_shut(scene, warnings)
    _check_tilt(scene, scales, warnings)
    _check_unheld(scene, scales, warnings)
    if not solids and scales.relaxation_time > LONGEST_ALONE:
        step = (LONGEST_ALONE - 0.5) / 3 * scales.spacing**2 / scales.viscosity
        warnings.append(
            f"relaxation time {scales.relaxation_time:.3g}: above {LONGEST_ALONE:g} flows that change with time are"
            f" off; a step of {0.99 * step:.2g} s keeps it below"
        )


def _check_filled(scene: Scene, faults: list[Fault], warnings: list[str]) -> None:
    """Refuse or warn of fluid that sides let into a room without a way out, or out of it: the box, and what is on
    either side of the gate while it is shut."""
    end, width, shut = scene.time.end, scene.domain.width, "of the gate while it is shut"
    rooms = {"until time.end": (0.0, width, end)}
    if scene.gate is not None:
        x, opens = scene.gate.x, min(scene.gate.opens_at, end)
        rooms |= {f"left {shut}": (0.0, x, opens), f"right {shut}": (x, width, opens)}
    for where, room in rooms.items():
        filled = filled_by(scene, *room)
        way, other = ("in", "out") if filled > 0 else ("out", "in")
        what = f"the sides let {abs(filled):.2g} of the fluid {way} {where}, and none lets it {other}"
        repair = 'make one { kind = "pressure", pressure = 0 }'
        if abs(filled) > DENSITY_REFUSE:
            faults.append(Fault("domain", None, what, repair=repair))
        elif abs(filled) > FILLED_WARN:
            warnings.append(f"{what}: the density changes by as much; {repair}")


def _check_gaps(scene: Scene, scales: Scales, faults: list[Fault], warnings: list[str]) -> None:
    """Refuse or warn of rectangles that open a gap behind them which no fluid comes into: what is in it is spread over
    a longer one, or there is nothing at all where they began at a side."""
    for k, it in enumerate(scene.rectangle):
        for axis, size in enumerate((scene.domain.width, scene.domain.height)):
            before, after = _gap_behind(scene, it, axis)
            if after - before < 0.5 * scales.spacing or (falls := 1.0 - before / after) < FILLED_WARN:
                continue  # less than half a cell is no gap
            side, gone = _behind(it, axis), abs(it.travelled(scene.time.end)[axis])
            first = f"lower.{'xy'[axis]} <= {-gone:.3g} m"
            if it.velocity[axis] < 0.0:
                first = f"upper.{'xy'[axis]} >= {size + gone:.3g} m"
            what = f"moves away from the {side} side, which lets no fluid in: the gap behind it grows from"
            what += f" {before:.3g} to {after:.3g} m, and the density in it falls by {falls:.2g}"
            if falls > DENSITY_REFUSE:
                faults.append(Fault(f"rectangle[{k}]", None, what, repair=f"let it begin outside, with {first}"))
            else:
                warnings.append(f"rectangle {k} {what}; let it begin outside, with {first}")


def _behind(it: Rectangle, axis: int) -> str:
    """The side that a rectangle moves away from along ``axis``."""
    return ENDS[axis][0 if it.velocity[axis] > 0.0 else 1]


def _gap_behind(scene: Scene, it: Rectangle, axis: int) -> tuple[float, float]:
    """Lengths (m), at the start and the end, of the gap between a side and a rectangle that moves away from it along
    ``axis`` and reaches from one of the sides across to the other; (0, 0) where fluid comes in, or another rectangle
    is in it."""
    d, across = scene.domain, 1 - axis
    size = d.width, d.height
    spans = it.lower[across] <= EDGE * size[across] and it.upper[across] >= (1 - EDGE) * size[across]
    if not it.velocity[axis] or it.velocity[across] or not spans:
        return 0.0, 0.0
    if not d.side(_behind(it, axis)).boundary.closed or any(d.side(name).open for name in ENDS[across]):
        return 0.0, 0.0

    def from_side(other: Rectangle) -> tuple[float, float]:
        """How far from the side a rectangle begins and ends, m."""
        if it.velocity[axis] > 0.0:
            return other.lower[axis], other.upper[axis]
        return size[axis] - other.upper[axis], size[axis] - other.lower[axis]

    first = from_side(it)[0]
    others = [from_side(other) for other in scene.rectangle if other is not it]
    if any(begin < first and end > 0.0 for begin, end in others):
        return 0.0, 0.0
    gone = abs(it.travelled(scene.time.end)[axis])
    return max(first, 0.0), min(max(first + gone, 0.0), size[axis])


def _check_shut(scene: Scene, warnings: list[str]) -> None:
    """Warn of rectangles that come into a closed box, or leave it, while its gate is shut: what fluid they let in is
    taken out again from all of the box, beyond the gate, too."""
    d = scene.domain
    if scene.gate is None or any(side.open for side in d.sides.values()):
        return
    until = min(scene.gate.opens_at, scene.time.end)
    for k, it in enumerate(scene.rectangle):
        if it.make_good is False:
            continue
        before, after = (_area_inside(it, time, (d.width, d.height)) for time in (0.0, until))
        share = (after - before) / (d.width * d.height)
        if abs(share) > FILLED_WARN:
            way = ("comes in", "falls") if share > 0.0 else ("leaves", "rises")
            warnings.append(
                f"rectangle {k} {way[0]} while the gate is shut: the mass of the fluid is restored in all of the box,"
                f" so that the density beyond the gate {way[1]} by {abs(share):.2g}; let it move when the gate is open"
            )


def _area_inside(it: Rectangle, time: float, size: tuple[float, float]) -> float:
    """Area (m²) of a rectangle that is in the box of that size (m) at ``time`` (s)."""
    gone = it.travelled(time)
    ends = [
        (max(low + way, 0.0), min(high + way, length))
        for low, high, way, length in zip(it.lower, it.upper, gone, size, strict=True)
    ]
    return math.prod(max(0.0, high - low) for low, high in ends)


def _check_tilt(scene: Scene, scales: Scales, warnings: list[str]) -> None:
    """Warn where gravity has a part along periodic sides, as down an inclined channel, and nothing else drives it, not
    even a body force that is said to be zero."""
    assert scene.fluid
    force, g = scene.fluid.body_force, scene.gravity
    along = [axis for axis in range(2) if g[axis] and scene.domain.periodic[axis]]
    if len(along) != 1 or isinstance(force, OwnLaw) or "body_force" in scene.fluid.model_fields_set:
        return
    if scene.grains is not None and not g[1 - along[0]]:
        return  # grains that sink for ever, in fluid that stays
    wanted = [scales.density * g[axis] if axis in along else 0.0 for axis in range(2)]
    warnings.append(
        f"gravity along {'xy'[along[0]]}, which is periodic, drives grains but no fluid: pressure balances it;"
        f" fluid.body_force = [{wanted[0]:g}, {wanted[1]:g}] drives it, [0, 0] leaves it still"
    )


def _check_unheld(scene: Scene, scales: Scales, warnings: list[str]) -> None:
    """Warn where free grains sink, or rise, along a periodic axis and nothing holds the fluid that goes with them: no
    side with friction, no solid that stands and no body force.  Both together then gain speed until the end."""
    assert scene.fluid
    force, d = scene.fluid.body_force, scene.domain
    if scene.grains is None or isinstance(force, OwnLaw) or _standing(scene):
        return
    solids = _free_discs(scene, scene.grains, 1.0)
    share, heavy = sum(it.area for it in solids) / (d.width * d.height), _mean_density(scene, solids)
    for axis, name in enumerate("xy"):
        borne = any(_has_friction(d, side) for side in ENDS[1 - axis])
        pull = share * (heavy - scales.density) * scene.gravity[axis]
        if not d.periodic[axis] or borne or force[axis] or not pull:
            continue
        both = scales.density * (1 - share) + heavy * share
        wanted = [-pull if k == axis else force[k] for k in range(2)]
        known = not (scene.clump or scene.polygon)  # whose areas differ
        value = f" = [{wanted[0]:.4g}, {wanted[1]:.4g}]" if known else ""
        warnings.append(
            f"nothing holds the fluid along {name}: it goes with the grains, and both gain {abs(pull) / both:.2g} m/s a"
            f" second; a fluid.body_force{value} against it balances the buoyant weight of the grains"
        )


def filled_by(scene: Scene, left: float, right: float, until: float) -> float:
    """Share of the fluid between ``left`` and ``right`` (m) that sides of given velocity let in until then (s), out
    where negative; 0 where another side balances it, where a velocity is a function of one's own, or where rectangles
    move."""
    domain, inwards, wide = scene.domain, 0.0, right - left
    if any(it.fastest for it in scene.rectangle):
        return 0.0
    for name, side in domain.sides.items():
        beyond = (name == "left" and left > 0.0) or (name == "right" and right < domain.width)
        if beyond or not side.open:
            continue
        if not side.boundary.prescribes_velocity or side.velocity is None or isinstance(side.velocity, OwnLaw):
            return 0.0
        u, v = side.velocity
        inwards += {"left": u, "right": -u}.get(name, 0.0) * domain.height
        inwards += {"bottom": v, "top": -v}.get(name, 0.0) * wide
    share = inwards * until / (wide * domain.height)
    return share if math.isfinite(share) else 0.0
