"""What the map of stability says holds: thresholds for warnings and for naming causes.

Each is a row or a column of the tables in docs/stability/stability.md, from which a test derives it again;
`porescale study stability --out docs/stability` makes the map anew.
"""

from __future__ import annotations

IN_THE_OPEN = {"trt": 51.0, "mrt": 10.0, "central": 5100.0, "bgk": 100.0}
"""Cell Reynolds number |u|/nu up to which the thin double shear layer holds, by collision operator (lbm.shear, rounded
down; "trt" with magic 3/16).  Central moments held in all of the map."""
IN_THE_OPEN_WITH_EDDIES = {"trt": 5100.0, "mrt": 17.0, "central": 5100.0, "bgk": 5100.0}
"""The same with Smagorinsky's constant 0.1.  They hold but are right only where the molecular viscosity leads."""
UNDER_A_LID = {"trt": 20.0, "mrt": 31.0, "central": 62.0, "bgk": 8.0}
"""The same in a cavity whose lid starts at once (lbm.cavity, lid's speed/nu)."""
UNDER_A_LID_WITH_EDDIES = {"trt": 41.0, "mrt": 200000.0, "central": 200000.0, "bgk": 8.0}
"""The same with Smagorinsky's constant 0.1."""
MACH = 0.3
"""Largest Mach number of the map: at relaxation times of 0.52 to 5 every operator but "mrt" holds there (lbm.shear)."""
DENSITY = 0.3
"""Relative change of density beyond which the linear equation of state misleads: 0.5 is taken for beyond sense."""
HELD_ONLY = ("SC3",)
"""Solid operators with which free discs run away: in the map at nearly every density ratio (coupling.fall,
coupling.fly) and in beds of every solid fraction (coupling.bed)."""
LIGHTEST = {
    "exact-wall wall": ((5.0, 0.1), (3.0, 0.2)),
    "odd-SC1 B2": ((16.0, 0.1), (10.0, 0.2), (5.0, 0.3), (3.0, 0.5)),
    "odd-SC1 B1": ((10.0, 0.1), (5.0, 0.2), (3.0, 0.5)),
}
"""Cells per diameter, and the density ratio from which on a free disc of that size holds, by solid operator and weight
(coupling.fall; at 10 cells also shot at Mach 0.1, coupling.fly).  Lighter ones than 0.1 were not tried."""
CELLS_RIGHT = {"exact-wall wall": 3.0, "odd-SC1 B2": 10.0, "odd-SC1 B1": 10.0}
"""Cells per diameter from which on the drag of a free disc is within a tenth, wherever it holds (coupling.fall)."""

BED_RIGHT = {
    "exact-wall wall": ((0.4, 5.0), (0.6, 15.0)),
    "odd-SC1 B2": ((0.2, 10.0), (0.4, 15.0)),
    "odd-SC1 B1": ((0.1, 10.0),),
}
"""Solid fraction of a square bed, and the cells per diameter from which on its drag is within a tenth up to there; with
none of the map's beyond the last one (coupling.bed)."""


def cell_reynolds(operator: str, *, eddies: bool, lid: bool = False) -> float:
    """Cell Reynolds number |u|/nu up to which an operator is known to hold; the least of all for one not tried.

    lid : whether a wall moves along itself, which is harder at its corners than anything in the open.
    """
    if lid:
        known = UNDER_A_LID_WITH_EDDIES if eddies else UNDER_A_LID
    else:
        known = IN_THE_OPEN_WITH_EDDIES if eddies else IN_THE_OPEN
    return known.get(operator, min(known.values()))


def lightest(cells_per_diameter: float, solid_operator: str = "exact-wall", weighting: str = "wall") -> float:
    """Density ratio from which on free discs of that size are known to hold; 1 below the fewest cells of the map.

    A pair of solid operator and weight that is not in the table counts as the worst that is.
    """
    name = f"{solid_operator} {weighting}"
    tables = [LIGHTEST[name]] if name in LIGHTEST else list(LIGHTEST.values())
    held = [min((ratio for cells, ratio in rows if cells_per_diameter >= cells), default=1.0) for rows in tables]
    return max(held)


def cells_in_bed(solid_fraction: float, solid_operator: str = "exact-wall", weighting: str = "wall") -> float:
    """Cells per diameter from which on the drag in a bed is within a tenth; infinite where none of the map's is.

    A pair of solid operator and weight that is not in the table counts as the worst that is.
    """
    name = f"{solid_operator} {weighting}"
    tables = [BED_RIGHT[name]] if name in BED_RIGHT else list(BED_RIGHT.values())
    return max(next((cells for most, cells in rows if solid_fraction <= most), float("inf")) for rows in tables)
