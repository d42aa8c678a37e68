"""Where motion is too quick for the sound of the lattice: a flow of the stability map, lattice units.

Sound is slowed, so that steps may be long.  What changes while sound crosses the box is not incompressible, however
small its Mach number is.
"""

import math

import numpy as np

from porescale.benchmarks.stability_psm import variants
from porescale.common.evidence.stability import Axis, Stability, Tried
from porescale.lbm.lattice import relaxation_time
from porescale.lbm.sanity import SOUND
from porescale.validation.coupling.moving import oscillation, oscillation_in_a_box
from porescale.validation.coupling.setups import Method

STABILITY = Stability()

FREQUENCY, WIDTH = 5.0, 14.0
"""a² w/nu;  width of the box in radii."""

ANGLES = Axis("angle of the swing while sound crosses the box, rad", (0.1, 0.2, 0.3, 0.5, 1, 2.4, 6, 12), (0.3, 2.4))


def laws(quick: bool) -> list[str]:
    """Names of the variants in double precision: swings of a thousandth of a radius are lost in single."""
    return [name for name, parts in variants(quick).items() if parts["dtype"] is np.float64]


@STABILITY.flow(
    "coupling.sound",
    title="A disc swings by a thousandth of its radius in a closed box of 7 diameters, a² w/nu = 5",
    x=ANGLES,
    y=Axis("cells per diameter", (10, 5), (10,)),
    laws=laws,
    right=0.05,
    because="damping within 5 % of linear theory without sound (Stokes 1851, images of the dipole in the box added);"
    " the largest Mach number is 0.001",
)
def sound(law: str, x: float, y: float) -> Tried:
    """Angle w W/c against cells per diameter; the viscosity follows from both."""
    parts, radius = variants(False)[law], y / 2
    tau = relaxation_time(x * SOUND * radius / (FREQUENCY * WIDTH))
    method = Method(parts["solid_operator"], parts["weighting"], parts["operator"])
    with np.errstate(over="ignore", invalid="ignore"):
        found = oscillation(FREQUENCY, radius=radius, width=WIDTH, relaxation_time=tau, method=method).imag
    ratio = found / oscillation_in_a_box(FREQUENCY, WIDTH).imag
    numbers = {"relaxation time": tau, "acoustic wavelengths": x / (2 * math.pi), "damping over the known one": ratio}
    return Tried(True, abs(ratio - 1), numbers) if math.isfinite(ratio) else Tried(False, None)
