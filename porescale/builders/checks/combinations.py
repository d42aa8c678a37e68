"""Sections that do not go with each other, or need one another."""

from porescale.builders.checks.polygons_in_fluid import check_in_fluid
from porescale.builders.initial.contact_laws import law_class
from porescale.builders.initial.walls import moving_sides
from porescale.common.core.constants import EDGE
from porescale.common.core.errors import Fault
from porescale.common.schema.names import name_faults, names_of
from porescale.dem.prepare.rock import BEYOND, lines
from porescale.scene.bodies.rock import Rock
from porescale.scene.domain import SIDES
from porescale.scene.packing import Packing
from porescale.scene.scene import Scene

DEEPEST = 1.0
"""Of the gap, that sides of a rock's polygons may overlap from the start: cells and triangles run with as much, and at
twice as much are torn within twenty steps."""


def check_cell(scene: Scene) -> list[Fault]:
    """What cannot be beside a strained cell."""
    if scene.cell is None:
        return []
    faults = []
    if scene.fluid or scene.grains is None:
        repair = "leave [fluid] or it out" if scene.fluid else "add [grains] or leave it out"
        faults.append(Fault("cell", None, "is for dry grains", repair=repair))
    if not all(scene.domain.periodic):
        problem = "only a box that is periodic both ways can be strained"
        faults.append(Fault("cell", None, problem, repair='make all sides of [domain] "periodic"'))
    beside = {
        "disc": scene.disc, "rectangle": scene.rectangle, "wall": scene.wall, "gate": scene.gate,
        "output.forces": scene.output.forces,
    }  # fmt: skip
    if scene.output.energy and any(scene.gravity):
        problem, repair = (
            "in a strained cell energy has no potential of weight",
            "set it to [0, 0], or leave energy out",
        )
        faults.append(
            Fault("gravity", f"[{scene.gravity[0]:g}, {scene.gravity[1]:g}]", problem, "m/s^2", repair=repair)
        )
    faults += [Fault(name, None, "does not go with a strained cell", repair="leave it or [cell] out")
               for name, given in beside.items() if given]  # fmt: skip
    return faults


def check_bonds(scene: Scene) -> list[Fault]:
    """Faults of sections that do not go together with [[bonds]]."""
    if not scene.bonds:
        return []
    beside_them = {"fluid": scene.fluid, "cell": scene.cell}
    faults = [Fault("bonds", None, f"are for dry grains, not for [{name}]" if name == "fluid" else f"and [{name}] "
                    "do not go together", repair="leave one of them out")
              for name, given in beside_them.items() if given]  # fmt: skip
    if scene.grains is None:
        faults.append(Fault("bonds", None, "there are no grains", repair="add [grains] or leave it out"))
    for k, it in enumerate(scene.bonds):
        if it.at >= scene.time.end:
            faults.append(Fault(f"bonds[{k}].at", it.at, "is past the end", "s", f"< {scene.time.end:g}"))
    return faults


def check_rock(scene: Scene) -> list[Fault]:
    """Faults of a [rock] whose required sections or keys are missing."""
    if scene.rock is None:
        return []
    faults, packing = [], scene.grains.packing if scene.grains else None
    if packing is None or packing.pressure is None:
        repair = "add [grains.packing] with pressure, or pressure to it"
        faults.append(Fault("rock", None, "is made of a packing that was pressed together", repair=repair))
    if scene.contact and not law_class(scene.contact).compresses:
        faults.append(Fault("contact.law", str(scene.contact.law), "rock is bonded under the linear law", "", "linear"))
    if packing and scene.rock.gap and scene.rock.gap > 0.2 * packing.diameter:
        problem = "leaves little of polygons as large as the packing's discs"
        faults.append(Fault("rock.gap", scene.rock.gap, problem, "m", f"<= {0.2 * packing.diameter:.3g}"))
    if scene.rock.gap and (scene.rock.pressed or 0.0) > DEEPEST * scene.rock.gap:
        problem = "presses sides so deep into each other that corners come near the lines of neighbours"
        faults.append(Fault("rock.pressed", scene.rock.pressed, problem, "m", f"<= {DEEPEST * scene.rock.gap:.3g}"))
    if packing:
        faults += _room_for_rock(scene, scene.rock, packing)
    return faults


def _room_for_rock(scene: Scene, rock: Rock, packing: Packing) -> list[Fault]:
    """Faults of sides of the box that press on the sample, or that its plates would reach: it is to be free."""
    size = packing.width, packing.height
    thickness, off = lines(0.5 * packing.diameter, rock.gap, rock.pressed)
    needed = dict.fromkeys(SIDES, thickness)
    if rock.plates != "none":
        along = 0 if rock.plates == "x" else 1
        first, second = (("left", "right"), ("bottom", "top"))[along]
        across = (("bottom", "top"), ("left", "right"))[along]
        needed |= dict.fromkeys((first, second), off + thickness)
        needed |= dict.fromkeys(across, BEYOND * size[1 - along] + thickness)
        needed[second] += (rock.strain.most - rock.strain.value(0.0)) * size[along] if rock.strain else 0.0
    room = {
        "left": packing.left, "bottom": packing.bottom, "right": scene.domain.width - packing.left - packing.width,
        "top": scene.domain.height - packing.bottom - packing.height,
    }  # fmt: skip
    short = [side for side in SIDES if room[side] < needed[side] * (1.0 - EDGE)]
    if not short:
        return []
    wanted = " and ".join(f"{needed[side]:.3g} m from domain.{side}" for side in short)
    problem = "reaches the sides of the box, which would press on it: a rock stands free between its plates"
    return [Fault("rock", None, problem, repair=f"leave {wanted}: make the box larger, or the packing smaller")]


