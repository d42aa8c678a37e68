"""What a fluid cannot do as its sides, gravity and step ask: fill a box without outlet, flow by a gravity that pressure
balances, and begin to flow with too long a relaxation time."""

import math

from porescale.builders.checks.limits import DENSITY_REFUSE
from porescale.common.compiled.own import OwnLaw
from porescale.common.core.errors import Fault
from porescale.lbm.scales import Scales
from porescale.scene.scene import Scene

FILLED_WARN = 0.01
"""Change of the density by what sides let in and none lets out, over the run: a hundredth, that of Mach 0.1."""
LONGEST_ALONE = 3.0
"""Relaxation time of a fluid without solids up to which a flow begins right: the profile of a wall that starts to move,
after a tenth of the time in which it spreads over 30 cells, is off by 0.2 % at 3, 0.8 % at 5, 17 % at 10 with two
relaxation times, and by 1.2, 4.4 and 25 % with one (lbm.begun_couette)."""


def check_flows(scene: Scene, scales: Scales, solids: bool, faults: list[Fault], warnings: list[str]) -> None:
    """Refuse or warn of the three;  solids : whether any are in the fluid, whose drag has a limit of its own."""
    filled = filled_by(scene)
    if abs(filled) > FILLED_WARN:
        what = f"the sides let {abs(filled):.2g} of the fluid {'in' if filled > 0 else 'out'} until time.end, and none"
        way, repair = "out" if filled > 0 else "in", 'make one { kind = "pressure", pressure = 0 }'
        if abs(filled) > DENSITY_REFUSE:
            faults.append(Fault("domain", None, f"{what} lets it {way}", repair=repair))
        else:
            warnings.append(f"{what} lets it {way}: the density changes by as much; {repair}")
    _check_tilt(scene, scales, warnings)
    if not solids and scales.relaxation_time > LONGEST_ALONE:
        step = (LONGEST_ALONE - 0.5) / 3 * scales.spacing**2 / scales.viscosity
        warnings.append(
            f"relaxation time {scales.relaxation_time:.3g}: above {LONGEST_ALONE:g} flows that change with time are"
            f" off; a step of {0.99 * step:.2g} s keeps it below"
        )


def _check_tilt(scene: Scene, scales: Scales, warnings: list[str]) -> None:
    """Warn where gravity has a part along periodic sides, as down an inclined channel, and nothing else drives it."""
    assert scene.fluid
    force, g = scene.fluid.body_force, scene.gravity
    along = [axis for axis in range(2) if g[axis] and scene.domain.periodic[axis]]
    if len(along) != 1 or isinstance(force, OwnLaw) or force[along[0]]:
        return
    if scene.grains is not None and not g[1 - along[0]]:
        return  # grains that sink for ever, in fluid that stays
    wanted = [scales.density * g[axis] if axis in along else 0.0 for axis in range(2)]
    warnings.append(
        f"gravity along {'xy'[along[0]]}, which is periodic, drives grains but no fluid: pressure balances it;"
        f" fluid.body_force = [{wanted[0]:g}, {wanted[1]:g}] drives it"
    )


def filled_by(scene: Scene) -> float:
    """Share of the box's fluid that sides of given velocity let in until the end, out where negative; 0 where another
    side balances it, where a velocity is a function of one's own, or where rectangles move."""
    domain, inwards = scene.domain, 0.0
    if any(it.fastest for it in scene.rectangle):
        return 0.0
    for name, side in domain.sides.items():
        if not side.open:
            continue
        if not side.boundary.prescribes_velocity or side.velocity is None or isinstance(side.velocity, OwnLaw):
            return 0.0
        u, v = side.velocity
        inwards += {"left": u, "right": -u}.get(name, 0.0) * domain.height
        inwards += {"bottom": v, "top": -v}.get(name, 0.0) * domain.width
    share = inwards * scene.time.end / (domain.width * domain.height)
    return share if math.isfinite(share) else 0.0
