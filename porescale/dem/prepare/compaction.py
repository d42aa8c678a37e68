"""Packings of a wanted pressure or density, made by isotropic compression, and packings from files.

Compression: discs are placed at random without overlap, small, and grow in place, slowly and damped, until the box has
the wanted pressure or they have their size; then they rest.  For discs in a fixed box that is the same as a box that
shrinks.  Little friction meanwhile packs densely, much of it loosely.  Rest is reached under the law that is to come.

Files hold x, y, radius in m: .csv, one disc a line below its header, or .h5, three datasets.  A laboratory's list of
circles is read with its own units and direction of y by ``read_circles``.
"""

import csv
import dataclasses
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from porescale.common.core.atomic import write_bytes
from porescale.common.core.errors import Fault, InputError, PorescaleError
from porescale.common.core.given_file import given_text, reason
from porescale.common.core.types import Floats
from porescale.common.neighbors.placement import place
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.contacts import contacts
from porescale.dem.measures.region import Region
from porescale.dem.measures.stress import contact_stress, principal
from porescale.dem.measures.survey import max_overlap
from porescale.dem.prepare.obstacles import NOTHING, Obstacles
from porescale.dem.prepare.on_disk import once
from porescale.dem.timestep import crowded

START = 0.7  # packing fraction at which discs are placed: short of where friction can hold them
DRAG = 0.02  # background damping per step: lets discs that are pushed travel, ends waves between two looks
DENSEST = 0.84  # packing fraction of random close packing
GROWTH = 5e-4  # of the radii at a time: less than the overlaps at which a packing is loaded
PAUSE = 40  # steps after each: some periods of a contact
REST = 400  # steps between checks once the pressure is reached
PATIENCE = 1500  # checks before the run is given up
NEAR = 3e-3  # share of the wanted pressure within which it is there
BALANCE = 3e-3  # mean net force on a disc over the mean contact force that counts as rest
DEEPEST = 0.02  # overlap over diameter beyond which discs are no longer discs
ROUNDED = 0.01  # share by which twice a radius may differ from the diameter beside it: lists are rounded
UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6}
COLUMNS = ("x (m)", "y (m)", "radius (m)")


class Compressed(NamedTuple):
    """grains at rest;  scale: radii over those requested;  fraction: disc area over box area;  pressure Pa;  overlap:
    the deepest over its smaller diameter."""

    grains: Grains
    scale: float
    fraction: float
    pressure: float
    overlap: float


