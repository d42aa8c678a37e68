"""Whether a fluid, alone or with grains, has diverged, and if so: where, since when, and why, in words."""

from dataclasses import replace

import numpy as np

from porescale.common.core.errors import Unstable
from porescale.common.core.types import Reals
from porescale.coupling.coverage.interpenetration import require_apart
from porescale.coupling.displaced import displaced
from porescale.coupling.divergence_cause import Circumstances, likely_cause
from porescale.coupling.step import Coupled
from porescale.coupling.weighting.choose import fitting_weight
from porescale.dem.grains import Grains
from porescale.lbm.boundary.sides import NAMES, Sides
from porescale.lbm.fluid import Fluid
from porescale.lbm.sanity import SOUND, WORST_DENSITY, WORST_MACH
from porescale.lbm.scales import Scales


class DivergenceCheck:
    """Checks a fluid, and the grains in it.  Keeps how it stood at the last check, for the cause.

    operator, eddies, solid_operator, weighting : names of the laws, for the cause; None: the weight that fits.
    """

    def __init__(
        self, fluid: Fluid, scales: Scales, coupled: Coupled | None, *, operator: str, eddies: bool,
        solid_operator: str, weighting: str | None = None,
    ) -> None:  # fmt: skip
        self.fluid, self.scales, self.coupled = fluid, scales, coupled
        ratio, cells = _lightest(coupled) if coupled else (None, 0.0)
        self.last = Circumstances(
            operator, eddies, fluid.relaxation_time, self._prescribed_speed(), 0.0, solid_operator,
            fitting_weight(solid_operator, weighting), ratio, cells,
            lid=any(fluid.sides.speed(name) for name in NAMES),
        )  # fmt: skip

    def check(self, step: int, time: float) -> None:
        """Raise Unstable, naming cell, quantity, value and likely cause, where the fluid is outside of its bounds.

        That is: a number that is none, Mach 0.6, a density changed by a half, polygons within each other.  step, time
        (s): as the message has it.
        What is read is the fluid alone, so that grains which are nowhere do no harm; its fields only where its totals
        are out of bounds.
        """
        found = self.fluid.totals()
        if not (found.fastest <= WORST_MACH * SOUND and found.density_change <= WORST_DENSITY):  # a nan is not
            self._find(step, time)
        if self.coupled and self.coupled.polygons:
            require_apart(self.coupled.polygons, self.coupled.grains, step, time)
        fastest = max(found.fastest, self._prescribed_speed())
        self.last = replace(self.last, speed=fastest, density_change=found.density_change)

    def _find(self, step: int, time: float) -> None:
        """Raise Unstable for the worst cell; returns where the fields are within bounds by a rounding."""
        with np.errstate(all="ignore"):  # what is no number any more is what is looked for
            rho, ux, uy = self.fluid.fields()
            change, speed = np.abs(rho - 1), np.hypot(ux, uy)
        for name, values, bound, unit, factor in (
            ("relative density change", change, WORST_DENSITY, "", 1.0),
            ("speed", speed, WORST_MACH * SOUND, "m/s", self.scales.velocity),
        ):
            if not bool(np.all(values <= bound)):  # a nan is not
                y, x = worst_cell(values)
                h = self.scales.spacing
                where = f"cell ({x}, {y}) at ({(x + 0.5) * h:.4g}, {(y + 0.5) * h:.4g}) m"
                cause = likely_cause(self._before(speed))
                raise Unstable(where, name, float(values[y, x]) * factor, unit, step, time, cause)

    def _prescribed_speed(self) -> float:
        """The fastest of grains and sides, cells per step; what is no number does not count."""
        speed = _sides_speed(self.fluid.sides)
        if self.coupled and self.coupled.grains.discs.count:
            velocity = self.coupled.grains.discs.velocity / self.scales.velocity
            moving = np.hypot(velocity[:, 0], velocity[:, 1])
            speed = max(speed, float(np.where(np.isfinite(moving), moving, 0.0).max()))
        return speed

    def _before(self, speed: Reals) -> Circumstances:
        """The last state within bounds; where nothing had moved yet, the fastest cell that is still within bounds."""
        if self.last.speed > 0:
            return self.last
        within = speed[speed <= WORST_MACH * SOUND]
        return replace(self.last, speed=float(within.max()) if len(within) else WORST_MACH * SOUND)


def worst_cell(values: Reals) -> tuple[int, int]:
    """(y, x) of the largest of ``values`` (ny, nx); where some are not finite, the one in the middle of those.

    What is no number spreads by a cell a step on all sides, so it began in the middle.
    """
    lost = np.argwhere(~np.isfinite(values))
    if len(lost) == 0:
        y, x = np.unravel_index(int(values.argmax()), values.shape)
        return int(y), int(x)
    away = np.abs(lost - np.median(lost, axis=0)).sum(axis=1)
    y, x = lost[int(away.argmin())]
    return int(y), int(x)


def _sides_speed(sides: Sides) -> float:
    """The fastest that a side moves or lets in, cells per step."""
    speeds = [abs(sides.speed(name)) for name in NAMES]
    for name in NAMES:
        if sides.boundary(name).prescribes_velocity:
            given = np.atleast_2d(np.asarray(getattr(sides, f"{name}_velocity"), float))
            speeds.append(float(np.hypot(given[:, 0], given[:, 1]).max()))
    return max(speeds)


def _lightest(coupled: Coupled) -> tuple[float | None, float]:
    """Density ratio of the lightest grain that is free to move, None without one, and cells across the smallest."""
    grains: Grains = coupled.grains
    discs = grains.discs
    free = np.ones(discs.count, bool)
    if len(grains.held):
        free = ~np.all(grains.held[:, :2] != 0, axis=1)
    if not free.any():
        return None, 0.0
    inside = displaced(grains, discs.radius, coupled.scales.density).mass
    ratio = discs.mass[free] / inside[free]
    round_ones = free & (coupled.hydraulic_radius > 0.0)  # corners of polygons cover no cells
    across = 2 * float(coupled.hydraulic_radius.min(where=round_ones, initial=np.inf)) / coupled.scales.spacing
    if coupled.polygons:
        across = min(across, float(coupled.polygons.polygons.width.min()))
    return float(ratio.min()), across
