"""What the numbers of a lattice mean for its box: whole cells, numbers that disagree, and how they may have been meant.

Of no section; lengths in m, times in s.
"""

import math
from collections.abc import Mapping

from porescale.common.core.errors import Fault
from porescale.lbm.scales import AGREEMENT, NAMES, implied

WHOLE = 1e-6
"""A length is a whole number of cells if it misses by less than this share of a cell or of itself."""
UNITS = {"spacing": "m", "step": "s", "relaxation_time": "", "viscosity": "m^2/s"}

ROUND = (1, 5, 2)
"""Leading digits of a round spacing, the likeliest first: a misprint is most often one of the exponent."""


def is_whole(length: float, spacing: float) -> bool:
    """Whether ``length`` is a whole number of cells, one at least."""
    cells = length / spacing
    return round(cells) >= 1 and abs(cells - round(cells)) <= WHOLE * max(1.0, cells)


def disagreements(given: Mapping[str, float], width: float, height: float) -> list[Fault]:
    """A fault for each of the four ``given`` numbers if they disagree, keys as in NAMES; none if they agree.

    Each gives what the others imply, and how many cells the box is then wide; that of the spacing also names a round
    spacing that divides the box.  width, height : of the box, 0 where not given.
    """
    follows = implied(**given)
    if all(abs(follows[name] - given[name]) <= AGREEMENT * given[name] for name in NAMES):
        return []
    faults = []
    for name in NAMES:
        others = ", ".join(other for other in NAMES if other != name)
        unit, value = UNITS[name], follows[name]
        repair = f"leave {name} out, or give {value:.6g}"
        if width:
            repair += f" ({_cells(width, value if name == 'spacing' else given['spacing'])})"
            if name == "spacing":
                repair += _reading(given, value, width, height)
        problem = f"the others ({others}) imply {value:.4g} {unit}".rstrip()
        faults.append(Fault(name, given[name], problem, unit, repair=repair))
    return faults


def _cells(width: float, spacing: float) -> str:
    if is_whole(width, spacing):
        return f"{round(width / spacing)} cells over domain.width"
    return f"{width / spacing:.6g} cells over domain.width, not a whole number"


def _reading(given: Mapping[str, float], near: float, width: float, height: float) -> str:
    """A round spacing next to ``near`` that divides the box and is not the given one, with the step it implies."""
    for digit in ROUND:
        exponent = math.floor(math.log10(near / digit))
        for spacing in (float(f"{digit}e{exponent + 1}"), float(f"{digit}e{exponent}")):
            if math.isclose(spacing, given["spacing"], rel_tol=AGREEMENT):
                continue
            if is_whole(width, spacing) and is_whole(height, spacing):
                step = implied(spacing=spacing, relaxation_time=given["relaxation_time"], viscosity=given["viscosity"])[
                    "step"
                ]
                return (
                    f"; a round spacing that divides the box is {spacing:g} m "
                    f"({_cells(width, spacing)}), with a step of {step:.4g} s"
                )
    return ""
