"""What compressibility does to a scene beside its Mach number: motion that sound does not keep up with, pistons and
inflows that start at once, and the suction below a gate that rises along grains."""

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

from porescale.builders.checks.limits import DENSITY_WARN, SOUND_WARN
from porescale.builders.checks.own_laws import force_rate, inflow_rate
from porescale.common.compiled.own import OwnLaw
from porescale.lbm.scales import Scales
from porescale.scene.scene import Scene
from porescale.scene.time_function import TimeFunction

GATE_FILM = 2.6
"""Suction over mu V sqrt(R)/g^(3/2) where a gate rises at V along discs of hydraulic radius R, which keep a film g from
it.  In the film p' = 6 mu V/h² - 12 mu q/h³ with h = g + x²/2R (Reynolds 1886): 0.92 at a disc alone, with as much
pressure above as below, and 13.3 where nothing flows past it.  The discs of a bed lie between: 2.3 to 2.6 in the case
column_collapse at half the speed, half the viscosity, a film half as thick again, two thirds of the spacing."""
GATE_EDGE = 2.6
"""Suction over mu V/h at the edge of a gate that rises in plain water: 2.6 to 3.1 at V h/nu below 1."""
GATE_HEAD = 0.75
"""What is added to it over rho V²: 0.75 at V h/nu of 2 to 10."""


SWING = 0.1
"""Share of the displaced flow by which a piston's start may still ring halfway through its motion."""
RAMP = 2 / SWING
"""Ramp, over 1/w of the ringing, that keeps it below."""
OPPOSITE = {"left": "right", "right": "left", "bottom": "top", "top": "bottom"}
"""The side that sound from a side comes to."""


class Ringing(NamedTuple):
    """axis : along which a piston moves;  rate : w, rad/s;  step : share of the flow that swings at first;  left :
    halfway through the motion."""

    axis: int
    rate: float
    step: float
    left: float


def check_sound(scene: Scene, scales: Scales, warnings: list[str]) -> None:
    """Warn of motion that changes while sound crosses the box."""
    size = max(scene.domain.width, scene.domain.height)
    for what, rate in rates(scene, scales.step):
        turn = rate * size / scales.sound_speed
        if turn > SOUND_WARN:
            warnings.append(
                f"{what} at {rate / (2 * math.pi):.3g} Hz, by {turn:.2g} rad while sound crosses the box"
                f" ({turn / (2 * math.pi):.2g} acoustic wavelengths): pressures lag by as much; a step of"
                f" {scales.step * 0.9 * SOUND_WARN / turn:.2g} s keeps it below {SOUND_WARN}"
            )
    for what, rate in _turns(scene):
        if rate * scales.step > SOUND_WARN:  # it makes no sound, but steps have to follow it
            warnings.append(
                f"{what} turns to and fro at {rate / (2 * math.pi):.3g} Hz, by {rate * scales.step:.2g} rad of its"
                f" oscillation a step: a step of {0.9 * SOUND_WARN / rate:.2g} s keeps it below {SOUND_WARN}"
            )


def rates(scene: Scene, step: float) -> Iterator[tuple[str, float]]:
    """Everything that changes the flow with time: what it does, and how fast it changes, rad/s;  step: of the fluid, s.

    The steepest slope over half the range of values: of a sine its pulsation.  So for tables and laws of a user's, too.
    """
    for k, it in enumerate(scene.disc):
        yield f"disc {k} swings", max(rate_of(it.velocity_x), rate_of(it.velocity_y))
    for k, control in enumerate(scene.control):
        given = [fn for axis in (control.x, control.y) for fn in (axis.velocity, axis.force)]
        ways = [axis.displacement for axis in (control.x, control.y) if not _one_way(axis.displacement)]
        yield f"what control {k} moves swings", max(map(rate_of, [*given, *ways]))
    for name in scene.domain.sides:
        yield f"the velocity of the {name} side changes", inflow_rate(scene, name, step)
    yield "fluid.body_force changes", force_rate(scene, step)


