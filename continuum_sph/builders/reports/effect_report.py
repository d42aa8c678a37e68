"""What is said of keys that change nothing in a scene: a sweep over one would show no error."""

from continuum_sph.builders.parts.inclusion import inclusion_fluid
from continuum_sph.builders.parts.water import water_state
from continuum_sph.scene.inclusion import InclusionSection
from continuum_sph.scene.numerics import NumericsSection
from continuum_sph.scene.sections import Scene
from continuum_sph.scene.soil import SoilSection
from continuum_sph.scene.tank import TankSection
from continuum_sph.scene.water import WaterSection
from porescale.common.api.report import Report

OF_WATER = (
    "artificial_viscosity", "artificial_viscosity_2", "softening", "density_diffusion", "diffusion_of", "noise_floor",
    "density_filter", "gradient", "shifting", "smoothing_length", "xsph",
)  # fmt: skip
"""Keys of particles of water alone; those of soil are in ``[soil.numerics]``."""
IN_THE_OPEN = ("diffusion_of", "gradient")
"""Keys that water has alone, and not with soil (`parts.pore_water.pore_law`)."""

OF_LIQUID = ("viscosity", "exponent", "pressure")
"""Keys of water that its particles alone have: density and speed of sound are also those of pores under suction."""
OF_TANK = ("walls", "wall_particles")
"""Keys of the tank that water has alone; those of soil are soil.floor and soil.sides."""
OF_STATE = ("sound_speed", "pressure", "exponent")
"""Keys of the second fluid that its equation of state may leave alone."""


def warn_without_effect(scene: Scene, out: Report) -> None:
    """Warn of keys, given and not their defaults, that change nothing."""
    if scene.soil is not None:
        _warn_beside_soil(scene, scene.soil, out)
    if scene.inclusion is not None:
        _warn_of_state(scene, scene.inclusion, out)


def _warn_of_state(scene: Scene, section: InclusionSection, out: Report) -> None:
    """Warn of keys of a second fluid without which its equation of state is the same."""
    water = water_state(scene)
    numbers = inclusion_fluid(section, water).state.numbers
    for key in OF_STATE:
        value, default = getattr(section, key), InclusionSection.model_fields[key].default
        without = inclusion_fluid(section.model_copy(update={key: default}), water)
        if value != default and without.state.numbers == numbers:
            out.warn(f'inclusion.{key} = {value} has no effect: inclusion.law = "{section.law}" has none; take it out')


def _warn_beside_soil(scene: Scene, soil: SoilSection, out: Report) -> None:
    """Warn of keys of water where there are no particles of it, of those that are chosen for water among grains, and of
    one that a material file alone has."""
    wet = scene.has_water and soil.suction is None
    why = "gradients and noise of water beside soil are chosen for it" if wet else "there are no particles of water"
    for key in IN_THE_OPEN if wet else OF_WATER:
        value = getattr(scene.numerics, key)
        if value != NumericsSection.model_fields[key].default:
            beside = ": soil.numerics.gradient is that of the soil" if key == "gradient" and not soil.held else ""
            out.warn(f"numerics.{key} = {value} has no effect: {why}; take it out{beside}")
    for key in () if wet else OF_LIQUID:
        value = getattr(scene.water, key)
        if value != WaterSection.model_fields[key].default:
            out.warn(f"water.{key} = {value} has no effect: {why}; take it out")
    for key in () if wet else OF_TANK:
        value = getattr(scene.tank, key)
        if value != TankSection.model_fields[key].default:
            out.warn(f"tank.{key} = {value} has no effect: {why}; take it out: the soil has soil.floor and soil.sides")
    if soil.held and soil.rest is not None:
        out.warn(f"soil.rest = {soil.rest:g} has no effect: soil.held has no stress; take it out")
    if soil.strength != SoilSection.model_fields["strength"].default and soil.origin is None:
        out.warn(f"soil.strength = {soil.strength} has no effect: there is no soil.material to have it; take it out")