@dataclass(frozen=True)
class Compactor:
    """How discs are compressed: in the rectangle ``lower`` to ``upper`` (m), periodic or between walls, under ``law``,
    with ``friction`` between discs while they grow (walls without), density kg/m³, seed of the random start;  rolling :
    friction of rolling while they grow (0: that of the law);  around : discs that stand, after those that grow."""

    lower: tuple[float, float]
    upper: tuple[float, float]
    law: Linear
    periodic: tuple[bool, bool] = (True, True)
    friction: float = 0.0
    density: float = 2500.0
    seed: int = 0
    rolling: float = 0.0
    around: Obstacles = NOTHING

    def to_pressure(self, radius: Floats, pressure: float) -> Compressed:
        """Discs with sizes in the ratios of ``radius`` (n,) m, grown or shrunk until the mean stress is ``pressure``
        (Pa).  Raises InputError when that needs overlaps beyond 2 % of a diameter, PorescaleError without rest."""
        if not pressure > 0.0 or not math.isfinite(pressure):
            raise InputError(Fault("pressure", pressure, "cannot hold a packing together", "Pa", "> 0"))
        if (soft := pressure / self.law.stiffness) > DEEPEST:
            problem = f"would press grains into each other by about {soft:.2g} of a diameter"
            repair = "raise contact.stiffness or lower the pressure"
            highest = f"<= {DEEPEST * self.law.stiffness:.3g}"
            raise InputError(Fault("pressure", pressure, problem, "Pa", highest, repair))
        grains, _ = self._start(radius)
        for law in (self._preparing, self.law):
            grains.set_law(law, law.with_friction(0.0) if law is not self.law else law)
            self._hold(grains, pressure)
        return self._made(grains, radius)

    def further(self, position: Floats, radius: Floats, pressures: Sequence[float]) -> list[tuple[Floats, Floats]]:
        """Positions and radii of discs that rest at ``position`` (n, 2) m with ``radius`` (n,) m, pressed to each of
        ``pressures`` (Pa) in turn.  What friction held is forgotten at first.  Raises PorescaleError without rest."""
        grains, found = self.grains(position, radius), []
        grains.set_law(self.law, self.law.with_friction(0.0))
        for pressure in pressures:
            self._hold(grains, pressure)
            found.append((grains.discs.position.copy(), grains.discs.radius.copy()))
        return found

    def to_size(self, radius: Floats) -> Compressed:
        """Discs of ``radius`` (n,) m in the rectangle: the packing fraction then follows from their areas.

        Raises InputError when that is so dense that they overlap by more than 2 % of a diameter.
        """
        if self.around:
            self._require_room(radius)
        grains, scale = self._start(radius)
        fits, deepest = scale, 0.0
        while scale < 1.0:
            factor = min(1.0 + GROWTH, 1.0 / scale)
            self._grow(grains, factor, PAUSE)
            scale *= factor
            deepest = 0.5 * max_overlap(grains, self._free(grains)).share
            if deepest <= DEEPEST:
                fits = scale
        if deepest > DEEPEST:
            made = float(grains.discs.area[: self._free(grains)].sum()) / self._region.area
            problem = f"is what these discs make, pressed into each other by {deepest:.2g} of a diameter"
            repair = "lower packing_fraction, or the friction while preparing"
            most = f"< {math.floor(100.0 * made * fits**2) / 100.0:g}"
            raise InputError(Fault("packing_fraction", round(made, 4), problem, "", most, repair))
        for law in (self._preparing, self.law):
            grains.set_law(law, law.with_friction(0.0) if law is not self.law else law)
            self._rest(grains)
        return self._made(grains, radius)

    def grains(self, position: Floats, radius: Floats) -> Grains:
        """Discs in the rectangle under the law with the friction of preparation, walls without."""
        across, up = ("periodic" if it else "solid" for it in self.periodic)
        box = Box(self.lower, self.upper, across, across, up, up)
        law = self._preparing
        discs, walls = make_discs(position, radius, self.density), law.with_friction(0.0)
        if self.around:
            return self.around.beside(discs, law, box, self.density, wall_law=walls)
        return Grains(discs, law, box, wall_law=walls)

    def _require_room(self, radius: Floats) -> None:
        """InputError where discs of ``radius`` (n,) m are more than can be pressed into what the obstacles leave."""
        left = 1.0 - self.around.area(self.lower, self.upper) / self._region.area
        share = float(np.pi * np.sum(radius**2)) / self._region.area
        if share > DENSEST * left:
            problem = "of the rectangle does not fit beside what stands in it"
            most = f"<= {math.floor(1e3 * DENSEST * left) / 1e3:g}"
            raise InputError(Fault("packing_fraction", round(share, 4), problem, "", most, "lower packing_fraction"))

    def _free(self, grains: Grains) -> int:
        """Number of the discs that grow, the first ones."""
        return grains.discs.count - len(self.around.discs)

    @property
    def _preparing(self) -> Linear:
        """The law while discs grow."""
        law = self.law.with_friction(self.friction)
        return law.with_rolling(self.rolling, law.tangential_stiffness) if self.rolling else law

    @property
    def _region(self) -> Region:
        return Region(self.lower, self.upper)

    def _start(self, radius: Floats) -> tuple[Grains, float]:
        """Small discs at random places, and their radii over those wanted."""
        room = self._region.area - (self.around.area(self.lower, self.upper) if self.around else 0.0)
        covered = float(np.pi * np.sum(radius**2)) / room if room > 0.0 else math.inf
        scale = min(1.0, math.sqrt(START / covered))
        if self.around:
            placed = self.around.place(self.lower, self.upper, scale * radius, self.seed, self.periodic)
        else:
            placed = place(self.lower, self.upper, radii=scale * radius, periodic=self.periodic, seed=self.seed)
        grains = self.grains(placed.position, placed.radius)
        # Nearly one mass for all while they are prepared: small discs would else set the step, and large ones crawl.
        d, free = grains.discs, self._free(grains)
        d.mass[:free] = d.mass[:free].mean() * crowded(d.radius[:free])
        d.inertia[:free] = 0.5 * d.mass[:free] * d.radius[:free] ** 2
        return grains, scale

    def _grow(self, grains: Grains, factor: float, steps: int) -> None:
        """Radii times ``factor``, and steps for what that does to settle."""
        d, free = grains.discs, self._free(grains)
        d.radius[:free] *= factor
        d.inertia[:free] *= factor**2
        grains.refresh()
        dt = grains.stable_step(steps_per_contact=0.0)
        grains.step(dt, None, None, steps, DRAG / dt)
        grains.check()

    def _hold(self, grains: Grains, pressure: float) -> None:
        """Grow or shrink a little until pressure and rest are there."""
        looks = 0
        while looks < PATIENCE:
            now = mean_stress(grains)
            if now < 0.5 * pressure:
                self._grow(grains, 1.0 + GROWTH, PAUSE)
                continue
            looks += 1
            if abs(now / pressure - 1.0) < NEAR and out_of_balance(grains, self._free(grains)) < BALANCE:
                self._stop(grains)
                return
            # The modulus of a packing is at most about its contact stiffness: this does not go too far.
            step = min(max((pressure - now) / self.law.stiffness, -GROWTH), GROWTH)
            self._grow(grains, 1.0 + step, REST)
        raise PorescaleError(
            f"the packing did not come to rest under {pressure:.3g} Pa: pressure {mean_stress(grains):.3g} Pa, "
            f"net force {out_of_balance(grains, self._free(grains)):.2g} of the mean contact force"
        )

    def _rest(self, grains: Grains) -> None:
        """Steps until net forces are small, or nothing touches."""
        for _ in range(PATIENCE):
            self._grow(grains, 1.0, REST)
            if out_of_balance(grains, self._free(grains)) < BALANCE:
                self._stop(grains)
                return
        left = out_of_balance(grains, self._free(grains))
        raise PorescaleError(f"the packing did not come to rest: net force {left:.2g} of the mean contact force")

    def _stop(self, grains: Grains) -> None:
        d = grains.discs
        d.velocity[:] = 0.0
        d.spin[:] = 0.0
        grains.reset_clock()

    def _made(self, grains: Grains, radius: Floats) -> Compressed:
        d, free = grains.discs, self._free(grains)
        d.mass[:free] = self.density * d.area[:free]
        d.inertia[:free] = 0.5 * d.mass[:free] * d.radius[:free] ** 2
        fraction = float(d.area[:free].sum()) / self._region.area
        scale = float(d.radius[0] / radius[0])
        return Compressed(grains, scale, fraction, mean_stress(grains), 0.5 * max_overlap(grains).share)


