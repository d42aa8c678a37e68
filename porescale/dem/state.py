"""State of a system of grains: arrays and settings, without what steps it (step.py, grains.py) or measures it.

Kernels write into the arrays; functions over a State stand in the files that import it.  Positions are not wrapped on
periodic sides.  SI units per metre of depth.
"""

from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from porescale.common.core.types import Floats
from porescale.common.neighbors.pair_list import PairList
from porescale.dem.arrays import DiscArrays, Pairs, Surface, Surfaces, contact_arrays
from porescale.dem.contact.budget import BUDGET
from porescale.dem.contact.law import ContactLaw, KernelLaw
from porescale.dem.contact.materials import Materials
from porescale.dem.discs import Discs
from porescale.dem.forces.bonds import BondList
from porescale.dem.forces.segment_list import SegmentList
from porescale.dem.forces.threads import ThreadChoice
from porescale.dem.forces.walls import Box, Plate
from porescale.dem.motion.drivers import Drivers
from porescale.dem.motion.periodic_cell import Still, Straining, period_of

StepNumbers = tuple[float, int, float, type]
"""Step (s), number of steps, drag (1/s) of a call, and the type of the number."""


class StaticState(NamedTuple):
    """What a system was when a full step left it as it was, see resting/static.py: copies of positions (n, 2) m, radii
    (n,) m and walls (w, WALL), since owners write into those; step (s), drag (1/s).
    """

    position: Floats
    radius: Floats
    walls: Floats
    dt: float
    drag: float


class Sleeping(Protocol):
    """What the state keeps of discs that sleep: resting/sleep.py."""

    asleep: NDArray[np.uint8]  # (n,)
    allowed: Floats  # (n,) N/m, beyond which a disc out of balance wakes
    removed: Floats  # (n,) J/m, kinetic energy taken so far

    @property
    def count(self) -> int:
        """Number of discs that sleep."""

    def step(self, grains: "State", dt: float, drag: float, count: int) -> int:
        """Up to ``count`` contact steps of the discs that are awake; returns how many are left for all."""

    def state(self) -> dict[str, Any]:
        """What decides from here on which discs sleep."""

    def restore(self, state: dict[str, Any]) -> None:
        """Overwrite it with what ``state`` returned."""


