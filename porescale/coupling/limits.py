"""Limits of the map of stability: thresholds for warnings and for naming causes.

Each is a row or a column of the tables in docs/stability/stability.md, from which a test derives it again;
`porescale study stability --out docs/stability` makes the map anew.  What depends on a law stands in the law's own
file: ``Operator.holds``, ``SolidOperator.holds``.
"""

from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.lbm.collision.choose import OPERATORS

MACH = 0.3
"""Largest Mach number of the map: at relaxation times of 0.52 to 5 every operator but "mrt" holds there (lbm.shear)."""
DENSITY = 0.3
"""Relative change of density beyond which the linear equation of state misleads; from 0.5 on a run has diverged."""
_MEASURED = {name: operator.holds for name, operator in OPERATORS.items() if operator.holds}
IN_THE_OPEN = {name: holds.in_the_open for name, holds in _MEASURED.items()}
"""Cell Reynolds number |u|/nu up to which each collision operator holds in the open, see lbm/collision/law.py."""
IN_THE_OPEN_WITH_EDDIES = {name: holds.in_the_open_with_eddies for name, holds in _MEASURED.items()}
"""The same limits with an eddy viscosity."""
UNDER_A_LID = {name: holds.under_a_lid for name, holds in _MEASURED.items()}
"""The same under a lid that starts at once."""
UNDER_A_LID_WITH_EDDIES = {name: holds.under_a_lid_with_eddies for name, holds in _MEASURED.items()}
"""The same under a lid with an eddy viscosity."""
STEADIEST = max(_MEASURED, key=lambda name: min(_MEASURED[name]))
"""The operator that holds furthest where it holds least."""

RECOMMENDED = next(iter(SOLID_OPERATORS))
"""The solid operator to take where nothing speaks for another."""
FOR_NARROW_GAPS = next(name for name, operator in SOLID_OPERATORS.items() if operator.narrow_gaps)
"""The solid operator for gaps of few cells."""
_ON_THE_MAP = {f"{name} {weight}": holds for name, it in SOLID_OPERATORS.items() for weight, holds in it.holds.items()}
TURNING_BACK = tuple(name for name, operator in SOLID_OPERATORS.items() if operator.turns_back)
"""Solid operators that free bodies of this density ratio and more are verified to hold with."""
LIGHT = 1.0
"""At tau 0.8 discs of a tenth hold with them, too (coupling.fall); at tau 0.51 one of 0.3 runs away when shot at Mach
0.1 (coupling.fly), at 0.55 one of 0.5 after 8000 steps in an array of solid fraction 0.4."""
LIGHTEST = {pair: holds.lightest for pair, holds in _ON_THE_MAP.items()}
"""By solid operator and weight: cells per diameter, and the density ratio from which on free discs hold."""
CELLS_RIGHT = {pair: holds.cells for pair, holds in _ON_THE_MAP.items()}
"""The same: cells per diameter from which on the drag of a free disc is within a tenth."""
BED_RIGHT = {pair: holds.bed for pair, holds in _ON_THE_MAP.items()}
"""The same: solid fraction of a bed, and the cells per diameter from which on its drag is within a tenth."""


def cell_reynolds(operator: str, *, eddies: bool, lid: bool = False) -> float:
    """Cell Reynolds number |u|/nu up to which an operator is verified to be stable; the least of all for one not tried.

    lid : whether a wall moves along itself, which is harder at its corners than anything in the open.
    """
    if lid:
        known = UNDER_A_LID_WITH_EDDIES if eddies else UNDER_A_LID
    else:
        known = IN_THE_OPEN_WITH_EDDIES if eddies else IN_THE_OPEN
    return known.get(operator, min(known.values()))


def lightest(cells_per_diameter: float, solid_operator: str = "exact-wall", weighting: str = "wall") -> float:
    """Density ratio from which on free discs of that size are verified to be stable; 1 below the fewest cells of the
    map.

    A pair of solid operator and weight that is not in the table counts as the worst that is, and at least as ``LIGHT``
    where full cells turn populations back.
    """
    name = f"{solid_operator} {weighting}"
    tables = [LIGHTEST[name]] if name in LIGHTEST else list(LIGHTEST.values())
    held = [min((ratio for cells, ratio in rows if cells_per_diameter >= cells), default=1.0) for rows in tables]
    return max(*held, LIGHT if solid_operator in TURNING_BACK else 0.0)


def cells_in_bed(solid_fraction: float, solid_operator: str = "exact-wall", weighting: str = "wall") -> float:
    """Cells per diameter from which on the drag in a bed is within a tenth; infinite where none of the map's is.

    A pair of solid operator and weight that is not in the table counts as the worst that is.
    """
    name = f"{solid_operator} {weighting}"
    tables = [BED_RIGHT[name]] if name in BED_RIGHT else list(BED_RIGHT.values())
    return max(next((cells for most, cells in rows if solid_fraction <= most), float("inf")) for rows in tables)