def check_sleep(scene: Scene) -> list[Fault]:
    """Faults of [sleep] in a scene: what has no grains, or more than discs and walls that stand or rise."""
    if scene.sleep is None:
        return []
    if scene.grains is None:
        return [Fault("sleep", None, "there are no grains", repair="add [grains] or leave it out")]
    if scene.gravity == (0.0, 0.0):
        return [Fault("sleep", None, "grains without weight have no share of it", repair="leave it out")]
    others = {
        "clump": scene.clump, "segment": scene.segment, "polygon": scene.polygon, "container": scene.container,
        "bonds": scene.bonds, "rock": scene.rock, "control": scene.control, "wall": scene.wall, "cell": scene.cell,
        "lubrication": scene.lubrication, "domain": moving_sides(scene.domain),
    }  # fmt: skip
    return [
        Fault("sleep", None, f"does not know [{name}]", repair="leave one of them out")
        for name, section in others.items()
        if section
    ]


def check_walls(scene: Scene) -> list[Fault]:
    """What is wrong with walls beside the rest of a scene."""
    faults = []
    moving = [
        *(f"domain.{name}" for name in moving_sides(scene.domain)),
        *(f"wall[{k}]" for k in range(len(scene.wall))),
    ]
    if moving and (scene.fluid or scene.grains is None):
        problem = "is for dry grains"
        repair = "leave [fluid] or it out" if scene.fluid else "add [grains] or leave it out"
        faults += [Fault(key, None, problem, repair=repair) for key in moving]
    for name, side in scene.domain.sides.items():
        if side.speed and not scene.fluid:
            along = f"[{side.speed:g}, 0]" if name in ("bottom", "top") else f"[0, {side.speed:g}]"
            problem, repair = "is felt by a fluid alone, and there is none", f"write velocity = {along}, for grains"
            faults.append(Fault(f"domain.{name}.speed", side.speed, problem, "m/s", repair=repair))
        if side.boundary.passes and not scene.fluid:
            problem, repair = "is for a fluid, and there is none", 'write "wall", which grains feel, or add [fluid]'
            faults.append(Fault(f"domain.{name}", side.kind, problem, repair=repair))
    columns = [*SIDES, *(["gate"] if scene.gate else []), *(f"rectangle {k}" for k in range(len(scene.rectangle)))]
    faults += [
        Fault(f"wall[{k}].name", name, "is taken", repair="give each its own")
        for k, name in enumerate(names_of(scene.wall, "wall"))
        if name in columns
    ]
    return faults


def check_names(scene: Scene) -> list[Fault]:
    """What is wrong with names of measurements, walls and containers, from which columns have theirs."""
    return [
        *name_faults("probe", scene.probe, "probe"),
        *name_faults("line", scene.line, "line"),
        *name_faults("flux", scene.flux, "section"),
        *name_faults("region", scene.region, "region"),
        *name_faults("wall", scene.wall, "wall"),
        *name_faults("container", scene.container, "container"),
    ]


def check_frame_sections(scene: Scene) -> list[Fault]:
    """What bodies of segments cannot be beside."""
    given = {"segment": scene.segment, "polygon": scene.polygon, "container": scene.container, "rock": scene.rock}
    frames = [name for name, it in given.items() if it]
    if not frames:
        return []
    first, faults = frames[0], []
    if scene.fluid:
        faults += check_in_fluid(scene, frames)
    if scene.grains is None:
        faults.append(Fault(first, None, "needs [grains], which says what is dense", repair="add [grains] and density"))
    beside = {"gate": (scene.gate, "make it a [[container]] that moves"), "cell": (scene.cell, "leave one of them out"),
              "rectangle": (scene.rectangle, "make it a [[container]]")}  # fmt: skip
    faults += [Fault(name, None, f"does not go with [[{first}]]", repair=repair)
               for name, (section, repair) in beside.items() if section]  # fmt: skip
    names = [it.name for it in scene.material]
    named = [(f"segment[{k}]", it.material) for k, it in enumerate(scene.segment)]
    named += [(f"polygon[{k}]", it.material) for k, it in enumerate(scene.polygon)]
    named += [(f"container[{k}]", it.material) for k, it in enumerate(scene.container)]
    for key, material in named:
        if material and material not in names:
            allowed = ", ".join(names) or "none: there is no [[material]]"
            faults.append(Fault(f"{key}.material", material, "no such material", "", allowed))
    return faults
