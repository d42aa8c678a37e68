"""A row of the register of collision operators: name, laws and consequences."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

MAGIC_MIDWAY_WALL = 3 / 16
"""Magic parameter with which a half-way wall lies exactly midway in a parabolic flow (trt.py)."""
MAGIC_NARROW_CHANNEL = 1 / 24
"""Magic parameter with which a channel of a few cells carries what it should: of exact walls, 4 cells apart, within 1 %
as the mean over places in a cell (docs/theory/saturated_cells.md).  For dense beds in slow flow."""


class Stability(NamedTuple):
    """Cell Reynolds numbers |u|/nu up to which an operator holds on the map of docs/stability/stability.md, rounded
    down: in the open (a thin double shear layer, lbm.shear) and under a lid that starts at once (lbm.cavity), without
    and with an eddy viscosity of Smagorinsky's constant 0.1.  With eddies a flow holds, but is right only where the
    molecular viscosity leads."""

    in_the_open: float
    in_the_open_with_eddies: float
    under_a_lid: float
    under_a_lid_with_eddies: float


@dataclass(frozen=True)
class Operator:
    """A row of the register.

    name : in scenes;  purpose : what it is good for, one line;  law, eddy_law : its NamedTuples, without and with an
    eddy viscosity (``eddy_version``);  third_order_rate : of a law, the rate s of the antisymmetric moments that are
    not momentum;  convective_delay : of a law, by how many steps convection is late at a half-way wall that fluid
    passes (boundary/velocity.py), None where it is 1/s - 1/2;  constants : values of further fields of the law
    (``magic`` is given by its user);  law_without_force : with the same fields, for a force of zero;  holds : see
    ``Stability``, None where it was not measured;  soft_rim :
    whether grains get soft rims with it unless the scene says otherwise;  order : place in lists.
    """

    name: str
    purpose: str
    law: Any
    eddy_law: Any
    third_order_rate: Callable[[Any], float]
    convective_delay: Callable[[Any], float] | None = None
    constants: Mapping[str, float] = field(default_factory=dict)
    law_without_force: Any = None
    holds: Stability | None = None
    soft_rim: bool = False
    order: int = 100
