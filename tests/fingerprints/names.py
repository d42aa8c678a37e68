"""All fingerprints by name, and those that are quick to take."""

from tests.fingerprints import cases, continuum, fluids, grains
from tests.fingerprints.subjects import Subject

SUBJECTS: dict[str, Subject] = (
    fluids.subjects() | grains.subjects() | continuum.subjects() | cases.subjects()
)  # fmt: skip

QUICK: tuple[str, ...] = (
    "fluid/trt", "fluid/central, eddies", "fluid/through", "solid/exact-wall", "solid/odd-SC1, B2",
    "solid/rectangle", "contact/linear", "contact/hertz, rolling", "contact/linear, materials", "grains/settled",
    "grains/bodies", "grains/bonds", "grains/cell, pressed", "water/plain", "water/corrected, shifted",
    "inclusion/liquid, corrected", "soil/drained", "seepage/rising level", "seepage/air",
    "script/bouncing_disc", "script/biaxial_element", "script/demseg_triangle", "scene/piston",
)  # fmt: skip
