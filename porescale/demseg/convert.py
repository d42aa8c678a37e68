"""A deck as a scene: the tables of a scene.toml, and their text.

Scenes have discs, clumps, bodies of segments, materials, walls, controls and bonds; their domain begins at the origin.
Their bodies are in another order: discs, clumps, segments, polygons, so sums are added up otherwise and runs agree to
round-off, as long as it does not grow.  Scenes have no angle at the start, which is left out: nothing depends on it.
Scenes start with tangential springs at rest: of a deck that goes on from another run (jclid 1) places, speeds and bonds
are kept, and its tangential springs are left out; ``stretched`` counts the contacts that had one.  Contacts count
corners of segments once (rule "outline").
"""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from porescale.dem.bodies.frames import from_ends
from porescale.dem.grains import Grains
from porescale.dem.measures.contacts import contacts
from porescale.demseg.build import ROD
from porescale.demseg.deck import MOVED, Body, Control, Deck
from porescale.demseg.numbers import real
from porescale.demseg.tension import Row

OVERLAP = 0.1  # over diameter, the most that a scene lets grains start with
KEYS = ("x", "y", "rotation")


@dataclass(frozen=True)
class Units:
    """What the deck's numbers are in SI: length (m), density (kg/m^3); its time is in s."""

    length: float = 1.0
    density: float = 1.0


UNITS = {"plain": Units(), "cgs": Units(1e-2, 1e3), "mm-g": Units(1e-3, 1e6)}


def scene_of(
    deck: Deck, name: str, release: str, units: Units, bonds: list[Row] | None = None, rod: float | None = None
) -> dict[str, Any]:
    """The tables of the scene of a deck with bodies, see module.

    bonds : those that hold, see tension.py;  rod : width of segments that weigh, see build.py.
    """
    size, stiff = units.length, units.density * units.length**2  # of the second: stiffness and damping, per depth
    x1, x2, y1, y2 = deck.domain
    scene: dict[str, Any] = {
        "title": name,
        "gravity": [g * size for g in deck.gravity],
        "domain": {"width": (x2 - x1) * size, "height": (y2 - y1) * size},
        "time": {"end": deck.nstep * deck.dt},
        "output": {"snapshot_interval": deck.nprn1 * deck.dt, "series_interval": deck.nprn2 * deck.dt, "energy": True},
        "grains": {"density": deck.stuff[0].density * units.density, "overlap": OVERLAP},
        "contact": {**_contact(deck, 0, stiff), "release": release, "step": deck.dt},
    }
    several = len(deck.stuff) > 1
    if several:
        scene["material"] = [
            {"name": str(k + 1), "density": it.density * units.density, **_contact(deck, k, stiff)}
            for k, it in enumerate(deck.stuff)
        ]
    single = [body for body in deck.bodies if len(body.discs) == 1]
    solid = [body for body in deck.bodies if len(body.discs) > 1]
    lines = [body for body in deck.bodies if body.segments and _outline(body) is None]
    loops = [body for body in deck.bodies if body.segments and _outline(body) is not None]
    order = {"grain": single, "clump": solid, "segment": lines, "polygon": loops}
    scene["grains"]["grain"] = [_grain(body, x1, y1, size, several) for body in single]
    scene["clump"] = [_clump(body, x1, y1, size, several) for body in solid]
    width = rod if rod is not None else 2.0 * deck.thick or ROD
    scene["segment"] = [_segment(deck, body, width, size, several) for body in lines]
    scene["polygon"] = [_polygon(deck, body, size, several) for body in loops]
    if bonds:
        scene["bonds"] = {"known": _renumbered(deck, order, bonds, stiff * size)}
    given = {it.body: it for it in deck.controls}
    recorded = sorted({*given, *deck.recorded})
    scene["control"] = [_control(deck, it, order, given.get(it), size, stiff * size) for it in recorded]
    return {key: part for key, part in scene.items() if part != []}


def stretched(grains: Grains) -> int:
    """How many contacts have a tangential spring that is not at rest."""
    return int(np.count_nonzero(contacts(grains).spring))


def _contact(deck: Deck, material: int, stiff: float) -> dict[str, Any]:
    it = deck.stuff[material]
    return {
        "stiffness": it.kn * stiff,
        "damping": it.cn * stiff,
        "tangential_stiffness": it.ks * stiff,
        "tangential_damping": it.cs * stiff,
        "friction": math.tan(math.radians(it.angle)),
    }


def _own(body: Body, size: float, several: bool) -> dict[str, Any]:
    vx, vy, spin = body.velocity
    return {"velocity": [vx * size, vy * size], "spin": spin, **({"material": str(body.material)} if several else {})}


def _grain(body: Body, x1: float, y1: float, size: float, several: bool) -> dict[str, Any]:
    radius, x, y, _ = body.discs[0]
    return {"x": (x - x1) * size, "y": (y - y1) * size, "diameter": 2.0 * radius * size, **_own(body, size, several)}


