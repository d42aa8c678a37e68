"""``porescale show``: pictures, a film, the pile's surface and the profiles of a run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from porescale.common.pictures.look import Line, Look
    from porescale.common.record.model import Snapshot
    from porescale.common.record.open_run import Run


def show(folder: Path) -> list[Path]:
    """Write pictures, film, surface and profiles of the run in ``folder``; returns their paths."""
    from porescale.common.pictures.film import painted
    from porescale.common.pictures.picture import paint_last
    from porescale.common.record.open_run import open_run
    from porescale.output.breaks import write_breaks
    from porescale.output.grain_pictures import write_grain_pictures
    from porescale.output.lines import write_lines
    from porescale.output.rock_pictures import write_rock_picture
    from porescale.output.surface import write_surface

    run = open_run(folder)
    scene = run.card["scene"]
    look = look_of(run)
    written = painted(folder, look)
    fields = scene["output"].get("fields", ())
    written += [paint_last(folder, name, replace(look, field=name, label="")) for name in fields]
    if scene.get("grains") is not None:
        written += [write_surface(run, folder)] if "grains" in run.clouds else []
        written += write_grain_pictures(run, folder, look)
    written += [*write_breaks(run, folder), *write_rock_picture(run, folder)]
    return [*written, *write_lines(run, folder)]


def look_of(run: Run) -> Look:
    """How pictures and films show a run, of a scene or of a deck of DEMseg."""
    scene = run.card["scene"]
    if "deck" in scene:
        return _look_of_deck(run.name, scene["deck"])
    return look_of_scene(scene, run.name)


def look_of_scene(scene: dict[str, Any], name: str) -> Look:
    """The look of a scene, as on a run card."""
    from porescale.common.pictures.choose import with_section
    from porescale.common.pictures.look import Look
    from porescale.output.frame_clouds import FRAMES
    from porescale.output.frame_pictures import cracks

    fluid = scene.get("fluid")
    look = Look(
        title=title(scene, name),
        cloud="grains",
        label="speed of the fluid",
        lines=solid_lines(scene),
        walls="solid_fraction" if scene.get("rectangle") or scene.get("ring") else "",
        streamlines=fluid is not None,
        colour="velocity" if fluid is None else None,
        shapes=FRAMES,
        marks=cracks,
        view=(0.0, scene["domain"]["width"], 0.0, scene["domain"]["height"]),
        period=periods(scene),
        held=len(scene.get("disc") or ()),
        density=(fluid or {}).get("density") or 0.0,
        round_off=1e-4 if (fluid or {}).get("precision") == "float32" else 1e-12,
    )
    return with_section(look, scene.get("look"), cells=fluid is not None)


def periods(scene: dict[str, Any]) -> tuple[float, float]:
    """Width and height, m, of the box of a scene on a run card where it is periodic, else 0; 0 where it is strained."""
    from porescale.lbm.boundary.choose import boundaries

    domain = scene["domain"]
    kinds = (boundaries().get(domain.get(side, {}).get("kind")) for side in ("left", "bottom"))  # None: since gone
    x, y = (kind is not None and kind.periodic and not scene.get("cell") for kind in kinds)
    return domain["width"] * x, domain["height"] * y


def _look_of_deck(name: str, deck: dict[str, Any]) -> Look:
    """Discs and segments in the deck's box, in its own units."""
    from porescale.common.pictures.look import Look

    x1, x2, y1, y2 = (float(value) for value in deck["domain"])
    sides = [((x1, y1), (x2, y1)), ((x2, y1), (x2, y2)), ((x2, y2), (x1, y2)), ((x1, y2), (x1, y1))]
    return Look(title=name, cloud="grains", shapes="ends", colour="velocity", lines=sides, view=(x1, x2, y1, y2),
                plain=True)  # fmt: skip


def title(scene: dict[str, Any], name: str) -> str:
    """The scene's title, and lambda where grains lie in fluid: every picture carries it."""
    words = scene.get("title") or name
    ratio = (scene.get("grains") or {}).get("hydraulic_radius_ratio")
    return f"{words}, λ = {ratio:g}" if ratio else words


def gate_lines(scene: dict[str, Any]) -> Callable[[Snapshot], list[Line]]:
    """The gate as a line, at any time, from the scene on a run card."""
    gate, height = scene.get("gate"), scene["domain"]["height"]

    def lines(snapshot: Snapshot) -> list[Line]:
        """What is left of the gate."""
        if gate is None:
            return []
        since = snapshot.time - gate["opens_at"]
        if since >= 0 and gate["lift_speed"] is None and snapshot.step > 0:
            return []
        low = max(0.0, since) * (gate["lift_speed"] or 0.0)
        return [((gate["x"], low), (gate["x"], height))] if low < height else []

    return lines


def solid_lines(scene: dict[str, Any]) -> Callable[[Snapshot], list[Line]]:
    """The gate and the outlines of rectangles, at any time, from the scene on a run card."""
    from porescale.scene.bodies.rectangle import outline

    gate, size = gate_lines(scene), (scene["domain"]["width"], scene["domain"]["height"])

    def lines(snapshot: Snapshot) -> list[Line]:
        """The gate, and each rectangle where it is by then."""
        outlines = (outline(section, snapshot.time, size) for section in scene.get("rectangle") or ())
        return [*gate(snapshot), *chain.from_iterable(outlines)]

    return lines
