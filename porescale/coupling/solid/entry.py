"""A row of the register of solid operators: name, laws and consequences."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple


class Holds(NamedTuple):
    """Limits from the map of stability for a solid operator with one weight (docs/stability/stability.md).

    lightest : cells per diameter, and the density ratio from which on a free disc of that size holds (coupling.fall; at
    10 cells also shot at Mach 0.1, coupling.fly; lighter ones than 0.1 were not tried);  cells : per diameter from
    which on the drag of a free disc is within a tenth, wherever it holds (coupling.fall);  bed : solid fraction of a
    square bed, and the cells per diameter from which on its drag is within a tenth up to there; with none of the map's
    beyond the last one (coupling.bed).
    """

    lightest: tuple[tuple[float, float], ...]
    cells: float
    bed: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class SolidOperator:
    """A row of the register.

    name : in scenes;  purpose : what it is good for, one line;  law : its NamedTuple, whose fields ``k`` (tau - 1/2)
    and ``third_order`` are known, others come from ``constants``;  soft_law : that of soft rims, None where it has
    none;  weight : the one weight it goes with; None: with every general one (weighting).

    What follows from it:  radius_shift : times the magic parameter, cells², over the radius: what a disc's radius lacks
    in the lattice;  half_step_correction : whether full cells are given a velocity whose time-centred value is the
    body's (load.py);  turns_back : whether full cells turn populations back, so that the fluid inside a free body
    answers it with a change of sign each step (immersed.py);  force_everywhere : whether the body force acts in the
    whole of a cell;  longest_relaxation_time : up to which drag is right;  magic : the one magic parameter that it is
    made for, None for any;  narrow_gaps : whether a gap of 1.4 cells carries what it should;  films : whether films
    (lubrication.py) were measured with it;  gaps : gap in cells between discs of a square array, and by how much of it
    the drag is too small there, the worst of relaxation times up to 1; ascending;  holds : by weight;  order : place in
    lists, the recommended one first.
    """

    name: str
    purpose: str
    law: Any
    constants: Mapping[str, float] = field(default_factory=dict)
    soft_law: Any = None
    weight: str | None = None
    radius_shift: float = 0.0
    half_step_correction: bool = False
    turns_back: bool = False
    force_everywhere: bool = False
    longest_relaxation_time: float = 1.5
    magic: float | None = None
    narrow_gaps: bool = False
    films: bool = False
    gaps: tuple[tuple[float, float], ...] = ()
    holds: Mapping[str, Holds] = field(default_factory=dict)
    order: int = 100
