"""The section of the particles and of what corrects them."""

from typing import Literal

import pydantic

from porescale.common.schema.sections import Section, quantity


class NumericsSection(Section):
    """Particles and what corrects them.  Maeda & Sakai 2004: kernel cubic, smoothing_ratio 1, smoothing_length evolved,
    density_filter (eq. 27), xsph, and neither density diffusion nor shifting nor corrected gradients.  Their plain ones
    are 1.3 % too steep on a lattice; here all are multiplied by what makes them exact there.

    diffusion_of : what the density diffusion takes for noise, the departure from "hydrostatic" density, from a "linear"
    field, or every difference ("plain");  noise_floor : over the pressure under the deepest water; noise below it
    diffuses the more slowly the weaker it is, with 0 all of it at the speed of sound, and water at rest creeps;
    density_filter : steps between filters, 0 never.
    smoothing_ratio : of water among grains at least 1.05/√n where pores start empty, to reach the next row there.
    xsph moves particles with the smoothed velocity but continuity with their own: volume is lost where they differ.
    """

    spacing: float = quantity("m", ge=1e-6, le=1e3, help="spacing of the particles at the start")
    kernel: Literal["wendland", "cubic"] = pydantic.Field(default="wendland", description="smoothing kernel")
    smoothing_ratio: float = quantity("", 1.375, ge=1, le=3, help="smoothing length over spacing")
    artificial_viscosity: float = quantity("", 0.02, ge=0, le=10, help="alpha of eq. 36")
    artificial_viscosity_2: float = quantity("", 0.0, ge=0, le=10, help="beta of eq. 36")
    softening: float = quantity("", 0.1, ge=1e-6, le=10, help="epsilon of eq. 36")
    density_diffusion: float = quantity("", 0.1, ge=0, le=0.2, help="delta of the density diffusion")
    diffusion_of: Literal["hydrostatic", "linear", "plain"] = pydantic.Field(
        default="hydrostatic", description="what the diffusion of density takes for noise"
    )
    noise_floor: float = quantity("", 1e-3, ge=0, le=1, help="noise over the water's weight; below it diffuses slowly")
    density_filter: int = pydantic.Field(0, ge=0, le=1_000_000, description="steps between density filters (eq. 27)")
    gradient: Literal["plain", "corrected"] = pydantic.Field(default="plain", description="gradients of the kernel")
    shifting: float = quantity("", 0.0, ge=0, le=4, help="strength of particle shifting, about 1")
    smoothing_length: Literal["fixed", "evolved"] = pydantic.Field(
        default="fixed", description="whether h follows the density"
    )
    xsph: float = quantity("", 0.0, ge=0, le=1, help="epsilon of eq. 53")
    tension: Literal["cut", "kept"] | None = pydantic.Field(
        default=None,
        description="negative pressures: kept, or cut to zero; left out cut with soil without air",
    )
    courant: float = quantity("", 0.25, ge=1e-3, le=0.5, help="share of the acoustic step of eq. 49")
    skin: float = quantity("", 0.25, ge=1e-3, le=2, help="largest skin of the pair lists over h; less where it pays")
