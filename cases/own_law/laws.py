"""A contact that pulls with a constant force as long as grains touch, as of Derjaguin, Muller & Toporov 1975."""

import porescale as ps


@ps.contact_law(keys={"stiffness": "N/m", "damping": "N s/m", "adhesion": "N/m"})
def sticky(overlap, closing, radius, mass, p):
    """Normal force per metre of depth, N/m: spring and dashpot, less the adhesion."""
    return p.stiffness * overlap + p.damping * closing - p.adhesion