def _turns(scene: Scene) -> Iterator[tuple[str, float]]:
    """Every rotation that changes with time, as `rates` has motions along x and y."""
    for k, it in enumerate(scene.disc):
        yield f"disc {k}", rate_of(it.turning)
    for k, control in enumerate(scene.control):
        turn = control.rotation
        angle = None if _one_way(turn.displacement) else turn.displacement
        yield f"what control {k} moves", max(map(rate_of, (turn.velocity, turn.force, angle)))


def _one_way(course: TimeFunction | None) -> bool:
    """Whether a displacement never turns round: the flow sees its speed, which swings in no other way."""
    values = course.values if course else ()
    steps = [b - a for a, b in itertools.pairwise(values)]
    return bool(steps) and (min(steps) >= 0.0 or max(steps) <= 0.0)


def rate_of(course: TimeFunction | None) -> float:
    """How fast a course changes, rad/s; 0 of a constant."""
    if course is None:
        return 0.0
    if course.times:
        reach = 0.5 * (max(course.values) - min(course.values))
        return course.steepest / reach if reach else 0.0
    return 2 * math.pi * course.frequency if course.amplitude else 0.0


def gate_suction(scene: Scene, scales: Scales, speed: float) -> float:
    """Suction (Pa) below a gate that rises at ``speed`` (m/s): at its edge, or in the film along a packing."""
    viscosity = scales.density * scales.viscosity
    drawn = GATE_EDGE * viscosity * speed / scales.spacing + GATE_HEAD * scales.density * speed**2
    if scene.grains is None or scene.grains.packing is None:
        return drawn
    ratio, diameter = scene.grains.hydraulic_radius_ratio or 1.0, scene.grains.packing.diameter
    film = max(0.5 * (1 - ratio) * diameter, 0.25 * scales.spacing)  # thinner ones are no film in the lattice
    return float(max(drawn, GATE_FILM * viscosity * speed * math.sqrt(0.5 * ratio * diameter) / film**1.5))


def check_pistons(scene: Scene, scales: Scales, warnings: list[str]) -> None:
    """Warn of rectangles that fill half of a channel or more and start so fast that what they push rings."""
    for k, it in enumerate(scene.rectangle):
        found = ringing(scene, scales, k)
        if not found or it.ramp >= RAMP / found.rate:
            continue
        axis = found.axis
        press = scales.density * scales.sound_speed * abs(it.velocity[axis])
        warnings.append(
            f"rectangle {k} starts {f'in {it.ramp:g} s' if it.ramp else 'at once'}: a pulse of"
            f" {found.step * press:.2g} Pa goes to and fro at {found.rate / (2 * math.pi):.3g} Hz, and flows swing by"
            f" {100 * found.step:.0f} % of what it displaces, by {100 * found.left:.0f} % halfway through its motion;"
            f" rectangle.ramp = {RAMP / found.rate:.2g} s keeps them below {100 * SWING:g} %"
        )


def check_inflows(scene: Scene, scales: Scales, warnings: list[str]) -> None:
    """Warn of inflows of constant velocity, towards an outlet, whose start still rings halfway through the run."""
    d = scene.domain
    for name in d.sides:
        side, opposite = d.sides[name], d.sides[OPPOSITE[name]]
        if not side.boundary.prescribes_velocity or not opposite.boundary.passes or isinstance(side.velocity, OwnLaw):
            continue
        axis = 0 if name in ("left", "right") else 1
        if not side.velocity or not side.velocity[axis] or opposite.boundary.prescribes_velocity:
            continue
        rate, damping = modes(scene, scales, axis, passes=True)
        begins = scene.fluid.velocity[axis] if scene.fluid else 0.0
        step = abs(1.0 - begins / side.velocity[axis])  # of what comes in
        left = step * math.exp(-0.5 * damping * scene.time.end)
        if left > SWING:
            press = step * scales.density * scales.sound_speed * abs(side.velocity[axis])
            warnings.append(
                f"the {name} side lets fluid in at once: a pulse of {press:.2g} Pa goes to and fro at"
                f" {rate / (2 * math.pi):.3g} Hz, and flows swing by {100 * left:.0f} % of what comes in halfway"
                f" through the run; fluid.velocity, what flows at the start, or an inflow of your own that rises in"
                f" {RAMP / rate:.2g} s, keeps them below {100 * SWING:g} %"
            )


