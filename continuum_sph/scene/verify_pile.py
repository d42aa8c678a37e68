"""Validation of the heave behind a sheet pile."""

from __future__ import annotations

import functools

from continuum_sph.scene.trials_pile import Around, Heave
from porescale.workbench.validations import Measured, Validations

VALIDATIONS = Validations()

BOUNDS = {0.25: (2.85, 3.18), 0.5: (2.93, 3.34), 0.75: (3.18, 3.76)}
"""h/(i_c s) of Terzaghi's prism, s/2 wide and without friction, and of the exit gradient at the pile, by s/T."""
QUICK = Heave(rows=12, reach=1.0, cover=0.17, modulus=5e5, permeability=3e-2, first=2.7, rate=0.7, calm=0.4)


@functools.cache
def onset(given: Heave = QUICK) -> float:
    """h/(i_c s) at which heave begins."""
    return given.onset()


@VALIDATIONS.row(
    "continuum.heave_behind_pile",
    source="Terzaghi 1943: prism s/2 wide behind the pile; exit gradient by conformal mapping (Harr 1962); s/T = 0.5",
    because="heave begins between the two, whose distance is twice this; it has begun when the prism's surface has "
    "risen four times as much as soil without weight swells, i_c ρ g s²/2M",
    tolerance=0.5 * (BOUNDS[0.5][1] - BOUNDS[0.5][0]),
    slow=True,
)
def heave_row() -> Measured:
    """Head over i_c s at which the ground behind a pile to half its depth begins to rise, 12 particles over T."""
    low, high = BOUNDS[QUICK.share]
    found = onset()
    return Measured(0.5 * (low + high), found, abs(found - 0.5 * (low + high)))


NARROW = {0.25: (2.83, 3.15), 0.5: (2.86, 3.19), 0.75: (3.05, 3.46)}
"""The same bounds in ground that ends 1 T beside the pile, by finite volumes: `tests/reference/sheet_pile.py`."""
HEADS = (2.8, 3.0, 3.2)  # over i_c s


@functools.cache
def held(given: Heave = QUICK) -> float:
    """Middle between the highest of HEADS that ground stands and the next, which it does not; nan without either."""
    last = float("nan")
    for head in HEADS:
        if not given.stands(head):
            return 0.5 * (last + head)
        last = head
    return float("nan")


@VALIDATIONS.row(
    "continuum.heave_under_held_head",
    source="Terzaghi 1943: prism s/2 wide behind the pile; exit gradient at the pile; both by finite volumes in ground "
    "that ends 1 T beside it; s/T = 0.5",
    because="heave begins between the two, whose distance is twice this; heads are held and a fifth apart, so it is "
    "known to a tenth, and no rate of rising comes in",
    tolerance=0.5 * (NARROW[0.5][1] - NARROW[0.5][0]),
    slow=True,
)
def held_row() -> Measured:
    """Head over i_c s, held, above which ground behind a pile to half its depth goes on rising, 12 particles over T."""
    low, high = NARROW[QUICK.share]
    found = held()
    return Measured(0.5 * (low + high), found, abs(found - 0.5 * (low + high)))


AROUND = {
    Around(0.25, 32): (0.6888, 1.3200), Around(0.5, 24): (0.4637, 0.6361), Around(0.75, 24): (0.3193, 0.3887),
}  # fmt: skip
"""(q/(k h), i_E T/h as `Around` reads it) by finite volumes: `tests/reference/sheet_pile.py`."""


@functools.cache
def seepage(given: Around) -> tuple[float, float]:
    """Discharge and exit gradient over those of finite volumes."""
    discharge, gradient = given.run(100 * given.rows)
    return discharge / AROUND[given][0], gradient / AROUND[given][1]


def around_row(given: Around) -> None:
    """Add the row of a pile of one depth."""

    @VALIDATIONS.row(
        f"continuum.pile_both_sides_{100 * given.share:.0f}",
        source="Laplace's equation by finite volumes in the same ground: 1 T beside a pile one particle thick",
        because="the tip lies between wall and open particles, uncertain to half a spacing of 1/32 or 1/24 T, q by "
        "1.9 % of itself; kernels 1.3 spacings wide round off the root of its edge; held to 3 %, and 8 % for the "
        "gradient, scaled to that",
        tolerance=0.03,
        slow=True,
    )
    def row() -> Measured:
        """q and i_E of a pile that both sides touch over those of finite volumes, 32 or 24 particles over T."""
        q, gradient = seepage(given)
        return Measured([1.0, 1.0], [q, gradient], max(abs(q - 1.0), abs(gradient - 1.0) * 3.0 / 8.0))


for ground in AROUND:
    around_row(ground)
