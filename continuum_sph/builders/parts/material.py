"""The material of a scene's soil."""

import math
from dataclasses import replace

from continuum_sph.scene.rate import RateSection
from continuum_sph.scene.softening import SofteningSection
from continuum_sph.scene.soil import SoilSection
from continuum_sph.soil import Material, Rate, Softening


def material_of(section: SoilSection) -> Material:
    """The material of a section."""
    phi, psi = section.friction_angle, section.dilatancy_angle
    return Material(
        stiffness=section.stiffness,
        density=section.density,
        poisson=section.poisson,
        exponent=section.exponent,
        reference=section.reference,
        least=section.least,
        modulus=section.modulus,
        sin_friction=math.sin(phi),
        cohesion_intercept=section.cohesion * math.cos(phi),
        sin_dilatancy=math.sin(psi),
        tension=section.tension,
        yields=not section.elastic,
        porosity=section.porosity,
        rate=rate_of(section.rate) if section.rate else None,
        softening=softening_of(section.softening) if section.softening else None,
    )


def rate_of(section: RateSection) -> Rate:
    """How the friction of a soil grows with the rate of shear."""
    return Rate(math.sin(section.friction_angle), section.inertial_number, section.grain_diameter)


def softening_of(section: SofteningSection) -> Softening:
    """How the strength of the soil itself falls with plastic shear strain; `banded` has that of its particles."""
    left = section.friction_angle
    return Softening(math.sin(left), section.cohesion * math.cos(left), section.shear_strain)


def banded(material: Material, section: SoilSection, width: float) -> Material:
    """A ``material`` whose bands of particles, of a ``width`` (m), soften by the slip that those of the soil do.

    Soil that softens shears in bands, which grains make some ten diameters wide (Roscoe, Géotechnique 20 (1970) 129;
    Mühlhaus & Vardoulakis, Géotechnique 37 (1987) 271) and particles `softening.band_width`: γs goes with the ratio of
    both (Pietruszczak & Mróz, Int. J. Numer. Meth. Eng. 17 (1981) 327).
    """
    if not (section.softening and material.softening):
        return material
    strain = material.softening.shear_strain * section.softening.band_width / width
    return replace(material, softening=replace(material.softening, shear_strain=strain))