class State:
    """Discs, the laws of their contacts, and what they touch.

    discs, box, material (n,) uint8 or None where there is one;  budget (n, BUDGET) or None: of energy, see
    measures/energy.py, budget_start: its values before the first step.
    Laws: law (as given), wall_law, laws_at_walls (one for each material), laws (all in use), contact (as kernels take
    it), free_law (as steps of free discs take it, None: not computed yet), springs: springs of a contact.
    Walls: wall_names, walls (w, WALL), wall_frictions (None: that of the law), wall_laws (w, m, COLUMNS), wall_spring
    (w, n, s) m, wall_load (w, 3) N/m, N m/m of the last step, with its views wall_force (w, 2) and wall_moment (w,),
    about the walls' points.  Plates: plate_names, plates (p, 5), plate_frictions, plate_laws, plate_spring (p, n, s),
    plate_force (p, 2).  Rectangles: rectangles (k, 6) and likewise.  Springs: tangential and, with rolling resistance,
    rolling.  body_mass (n,) kg/m: of each disc's body, a clump or itself.
    Pairs: pairs, skin (m), reach (n,) m where it is more than the radii, stale: the list must be checked before the
    next step, sweeps, touching (n,): discs that touch each disc, of the last survey.
    Loads: external_force (n, 2) N/m, external_torque (n,) N m/m.  held (n, 3): not 0 where x, y, rotation of a disc is
    held;  withheld (n, 3) N/m, N/m, N m/m: force and torque that held components did not follow, mean over the last
    call of ``step``; both (0, 3) until first used.
    Parts: drivers (clumps, controls, moving walls, strain), segments, bonds, sleep; None where there is none.
    Clock: steps, last_dt (s), seconds (before the step last changed), steps_of_dt (since then).
    Last check: plate_sides (p, 3, n): right of the plate, beside it, height, valid if plates_checked.
    static: where nothing can move, see resting/static.py.  checked: what ``step`` was last given: dt (s), count,
    drag (1/s) and the type of the count; force and torque, as they were given.
    """

    law: ContactLaw | Materials
    wall_law: ContactLaw | None
    laws_at_walls: list[ContactLaw]
    laws: list[ContactLaw]
    contact: KernelLaw
    body_mass: Floats
    wall_laws: Floats
    plate_laws: Floats
    rectangle_laws: Floats
    pairs: PairList

    def __init__(
        self, discs: Discs, box: Box, plates: list[Plate], material: NDArray[np.uint8] | None, skin: float, energy: bool
    ) -> None:
        """Discs in ``box`` with ``plates``, without laws (laws.set_law) and so without a pair list."""
        count = discs.count
        self.discs, self.box, self.material, self.skin = discs, box, material, skin
        self.budget = np.zeros((count, BUDGET)) if energy else None
        self.budget_start: Floats | None = None
        self.springs = 0
        self.free_law: KernelLaw | None = None
        self.wall_names, self.walls = box.walls()
        self.wall_frictions: list[float | None] = [None] * len(self.walls)
        self.wall_spring = np.zeros((len(self.walls), count, 0))
        self.load_walls()
        self.plate_names = [plate.name for plate in plates]
        self.plates = np.array([plate.row() for plate in plates]).reshape(-1, 5)
        self.plate_frictions = [plate.friction for plate in plates]
        self.plate_spring, self.plate_force = np.zeros((len(plates), count, 0)), np.zeros((len(plates), 2))
        self.rectangle_frictions: list[float | None] = []
        self.rectangles, self.rectangle_spring = np.zeros((0, 6)), np.zeros((0, count, 0))
        self.rectangle_force = np.zeros((0, 2))
        self.sweeps, self.stale, self.touching = ThreadChoice(count), True, np.zeros(count, np.int64)
        self.reach: Floats | None = None
        self.external_force, self.external_torque = np.zeros((count, 2)), np.zeros(count)
        self.held, self.withheld = np.zeros((0, 3), np.uint8), np.zeros((0, 3))
        self.drivers: Drivers | None = None
        self.segments: SegmentList | None = None
        self.bonds: BondList | None = None
        self.sleep: Sleeping | None = None
        self.still = Still(*box.period)
        self.steps, self.last_dt, self.seconds, self.steps_of_dt = 0, 0.0, 0.0, 0
        self.plate_sides, self.plates_checked = np.zeros((len(plates), 3, count)), False
        self.static: StaticState | None = None
        self.checked: tuple[StepNumbers, Floats | None, Floats | None] = (0.0, 0, 0.0, int), None, None

    def load_walls(self) -> None:
        """Arrays for the load on as many walls as there are now."""
        self.wall_load = np.zeros((len(self.walls), 3))
        self.wall_force, self.wall_moment = self.wall_load[:, :2], self.wall_load[:, 2]

    def disc_arrays(self) -> DiscArrays:
        """The discs as kernels take them."""
        d = self.discs
        return DiscArrays(
            d.position, d.angle, d.velocity, d.spin, d.radius, d.mass, d.inertia, d.force, d.torque,
            self.external_force, self.external_torque, self.held, self.withheld, self.body_mass, self.material,
            self.budget,
        )  # fmt: skip

    def some_discs(self, discs: NDArray[Any]) -> DiscArrays:
        """Copies of some of the discs, by index, as contact kernels take them; forces zero, without energy budget."""
        d = self.discs
        own = None if self.material is None else self.material[discs]
        return contact_arrays(
            d.position[discs], d.velocity[discs], d.spin[discs], d.radius[discs], self.body_mass[discs], own
        )

    def pair_arrays(self) -> Pairs:
        """The pair list as kernels take it."""
        p = self.pairs
        return Pairs(p.start, p.partner, p.carried, p.checked_position, p.skin_margin**2)

    def surface(self, kind: str) -> Surface:
        """All surfaces of a ``kind``, "wall", "plate" or "rectangle", as kernels take them."""
        load = self.wall_load if kind == "wall" else getattr(self, f"{kind}_force")
        return getattr(self, f"{kind}s"), getattr(self, f"{kind}_laws"), getattr(self, f"{kind}_spring"), load

    def surfaces(self) -> Surfaces:
        """Walls, plates and rectangles as kernels take them."""
        return Surfaces(
            self.walls, self.wall_laws, self.wall_spring, self.wall_load, self.plates, self.plate_laws,
            self.plate_spring, self.plate_force, self.rectangles, self.rectangle_laws, self.rectangle_spring,
            self.rectangle_force,
        )  # fmt: skip

    @property
    def surface_count(self) -> int:
        """Number of walls, plates and rectangles."""
        return len(self.walls) + len(self.plates) + len(self.rectangles)

    @property
    def cell(self) -> Still | Straining:
        """The periodic cell now, as kernels over pairs take it (periodic_cell.image), strained or not."""
        return self.still if self.drivers is None else self.drivers.shape()

    @property
    def period(self) -> tuple[float, float, float]:
        """Width and height of the periodic cell now, 0 where not periodic, and its tilt, m."""
        return period_of(self.cell)

    @property
    def steered(self) -> bool:
        """Whether there is or was a clump, a control, a moving wall or a strained cell."""
        return self.drivers is not None

    @property
    def time(self) -> float:
        """Seconds done; the same bits however the steps were divided into calls."""
        return self.seconds + self.steps_of_dt * self.last_dt

    def reset_clock(self) -> None:
        """Count steps and seconds from zero again."""
        self.steps, self.seconds, self.steps_of_dt = 0, 0.0, 0

    def means(self) -> list[Floats]:
        """Views of what ``step`` leaves as means over its steps: ``withheld``, and what drivers have; see there."""
        return [self.withheld, *([] if self.drivers is None else self.drivers.means())]

    def stiffest_contact(self) -> tuple[float, float]:
        """Normal stiffness (N/m) and dashpot (N s/m) of the stiffest contact there can be.

        Where they depend on the discs they grow with both: it is that of the largest disc at a wall, as part of the
        heaviest body.
        """
        largest = float(self.body_mass.max()), float(self.discs.radius.max())
        found = [law.stiffest(*largest) for law in self.laws]
        return max(it.stiffness[0] for it in found), max(it.damping[0] for it in found)
