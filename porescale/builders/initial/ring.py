"""The ring of a scene as the lattice has it."""

from porescale.coupling.coverage.ring import Ring as LatticeRing
from porescale.lbm.scales import Scales
from porescale.scene.bodies.ring import Ring


def on_the_lattice(section: Ring, scales: Scales) -> LatticeRing:
    """The ring in cells and steps."""
    h = scales.spacing
    return LatticeRing((section.x / h, section.y / h), 0.5 * section.diameter / h, spin=section.spin * scales.step)