def kept(press: Compactor, radius: Floats, pressure: float | None, folder: Path | None = None) -> Compressed:
    """``press.to_pressure``, or ``to_size`` without one; from disk if it was made before, with the bits it had.

    folder : as of `once`.
    """

    def read(state: dict[str, Any]) -> Compressed:
        """The grains of a state that was kept."""
        grains = press.grains(np.array(state["discs"]["position"])[: len(radius)], radius)
        grains.set_law(press.law, press.law)
        grains.restore(state)
        return Compressed(grains, *(float(state["made"][key]) for key in Compressed._fields[1:]))

    return once(
        [dataclasses.asdict(press), np.asarray(radius).tolist(), pressure],
        read,
        lambda: press.to_size(radius) if pressure is None else press.to_pressure(radius, pressure),
        lambda made: {**made.grains.state(), "made": dict(zip(Compressed._fields[1:], made[1:], strict=True))},
        folder,
    )


def mean_stress(grains: Grains) -> float:
    """Mean of the principal contact stresses of the whole box, Pa."""
    region = Region(grains.box.lower, grains.box.upper)
    return principal(contact_stress(region, contacts(grains), grains.box.period)).mean


def out_of_balance(grains: Grains, free: int | None = None) -> float:
    """Mean net contact force on a disc, of so many ``free`` first ones (None: all), over the mean force of a contact; 0
    where nothing touches."""
    found = contacts(grains)
    if not found.count or not (scale := float(np.abs(found.normal_force).mean())) > 0.0:
        return 0.0
    return float(np.hypot(*found.resultants(grains.discs.count)[0][:free].T).mean()) / scale


# ---------------------------------------------------------------- files


def write_packing(path: Path, position: Floats, radius: Floats) -> None:
    """Write x, y, radius (m) to a .csv or .h5 file, whole or absent.  Raises InputError for another suffix.

    x (m) : of the grain's centre
    y (m) : of the grain's centre
    radius (m) : of the grain
    """
    table = np.column_stack((position, radius))
    if path.suffix == ".csv":
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows([repr(value) for value in row] for row in table.tolist())
        write_bytes(path, text.getvalue().encode())
        return
    from porescale.common.core.hdf5 import writing  # takes longer to import than a scene to be judged

    _judge_suffix(path)
    with writing(path) as file:
        for name, column in zip(("x", "y", "radius"), table.T, strict=True):
            file.create_dataset(name, data=column, fletcher32=True, chunks=(max(len(column), 1),)).attrs["units"] = "m"


def read_packing(path: Path) -> tuple[Floats, Floats]:
    """Positions (n, 2) m and radii (n,) m of a file that ``write_packing`` wrote, or one like it.

    Raises InputError, naming line or dataset, for what is no packing.
    """
    _judge_suffix(path)
    if path.suffix == ".csv":
        return read_circles(path)
    import h5py

    try:
        with h5py.File(path, "r") as file:
            columns = [np.asarray(file[name][...], np.float64).ravel() for name in ("x", "y", "radius")]
    except (OSError, KeyError, ValueError, TypeError) as error:
        reason = " ".join(str(error).split())[:120]
        repair = "give a file with datasets x, y and radius in m"
        raise InputError(Fault("file", str(path), f"is no packing ({reason})", repair=repair)) from error
    if len({len(column) for column in columns}) != 1:
        raise InputError(Fault("file", str(path), "x, y and radius differ in length", repair="write it anew"))
    x, y, radius = columns
    return _judged(path, np.column_stack((x, y)), radius)


