"""What is said of keys of ``[numerics]`` that change nothing in a scene: a sweep over one would show no error."""

from continuum_sph.scene.numerics import NumericsSection
from continuum_sph.scene.sections import Scene
from porescale.common.api.report import Report

OF_WATER = (
    "artificial_viscosity", "artificial_viscosity_2", "softening", "density_diffusion", "diffusion_of", "noise_floor",
    "density_filter", "gradient", "shifting", "smoothing_length", "xsph",
)  # fmt: skip
"""Keys of particles of water alone; those of soil are in ``[soil.numerics]``."""
IN_THE_OPEN = ("diffusion_of", "gradient")
"""Keys that water has alone, and not with soil (`parts.pore_water.pore_law`)."""


def warn_without_effect(scene: Scene, out: Report) -> None:
    """Warn of keys, given and not their defaults, that change nothing: of water where there are no particles of it, and
    of those that are chosen for water among grains."""
    assert scene.soil is not None
    wet = scene.has_water and scene.soil.suction is None
    why = "gradients and noise of water beside soil are chosen for it" if wet else "there are no particles of water"
    for key in IN_THE_OPEN if wet else OF_WATER:
        value = getattr(scene.numerics, key)
        if value != NumericsSection.model_fields[key].default:
            beside = ": soil.numerics.gradient is that of the soil" if key == "gradient" and not scene.soil.held else ""
            out.warn(f"numerics.{key} = {value} has no effect: {why}; take it out{beside}")
