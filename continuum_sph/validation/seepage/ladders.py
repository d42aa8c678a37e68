"""Convergence of water in soil: consolidation, sheet pile, imbibition, wet slopes, dam at several spacings."""

from dataclasses import replace
from functools import partial

from continuum_sph.validation.seepage.consolidation import LAYER, consolidation
from continuum_sph.validation.seepage.dam import CALM, DAM, unlike
from continuum_sph.validation.seepage.infiltration import DRAWN, fronts
from continuum_sph.validation.seepage.sheet_pile import SheetPile, flow
from continuum_sph.validation.seepage.wet_slopes import SEEPING, STILL, WetSlope, friction
from porescale.common.evidence.convergence import Ladders

LADDERS = Ladders()


@LADDERS.ladder(
    "seepage.consolidation",
    title="Largest error of excess pressure over its start, at time factor 0.1",
    along="rows of particles",
    levels=(10, 20, 40),
    expected=2.0,
    within=0.1,
    because="corrected sums smooth over h, and a drained base holds its pressure at its face: second order",
)
def layer(rows: float) -> float:
    """Against Biot's equations with inertia."""
    return consolidation(replace(LAYER, rows=int(rows)), (0.1,))[1]


def pile_error(which: int, share: float, rows: float) -> float:
    """|discharge, or exit gradient, over that of the conformal map, less 1|, the larger of a pile to ``share`` T and,
    where it has four rows beside it, half a row deeper;  which : 0 or 1."""
    return max(abs(flow(SheetPile(depth, int(rows)))[which] - 1.0) for depth in (share, share + 0.5 / rows))


for which, (name, title, order) in enumerate((
    ("seepage.flow_under_a_sheet_pile", "Relative error of the discharge under a pile to half of the depth",
     "what the foot of the pile leaves is a share of a spacing: first order, in one sign or the other"),
    ("seepage.exit_gradient_at_a_sheet_pile", "Relative error of the exit gradient there",
     "no order is expected, as which rows the fit takes hangs on the spacing"),
)):  # fmt: skip
    LADDERS.ladder(name, title=title, along="particles over the depth", levels=(12, 16, 24), because=order)(
        partial(pile_error, which, 0.5)
    )


@LADDERS.ladder(
    "seepage.imbibition",
    title="Relative error of the way of a wetting front after 0.6 s",
    along="rows of particles",
    levels=(10, 20, 40, 60),
    because="no order is expected: water starts 0.01 s late, 0.8 % of the way, at any spacing, and a front's place is"
    " known to a quarter of a row of either sign",
)
def front(rows: float) -> float:
    """Exact: Green & Ampt 1911 without capillarity and gravity."""
    return abs(fronts(replace(DRAWN, rows=int(rows)), (0.6,))[0] - 1.0)


@LADDERS.ladder(
    "seepage.in_and_out",
    title="Largest difference of what passes into and out of a dam in 3.5 s, over what passes",
    along="particles over the water before it",
    levels=(12, 20, 32),
    expected=2.0,
    within=1.0,
    because="water that leaves ground a particle at a time counts by a share of one too early or too late: of the"
    " spacing squared, and of the spacing if as many as there are rows did so at once",
)
def between(rows: float) -> float:
    """Exact: nothing where nothing changes any more."""
    return unlike(replace(DAM, rows=int(rows), permeability=CALM))


def slope_error(given: WetSlope, rows: float) -> float:
    """|friction that a wet layer shows over sin φ, less 1|."""
    return abs(friction(replace(given, rows=int(rows))) / given.friction - 1.0)


for name, title, given in (
    (
        "seepage.friction_under_water",
        "Relative error of the friction of an endless layer in still water, on 28°",
        STILL,
    ),
    ("seepage.friction_with_seepage", "The same of one that water seeps along, on 16°", SEEPING),
):
    LADDERS.ladder(
        name,
        title=title,
        along="rows of particles",
        levels=(10, 20, 40, 80),
        because="half of the row at the floor is held, 0.5/N of what drives: first order, if nothing else were off",
    )(partial(slope_error, given))
