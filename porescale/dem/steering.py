"""Clumps, controlled bodies, moving walls and the strain of the cell of a system: set up and read."""

import math
from collections.abc import Sequence
from typing import cast

import numpy as np
from numpy.typing import ArrayLike

from porescale.common.core.errors import Fault, InputError
from porescale.common.core.types import Floats
from porescale.dem.bodies.clumps import Body, Clumps
from porescale.dem.bodies.rigid import masses
from porescale.dem.contact.law import ContactLaw
from porescale.dem.forces.walls import TURN
from porescale.dem.listing import refresh
from porescale.dem.motion import affine_strain as cells
from porescale.dem.motion import servo as servos
from porescale.dem.motion.control import KINDS, PUSH, SUPPLY, Control
from porescale.dem.motion.drivers import Clump, Drivers, LoadRecord
from porescale.dem.motion.time_function import Schedule
from porescale.dem.state import State
from porescale.dem.timestep import lightest

COMPONENTS = ("xx", "yy", "xy")
SHARE = 0.5
"""Of the stability bound of a servo that is 2: monotone, see servo.py."""


def hold(grains: State, disc: int | slice | Floats, x: bool = True, y: bool = True, rotation: bool = True) -> None:
    """Hold these components of the velocity of discs (index, slice or mask) from now on, and release the others.

    A held component keeps its value until the owner writes another between steps, whatever the forces; they are in
    ``withheld``.  Contacts with other discs go on.  Raises InputError for a disc that is not there, or of a clump.
    """
    count = grains.discs.count
    if isinstance(disc, int) and not -count <= disc < count:
        raise InputError(Fault("disc", disc, "no such disc", allowed=f"0 to {count - 1}"))
    if grains.drivers is not None and np.any(grains.drivers.clumps.group[disc] >= 0):
        raise InputError(Fault("disc", str(disc), "belongs to a clump", repair="control the clump"))
    if not len(grains.held):
        grains.held, grains.withheld = np.zeros((grains.discs.count, 3), np.uint8), np.zeros((grains.discs.count, 3))
    grains.held[disc] = x, y, rotation
    grains.withheld[disc] = 0.0


def steering_of(grains: State) -> "Steering":
    """Drivers of ``grains``: there from the first use on."""
    if grains.drivers is None:
        grains.drivers = Steering(grains)
    return cast(Steering, grains.drivers)


class Steering(Drivers):
    """Drivers of ``grains`` that can be changed.  Made by Grains on first use, see ``Grains.steering``."""

    def __init__(self, grains: State) -> None:
        self._grains = grains
        super().__init__(grains.discs, grains.box.period)

    def bind(self, members: Sequence[ArrayLike], density: ArrayLike, bodies: Sequence[Body | None] = ()) -> Clumps:
        """Make clumps of discs, in place of those there were; see Clumps.  Controls and records of clumps are dropped.

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
        grains.body_mass = masses(grains)
        grains.pairs.group = clumps.group if clumps.count else None
        refresh(grains, anew=True)
        return clumps

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
        given = [(axis, control) for axis, control in enumerate((x, y, rotation)) if control is not None]
        self._controls += [(clump, index, axis, control) for axis, control in given]
        self._given = np.concatenate((self._given, np.zeros((len(given), 2))))
        held = [control is not None and KINDS[type(control)] != PUSH for control in (x, y, rotation)]
        if clump:
            self.clumps.held[index] = held
            self.clumps.withheld[index] = 0.0
        else:
            hold(self._grains, index, *held)
        self._compile()

    def record(self) -> list[LoadRecord]:
        """Force and displacement of every recorded body now, after a call of step."""
        rows = []
        for k, body in enumerate(self._watched):
            where = self._locate(body)
            met = self._watched_load[k]
            supply = np.zeros(3)
            for row, given in zip(self._controls, self._given, strict=True):
                if row[:2] == where:
                    supply[row[2]] = given[SUPPLY]
            gone = self._place(*where) - self._watched_from[k]
            rows.append(LoadRecord(self._grains.time, body, *(tuple(part.tolist()) for part in (gone, met, supply))))
        return rows

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
        when neither or both of force and stress are given, or a number is not finite or out of range.
        """
        if (force is None) == (stress is None):
            raise InputError(Fault(f"{name}.servo", problem="needs either force or stress"))
        if stress is not None and (length is None) == (between is None):
            raise InputError(Fault(f"{name}.servo", problem="needs either length or between for a stress"))
        if length is not None and not 0.0 < length < math.inf:
            raise InputError(Fault(f"{name}.servo.length", length, "makes no sense", "m", "> 0"))
        if not 0.0 < share < 2.0 or not speed > 0.0:
            bad, what, allowed = (share, "share", "> 0, < 2") if speed > 0.0 else (speed, "speed", "> 0")
            raise InputError(Fault(f"{name}.servo.{what}", bad, allowed=allowed))
        low, high = (self._wall(between[0]), self._wall(between[1])) if between else (-1, -1)
        mode, wanted = (servos.BY_FORCE, force) if stress is None else (servos.BY_STRESS, stress)
        assert wanted is not None
        numbers = [*self._grains.stiffest_contact(), share, speed, length or 0.0, 0.0]
        self._drive(name, [(mode, wanted)], low, high, numbers)

    def _wall(self, name: str) -> int:
        names = self._grains.wall_names
        if name not in names:
            raise InputError(Fault("wall", name, "no such wall", allowed=", ".join(names)))
        return names.index(name)

    def _drive(
        self,
        name: str,
        given: Sequence[tuple[int, Schedule]],
        low: int = -1,
        high: int = -1,
        numbers: Sequence[float] = (0.0,) * 6,
    ) -> None:
        wall = self._wall(name)
        kept = [k for k, row in enumerate(self._drives) if row[0] != wall]
        self._drives, self._servo = [self._drives[k] for k in kept], self._servo[kept]
        self._grains.walls[wall, TURN - 2 :] = 0.0
        self._drives += [(wall, mode, low, high, schedule) for mode, schedule in given]
        self._servo = np.concatenate((self._servo, np.array([numbers] * len(given), float)))
        self._compile()

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
        ``edges``.  Raises InputError when the box is not periodic both ways, or a number is not finite or out of range.
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
            stiff, damping = (self._leverage() * value for value in grains.stiffest_contact())
            self._plan[k] = stress is not None, share, limit, stiff, damping
        if self.cell is None:
            self.cell = np.zeros(cells.STATE)
            self.cell[cells.WIDTH : cells.TILT] = grains.box.period
        self._compile()
        refresh(grains, anew=True)

    def _leverage(self) -> float:
        """Square of how much further than discs that touch their bodies' centroids may be apart: a contact resists a
        strain of the cell that much more."""
        c = self.clumps
        round_ones = c.radius > 0.0
        far = np.hypot(*c.offset[round_ones].T) / c.radius[round_ones]
        return (1.0 + float(far.max(initial=0.0))) ** 2

    def cell_pressure(self) -> Floats:
        """Pressure tensor (xx, xy, yy) of the strained cell in its last step, Pa, compression positive."""
        assert self.cell is not None
        d = self._grains.discs
        area = float(self.cell[cells.WIDTH] * self.cell[cells.HEIGHT])
        return np.array(cells.pressure(d.velocity, d.mass, self.load, area))

    def lightest(self, laws: Sequence[ContactLaw]) -> float:
        """Mass (kg/m) of a disc with the same stable step as the clumps, see timestep.lightest."""
        return lightest(self.clumps, self._grains.discs, laws)
