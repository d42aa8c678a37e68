"""[lubrication]: films between grains that are too thin for the lattice."""

from porescale.common.schema.sections import Section, quantity


class Lubrication(Section):
    """Squeeze films between grains, and at walls, that are too thin for the lattice: their normal force is added.

    The gap is that between the radii used in the fluid.
    """

    gap: float = quantity(
        "", 3.0, gt=0, le=10, help="gap in cells below which films are corrected; beyond 3 the lattice lacks nothing"
    )
