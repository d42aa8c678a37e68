"""Validations of the flow around a sheet pile and of the heave behind it."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from continuum_sph.build.exit_gradient import NAME
from continuum_sph.validation.pile_trials import Around, Heave
from continuum_sph.validation.seepage_steady_trials import SheetPile
from porescale.common.evidence.validations import Measured, Validations

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
APART = {share: high / low - 1.0 for share, (low, high) in NARROW.items()}
"""How far ground may rise, over s, and its head still tell one bound from the other: ground that has risen by δ s is
that of a pile (1 + δ) s deep, which stands at least (1 + δ) times the head."""
HEADS = (2.8, 3.0, 3.2, 3.4)  # over i_c s
HELD = {0.5: QUICK, 0.25: replace(QUICK, share=0.25, rows=20), 0.75: replace(QUICK, share=0.75, rows=20)}


@functools.cache
def held(given: Heave = QUICK) -> float:
    """Middle between the highest of HEADS that ground stands and the next, which it does not, from the last below the
    lower bound on; nan without either."""
    last, least = float("nan"), NARROW[given.share][0]
    for head in HEADS[np.searchsorted(HEADS, least) - 1 :]:
        if not given.stands(head, APART[given.share]):
            return 0.5 * (last + head)
        last = head
    return float("nan")


def held_row(share: float, name: str) -> None:
    """Add the row of ground behind a pile to one depth."""
    low, high = NARROW[share]

    @VALIDATIONS.row(
        name,
        source="Terzaghi 1943: prism s/2 wide behind the pile; exit gradient at the pile; both by finite volumes in "
        f"ground that ends 1 T beside it; s/T = {share:g}",
        because="heave begins between the two, whose distance is twice this; heads are held and a fifth apart, so it "
        "is known to a tenth, and no rate of rising comes in",
        tolerance=0.5 * (high - low),
        slow=True,
    )
    def row() -> Measured:
        """Head over i_c s, held, above which ground behind a pile goes on rising; 12 or 20 particles over T."""
        found = held(HELD[share])
        return Measured(0.5 * (low + high), found, abs(found - 0.5 * (low + high)))


for buried in HELD:
    held_row(buried, "continuum.heave_under_held_head" + (f"_{100 * buried:.0f}" if buried != QUICK.share else ""))


WITHIN = "or 1/24 T, q by 1.9 % of itself; kernels 1.3 spacings wide round off the root of its edge; held to 3 %, and "


def flow_row(name: str, source: str, found: Callable[[], tuple[float, float]]) -> None:
    """Add the row of the steady flow around a pile; ``found`` gives q and i_E over what is known of them."""

    @VALIDATIONS.row(
        name,
        source=source,
        because=f"the tip lies between wall and open particles, uncertain to half a spacing of 1/32 {WITHIN}8 % for "
        "the gradient, scaled to that",
        tolerance=0.03,
        slow=True,
    )
    def row() -> Measured:
        """q and i_E over what they should be, 32 particles over T around the short pile, 24 else."""
        q, gradient = found()
        return Measured([1.0, 1.0], [q, gradient], max(abs(q - 1.0), abs(gradient - 1.0) * 3.0 / 8.0))


ROWS = {0.25: 32, 0.5: 24, 0.75: 24}
"""Particles over T by s/T: the short pile has the fewest beside it."""


@functools.cache
def one_side(share: float, rows: int) -> tuple[float, float]:
    """(q/(k h), i_E T/h) under a sheet pile to the depth ``share`` T, over what they are exactly."""
    given = SheetPile(share, rows)
    discharge, gradient, _ = given.run(100 * rows)
    return discharge / given.discharge, gradient / given.exit_gradient


AROUND = {
    Around(0.25, 32): (0.6888, 1.3200), Around(0.5, 24): (0.4637, 0.6361), Around(0.75, 24): (0.3193, 0.3887),
}  # fmt: skip
"""(q/(k h), i_E T/h as `Around` reads it) by finite volumes: `tests/reference/sheet_pile.py`."""


@functools.cache
def seepage(given: Around) -> tuple[float, float]:
    """Discharge and exit gradient over those of finite volumes."""
    discharge, gradient = given.run(100 * given.rows)
    return discharge / AROUND[given][0], gradient / AROUND[given][1]


for depth, over in ROWS.items():
    flow_row(
        f"continuum.sheet_pile_{100 * depth:.0f}",
        "conformal mapping: q/(kh) = K'(m)/2K(m), i_E = πh/(4KmT), m = sin(πs/2T) (Harr 1962)",
        functools.partial(one_side, depth, over),
    )
for ground in AROUND:
    flow_row(
        f"continuum.pile_both_sides_{100 * ground.share:.0f}",
        "Laplace's equation by finite volumes in the same ground: 1 T beside a pile one particle thick",
        functools.partial(seepage, ground),
    )


CALM = Heave(rows=16, reach=1.0, cover=0.5, modulus=5e5, permeability=3e-2, first=1.5, last=1.51, rate=5e-3, calm=0.4)
"""Ground under half the head that lifts it, below eight rows of water."""
RISING = {CALM: 0.6493, replace(CALM, share=0.75): 0.3934}
"""i_E T/h as `Around` reads it, by finite volumes."""


@functools.cache
def rising(given: Heave, known: float) -> float:
    """Mean of the exit gradient of the series over the last four fifths of a run, over what is ``known`` of it."""
    table = np.array([(head, model.series()[NAME]) for _, head, _, model in given.course(0.02)])
    head, gradient = table[len(table) // 5 :].T
    return float((gradient / (head * given.critical * given.share * known)).mean())


@VALIDATIONS.row(
    "continuum.exit_gradient_in_a_run",
    source="Laplace's equation by finite volumes in the same ground: 1 T beside a pile one particle thick; s/T 0.5 and "
    "0.75",
    because="the tip is uncertain to half a spacing of 1/16 T, and d ln i_E/ds = 2.5/T at s = T/2: 1 in 13",
    tolerance=2.5 / 32,
    slow=True,
)
def rising_row() -> Measured:
    """Column of series.csv over what it should be, soil and water free to move, 16 particles over T."""
    found = [rising(given, known) for given, known in RISING.items()]
    return Measured([1.0, 1.0], found, max(abs(one - 1.0) for one in found))
