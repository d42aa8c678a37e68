"""What damps zig-zags of velocity and levels stress: one law, from gravity and the ground's own height and stiffness.

Rate-independent soil under its weight knows no scale but its height H, gravity g and its stiffness E, so whatever keeps
its particles in step has to be made of these, or run-outs over H would depend on the size of the model, on how stiff
soil is for the sake of long steps, or on the spacing:

    α c h = H √(g H),     χ = LEVELLING E/(ρ g H)

The first is the viscosity (m²/s) that takes zig-zags of velocity (`momentum`): the same at any stiffness and spacing.
What gradients contain is not damped, so on motion that particles resolve it acts as (h/L)², L its length.  The second:
particles that slide past each other strain unevenly, and their stress is uneven by E times that.  Diffusion takes it
away within a shear strain that goes as 1/χ, so what is left goes as E/χ.  It bears load, as yielding keeps what is over
the mean and cuts off what would pull: with one χ for all, soil would stand the longer the stiffer it is.

LEVELLING keeps the course of a levee's failure alike from E 0.5 to 2 MPa (`continuum.levee_stiffness`); with H √(g H)
rods that are let go stop where those of an experiment did (`cases/soil_column_collapse`).  Neither is a property of a
material.
"""

import math

from continuum_sph.soil.material import Material

LEVELLING = 6.4
"""χ over E/(ρ g H)."""
MOST = 1000.0  # χ at most: a step follows a shear strain of 1/7χ
WEIGHTLESS = 0.2, 100.0  # α and χ where nothing weighs; α of damping that is bounded or as eq. 36, too


def steadied(material: Material, gravity: float, height: float, length: float) -> tuple[float, float]:
    """(α of the damping, χ of the diffusion) of ground of ``height`` (m) under ``gravity`` (m/s²);  length: h, m.

    E and the speed of sound c are those under the mean stress at its foot.
    """
    if not gravity * height > 0.0:
        return WEIGHTLESS
    weight = material.density * gravity * height
    softer = material.stiffness_at(0.5 * weight * (1.0 + material.rest)) / material.stiffness
    sound = math.sqrt(material.column_modulus * softer / material.density)
    damping = height * math.sqrt(gravity * height) / (sound * length)
    return damping, min(MOST, LEVELLING * material.stiffness * softer / weight)
