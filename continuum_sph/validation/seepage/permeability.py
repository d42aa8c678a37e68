"""Flux through held soil by the laws of permeability and porosity.  SI."""

import functools

import numpy as np

from continuum_sph.seepage import Frame, Resistance, Seepage
from continuum_sph.validation.seepage.setups import WATER, pore_flow
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.smoothing import RATIO, Smoothing
from continuum_sph.water.state import Layer
from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.neighbors import square_lattice

VALIDATIONS = Validations()


def permeated(
    permeability: float, gradient: float, *, law: str = "constant", porosity: float = 0.4, share: float = 1.0
) -> Seepage:
    """Held soil in a periodic box of 12 spacings of 1 cm, its water driven along x by a hydraulic ``gradient``.

    porosity : of the soil, whose permeability is given at 0.4;  share : of `Resistance`;  water lies at random in it.
    """
    across, spacing, given = 12, 0.01, 0.4
    side = across * spacing
    box, smoothing = ((0.0, 0.0), (side, side), (True, True)), Smoothing("wendland", RATIO * spacing)
    rng = np.random.default_rng(4)
    frame = Frame(square_lattice((0.0, 0.0), (side, side), spacing), spacing**2, porosity, permeability)
    x = (
        frame.skeleton.x + rng.uniform(0.0, 1.0, 2) * spacing + rng.uniform(-0.1, 0.1, frame.skeleton.x.shape) * spacing
    ) % side
    n = len(x)
    rules = Law(smoothing, spacing, (Fluid(Tait(WATER, 10.0)),), (gradient * GRAVITY, 0.0), diffusion=0.0, cut=False)
    layer = Layer(n, x, np.zeros((n, 2)), np.full(n, porosity * WATER * spacing**2), np.full(n, WATER))
    both = Seepage(pore_flow(layer, rules, frame.skeleton, Resistance(given, law, share=share), *box), frame)
    both.start()
    return both


def discharge(both: Seepage) -> float:
    """Mean n (v_f - v_s) along x, m/s, over the volume."""
    layer = both.water.layer
    n = layer.fluid
    volume = layer.mass[:n] / (both.water.porosity * layer.density)
    return float((volume * both.water.porosity * layer.v[:n, 0]).sum() / volume.sum())


GIVEN, CHANGED = 0.4, (0.3, 0.5)  # porosities: at which k is given, and of the soil
K, GRADIENT = 1e-3, 0.5  # m/s
DISCS = 0.64  # share of their volume that discs take up in the flow, with 0.8 of their radius


@functools.cache
def passed(law: str, porosity: float, share: float = 1.0) -> float:
    """Flux through soil of a ``porosity`` by a ``law`` of `Resistance`, over k given at another porosity and i."""
    both = permeated(K, GRADIENT, law=law, porosity=porosity, share=share)
    for _ in range(100):  # 600 of the times in which drag stops water
        both.advance()
    return discharge(both) / (K * GRADIENT)


@VALIDATIONS.row(
    "continuum.permeability_follows_porosity",
    source="Kozeny 1927, Carman 1937: k(n)/k(n0) = m³ (1 - n0)²/{m0³ (1 - n)²}, n 0.3 and 0.5, n0 0.4; m = n, and "
    "1 - 0.64 (1 - n) of discs",
    because="grains are summed over a lattice to 0.0011 of themselves, n so to 0.0011 (1 - n), and k to 3/n + "
    "2/(1 - n) times that",
    tolerance=0.0011 * 0.7 * (3.0 / 0.3 + 2.0 / 0.7),
    slow=True,
)
def kozeny_carman_row() -> Measured:
    """Flux over that of the porosity at which k is given; error over the exact one."""
    exact, found = [], []
    for share in (1.0, DISCS):
        left = 1.0 - share * (1.0 - GIVEN)
        exact += [((1.0 - share * (1.0 - n)) / left) ** 3 * ((1.0 - GIVEN) / (1.0 - n)) ** 2 for n in CHANGED]
        found += [passed("kozeny-carman", n, share) for n in CHANGED]
    return Measured.relative(exact, found)
