"""Operators of [fluid] as keyword arguments of the lattice and of its coupling."""

from typing import Any

from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.coupling.weighting.choose import fitting_weight
from porescale.lbm.collision.choose import OPERATORS
from porescale.scene.fluid import Fluid


def collision_options(fluid: Fluid) -> dict[str, Any]:
    """What the collision operator is chosen by: keyword arguments of ``Fluid`` of the lattice."""
    return {"operator": fluid.operator, "magic": fluid.magic, "smagorinsky": fluid.smagorinsky or 0.0}


def weight_of(fluid: Fluid) -> str:
    """Name of the weight that is used."""
    return fitting_weight(fluid.solid_operator, fluid.weighting)


def has_soft_rim(fluid: Fluid) -> bool:
    """Whether grains have soft rims."""
    by_default = OPERATORS[fluid.operator].soft_rim and SOLID_OPERATORS[fluid.solid_operator].soft_law is not None
    return fluid.rim == "soft" or (fluid.rim is None and by_default)


def solid_options(fluid: Fluid) -> dict[str, Any]:
    """What chooses the laws of cells that grains lie in: keyword arguments of ``SaturatedCells`` and ``Coupled``."""
    return {"solid_operator": fluid.solid_operator, "weighting": weight_of(fluid), "soft_rim": has_soft_rim(fluid)}
