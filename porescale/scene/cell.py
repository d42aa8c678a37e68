"""The periodic cell of a dry scene, strained at given rates or by stresses; what it says in series.csv."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import pydantic
from numpy.typing import NDArray

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import Refused, Section, quantity
from porescale.dem.bodies.rigid import areas
from porescale.dem.grains import Grains
from porescale.dem.motion.time_function import Schedule
from porescale.scene.time_function import Course, with_courses

if TYPE_CHECKING:
    from porescale.scene.sections import Scene

Array = NDArray[np.float64]

RATES, STRESSES = ("rate_xx", "rate_yy", "rate_xy"), ("stress_xx", "stress_yy", "shear_stress")


class Cell(Section):
    """Strain of a box that is periodic both ways: each of xx, yy, xy at a rate or by a stress; left out, it stays.

    rate_xx, rate_yy : of stretching, < 0 shrinks;  rate_xy : of shear, dv_x/dy;  stress_xx, stress_yy : compression
    positive;  shear_stress : of the sign of the shear that it drives.  Dry scenes only.
    """

    rate_xx: Course | None = None
    rate_yy: Course | None = None
    rate_xy: Course | None = None
    stress_xx: Course | None = None
    stress_yy: Course | None = None
    shear_stress: Course | None = None
    fastest: float | None = quantity("1/s", None, gt=0, le=1e6, help="largest rate under a stress")

    UNITS: ClassVar[dict[str, tuple[str, str]]] = {
        **dict.fromkeys(RATES, ("1/s", "rate of strain")), **dict.fromkeys(STRESSES, ("Pa", "stress")),
    }  # fmt: skip

    @pydantic.model_validator(mode="before")
    @classmethod
    def _courses(cls, table: Any) -> Any:
        return with_courses(table, cls.UNITS)

    @pydantic.model_validator(mode="after")
    def _sensible(self) -> Cell:
        faults = []
        told = [name for name in (*RATES, *STRESSES) if getattr(self, name) is not None]
        if not told:
            faults.append(Fault("", None, "strains nothing", repair="give a rate or a stress, or leave it out"))
        for rate, stress in zip(RATES, STRESSES, strict=True):
            if rate in told and stress in told:
                faults.append(Fault(stress, None, f"and {rate} cannot both be told", repair="give one of them"))
        stressed = any(name in told for name in STRESSES)
        if stressed and self.fastest is None:
            problem, repair = "is missing: the largest rate under a stress", "add it, such as 1"
            faults.append(Fault("fastest", None, problem, "1/s", "> 0", repair))
        if self.fastest is not None and not stressed:
            faults.append(Fault("fastest", self.fastest, "belongs to a stress", "1/s", repair="leave it out"))
        if faults:
            raise Refused(*faults)
        return self


def judge_cell(scene: Scene) -> list[Fault]:
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


def strain(scene: Scene, grains: Grains) -> None:
    """Strain the cell of ``grains`` as the scene says."""
    it = scene.cell
    assert it

    def told(name: str) -> Schedule | None:
        """The course of a rate or stress over time; None where the scene names none."""
        course: Course | None = getattr(it, name)
        return course.schedule if course else None

    xx, yy, xy = (told(name) for name in RATES)
    along, up, shear = (told(name) for name in STRESSES)
    grains.steering.strain_cell(xx, yy, xy, pressure=(along, up), shear_stress=shear, limit=it.fastest or 0.0)


class Strained:
    """Follows the strain of a cell; shear: the integral of its rate, since the tilt starts anew at half a width."""

    def __init__(self, grains: Grains) -> None:
        self.grains = grains
        self.shear = 0.0

    def advance(self, step: float) -> None:
        """After a step of ``step`` (s): its rates stay till the next."""
        self.shear += step * float(self.grains.steering.gradient()[0, 1])

    def row(self) -> dict[str, float]:
        """Columns of the series: strain (logarithms of the stretch of the edges; shear), the stress of the last step
        (compression positive, shear of the sign of the strain that it drives), and the cell."""
        grains = self.grains
        (width, _), (tilt, height) = grains.steering.edges()
        xx, xy, yy = grains.steering.cell_pressure()
        return {
            "strain xx ()": math.log(width / grains.box.period[0]),
            "strain yy ()": math.log(height / grains.box.period[1]), "strain xy ()": self.shear,
            "stress xx (Pa)": float(xx), "stress yy (Pa)": float(yy), "shear stress (Pa)": -float(xy),
            "cell width (m)": width, "cell height (m)": height, "cell tilt (m)": tilt,
            "solid fraction ()": float(areas(grains).sum()) / (width * height),
        }  # fmt: skip

    def seen(self) -> tuple[Array, Array]:
        """Positions (n, 2) m of the discs within width and height of the cell; velocities (n, 2) with the cell's."""
        steering, discs = self.grains.steering, self.grains.discs
        (width, _), (tilt, height) = steering.edges()
        position = discs.position.copy()
        turns = np.floor(position[:, 1] / height)
        position -= turns[:, None] * np.array([tilt, height])
        position[:, 0] -= width * np.floor(position[:, 0] / width)
        return position, discs.velocity + position @ steering.gradient().T