def _clump(body: Body, x1: float, y1: float, size: float, several: bool) -> dict[str, Any]:
    discs = [[(x - x1) * size, (y - y1) * size, radius * size] for radius, x, y, _ in body.discs]
    return {"discs": discs, "at": [[0.0, 0.0]], **_own(body, size, several)}


def _outline(body: Body) -> list[list[float]] | None:
    """Corners of segments that go on from each other and close; None of others."""
    lines = body.segments
    turns = zip(lines, (*lines[1:], *lines[:1]), strict=True)
    closed = len(lines) > 2 and all(one[2:] == other[:2] for one, other in turns)
    return [list(line[:2]) for line in lines] if closed and not body.long else None


def _framed(deck: Deck, body: Body, size: float, several: bool) -> dict[str, Any]:
    return {"thickness": deck.thick * size, **_own(body, size, several)}


def _segment(deck: Deck, body: Body, width: float, size: float, several: bool) -> dict[str, Any]:
    x1, _, y1, _ = deck.domain
    ends = [[(a - x1) * size, (b - y1) * size, (c - x1) * size, (d - y1) * size] for a, b, c, d in body.segments]
    return {"ends": ends, "width": width * size, "long": body.long, **_framed(deck, body, size, several)}


def _polygon(deck: Deck, body: Body, size: float, several: bool) -> dict[str, Any]:
    x1, _, y1, _ = deck.domain
    corners = [[(x - x1) * size, (y - y1) * size] for x, y in _outline(body) or []]
    return {"corners": corners, **_framed(deck, body, size, several)}


def _renumbered(deck: Deck, order: dict[str, list[Body]], bonds: list[Row], force: float) -> list[list[float | int]]:
    """Bonds by the numbers that points and segments have in the scene, which has bodies in another order."""

    def places(sizes: Callable[[Body], int]) -> list[int]:
        """Number in the scene of each point, or segment, of the deck, in its order."""
        first, before = {}, 0
        for body in (body for kind in order.values() for body in kind):
            first[id(body)] = before
            before += sizes(body)
        return [first[id(body)] + k for body in deck.bodies for k in range(sizes(body))]

    def corners(body: Body) -> int:
        """How many points a body has: discs, or corners of its segments."""
        return len(body.discs) or len(from_ends(np.array(body.segments).reshape(-1, 2, 2), 1.0, 1.0).corners)

    points, segments = places(corners), places(lambda body: len(body.segments))
    return [
        [points[one], (segments if sided else points)[other], sided, back * force] for one, other, sided, back in bonds
    ]


def _control(
    deck: Deck, number: int, order: dict[str, list[Body]], control: Control | None, size: float, force: float
) -> dict[str, Any]:
    body = deck.bodies[number - 1]
    key, index = next((kind, k) for kind, among in order.items() for k, other in enumerate(among) if other is body)
    row: dict[str, Any] = {key: index, "name": f"body {number}", "record": number in deck.recorded}
    if control is None:
        return row
    for name, kind, value in zip(KEYS, control.kinds, control.values, strict=True):
        turns = name == KEYS[2]
        if kind == MOVED:
            row[name] = {"displacement": [[0.0, 0.0], [deck.nstep * deck.dt, value * (1.0 if turns else size)]]}
        elif value:
            row[name] = {"force": value * force * (size if turns else 1.0)}
    return row


def toml(tables: dict[str, Any]) -> str:
    """The text of tables, lists of tables last; raises TypeError at what scenes do not hold."""
    return "".join(_lines(tables, ""))


def _lines(table: dict[str, Any], above: str) -> list[str]:
    lines = [f"{_key(key)} = {_value(it)}\n" for key, it in table.items() if not _is_table(it, above)]
    for key, it in table.items():
        name = f"{above}.{key}" if above else key
        if isinstance(it, dict) and _is_table(it, above):
            lines += [f"\n[{name}]\n", *_lines(it, name)]
        elif isinstance(it, list) and _is_table(it, above):
            for each in it:
                lines += [f"\n[[{name}]]\n", *(f"{k} = {_value(v)}\n" for k, v in each.items())]
    return lines


def _key(name: str) -> str:
    """The key as TOML takes it: bare, or in quotes where it has a dot or a space."""
    bare = name.isascii() and name.replace("_", "").replace("-", "").isalnum()
    return name if bare else json.dumps(name, ensure_ascii=False)


def _is_table(value: Any, above: str) -> bool:
    return (isinstance(value, dict) and not above) or (
        isinstance(value, list) and any(isinstance(v, dict) for v in value)
    )


def _value(value: Any) -> str:
    if isinstance(value, bool | str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return real(value).replace("d", "e")
    if isinstance(value, list):
        return f"[{', '.join(_value(it) for it in value)}]"
    return "{ " + ", ".join(f"{key} = {_value(it)}" for key, it in value.items()) + " }"
