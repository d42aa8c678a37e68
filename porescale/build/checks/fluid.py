"""Operators of [fluid] that go together."""

from __future__ import annotations

from porescale.common.core.errors import Fault
from porescale.coupling.weighting import fitting_weight
from porescale.scene.fluid import Fluid


def check_solid_options(fluid: Fluid) -> list[Fault]:
    """The fault of a weight, or a rim, that does not go with the solid operator."""
    problem = f"does not go with the solid operator {fluid.solid_operator!r}"
    try:
        fitting_weight(fluid.solid_operator, fluid.weighting)
    except ValueError:
        fits = "'wall'" if fluid.solid_operator == "exact-wall" else "'B2' or 'B1'"
        return [Fault("weighting", fluid.weighting, problem, "", fits, "leave it out")]
    if fluid.rim == "soft" and fluid.solid_operator != "exact-wall":
        return [Fault("rim", fluid.rim, problem, "", "'sharp'", "leave it out, or take 'exact-wall'")]
    return []