def read_circles(
    path: Path, unit: str = "m", y: str = "up", height: float | None = None, origin: tuple[float, float] = (0.0, 0.0)
) -> tuple[Floats, Floats]:
    """Positions (n, 2) m and radii (n,) m of a list of circles: .csv with columns x, y and diameter or radius.

    unit : of all columns, m, cm, mm or um;  y : "up", or "down" as in images, then ``height`` (m) is that of the image
    (default: the lowest circle then touches y = 0);  origin : where the lower left corner of the list comes to lie, m.
    A header may carry its unit in brackets, "x (mm)", which then must be ``unit``.  Raises InputError naming the line.
    """
    if unit not in UNITS:
        raise InputError(Fault("unit", unit, "is not known", "", ", ".join(UNITS)))
    if y not in ("up", "down"):
        raise InputError(Fault("y", y, "is no direction", "", "up or down", "images count y downwards"))
    columns, by_radius = _table(path, unit)
    x, up, size = columns.T * UNITS[unit]
    radius = size if by_radius else 0.5 * size
    if y == "down":
        up = (float((up + radius).max(initial=0.0)) if height is None else height) - up
    return _judged(path, np.column_stack((x + origin[0], up + origin[1])), radius)


def _table(path: Path, unit: str) -> tuple[Floats, bool]:
    """Columns x, y, size (n, 3) of a file in its unit, and whether the size is a radius."""
    try:
        lines = list(csv.reader(io.StringIO(given_text(path))))
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise InputError(
            Fault("file", str(path), f"line {line} is not UTF-8 text", repair="save it as UTF-8")
        ) from None
    except (OSError, csv.Error) as error:
        problem = f"cannot be read ({reason(error)})"
        raise InputError(Fault("file", str(path), problem, repair="check the name")) from error
    header = [cell.strip().lower() for cell in lines[0]] if lines else []
    names = [cell.partition("(")[0].strip() for cell in header]
    by_radius = "diameter" not in names
    wanted = ("x", "y", "radius" if by_radius else "diameter")
    missing = [name for name in wanted if name not in names]
    if missing:
        problem = f"has no column {', '.join(missing)}; its first line is {', '.join(header)[:80]!r}"
        repair = "part columns by commas" if len(names) == 1 and {*";\t"} & {*names[0]} else "add a header line"
        raise InputError(Fault("file", str(path), problem, "", "x, y and diameter or radius", repair))
    places = [names.index(name) for name in wanted]
    twice = None if by_radius or "radius" not in names else names.index("radius")
    for k in places:
        given = header[k].partition("(")[2].rstrip(") ").strip()
        if given and UNITS.get(given) != UNITS[unit]:
            raise InputError(Fault("unit", unit, f"the column {header[k]!r} of {path.name} says otherwise", "", given))
    rows = []
    for number, cells in enumerate(lines[1:], 2):
        if not any(cell.strip() for cell in cells):
            continue
        try:
            rows.append([float(cells[k]) for k in places])
            if twice is not None and abs(2.0 * float(cells[twice]) - rows[-1][2]) > ROUNDED * abs(rows[-1][2]):
                problem = f"line {number} has radius {cells[twice].strip()} and diameter {rows[-1][2]:g}"
                raise InputError(Fault("file", str(path), problem, repair="leave one of the columns out"))
        except (ValueError, IndexError):
            problem = f"line {number} is {','.join(cells)[:60]!r}"
            raise InputError(Fault("file", str(path), problem, "", "numbers in x, y and size")) from None
    return np.array(rows, dtype=np.float64).reshape(-1, 3), by_radius


def _judge_suffix(path: Path) -> None:
    if path.suffix not in (".csv", ".h5"):
        raise InputError(Fault("file", str(path), "is of a kind not known", "", ".csv or .h5"))


def _judged(path: Path, position: Floats, radius: Floats) -> tuple[Floats, Floats]:
    """The given positions and radii, if every row is a valid circle; else InputError."""
    if (bad := ~np.isfinite(position).all(axis=1) | ~(radius > 0.0) | ~np.isfinite(radius)).any():
        k = int(bad.argmax())
        problem = f"circle {k} is ({position[k, 0]:g}, {position[k, 1]:g}) with radius {radius[k]:g}"
        raise InputError(Fault("file", str(path), problem, "m", "places that are finite, radius > 0"))
    if not len(radius):
        raise InputError(Fault("file", str(path), "holds no circle", repair="give one with at least one line"))
    return position, radius
