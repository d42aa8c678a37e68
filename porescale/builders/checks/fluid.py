"""Operators of [fluid] that go together."""

from porescale.common.core.errors import Fault
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.coupling.weighting.choose import fitting_weight, fitting_weights
from porescale.scene.fluid import Fluid


def check_solid_options(fluid: Fluid) -> list[Fault]:
    """The fault of a weight, or a rim, that does not go with the solid operator."""
    problem = f"does not go with the solid operator {fluid.solid_operator!r}"
    try:
        fitting_weight(fluid.solid_operator, fluid.weighting)
    except ValueError:
        fits = " or ".join(map(repr, fitting_weights(fluid.solid_operator)))
        return [Fault("weighting", fluid.weighting, problem, "", fits, "leave it out")]
    soft = [name for name, operator in SOLID_OPERATORS.items() if operator.soft_law]
    if fluid.rim == "soft" and fluid.solid_operator not in soft:
        repair = f"leave it out, or take {' or '.join(map(repr, soft))}"
        return [Fault("rim", fluid.rim, problem, "", "'sharp'", repair)]
    return []
