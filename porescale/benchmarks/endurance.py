"""Grains in water for very long: six that fly about in a periodic box, and a heap at the bottom of a closed one, which
may sleep."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from porescale.common.evidence.endurance import Endurance, Endurances, Held
from porescale.coupling.divergence_check import DivergenceCheck
from porescale.coupling.step import Coupled
from porescale.validation.coupling.setups import handful, immersed
from porescale.validation.coupling.sleep import let_sleep

EPS = float(np.finfo(float).eps)
WEIGHT = (0.0, -2e-4)
"""Acceleration, cells per step²."""
CELLS = (44, 56)


def heap(acceleration: tuple[float, float] = WEIGHT) -> Coupled:
    """Fifteen discs let go above the floor of a closed box, packed as closely as rows allow."""
    rng = np.random.default_rng(5)
    x, y = np.meshgrid(np.arange(5) * 8.6 + 4.6, np.arange(3) * 8.6 + 4.6)
    place = np.column_stack((x.ravel(), y.ravel())) + rng.uniform(-0.1, 0.1, (15, 2))
    return immersed(
        CELLS, place, rng.uniform(3.2, 4.2, 15), 2.5, relaxation_time=0.8, acceleration=acceleration, ratio=0.7
    )


class Watched:
    """What is read of fluid and grains; ``periodic``: no wall takes momentum, and no weight adds any."""

    def __init__(self, coupled: Coupled, periodic: bool) -> None:
        self.coupled = coupled
        self._periodic = periodic
        discs = coupled.grains.discs
        self._size = float(np.sum(discs.mass[:, None] * np.abs(discs.velocity)))
        self._cells = coupled.fluid.nx * coupled.fluid.ny
        self._sense = DivergenceCheck(
            coupled.fluid, coupled.scales, coupled, operator="trt", eddies=False, solid_operator="exact-wall"
        )

    def advance(self, steps: int) -> None:
        """Fluid steps with their contact steps."""
        for _ in range(steps):
            self.coupled.advance()

    def check(self) -> None:
        """Check the state as a run does; raises Unstable."""
        self.coupled.grains.check()
        self._sense.check(self.coupled.fluid.step, float(self.coupled.fluid.step))

    def read(self) -> Mapping[str, float]:
        """Mass of the fluid, and momentum or places of grains."""
        mass = {"mass over that at rest, less 1 ()": self.coupled.fluid.mass_excess() / self._cells}
        discs = self.coupled.grains.discs
        if self._periodic:
            x, y = self.coupled.momentum() / self._size
            return mass | {"momentum x over Σ mv at the start ()": x, "momentum y over Σ mv at the start ()": y}
        diameter = float(2.0 * discs.radius.mean())
        speed = float(np.hypot(discs.velocity[:, 0], discs.velocity[:, 1]).max())
        sleep = self.coupled.grains.sleep
        return mass | ({ASLEEP: float(sleep.count)} if sleep else {}) | {
            "mean place x (diameters)": float(discs.position[:, 0].mean()) / diameter,
            "mean height (diameters)": float(discs.position[:, 1].mean()) / diameter,
            "highest grain (diameters)": float((discs.position[:, 1] + discs.radius).max()) / diameter,
            "fastest grain (cells/step)": speed,
        }  # fmt: skip

    def state(self) -> dict[str, Any]:
        """All it takes to go on bit for bit."""
        return self.coupled.state()

    def restore(self, state: dict[str, Any]) -> None:
        """Go on from a state of the same start."""
        self.coupled.restore(state)


ASLEEP = "grains asleep ()"

MASS = Held(
    "mass over that at rest, less 1 ()", lambda steps: 1e-12,
    "required; the sum of nine rounded populations errs by eps a step either way, 1e3 eps in a million",
)  # fmt: skip
ROUNDING = "round-off: every step, and each of its 4 contact steps, rounds velocities, all one way: 5 eps a step"
PLACES = ("mean place x (diameters)", "mean height (diameters)", "highest grain (diameters)")
SETTLED = "share of a diameter by which a packing may shift: the overlap of a grain under its weight is 1e-4"

HEAPED = 1_000_000
"""Steps of which the heap lies still after a tenth, and sleeps after a twentieth; with 100 000 it does neither."""

ENDURANCES = Endurances([
    Endurance(
        "flying grains", "six grains collide in a periodic box of 60 x 40 cells of water, without weight",
        lambda: Watched(handful(), periodic=True),
        (MASS, *(Held(f"momentum {axis} over Σ mv at the start ()", lambda steps: 5 * EPS * steps, ROUNDING)
                 for axis in "xy")),
        settles=0,
    ),
    Endurance(
        "settled heap", "fifteen grains settle in a closed box of 44 x 56 cells of water within a tenth, and lie",
        lambda: Watched(heap(), periodic=False),
        (MASS, *(Held(name, lambda steps: 1e-3, SETTLED) for name in PLACES),
         Held("fastest grain (cells/step)", lambda steps: 1e-6, "at rest: 1e-3 of a cell in a thousand steps")),
        settles=2, least=HEAPED,
    ),
    Endurance(
        "sleeping heap", "the same heap sleeps and is not woken by the water, for a fifth of the steps",
        lambda: Watched(let_sleep(heap(), after=None), periodic=False),
        (MASS, Held(ASLEEP, lambda steps: 0.0, "nothing disturbs them"),
         *(Held(name, lambda steps: 0.0, "who sleeps does not move, not by a last digit")
           for name in (*PLACES, "fastest grain (cells/step)"))),
        settles=5, share=0.2, least=HEAPED,
    ),
])  # fmt: skip
"""What `porescale study endurance` runs."""
