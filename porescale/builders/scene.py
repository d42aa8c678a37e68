"""`Scene` with all that its sections must not import: checks between them, names of operators, readers of files.

Scenes are read with this class; without its checks it raises an error.
"""

from porescale.builders.checks.device import check_device
from porescale.builders.checks.fluid import check_solid_options
from porescale.builders.checks.needed import check_needed, check_places
from porescale.builders.initial.circles import grains_of
from porescale.builders.initial.random_polygons import check_random_places
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.coupling.weighting.choose import WEIGHTINGS
from porescale.dem.contact.choose import LAWS
from porescale.lbm.collision.choose import OPERATORS
from porescale.scene import contact
from porescale.scene.bodies.segments import PolygonBody
from porescale.scene.circles import Circles
from porescale.scene.fluid import CHOICES, Fluid
from porescale.scene.scene import Scene

__all__ = ["Scene"]

Scene.checks += [check_needed, check_places, check_device]
Fluid.checks.append(check_solid_options)
PolygonBody.checks.append(check_random_places)
Circles.read = grains_of
contact.LAWS += LAWS
CHOICES.update(operator=OPERATORS, solid_operator=SOLID_OPERATORS, weighting=WEIGHTINGS)

Scene.__module__ = __name__  # where what reads a pickle of a scene finds it together with its checks
