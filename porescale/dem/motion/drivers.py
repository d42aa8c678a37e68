"""Clumps, controlled bodies, driven walls and a strained cell: what a system of grains has beside free discs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from porescale.common.core.errors import Fault, InputError
from porescale.dem.bodies.clumps import Body, Clumps
from porescale.dem.bodies.rigid import masses
from porescale.dem.contact.materials import Law
from porescale.dem.forces.walls import TURN
from porescale.dem.motion import affine_strain as cells
from porescale.dem.motion import servo as servos
from porescale.dem.motion.control import KINDS, PUSH, WORK, Control, schedule_of
from porescale.dem.motion.periodic_cell import LOAD, Still, Straining
from porescale.dem.motion.rigid_and_driven import FIRST_CONTROL, Arrays
from porescale.dem.motion.time_function import Schedule, schedule_rows
from porescale.dem.timestep import lightest

if TYPE_CHECKING:
    from porescale.dem.grains import Grains

Array = NDArray[np.float64]

AXES = ("x", "y", "rotation")
COMPONENTS = ("xx", "yy", "xy")
SHARE = 0.5
"""Of the stability bound of a servo that is 2: monotone, see servo.py."""


class Clump(NamedTuple):
    """A clump by its number, where a body is named; a plain number names a disc."""

    number: int


class Row(NamedTuple):
    """One line of the force-displacement record: of a body, since it was watched."""

    time: float  # s
    body: int | Clump
    displacement: tuple[float, float, float]  # m, m, rad
    contact: tuple[float, float, float]  # N/m, N/m, N m/m, of contacts on the body, mean over the last call of step
    supply: tuple[float, float, float]  # what its controls gave, likewise; 0 where there is none


class Steering:
    """Everything of ``grains`` that moves as told.  Made by Grains on first use, see ``Grains.steering``.

    clumps : of the system, none at first;  cell (STATE,) or None: of a strained cell, see cell.py.
    """

    def __init__(self, grains: Grains) -> None:
        self._grains = grains
        self.clumps = Clumps(grains.discs, [], 1.0)
        self._controls: list[tuple[int, int, int, Control]] = []
        self._given = np.zeros((0, 2))
        self._watched: list[int | Clump] = []
        self._watched_load, self._watched_from = np.zeros((0, 3)), np.zeros((0, 3))
        self._drives: list[tuple[int, int, int, int, Schedule]] = []
        self._servo = np.zeros((0, 6))
        self._clock = np.zeros(2)
        self._rates: list[Schedule] = [0.0, 0.0, 0.0]
        self._plan = np.zeros((3, 5))
        self.cell: Array | None = None
        self.load = np.zeros(LOAD)
        self._compile()

    # -- clumps

    def bind(self, members: Sequence[ArrayLike], density: ArrayLike, bodies: Sequence[Body | None] = ()) -> Clumps:
        """Make clumps of discs, in place of those there were; see Clumps.  Controls and watches of clumps are dropped.

        Raises InputError as Clumps does, or when a member is held.
        """
        grains = self._grains
        if grains.segments is not None:
            raise InputError(Fault("clump", problem="frames are bound already", repair="bind all at once, in framed"))
        clumps = Clumps(grains.discs, members, density, bodies)
        held = grains.held[clumps.member].any(axis=1) if len(grains.held) else np.zeros(0, bool)
        if held.any():
            disc = int(clumps.member[held.argmax()])
            raise InputError(Fault("clump", disc, "a disc that is held", repair="control the clump instead"))
        self.clumps = clumps
        kept = [k for k, row in enumerate(self._controls) if not row[0]]
        self._controls, self._given = [self._controls[k] for k in kept], self._given[kept]
        self._watched = [body for body in self._watched if not isinstance(body, Clump)]
        self.watch(*self._watched)
        grains.contact = grains.contact._replace(mass=masses(grains))
        grains.pairs.group = clumps.group if clumps.count else None
        grains.refresh(anew=True)
        return clumps

    # -- control of bodies

    def control(
        self,
        body: int | Clump,
        x: Control | None = None,
        y: Control | None = None,
        rotation: Control | None = None,
    ) -> None:
        """Control these components of a disc or clump from now on, and let the others go (None).

        Schedules run on the system's time.  Raises InputError for a body that is not there, or a member of a clump.
        """
        clump, index = self._locate(body)
        kept = [k for k, row in enumerate(self._controls) if row[:2] != (clump, index)]
        self._controls, self._given = [self._controls[k] for k in kept], self._given[kept]
        told = [(axis, control) for axis, control in enumerate((x, y, rotation)) if control is not None]
        self._controls += [(clump, index, axis, control) for axis, control in told]
        self._given = np.concatenate((self._given, np.zeros((len(told), 2))))
        held = [control is not None and KINDS[type(control)] != PUSH for control in (x, y, rotation)]
        if clump:
            self.clumps.held[index] = held
            self.clumps.withheld[index] = 0.0
        else:
            self._grains.hold(index, *held)
        self._compile()

    def work(self) -> tuple[float, float]:
        """Work of controls so far, J/m: (by displacement, by force); that of a control that was replaced is dropped."""
        pushes = np.array([KINDS[type(row[3])] == PUSH for row in self._controls], bool)
        return float(self._given[~pushes, WORK].sum()), float(self._given[pushes, WORK].sum())

    def watch(self, *bodies: int | Clump) -> None:
        """Keep the record of these bodies and no others; displacements count from now."""
        located = [self._locate(body) for body in bodies]
        self._watched = list(bodies)
        self._watched_load = np.zeros((len(bodies), 3))
        self._watched_from = np.array([self._place(*each) for each in located]).reshape(-1, 3)
        self._compile()

    def record(self) -> list[Row]:
        """Force and displacement of every watched body now, after a call of step."""
        rows, count = [], max(self._grains.last_count, 1)
        for k, body in enumerate(self._watched):
            where = self._locate(body)
            met = self._watched_load[k] / count
            supply = np.zeros(3)
            for row, given in zip(self._controls, self._given, strict=True):
                if row[:2] == where:
                    supply[row[2]] = given[0] / count
            gone = self._place(*where) - self._watched_from[k]
            rows.append(Row(self._grains.time, body, *(tuple(part.tolist()) for part in (gone, met, supply))))
        return rows

    def _locate(self, body: int | Clump) -> tuple[int, int]:
        clump, index = (1, body.number) if isinstance(body, Clump) else (0, int(body))
        count, name = (self.clumps.count, "clump") if clump else (self._grains.discs.count, "disc")
        if not 0 <= index < count:
            raise InputError(Fault(name, index, f"no such {name}", allowed=f"0 to {count - 1}"))
        if not clump and self.clumps.group[index] >= 0:
            owner = int(self.clumps.group[index])
            raise InputError(Fault("disc", index, f"belongs to clump {owner}", repair="name the clump"))
        return clump, index

    def _place(self, clump: int, index: int) -> Array:
        body: Any = self.clumps if clump else self._grains.discs
        return np.array([*body.position[index], body.angle[index]])

    # -- walls

    def move_wall(self, name: str, x: Schedule = 0.0, y: Schedule = 0.0, turn: Schedule = 0.0) -> None:
        """Give a wall the velocity (x, y) m/s and turn it about its point (rad/s), from now on."""
        self._drive(name, [(servos.GIVEN_X, x), (servos.GIVEN_Y, y), (servos.GIVEN_TURN, turn)])

    def servo_wall(
        self,
        name: str,
        *,
        force: Schedule | None = None,
        stress: Schedule | None = None,
        speed: float,
        length: float | None = None,
        between: tuple[str, str] | None = None,
        share: float = SHARE,
    ) -> None:
        """Move a wall along its normal so that the discs press on it with ``force`` (N/m), or ``stress`` (Pa).

        The stress acts over ``length`` (m), or over the distance of the two walls that the wall lies ``between``.
        speed (m/s): the fastest it may go;  share: of the stability bound, 0 to 2, see servo.py.  Raises InputError
        when neither or both of force and stress are given, or the numbers make no sense.
        """
        if (force is None) == (stress is None):
            raise InputError(Fault(f"{name}.servo", problem="needs either force or stress"))
        if stress is not None and (length is None) == (between is None):
            raise InputError(Fault(f"{name}.servo", problem="needs either length or between for a stress"))
        if not 0.0 < share < 2.0 or not speed > 0.0:
            bad, what, allowed = (share, "share", "> 0, < 2") if speed > 0.0 else (speed, "speed", "> 0")
            raise InputError(Fault(f"{name}.servo.{what}", bad, allowed=allowed))
        low, high = (self._wall(between[0]), self._wall(between[1])) if between else (-1, -1)
        mode, wanted = (servos.BY_FORCE, force) if stress is None else (servos.BY_STRESS, stress)
        assert wanted is not None
        self._drive(name, [(mode, wanted)], low, high, [*self._grains.hardest(), share, speed, length or 0.0, 0.0])

    def _wall(self, name: str) -> int:
        names = self._grains.wall_names
        if name not in names:
            raise InputError(Fault("wall", name, "no such wall", allowed=", ".join(names)))
        return names.index(name)

    def _drive(
        self,
        name: str,
        told: Sequence[tuple[int, Schedule]],
        low: int = -1,
        high: int = -1,
        numbers: Sequence[float] = (0.0,) * 6,
    ) -> None:
        wall = self._wall(name)
        kept = [k for k, row in enumerate(self._drives) if row[0] != wall]
        self._drives, self._servo = [self._drives[k] for k in kept], self._servo[kept]
        self._grains.walls[wall, TURN - 2 :] = 0.0
        self._drives += [(wall, mode, low, high, schedule) for mode, schedule in told]
        self._servo = np.concatenate((self._servo, np.array([numbers] * len(told), float)))
        self._compile()

    # -- cell

    def strain_cell(
        self,
        xx: Schedule | None = None,
        yy: Schedule | None = None,
        xy: Schedule | None = None,
        *,
        pressure: tuple[Schedule | None, Schedule | None] = (None, None),
        shear_stress: Schedule | None = None,
        limit: float = 0.0,
        share: float = SHARE,
    ) -> None:
        """Strain the periodic cell: rates of stretching xx, yy and of shear xy = dv_x/dy (1/s), not given: 0.

        pressure (Pa, compression positive) in place of xx and yy, shear_stress (Pa, of the sign of the shear that it
        drives) in place of xy, where not None: the rate follows the stress then, no faster than ``limit`` (1/s).
        Velocities of discs are relative to the cell's from now on, and the box's sides are only where it began: see
        ``edges``.  Raises InputError when the box is not periodic both ways, or the numbers make no sense.
        """
        grains = self._grains
        if not all(grains.box.periodic):
            raise InputError(Fault("box", grains.box.left, "a cell can only be strained when all sides are periodic"))
        if grains.segments is not None or grains.bonds is not None:
            raise InputError(Fault("cell", problem="with segments or bonds a cell cannot be strained"))
        wanted = (*pressure, shear_stress)
        if any(each is not None for each in wanted) and not (limit > 0.0 and 0.0 < share < 2.0):
            bad, what, allowed = (share, "share", "> 0, < 2") if limit > 0.0 else (limit, "limit", "> 0")
            raise InputError(Fault(f"cell.{what}", bad, "of stress control", allowed=allowed))
        for k, (rate, stress) in enumerate(zip((xx, yy, xy), wanted, strict=True)):
            if rate is not None and stress is not None:
                raise InputError(Fault(f"cell.{COMPONENTS[k]}", problem="has both a rate and a stress"))
            self._rates[k] = stress if stress is not None else rate if rate is not None else 0.0
            self._plan[k] = stress is not None, share, limit, *(self._leverage() * value for value in grains.hardest())
        if self.cell is None:
            self.cell = np.zeros(cells.STATE)
            self.cell[cells.WIDTH : cells.TILT] = grains.box.period
        self._compile()
        grains.refresh(anew=True)

    def _leverage(self) -> float:
        """Square of how much further than discs that touch their bodies' centroids may be apart: a contact resists a
        strain of the cell that much more."""
        c = self.clumps
        round_ones = c.radius > 0.0
        far = np.hypot(*c.offset[round_ones].T) / c.radius[round_ones]
        return (1.0 + float(far.max(initial=0.0))) ** 2

    def edges(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Edges of the cell now, m: (width, 0) and (tilt, height)."""
        if self.cell is None:
            width, height = self._grains.box.period
            return (width, 0.0), (0.0, height)
        c = self.cell
        return (float(c[cells.WIDTH]), 0.0), (float(c[cells.TILT]), float(c[cells.HEIGHT]))

    def shape(self) -> Still | Straining:
        """The cell at this moment, see ``Grains.cell``."""
        if self.cell is None:
            return Still(*self._grains.box.period)
        width, height, tilt, gxx, gxy, gyy = (float(value) for value in self.cell[: cells.GYY + 1])
        return Straining(width, height, tilt, gxx, gxy, gyy, np.zeros(LOAD))

    def gradient(self) -> Array:
        """Velocity gradient of the cell, (2, 2) 1/s."""
        if self.cell is None:
            return np.zeros((2, 2))
        c = self.cell
        return np.array([[c[cells.GXX], c[cells.GXY]], [0.0, c[cells.GYY]]])

    def cell_pressure(self) -> Array:
        """Pressure tensor (xx, xy, yy) of the strained cell in its last step, Pa, compression positive."""
        assert self.cell is not None
        d = self._grains.discs
        area = float(self.cell[cells.WIDTH] * self.cell[cells.HEIGHT])
        return np.array(cells.pressure(d.velocity, d.mass, self.load, area))

    # -- for the system

    def _compile(self) -> None:
        """The arrays that kernels read."""
        kinds = [KINDS[type(row[3])] for row in self._controls]
        control = [(*row[:3], kind) for row, kind in zip(self._controls, kinds, strict=True)]
        told = [*self._rates, *(schedule_of(row[3]) for row in self._controls), *(row[4] for row in self._drives)]
        assert len(self._rates) == FIRST_CONTROL
        schedules, points = schedule_rows(told)
        c = self.clumps
        watched = [self._locate(body) for body in self._watched]
        self.arrays = Arrays(
            self._clock, schedules, points, c.start, c.member, c.offset, c.arm, c.turn, c.position, c.angle,
            c.velocity, c.spin, c.mass, c.inertia, c.force, c.torque, c.held, c.withheld,
            np.array(control, np.int64).reshape(-1, 4), self._given, np.array(watched, np.int64).reshape(-1, 2),
            self._watched_load, np.array([row[:4] for row in self._drives], np.int64).reshape(-1, 4), self._servo,
        )  # fmt: skip

    def now(self) -> Still | cells.Deforming:
        """The cell as kernels take it."""
        if self.cell is None:
            return Still(*self._grains.box.period)
        a = self.arrays
        return cells.Deforming(self.cell, self.load, self._plan, a.schedules, a.points, self._clock)

    def lightest(self, laws: Sequence[Law]) -> float:
        """Mass (kg/m) of a disc that allows no longer step than the clumps, see clump_step.py."""
        return lightest(self.clumps, self._grains.discs, laws)

    def start(self, seconds: float, steps: int) -> None:
        """Set the clock for a call: seconds before the step last changed, and steps since."""
        self._clock[0], self._clock[1] = seconds, steps

    def listed(self) -> None:
        """The pairs were listed: strain counts from now.  Called before, so that the list is that of the cell now."""
        if self.cell is None:
            return
        pairs, c = self._grains.pairs, self.cell
        pairs.set_cell(float(c[cells.WIDTH]), float(c[cells.HEIGHT]), float(c[cells.TILT]))
        c[cells.WIDTH_THEN : cells.TILT_THEN + 1] = c[cells.WIDTH : cells.TILT + 1]
        reach = self._grains.reach
        c[cells.REACH] = float((self._grains.discs.radius if reach is None else reach).max(initial=0.0))
        c[cells.SKIN] = pairs.skin

    def state(self) -> dict[str, Any]:
        """What changes as it moves, in flat names; what was told is the scene's."""
        parts = {f"clumps.{name}": part for name, part in self.clumps.state().items()}
        return {
            **parts,
            "given": self._given.copy(),
            "watched_load": self._watched_load.copy(),
            "watched_from": self._watched_from.copy(),
            "walls": self._grains.walls.copy(),
            "servo": self._servo.copy(),
            "load": self.load.copy(),
            **({} if self.cell is None else {"cell": self.cell.copy()}),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Go on exactly from ``state()`` of one told alike; raises InputError where it was told otherwise."""
        self.clumps.restore({name[7:]: part for name, part in state.items() if name.startswith("clumps.")})
        own = {"given": self._given, "watched_load": self._watched_load, "watched_from": self._watched_from,
               "walls": self._grains.walls, "servo": self._servo, "load": self.load}  # fmt: skip
        if (self.cell is None) != ("cell" not in state):
            raise InputError(Fault("state.steering.cell", "cell" in state, "strained in one, not in the other"))
        if self.cell is not None:
            own["cell"] = self.cell
        for name, array in own.items():
            if array.shape != np.asarray(state[name]).shape:
                raise InputError(Fault(f"state.steering.{name}", np.asarray(state[name]).shape, "wrong shape"))
            array[...] = state[name]
        if self.cell is not None:
            c = self.cell
            self._grains.pairs.set_cell(*(float(c[k]) for k in range(cells.WIDTH_THEN, cells.TILT_THEN + 1)))
