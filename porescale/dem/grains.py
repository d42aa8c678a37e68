"""A system of grains: discs, their law, walls and plates around them, and the list of pairs, stepped together."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.ranges import Range, numbers, require_in_range
from porescale.common.core.types import Floats
from porescale.dem import checkpoint, laws, listing, sanity, steering
from porescale.dem.bodies.bonding import framed_parts
from porescale.dem.contact.law import ContactLaw
from porescale.dem.contact.materials import Materials
from porescale.dem.discs import Discs
from porescale.dem.forces.rectangle import Rectangle
from porescale.dem.forces.walls import PRESENT, VELOCITY, Box, Plate
from porescale.dem.measures.energy import open_budget
from porescale.dem.motion.affine_strain import Deforming
from porescale.dem.motion.periodic_cell import Still
from porescale.dem.motion.rigid_and_driven import DriverArrays
from porescale.dem.resting.frictionless import law_of_steps, may_turn
from porescale.dem.resting.static import leave_out, what_stands
from porescale.dem.sanity import check_step
from porescale.dem.state import State
from porescale.dem.step import contact_steps
from porescale.dem.timestep import SAFETY, lightest, stable_step

SKIN = 0.5  # of the mean radius: measured 12 % faster than 0.3 in a dry collapse, 2 % slower in a pile at rest


class Grains(State):
    """Discs under ``law`` in ``box`` with ``plates``; their arrays: see State.

    law : between discs, or Materials;  wall_law : at sides and plates (default: ``law``, or what the material of the
    walls says); a plate may have its own friction.  material : (n,) numbers of the discs' materials (default: 0).
    energy : keep the energy budget, see measures/energy.py.  skin : m, of the pair list (default 0.5 mean radii).

    The first step starts from velocities half a step back; for a start from rest that is the same.
    """

    # Functions over a State, as methods.
    set_law = laws.set_law
    hold = steering.hold
    list_up_to = listing.list_up_to
    current_pairs = listing.current_pairs
    refresh = listing.refresh
    check = sanity.check
    state = checkpoint.state_of

    def __init__(
        self,
        discs: Discs,
        law: ContactLaw | Materials,
        box: Box,
        *,
        wall_law: ContactLaw | None = None,
        plates: Sequence[Plate] = (),
        skin: float | None = None,
        material: ArrayLike | None = None,
        energy: bool = False,
    ) -> None:
        mean_radius = float(discs.radius.mean()) if discs.count else 1.0
        numbers = laws.material_numbers(law, material, discs.count)
        super().__init__(discs, box, list(plates), numbers, SKIN * mean_radius if skin is None else skin, energy)
        self.set_law(law, wall_law)

    @property
    def steering(self) -> steering.Steering:
        """Clumps, controlled bodies, moving walls and the strain of the cell: there from the first use on."""
        return steering.steering_of(self)

    def add_wall(
        self, name: str, point: tuple[float, float], normal: tuple[float, float], friction: float | None = None
    ) -> None:
        """Another straight wall without end through ``point`` (m), with ``normal`` into the domain, of any length.

        friction : None: that of the sides.  Raises InputError at a name that is taken, a normal of no length, a point
        or normal that is no pair of numbers, and a negative friction.
        """
        x, y = numbers("wall.point", point, (2,), Range("m")).tolist()
        across, up = numbers("wall.normal", normal, (2,)).tolist()
        if friction is not None:
            require_in_range("wall", {"friction": friction}, {"friction": Range(ge=0)})
        length = math.hypot(across, up)
        if name in self.wall_names or not length > 0.0:
            problem = "is taken" if name in self.wall_names else "has a normal of no length"
            raise InputError(Fault("wall", name, problem))
        row = [x, y, across / length, up / length, 0.0, 0.0, 0.0]
        self.walls = np.concatenate((self.walls, [row]))
        self.wall_names.append(name)
        self.wall_frictions.append(friction)
        self.wall_laws = laws.surface_laws(self, self.wall_frictions)
        self.wall_spring = np.pad(self.wall_spring, ((0, 1), (0, 0), (0, 0)))
        self.load_walls()

    def set_rectangles(self, rectangles: Sequence[Rectangle]) -> None:
        """Put these rectangles, and no others, into the box; without contacts so far.  InputError beside segments."""
        if self.segments is not None and rectangles:
            raise InputError(
                Fault("rectangles", problem="cannot be in contact with segments", repair="make them frames")
            )
        self.rectangle_frictions = [it.friction for it in rectangles]
        self.rectangles = np.array([it.row() for it in rectangles]).reshape(-1, 6)
        self.rectangle_laws = laws.surface_laws(self, self.rectangle_frictions)
        self.rectangle_spring = np.zeros((len(rectangles), self.discs.count, self.springs))
        self.rectangle_force = np.zeros((len(rectangles), 2))

    def stable_step(self, *, safety: float = SAFETY, steps_per_contact: float = 10.0) -> float:
        """A safe contact step, s; see timestep.stable_step.  Clumps count as the disc of the same limit.

        Where stiffness grows with the radius, a light large disc may be faster than the smallest one: its limit goes
        with mass over radius.
        """
        mass, radius = self.discs.mass, self.discs.radius
        free = np.arange(len(mass))
        if self.drivers is not None and self.drivers.clumps.count:
            clumps = self.drivers.clumps
            free = np.flatnonzero(clumps.group < 0)
            mass = np.concatenate((mass[free], [lightest(clumps, self.discs, self.laws)]))
        fastest = [(float(mass.min()), float(radius.min()))]
        if len(free) and any(law.needs_radius for law in self.laws):
            light = free[np.argmax(radius[free] / self.discs.mass[free])]
            fastest.append((float(self.discs.mass[light]), float(radius[light])))
        return min(
            stable_step(self.laws, *each, safety=safety, steps_per_contact=steps_per_contact) for each in fastest
        )

    def step(
        self,
        dt: float,
        external_force: Floats | None = None,
        external_torque: Floats | None = None,
        count: int = 1,
        drag: float = 0.0,
    ) -> None:
        """``count`` contact steps of ``dt`` (s), none if 0, with the external force (n, 2) N/m and torque (n,) N m/m
        (None: 0).

        drag (1/s): background damping, for settling only.  Raises InputError at a step, count, drag or load that is no
        such number (of loads: when their array is first given), and Unstable when the list must be rebuilt and a
        position is no number.  Arrays are allocated only by a rebuild, for a longer list, and where all discs come to
        rest.
        """
        seen, force, torque = self.checked
        if (dt, count, drag, type(count)) != seen or external_force is not force or external_torque is not torque:
            check_step(self, (dt, count, drag, type(count)), external_force, external_torque)
        if count == 0:
            return
        for own, load in ((self.external_force, external_force), (self.external_torque, external_torque)):
            if load is None:
                own.fill(0.0)
            elif load is not own:
                own[:] = load
        if self.static and leave_out(self, self.static, dt, count, drag):
            return
        if dt != self.last_dt:
            self.seconds, self.steps_of_dt, self.last_dt = self.time, 0, dt
        if self.budget is not None and self.budget_start is None:
            self.current_pairs()
            self.budget_start = open_budget(self, self.budget, dt)
        motion: DriverArrays | None = None
        cell: Still | Deforming = self.still
        if self.drivers is not None:
            self.drivers.start(self.seconds, self.steps_of_dt)
            motion, cell = self.drivers.arrays, self.drivers.now()
        alone = cell is not self.still  # what drivers do is done by one thread
        if self.free_law is None:
            self.free_law = law_of_steps(self)
        free = motion is None and not alone and self.segments is None and self.bonds is None
        law = self.free_law if free and self.free_law is not None else self.contact
        left = count if self.sleep is None else self.sleep.step(self, dt, drag, count)
        while left > 0:
            pairs = self.current_pairs()
            d = self.disc_arrays()
            if not may_turn(self, law):
                d = d._replace(angle=d.angle[:0])
            done, self.stale = contact_steps(
                left, dt, drag, left == count, d[:], self.pair_arrays()[:], law, self.surfaces()[:],
                self.sweeps.now(pairs, self.surface_count, self.budget is not None, alone), motion, cell,
                framed_parts(self, self.seconds, self.steps_of_dt),
            )  # fmt: skip
            left -= done
            self.steps += done
            self.steps_of_dt += done
            if self.drivers is not None:
                self.drivers.start(self.seconds, self.steps_of_dt)
        for sums in self.means():
            sums /= count
        if len(self.held):
            self.static = what_stands(self, drag)

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

    def restore(self, state: dict[str, Any]) -> None:
        """Overwrite all that ``state()`` holds, bit for bit; raises InputError when numbers of parts differ."""
        if "steering" in state:
            assert self.steering  # made before its state is read
        checkpoint.restore(self, state)
