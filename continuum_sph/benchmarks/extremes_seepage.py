"""What `continuum-sph study extremes` tries on soil with water in it: permeabilities from gravel to rock."""

from collections.abc import Callable

from continuum_sph.builders.sanity import Now, advance_one
from continuum_sph.soil import SoilFlow
from continuum_sph.validation.seepage.saturated_box import energies, saturated_box
from porescale.common.evidence.extremes import Extreme, Extremes

CHECKED = 20  # steps between two checks of the energies
SPEED = 0.05  # m/s, of the stirring: strains of 0.2 %


def stirred(permeability: float, seconds: float = 0.2) -> Callable[[], str]:
    """A periodic box of saturated elastic soil, both layers stirred at random, at the step that sound allows."""

    def run() -> str:
        """How much energy is left, and how much it ever grew; Unstable where a particle is lost."""
        both = saturated_box(16, 1, permeability=permeability, speed=SPEED)
        ground = both.ground
        assert isinstance(ground, SoilFlow)
        start = energies(both, ground)["sum"]
        relaxing = permeability / (both.water.resistance.porosity * both.water.resistance.gravity)
        free = least = start
        growth = 0.0
        while both.time < seconds:
            advance_one(both.advance, Now(both.step, both.time, "lower numerics.courant"))
            if both.water.step % CHECKED == 0:
                parts = energies(both, ground)
                free = parts["sum"] - parts["heat of drag"]
                growth, least = max(growth, free - least), min(least, free)
        text = f"{both.water.step} steps of {both.next_step / relaxing:.2g} relaxation times of the drag"
        return f"{text}; {free / start:.2g} of the energy left, grown by {growth / start:.2g} at most"

    return run


EXTREMES = Extremes(
    Extreme("permeability", f"{k:g} m/s", stirred(k)) for k in (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
)
