"""Why a run diverged: the likely cause, from the state before, not from the diverged one.

At the end every number is huge.  The cause shows in the last state within bounds, by how far it lies beyond what holds
on the map of stability (limits.py).
"""

from dataclasses import dataclass

from porescale.coupling import limits


@dataclass(frozen=True)
class Circumstances:
    """How a run stood at the last check that it passed; lattice units.

    operator, eddies, solid_operator, weighting : the laws;  relaxation_time;  speed : the fastest, of fluid, grains and
    what is moved, cells per step;  density_change : the largest, relative;  density_ratio : of the lightest free
    grain over the fluid, None without one;  cells_per_diameter : of the smallest grain, at the hydraulic radius.
    """

    operator: str
    eddies: bool
    relaxation_time: float
    speed: float
    density_change: float
    solid_operator: str = "exact-wall"
    weighting: str = "wall"
    density_ratio: float | None = None
    cells_per_diameter: float = 0.0
    lid: bool = False


def likely_cause(now: Circumstances) -> str:
    """The circumstance that is furthest beyond its verified range, with its repair, in one line.

    What is wrong from the start comes first: grains with an operator, or of a weight, that cannot last.  Speed and
    pressure may be the first signs of these.
    """
    beyond = _light(now) or max(filter(None, (_thin(now), _fast(now), _pressed(now))), default=None)
    if beyond is None:
        return "likely cause: none that is known of; a shorter fluid.step or a finer spacing often helps"
    return f"likely cause: {beyond[1]}"


Found = tuple[float, str] | None


def _light(now: Circumstances) -> Found:
    """Grains lighter than their number of cells bears."""
    if now.density_ratio is None:
        return None
    least = limits.lightest(now.cells_per_diameter, now.solid_operator, now.weighting)
    if now.density_ratio >= least:
        return None
    return least / now.density_ratio, (
        f"free grains of density ratio {now.density_ratio:.3g} at {now.cells_per_diameter:.3g} cells per diameter,"
        f" where less than {least:g} is not known to hold; refine the spacing"
    )


def _thin(now: Circumstances) -> Found:
    """More speed than the viscosity damps: the cell Reynolds number |u|/nu, with tau near 1/2."""
    reynolds = 3 * now.speed / (now.relaxation_time - 0.5)
    holds = limits.cell_reynolds(now.operator, eddies=now.eddies, lid=now.lid)
    if reynolds <= holds:
        return None
    name = f"'{now.operator}'{' with eddies' if now.eddies else ''}{' under a lid' if now.lid else ''}"
    steadiest = now.operator == limits.STEADIEST and now.eddies
    better = "" if steadiest else f", or take operator = {limits.STEADIEST!r} with smagorinsky = 0.1"
    return reynolds / holds, (
        f"relaxation time {now.relaxation_time:.6g}, near 1/2, at a speed of Mach {now.speed * 3**0.5:.2g}: cell"
        f" Reynolds number {reynolds:.3g}, and {name} is known to hold up to {holds:g};"
        f" refine the spacing or raise the viscosity{better}"
    )


def _fast(now: Circumstances) -> Found:
    """Faster than the lattice bears at any viscosity."""
    mach = now.speed * 3**0.5
    if mach <= limits.MACH:
        return None
    return mach / limits.MACH, f"too fast for the lattice, Mach {mach:.2g} of at most {limits.MACH}; shorten fluid.step"


def _pressed(now: Circumstances) -> Found:
    """A pressure that the lattice takes for a change of density."""
    if now.density_change <= limits.DENSITY:
        return None
    return now.density_change / limits.DENSITY, (
        f"pressure changes the density by {now.density_change:.2g}: too much for the sound speed of the lattice;"
        " shorten fluid.step"
    )
