"""A system of grains: discs, their law, walls and plates around them, and the list of pairs, stepped together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.common.neighbors.pair_list import PairList
from porescale.dem import checkpoint as resume
from porescale.dem.bodies.rigid import masses
from porescale.dem.contact.law import BOOK, COLUMNS, KernelLaw, memory_of
from porescale.dem.contact.materials import Law, Materials
from porescale.dem.discs import Discs
from porescale.dem.forces.bonds import BondList, beside
from porescale.dem.forces.rectangle import Rectangle
from porescale.dem.forces.threads import Sweeps
from porescale.dem.forces.walls import HIGH, LOW, PRESENT, VELOCITY, Box, Plate, X
from porescale.dem.motion.affine_strain import Deforming
from porescale.dem.motion.drivers import Steering
from porescale.dem.motion.periodic_cell import Still, Straining, period_of
from porescale.dem.motion.rigid_and_driven import Arrays
from porescale.dem.resting.frictionless import law_of_steps, turning
from porescale.dem.resting.static import Standing, leave_out, what_stands
from porescale.dem.sanity import Health
from porescale.dem.step import contact_steps, stable_step

if TYPE_CHECKING:
    from porescale.dem.forces.segment_list import SegmentList
    from porescale.dem.resting.sleep import Sleep

Array = NDArray[np.float64]

SKIN = 0.5  # of the mean radius: measured 12 % faster than 0.3 in a dry collapse, 2 % slower in a pile at rest


class Grains:
    """Discs under ``law`` in ``box`` with ``plates``.

    law : between discs, or Materials;  wall_law : at sides and plates (default: ``law``, or what the material of the
    walls says); a plate may have its own friction.  material : (n,) numbers of the discs' materials (default: 0).
    energy : keep the energy book, see energy.py.  skin : m, of the pair list (default 0.5 mean radii).

    Positions are not wrapped on periodic sides.  The first step starts from velocities half a step back;
    for a start from rest that is the same.  ``steps`` and ``time`` count contact steps and seconds.
    Arrays: wall_force (w, 2), plate_force (p, 2) N/m of the last step, wall_moment (w,) N m/m about the walls' points,
    wall_spring (w, n, s), plate_spring (p, n, s) m, the springs: tangential and, with rolling resistance, rolling;
    rectangles (m, 6): see rectangle.py and ``set_rectangles``, with rectangle_force (m, 2), rectangle_spring (m, n, s);
    held (n, 3): not 0 where x, y, rotation of a disc is held, see ``hold``;  withheld (n, 3) N/m, N/m, N m/m: force
    and torque that held components did not follow, mean over the last call of ``step``;  both (0, 3) till first used.
    """

    def __init__(
        self,
        discs: Discs,
        law: Law | Materials,
        box: Box,
        *,
        wall_law: Law | None = None,
        plates: Sequence[Plate] = (),
        skin: float | None = None,
        material: ArrayLike | None = None,
        energy: bool = False,
    ) -> None:
        count = discs.count
        self.discs, self.box = discs, box
        self.book = np.zeros((count, BOOK)) if energy else None
        self._sweeps = Sweeps(count)
        self.book_start: Array | None = None  # what energy.open_book says before the first step
        self._steering: Steering | None = None
        self.material = self._numbers(law, material)
        self._memory = 0  # springs per contact, none yet
        mean_radius = float(discs.radius.mean()) if count else 1.0
        self._skin = SKIN * mean_radius if skin is None else skin
        self.wall_names, self.walls = box.walls()
        self._wall_frictions: list[float | None] = [None] * len(self.walls)
        self.plate_names = [plate.name for plate in plates]
        self.plates = np.array([plate.row() for plate in plates]).reshape(-1, 5)
        self.plate_frictions = [plate.friction for plate in plates]
        self._rectangle_frictions: list[float | None] = []
        self.rectangles, self.rectangle_spring = np.zeros((0, 6)), np.zeros((0, count, 0))
        self.rectangle_force = np.zeros((0, 2))
        self.wall_spring = np.zeros((len(self.walls), count, 0))
        self.plate_spring = np.zeros((len(self.plates), count, 0))
        self.set_law(law, wall_law)
        self._load_walls()
        self.plate_force = np.zeros((len(self.plates), 2))
        self.external_force, self.external_torque = np.zeros((count, 2)), np.zeros(count)
        self.held, self.withheld = np.zeros((0, 3), np.uint8), np.zeros((0, 3))
        self.reach: Array | None = None  # of the pair list, m, where it is more than the radii
        self.touching = np.zeros(count, np.int64)
        self.steps, self.last_count, self.last_dt = 0, 0, 0.0  # last_count: steps of the last call
        self._time, self._steps_of_dt = 0.0, 0  # seconds before dt last changed, steps since
        self._health = Health(len(self.plates), count)
        self.segments: SegmentList | None = None  # see frames.framed
        self.bonds: BondList | None = None  # see bonds.bond
        self.sleep: Sleep | None = None  # see asleep.py
        self._still = Still(*box.period)
        self.standing: Standing | None = None  # where nothing can move, see at_rest.py
        self._stale = True  # the pair list must be looked at before the next step

    def set_law(self, law: Law | Materials, wall_law: Law | None = None) -> None:
        """Use ``law`` between discs and ``wall_law`` (default: the same) at sides and plates from now on.

        One law holds between all materials.  Raises InputError when the laws are of different kinds, or know fewer
        materials than the discs have.
        """
        known = 1 if self.material is None else int(self.material.max(initial=0)) + 1
        if isinstance(law, Materials):
            if known > len(law.names):
                raise InputError(Fault("material", known - 1, "no such material", allowed=f"< {len(law.names)}"))
            at_walls = law.against(law.wall) if wall_law is None else [wall_law] * len(law.names)
            table, used = law.table(), [*law.all(), *at_walls]
        else:
            at_walls = [law if wall_law is None else wall_law] * known
            table, used = np.tile(law.row(), (known, known, 1)), [law, *at_walls]
        if len({type(each) for each in used}) > 1:
            raise InputError(Fault("contact.law", "linear and hertz", "all laws of a system must be of one kind"))
        self.law, self.laws_at_walls, self.laws = law, at_walls, used
        self.wall_law = law if wall_law is None and not isinstance(law, Materials) else wall_law
        kind = used[0].kind(self._memory > 1 or any(each.rolls for each in used))
        self.contact: KernelLaw = kind(table, self.material, masses(self), self.book)
        self._widen(memory_of(self.contact))
        self.wall_laws = self._own_laws(self._wall_frictions)
        self.plate_laws = self._own_laws(self.plate_frictions)
        self.rectangle_laws = self._own_laws(self._rectangle_frictions)

    def law_of(self, discs: NDArray[Any]) -> KernelLaw:
        """The law as kernels take it for some of the discs, by index, without an energy book."""
        law = self.contact
        own = None if law.material is None else law.material[discs]
        return type(law)(law.table, own, law.mass[discs], None)

    def _own_laws(self, frictions: Sequence[float | None]) -> Array:
        """Rows (surfaces, materials, COLUMNS) of the wall laws, with its own friction where a surface has one."""
        self._free_law: KernelLaw | None = None  # see smooth.py; not known until it is asked for
        rows = [
            [(each if own is None else each.with_friction(own)).row() for each in self.laws_at_walls]
            for own in frictions
        ]
        return np.array(rows).reshape(len(rows), len(self.laws_at_walls), COLUMNS)

    def _numbers(self, law: Law | Materials, material: ArrayLike | None) -> NDArray[np.uint8] | None:
        """The discs' materials, or None where there is but one; raises InputError at a number that is none."""
        if not isinstance(law, Materials) or len(law.names) == 1:
            return None
        given = np.broadcast_to(np.asarray(0 if material is None else material), (self.discs.count,))
        bad = np.flatnonzero((given < 0) | (given >= len(law.names)))
        if len(bad):
            raise InputError(
                Fault("material", given[bad[0]].item(), f"of grain {bad[0]}", allowed=f"0 to {len(law.names) - 1}")
            )
        return given.astype(np.uint8)

    def _widen(self, memory: int) -> None:
        """Room for ``memory`` springs per contact; what there is is kept, new ones are zero."""
        more = memory - self._memory
        if more == 0:
            return
        box = self.box
        pairs = PairList(self.discs.count, self._skin, box.lower, box.upper, box.periodic, carried=memory)
        if self._memory > 0:
            state = self.pairs.state()
            pairs.group = self.pairs.group
            pairs.restore({**state, "carried": np.pad(state["carried"], ((0, 0), (0, more)))})
        self.pairs: PairList = pairs
        self._sweeps.forget()
        self._memory = memory
        for name in ("wall_spring", "plate_spring", "rectangle_spring"):
            setattr(self, name, np.pad(getattr(self, name), ((0, 0), (0, 0), (0, more))))

    @property
    def steering(self) -> Steering:
        """Clumps, controlled bodies, moving walls and the strain of the cell: there from the first use on."""
        if self._steering is None:
            self._steering = Steering(self)
        return self._steering

    @property
    def cell(self) -> Still | Straining:
        """The periodic cell now, as kernels over pairs take it (cell.image), strained or not."""
        return self._still if self._steering is None else self._steering.shape()

    @property
    def period(self) -> tuple[float, float, float]:
        """Width and height of the periodic cell now, 0 where not periodic, and its tilt, m."""
        return period_of(self.cell)

    @property
    def steered(self) -> bool:
        """Whether ``steering`` has been used."""
        return self._steering is not None

    def add_wall(
        self, name: str, point: tuple[float, float], normal: tuple[float, float], friction: float | None = None
    ) -> None:
        """Another straight wall without end through ``point`` (m), with ``normal`` into the domain, of any length.

        friction : None: that of the sides.  Raises InputError at a name that is taken or a normal of no length.
        """
        length = math.hypot(*normal)
        if name in self.wall_names or not length > 0.0:
            problem = "is taken" if name in self.wall_names else "has a normal of no length"
            raise InputError(Fault("wall", name, problem))
        row = [*point, normal[0] / length, normal[1] / length, 0.0, 0.0, 0.0]
        self.walls = np.concatenate((self.walls, [row]))
        self.wall_names.append(name)
        self._wall_frictions.append(friction)
        self.wall_laws = self._own_laws(self._wall_frictions)
        self.wall_spring = np.pad(self.wall_spring, ((0, 1), (0, 0), (0, 0)))
        self._load_walls()

    def _load_walls(self) -> None:
        """Room for what acts on the walls."""
        self.wall_load = np.zeros((len(self.walls), 3))
        self.wall_force, self.wall_moment = self.wall_load[:, :2], self.wall_load[:, 2]

    def set_rectangles(self, rectangles: Sequence[Rectangle]) -> None:
        """Put these rectangles, and no others, into the box; without contacts so far.  InputError beside segments."""
        if self.segments is not None and rectangles:
            raise InputError(Fault("rectangles", problem="do not meet segments", repair="make them frames"))
        self._rectangle_frictions = [it.friction for it in rectangles]
        self.rectangles = np.array([it.row() for it in rectangles]).reshape(-1, 6)
        self.rectangle_laws = self._own_laws(self._rectangle_frictions)
        self.rectangle_spring = np.zeros((len(rectangles), self.discs.count, self._memory))
        self.rectangle_force = np.zeros((len(rectangles), 2))

    @property
    def time(self) -> float:
        """Seconds done; the same bits however the steps were divided into calls."""
        return self._time + self._steps_of_dt * self.last_dt

    def reset_clock(self) -> None:
        """Count steps and seconds from zero again."""
        self.steps, self._time, self._steps_of_dt = 0, 0.0, 0

    def stable_step(self, *, safety: float = 0.8, steps_per_contact: float = 10.0) -> float:
        """A safe contact step, s; see integrate.stable_step.  Clumps count as the disc that answers as fast."""
        mass = self.discs.mass
        if self._steering is not None and self._steering.clumps.count:
            mass = np.concatenate((mass[self._steering.clumps.group < 0], [self._steering.lightest(self.laws)]))
        smallest = float(mass.min()), float(self.discs.radius.min())
        return stable_step(self.laws, *smallest, safety=safety, steps_per_contact=steps_per_contact)

    def step(
        self,
        dt: float,
        external_force: Array | None = None,
        external_torque: Array | None = None,
        count: int = 1,
        drag: float = 0.0,
    ) -> None:
        """``count`` contact steps of ``dt`` (s) with the external force (n, 2) N/m and torque (n,) N m/m (None: 0).

        drag (1/s): background damping, for settling only.  Raises Unstable when the list must be rebuilt and a position
        is no number.  Arrays are allocated only by a rebuild, for a longer list, and where all discs come to rest.
        """
        for own, given in ((self.external_force, external_force), (self.external_torque, external_torque)):
            if given is not own:
                own[:] = 0.0 if given is None else given
        if self.standing and leave_out(self, self.standing, dt, count, drag):
            return
        d = self.discs
        if dt != self.last_dt:
            self._time, self._steps_of_dt, self.last_dt = self.time, 0, dt
        if self.book is not None and self.book_start is None:
            from porescale.dem.measures.energy import open_book

            self.current_pairs()
            self.book_start = open_book(self, self.book, dt)
        surfaces = len(self.walls) + len(self.plates) + len(self.rectangles)
        motion: Arrays | None = None
        cell: Still | Deforming = self._still
        if self._steering is not None:
            self._steering.start(self._time, self._steps_of_dt)
            motion, cell = self._steering.arrays, self._steering.now()
        strained = cell is not self._still
        if self._free_law is None:
            self._free_law = law_of_steps(self)
        free = motion is None and not strained and self.segments is None and self.bonds is None
        law = self._free_law if free and self._free_law is not None else self.contact
        self.last_count = count
        left = count if self.sleep is None else self.sleep.step(self, dt, drag, count)
        while left > 0:
            pairs = self.current_pairs()
            done, self._stale = contact_steps(
                left, dt, drag, d.position, d.angle if turning(self, law) else d.angle[:0],
                d.velocity, d.spin, d.radius, d.mass, d.inertia, d.force, d.torque,
                self.external_force, self.external_torque,
                pairs.start, pairs.partner, pairs.carried, pairs.mark, pairs.room**2,
                law,
                self.walls, self.wall_laws, self.wall_spring, self.wall_load,
                self.plates, self.plate_laws, self.plate_spring, self.plate_force,
                self.rectangles, self.rectangle_laws, self.rectangle_spring, self.rectangle_force,
                self.held, self.withheld, left == count,
                self._sweeps.now(pairs, surfaces, self.book is not None, strained),
                motion, cell,
                *beside(self, self._time, self._steps_of_dt),
            )  # fmt: skip
            left -= done
            self.steps += done
            self._steps_of_dt += done
            if self._steering is not None:
                self._steering.start(self._time, self._steps_of_dt)
        if len(self.held):
            self.withheld /= count
            self.standing = what_stands(self, drag)

    def hold(self, disc: int | slice | Array, x: bool = True, y: bool = True, rotation: bool = True) -> None:
        """Hold these components of the velocity of discs (index, slice or mask) from now on, and let the others go.

        A held component keeps its value until the owner writes another between steps, whatever the forces; they are in
        ``withheld``.  Contacts with other discs go on.
        """
        if self._steering is not None and np.any(self._steering.clumps.group[disc] >= 0):
            raise InputError(Fault("disc", str(disc), "belongs to a clump", repair="control the clump"))
        if not len(self.held):
            self.held, self.withheld = np.zeros((self.discs.count, 3), np.uint8), np.zeros((self.discs.count, 3))
        self.held[disc] = x, y, rotation
        self.withheld[disc] = 0.0

    def list_up_to(self, gap: float) -> None:
        """List all pairs with a gap below ``gap`` (m) from now on, not only those that touch.

        Raises InputError when the periodic box is too small for that, or the gap negative.
        """
        if not gap >= 0.0:
            raise InputError(Fault("gap", gap, "of listed pairs", "m", ">= 0"))
        self.reach = self.discs.radius + 0.5 * gap
        self._rebuild()

    def current_pairs(self) -> PairList:
        """The pair list, rebuilt first if it is due, as the next step would; fetch its arrays anew after each step."""
        if self._stale:
            self._rebuild()
        return self.pairs

    def refresh(self, anew: bool = False) -> None:
        """Bring the pair list up to date; call it after moving or resizing discs by hand.  anew: whatever it says."""
        self._health.forget()
        self._rebuild(anew)

    def hardest(self) -> tuple[float, float]:
        """Normal stiffness (N/m) and dashpot (N s/m) of the hardest contact there can be."""
        d = self.discs
        found = [law.stiffest(float(d.mass.min()), float(d.radius.min())) for law in self.laws]
        return max(law.stiffness for law in found), max(law.damping for law in found)

    def _rebuild(self, anew: bool = False) -> None:
        self._health.check_finite(self)
        reach = self.discs.radius if self.reach is None else self.reach
        if self._steering is not None and self._steering.cell is not None:
            self._steering.listed()
            anew = True  # the list judges by how far points went, not by how far beside the strain
        if anew:
            self.pairs.build(self.discs.position, reach)
        else:
            self.pairs.update(self.discs.position, reach)
        if self.segments is not None:
            self.segments.update()
        self._stale, self.standing = False, None

    def plate(self, name: str) -> int:
        """Index of the plate called ``name``; raises InputError when there is none."""
        if name not in self.plate_names:
            raise InputError(Fault("plate", name, "no such plate", allowed=", ".join(self.plate_names)))
        return self.plate_names.index(name)

    def move_plate(self, name: str, velocity: float) -> None:
        """Let the plate rise at ``velocity`` (m/s) from now on."""
        self.plates[self.plate(name), VELOCITY] = velocity

    def remove_plate(self, name: str) -> None:
        """The plate vanishes at once; its contacts are forgotten."""
        index = self.plate(name)
        self.plates[index, PRESENT] = 0.0
        self.plate_spring[index] = 0.0

    def plate_ends(self, name: str) -> tuple[float, float, float]:
        """(x, lower end, upper end) of the plate, m."""
        row = self.plates[self.plate(name)]
        return float(row[X]), float(row[LOW]), float(row[HIGH])

    def check(self) -> None:
        """Raise Unstable, naming grain, quantity and step, when the state is beyond sense; see health.py."""
        self._health.check(self)

    def state(self) -> dict[str, Any]:
        """Everything needed to go on bit for bit (law, box and the number of plates are the scene's)."""
        return resume.state_of(self)

    def restore(self, state: dict[str, Any]) -> None:
        """Go on exactly from ``state()`` of a system made alike; raises InputError when the numbers differ."""
        resume.restore(self, state)
        self._free_law = None
        self._health.forget()
