"""How stiff a scene's water is: its speed of sound as given, or as its head and its soil ask for."""

from continuum_sph.builders.parts.material import material_of
from continuum_sph.scene.sections import CALM_MACH, Scene

STIFF = 10.0  # K_w/(n M): water below this is what consolidation waits for
NATURAL = 2.2e9  # K_w of water, Pa


def largest_modulus(scene: Scene) -> float:
    """Modulus (Pa) of a column of the scene's soil under the largest mean stress that its dry weight makes."""
    section = scene.soil
    assert section is not None
    material = material_of(section)
    pressure = 0.5 * material.density * scene.gravity * section.height * (1.0 + material.rest)
    return material.column_modulus * material.stiffness_at(pressure) / material.stiffness


def sound_speed(scene: Scene) -> float:
    """c0 of the water, m/s: as given; else ten times the speed of free fall from the highest water, and fast enough
    that water is ten times as stiff as n M of soil that moves, or as stiff as water is."""
    if scene.water.sound_speed is not None:
        return scene.water.sound_speed
    fast = CALM_MACH * scene.fall_speed
    if scene.soil is None or scene.soil.held:
        return fast
    stiff = min(STIFF * scene.soil.porosity * largest_modulus(scene), NATURAL)
    return float(max(fast, (stiff / scene.water.density) ** 0.5))


def noise_speed(scene: Scene) -> float:
    """Speed of sound waves whose pressure is the noise floor, m/s."""
    pressure = 0.5 * scene.numerics.noise_floor * scene.fall_speed**2  # over the density of the water
    return pressure / sound_speed(scene) if pressure > 0.0 else 0.0
