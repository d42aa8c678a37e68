"""How scenes of a continuum are shown: where fluids and soil are, how fast water is, how far soil has come."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from porescale.common.pictures.look import Line, Look
    from porescale.common.record.model import Snapshot

LAYERS = {0: ("water", "#5b8fd0"), 1: ("dry soil", "#d9bd82"), 2: ("wet soil", "#8a6d3b")}
"""Names and colours of water and soil."""
PHREATIC = "phreatic", "#c0182b"
"""Name and colour of the surface of the water in soil, which is no particle's layer."""
AIR = {3: ("air", "#e2e2e2")}
"""And of air in it."""
GROUND = ("water", "#5b8fd0"), ("soil", "#d9bd82")
"""Of particles that are all of one kind."""
TWO = {0: ("water", "#5b8fd0"), 1: ("second fluid", "#e8a33d")}
"""Names and colours of two fluids."""


def is_dry(scene: Mapping[str, Any]) -> bool:
    """Whether a scene with soil, as on a run card, is without particles of water: dry, or with suction."""
    soil, water = scene["soil"], scene["water"]["column"] or scene.get("reservoir") or scene.get("face")
    return bool(soil.get("suction")) or not (water or soil.get("saturated") or soil.get("water_table"))


def look_of_scene(
    scene: Mapping[str, Any], name: str, surface: Callable[[Snapshot], Sequence[Line]] | None = None
) -> Look:
    """The look of a scene, as on a run card.  surface : of the water in soil, where it is known."""
    from continuum_sph.scene.look import MARGIN
    from continuum_sph.scene.pile import SheetPileSection  # pydantic takes longer to import than a page to be asked for
    from porescale.common.pictures.choose import with_section
    from porescale.common.pictures.look import MARKED, Look

    width, height = scene["tank"]["width"], scene["tank"]["height"]
    corners = [(0.0, height), (0.0, 0.0), (width, 0.0), (width, height)]
    if scene["tank"]["lid"]:
        corners.append(corners[0])
    lines = list(pairwise(corners))
    if pile := scene.get("pile"):
        at = SheetPileSection.model_validate(pile).column(scene["numerics"]["spacing"])
        lines.append(((at, pile["tip"]), (at, height)))
    margin = MARGIN * width
    more: dict[str, Any] = {"colour": "velocity"}
    if scene["soil"] and scene["soil"].get("suction"):
        more = {"colour": "saturation"}
    elif scene["soil"] and is_dry(scene):
        more = {"colour": "displacement"}
    elif scene.get("face") and scene["soil"]["held"]:
        more = {"colour": "head"}
    elif scene["soil"]:
        kinds = LAYERS | (AIR if scene.get("air") else {}) | ({MARKED: PHREATIC} if surface else {})
        more = {"colour": "layer", "kinds": kinds, "marks": surface}
    elif scene["inclusion"]:
        more = {"colour": "fluid", "kinds": TWO}
    look = Look(
        title=scene["title"] or name,
        cloud="particles",
        lines=lines,
        dot=0.5 * scene["numerics"]["spacing"],
        view=(-margin, width + margin, -margin, height + margin),
        box=(0.0, width, 0.0, height),
        density=scene["water"]["density"],
        **more,
    )
    return with_section(look, scene.get("look"), cells=False)
