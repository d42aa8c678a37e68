"""Clumps, controlled bodies, driven walls and a strained cell, as data: what a system has beside free discs."""

from typing import Any, NamedTuple

import numpy as np

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.common.neighbors.pair_list import PairList
from porescale.dem.bodies.clumps import Clumps
from porescale.dem.discs import Discs, overwrite
from porescale.dem.motion import affine_strain as cells
from porescale.dem.motion.control import KINDS, PUSH, SUPPLY, WORK, Control, schedule_of
from porescale.dem.motion.periodic_cell import LOAD, Still, Straining
from porescale.dem.motion.rigid_and_driven import FIRST_CONTROL, DriverArrays
from porescale.dem.motion.time_function import Schedule, schedule_rows


class Clump(NamedTuple):
    """A clump by its number, where a body is named; a plain number names a disc."""

    number: int


class LoadRecord(NamedTuple):
    """One line of the force-displacement record: of a body, since its recording began."""

    time: float  # s
    body: int | Clump
    displacement: tuple[float, float, float]  # m, m, rad
    contact: tuple[float, float, float]  # N/m, N/m, N m/m, of contacts on the body, mean over the last call of step
    supply: tuple[float, float, float]  # what its controls gave, likewise; 0 where there is none


class Drivers:
    """What a system of ``discs`` has beside free discs, with the arrays that kernels read.  steering.py sets it up.

    clumps: none at first;  cell (STATE,) or None: of a strained cell, see affine_strain.py;  load (LOAD,): of it;
    arrays: see rigid_and_driven.DriverArrays;  period: of the box, m.
    """

    def __init__(self, discs: Discs, period: tuple[float, float]) -> None:
        self._discs, self._period = discs, period
        self.clumps = Clumps(discs, [], 1.0)
        self._controls: list[tuple[int, int, int, Control]] = []
        self._given = np.zeros((0, 2))
        self._watched: list[int | Clump] = []
        self._watched_load, self._watched_from = np.zeros((0, 3)), np.zeros((0, 3))
        self._drives: list[tuple[int, int, int, int, Schedule]] = []
        self._servo = np.zeros((0, 6))
        self._clock = np.zeros(2)
        self._rates: list[Schedule] = [0.0, 0.0, 0.0]
        self._plan = np.zeros((3, 5))
        self.cell: Floats | None = None
        self.load = np.zeros(LOAD)
        self._compile()

    def work(self) -> tuple[float, float]:
        """Work of controls so far, J/m: (by displacement, by force); that of a control that was replaced is dropped."""
        pushes = np.array([KINDS[type(row[3])] == PUSH for row in self._controls], bool)
        return float(self._given[~pushes, WORK].sum()), float(self._given[pushes, WORK].sum())

    def means(self) -> list[Floats]:
        """Views of the means over the steps of the last call: loads of watched bodies, and what controls gave."""
        return [self._watched_load, self._given[:, SUPPLY]]

    def watch(self, *bodies: int | Clump) -> None:
        """Keep the record of these bodies and no others; displacements count from now."""
        located = [self._locate(body) for body in bodies]
        self._watched = list(bodies)
        self._watched_load = np.zeros((len(bodies), 3))
        self._watched_from = np.array([self._place(*each) for each in located]).reshape(-1, 3)
        self._compile()

    def _locate(self, body: int | Clump) -> tuple[int, int]:
        clump, index = (1, body.number) if isinstance(body, Clump) else (0, int(body))
        count, name = (self.clumps.count, "clump") if clump else (self._discs.count, "disc")
        if not 0 <= index < count:
            raise InputError(Fault(name, index, f"no such {name}", allowed=f"0 to {count - 1}"))
        if not clump and self.clumps.group[index] >= 0:
            owner = int(self.clumps.group[index])
            raise InputError(Fault("disc", index, f"belongs to clump {owner}", repair="name the clump"))
        return clump, index

    def _place(self, clump: int, index: int) -> Floats:
        body: Any = self.clumps if clump else self._discs
        return np.array([*body.position[index], body.angle[index]])

    def edges(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Edges of the cell now, m: (width, 0) and (tilt, height)."""
        if self.cell is None:
            width, height = self._period
            return (width, 0.0), (0.0, height)
        c = self.cell
        return (float(c[cells.WIDTH]), 0.0), (float(c[cells.TILT]), float(c[cells.HEIGHT]))

    def shape(self) -> Still | Straining:
        """The cell at this moment, see ``Grains.cell``."""
        if self.cell is None:
            return Still(*self._period)
        width, height, tilt, gxx, gxy, gyy = (float(value) for value in self.cell[: cells.GYY + 1])
        return Straining(width, height, tilt, gxx, gxy, gyy, np.zeros(LOAD))

    def gradient(self) -> Floats:
        """Velocity gradient of the cell, (2, 2) 1/s."""
        if self.cell is None:
            return np.zeros((2, 2))
        c = self.cell
        return np.array([[c[cells.GXX], c[cells.GXY]], [0.0, c[cells.GYY]]])

    def shear(self) -> float:
        """Shear of the cell since it began to be strained: the integral of its rate."""
        return 0.0 if self.cell is None else float(self.cell[cells.SHEAR])

    def _compile(self) -> None:
        """Overwrite the arrays of controls and time functions that kernels read."""
        kinds = [KINDS[type(row[3])] for row in self._controls]
        control = [(*row[:3], kind) for row, kind in zip(self._controls, kinds, strict=True)]
        given = [*self._rates, *(schedule_of(row[3]) for row in self._controls), *(row[4] for row in self._drives)]
        assert len(self._rates) == FIRST_CONTROL
        schedules, points = schedule_rows(given)
        watched = [self._locate(body) for body in self._watched]
        self.arrays = DriverArrays(
            self._clock, schedules, points, self.clumps.arrays(), np.array(control, np.int64).reshape(-1, 4),
            self._given, np.array(watched, np.int64).reshape(-1, 2), self._watched_load,
            np.array([row[:4] for row in self._drives], np.int64).reshape(-1, 4), self._servo,
        )  # fmt: skip

    def now(self) -> Still | cells.Deforming:
        """The cell as kernels take it."""
        if self.cell is None:
            return Still(*self._period)
        a = self.arrays
        return cells.Deforming(self.cell, self.load, self._plan, a.schedules, a.points, self._clock)

    def start(self, seconds: float, steps: int) -> None:
        """Set the clock for a call: seconds before the step last changed, and steps since."""
        self._clock[0], self._clock[1] = seconds, steps

    def listed(self, pairs: PairList, reach: Floats) -> None:
        """Count the strain from now on, and set the cell of ``pairs``, which are about to be listed with ``reach``
        (n,) m."""
        if self.cell is None:
            return
        c = self.cell
        pairs.set_cell(float(c[cells.WIDTH]), float(c[cells.HEIGHT]), float(c[cells.TILT]))
        c[cells.WIDTH_THEN : cells.TILT_THEN + 1] = c[cells.WIDTH : cells.TILT + 1]
        c[cells.REACH] = float(reach.max(initial=0.0))
        c[cells.SKIN] = pairs.skin

    def state(self, walls: Floats) -> dict[str, Any]:
        """Copies of what changes with time, ``walls`` (w, WALL) included, in flat names."""
        parts = {f"clumps.{name}": part for name, part in self.clumps.state().items()}
        return {
            **parts,
            "given": self._given.copy(),
            "watched_load": self._watched_load.copy(),
            "watched_from": self._watched_from.copy(),
            "walls": walls.copy(),
            "servo": self._servo.copy(),
            "load": self.load.copy(),
            **({} if self.cell is None else {"cell": self.cell.copy()}),
        }

    def restore(self, state: dict[str, Any], walls: Floats, pairs: PairList) -> None:
        """Overwrite what changes, ``walls`` and the cell of ``pairs`` included, with ``state()`` of the same set-up;
        raises InputError where it was another."""
        self.clumps.restore({name[7:]: part for name, part in state.items() if name.startswith("clumps.")})
        own = {"given": self._given, "watched_load": self._watched_load, "watched_from": self._watched_from,
               "walls": walls, "servo": self._servo, "load": self.load}  # fmt: skip
        if (self.cell is None) != ("cell" not in state):
            raise InputError(Fault("state.steering.cell", "cell" in state, "strained in one, not in the other"))
        if self.cell is not None:
            own["cell"] = self.cell
        overwrite(own, state, "state.steering")
        if self.cell is not None:
            c = self.cell
            pairs.set_cell(*(float(c[k]) for k in range(cells.WIDTH_THEN, cells.TILT_THEN + 1)))
