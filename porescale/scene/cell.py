"""[cell]: the periodic cell of a dry scene, strained at given rates or by stresses."""

from typing import ClassVar

from porescale.common.core.errors import Fault
from porescale.common.schema.sections import quantity
from porescale.scene.time_function import Timed, TimeFunction

RATES, STRESSES = ("rate_xx", "rate_yy", "rate_xy"), ("stress_xx", "stress_yy", "shear_stress")


class Cell(Timed):
    """Strain of a box that is periodic both ways: each of xx, yy, xy at a rate or by a stress; left out, it stays.

    rate_xx, rate_yy : of stretching, < 0 shrinks;  rate_xy : of shear, dv_x/dy;  stress_xx, stress_yy : compression
    positive;  shear_stress : of the sign of the shear that it drives.  Dry scenes only.
    """

    rate_xx: TimeFunction | None = None
    rate_yy: TimeFunction | None = None
    rate_xy: TimeFunction | None = None
    stress_xx: TimeFunction | None = None
    stress_yy: TimeFunction | None = None
    shear_stress: TimeFunction | None = None
    fastest: float | None = quantity("1/s", None, gt=0, le=1e6, help="largest rate under a stress")

    UNITS: ClassVar[dict[str, tuple[str, str]]] = {
        **dict.fromkeys(RATES, ("1/s", "rate of strain")), **dict.fromkeys(STRESSES, ("Pa", "stress")),
    }  # fmt: skip

    def _faults(self) -> list[Fault]:
        faults = []
        given = [name for name in (*RATES, *STRESSES) if getattr(self, name) is not None]
        if not given:
            faults.append(Fault("", None, "strains nothing", repair="give a rate or a stress, or leave it out"))
        for rate, stress in zip(RATES, STRESSES, strict=True):
            if rate in given and stress in given:
                faults.append(Fault(stress, None, f"and {rate} cannot both be given", repair="give one of them"))
        stressed = any(name in given for name in STRESSES)
        if stressed and self.fastest is None:
            problem, repair = "is missing: the largest rate under a stress", "add it, such as 1"
            faults.append(Fault("fastest", None, problem, "1/s", "> 0", repair))
        if self.fastest is not None and not stressed:
            faults.append(Fault("fastest", self.fastest, "belongs to a stress", "1/s", repair="leave it out"))
        return faults