def check_start(scene: Scene, scales: Scales, warnings: list[str]) -> None:
    """Warn of fluid that flows towards a closed side from the start, away from another: it is stopped by sound.

    From each of both sides a front runs at c and stops it: p = rho c u behind one, -rho c u behind the other.  The
    fronts meet, the fluid flows back, and after 2 L/c it is as at the start (the wave equation, by d'Alembert)."""
    sides, velocity = scene.domain.sides, scene.fluid.velocity if scene.fluid else (0.0, 0.0)
    for axis, ends in enumerate((("left", "right"), ("bottom", "top"))):
        if not velocity[axis] or not all(sides[name].boundary.closed for name in ends):
            continue
        rate, damping = modes(scene, scales, axis, passes=False)
        press = scales.density * scales.sound_speed * abs(velocity[axis])
        warnings.append(
            f"fluid.velocity = {velocity[axis]:g} m/s towards the {ends[velocity[axis] > 0.0]} side, which is closed,"
            f" rings as sound: pressures swing by {press:.3g} Pa (rho c u) with a period of {2 * math.pi / rate:.3g} s"
            f" (2 L/c), by a tenth of it after {math.log(1 / SWING) / damping:.2g} s; leave it out, or let fluid"
            " pass there"
        )


def modes(scene: Scene, scales: Scales, axis: int, *, passes: bool) -> tuple[float, float]:
    """The slowest oscillation of sound along an axis, rad/s, and how fast it is damped, 1/s.

    Towards a side that lets fluid through (``passes``) w = pi c/2L, between closed ones pi c/L.  Walls damp by their
    layers, at the rate sqrt(nu w/2)/H (Kirchhoff 1868; without heat), the fluid itself at about nu w²/c².
    """
    size = scene.domain.width, scene.domain.height
    rate = math.pi * scales.sound_speed / size[axis] * (0.5 if passes else 1.0)
    beside = ("bottom", "top") if axis == 0 else ("left", "right")
    walls = 0.5 * sum(scene.domain.sides[name].boundary.no_slip for name in beside)
    damping = walls * math.sqrt(0.5 * scales.viscosity * rate) / size[1 - axis]
    return rate, damping + scales.viscosity * (rate / scales.sound_speed) ** 2


def ringing(scene: Scene, scales: Scales, k: int) -> Ringing | None:
    """How rectangle ``k`` rings the box; None where it does not for long.

    A plane face that starts at V sends a step of rho c V ahead, and flows then swing about V by all of it (``modes``).
    L is that of the box: a piston far inside rings faster.  A ramp of T leaves |sin(wT/2)/(wT/2)| of it, at most 2/wT.
    """
    it, d = scene.rectangle[k], scene.domain
    axis = 0 if abs(it.velocity[0]) >= abs(it.velocity[1]) else 1
    size = d.width, d.height
    across = 1 - axis
    fills = min(it.upper[across], size[across]) - max(it.lower[across], 0.0)
    if not it.fastest or fills < 0.5 * size[across] or d.periodic[axis] or it.starts_at >= scene.time.end:
        return None
    ahead = ("left", "right") if axis == 0 else ("bottom", "top")
    rate, damping = modes(scene, scales, axis, passes=any(d.sides[name].boundary.passes for name in ahead))
    until = scene.time.end if it.stops_at is None else min(it.stops_at, scene.time.end)
    step = min(1.0, 2 / (rate * it.ramp)) if it.ramp else 1.0
    left = step * math.exp(-0.5 * damping * (until - it.starts_at))
    return Ringing(axis, rate, step, left) if left > SWING else None


def check_gate(scene: Scene, scales: Scales, warnings: list[str]) -> None:
    """Warn of a gate that thins the water as it is lifted."""
    speed = scene.gate.lift_speed if scene.gate else None
    if not speed:
        return
    change = gate_suction(scene, scales, speed) / (scales.density * scales.sound_speed**2)
    if change > DENSITY_WARN:
        share = 0.9 * DENSITY_WARN / change
        warnings.append(
            f"gate.lift_speed = {speed:g} m/s draws the water at the gate thinner by {change:.2g}, most in the film"
            f" between it and grains; {share * speed:.2g} m/s, or a step of {scales.step * math.sqrt(share):.2g} s,"
            f" keeps it below {DENSITY_WARN}"
        )
