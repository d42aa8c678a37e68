"""What pictures of a scene can show: the arrays of the particles in its snapshots."""

from typing import Any

from continuum_sph.scene.bounds import WHOLE
from porescale.common.core.errors import Fault

WATER = ("velocity", "pressure", "density")
"""Arrays of water in a tank;  "fluid" besides with a second one."""
SOIL = (
    "velocity", "displacement", "mean_stress", "stress_xx", "stress_yy", "stress_xy", "stress_zz", "plastic_strain",
    "opening", "porosity",
)  # fmt: skip
"""Arrays of soil without water in its pores, or with suction."""
MOISTURE = ("saturation", "suction", "pore_pressure")
"""Arrays of soil with suction besides."""
LAYERS = ("layer", "velocity", "porosity", "pressure")
"""Arrays that soil and the water in its pores have both;  "head" besides where the soil is held and has no air."""
MARGIN = 0.02
"""Share of the width of the tank by which a picture reaches beyond its sides."""


def shown_arrays(scene: Any) -> tuple[str, ...]:
    """Names of the arrays that the snapshots of a scene hold of all their particles."""
    soil = scene.soil
    if soil is None:
        return (*WATER, "fluid") if scene.inclusion else WATER
    if soil.suction is not None:
        return SOIL + MOISTURE
    if scene.dry:
        return SOIL
    return (*LAYERS, "head") if soil.held and scene.air is None and scene.gravity > 0.0 else LAYERS


def look_faults(scene: Any) -> list[Fault]:
    """What is wrong with the section [look] of a scene: arrays that no snapshot holds, two keys for one thing, limits
    of what has no range, and a view beyond the tank."""
    look = scene.look
    if look is None:
        return []
    known, faults = shown_arrays(scene), []
    for key in ("field", "colour"):
        name = getattr(look, key)
        if name and name not in known:
            repair = "choose one of these"
            faults.append(Fault(f"look.{key}", name, "is not recorded", "", ", ".join(known), repair))
    for key, other in (("field", "colour"), ("limits", "colour_limits")):
        if getattr(look, key) and getattr(look, other):
            problem, repair = f"is of the particles, as look.{other} is: there are no cells", "take out one of them"
            faults.append(Fault(f"look.{key}", getattr(look, key), problem, repair=repair))
    limits = "limits" if look.limits else "colour_limits" if look.colour_limits else ""
    if limits and not (look.field or look.colour) and _kinds(scene):
        problem = "has no quantity: pictures show where soil, water and other fluids are"
        faults.append(Fault(f"look.{limits}", getattr(look, limits), problem, repair="add look.colour"))
    return faults + _beyond(look.view, scene)


def _kinds(scene: Any) -> bool:
    """Whether pictures of a scene without a [look] show kinds of particles, not a quantity."""
    if scene.soil is None:
        return scene.inclusion is not None
    return not (scene.dry or scene.soil.suction or (scene.face and scene.soil.held))


def _beyond(view: tuple[float, float, float, float] | None, scene: Any) -> list[Fault]:
    """The fault of a view that reaches farther out of the tank than the picture of all of it."""
    if view is None:
        return []
    width, height = scene.tank.width, scene.tank.height
    margin = MARGIN * width
    slack = margin + WHOLE * scene.numerics.spacing
    left, right, bottom, top = view
    if min(left, bottom) >= -slack and right <= width + slack and top <= height + slack:
        return []
    allowed = f"x {-margin:g} to {width + margin:g}, y {-margin:g} to {height + margin:g}"
    value = ", ".join(f"{it:g}" for it in view)
    return [Fault("look.view", value, "reaches beyond the tank", "m", allowed, "move its sides")]
