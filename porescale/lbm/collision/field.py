"""A body force that differs from cell to cell, for any collision operator: only where it is asked for.

The law of a sweep then holds the force of every cell, that of a row the force of its cells, and in each cell the
operator's own law has the force of that cell.  All other laws are, in each of these places, themselves: nothing is
computed for them.
"""

import sys
from collections import namedtuple
from typing import Any

from porescale.lbm.collision.law import cell_law, part_law, row_law

_BODIES = """
def row_law(y, law):
    return Field({own}, law.force_x[y], law.force_y[y])


def part_law(first, last, law):
    return Field({own}, law.force_x[first:last], law.force_y[first:last])


def cell_law(x, law):
    return Plain({cell})
"""
"""Laws of a row, of part of it and of a cell, for an operator with so many numbers."""


def field_version(law: Any) -> Any:
    """The type of a law with two more fields, ``force_x`` and ``force_y`` (ny, nx), force densities of all cells."""
    name = f"Field_{law.__module__}_{law.__qualname__}".replace(".", "_")
    here = vars(sys.modules[__name__])
    if name in here:
        return here[name]
    fields = law._fields
    here[name] = namedtuple(name, (*fields, "force_x", "force_y"), module=__name__)
    own = ", ".join(f"law.{field}" for field in fields)
    at = {"fx": "law.force_x[x]", "fy": "law.force_y[x]"}
    names: dict[str, Any] = {"Field": here[name], "Plain": law, "__name__": __name__}
    exec(_BODIES.format(own=own, cell=", ".join(at.get(field, f"law.{field}") for field in fields)), names)
    for key, chosen in (("row_law", row_law), ("part_law", part_law), ("cell_law", cell_law)):
        chosen.of(here[name])(names[key])
    return here[name]
