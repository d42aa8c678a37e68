"""The command line ``porescale``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from cyclopts import App

from porescale.cli import demseg, homogenise, homogenise_volume, piv
from porescale.common.cli import application
from porescale.common.cli.package import Package
from porescale.common.evidence.register import discovered
from porescale.program import PROGRAM

if TYPE_CHECKING:
    from porescale.common.core.types import AnyArray

BENCHMARKS = "porescale.benchmarks"


def template() -> str:
    """The text of the scene that ``new`` writes, with the names that the registers offer."""
    from porescale.coupling.solid.choose import SOLID_OPERATORS
    from porescale.coupling.weighting.choose import WEIGHTINGS
    from porescale.dem.contact.choose import LAWS
    from porescale.lbm.boundary.choose import boundaries
    from porescale.lbm.collision.choose import OPERATORS

    text = files("porescale.cli").joinpath("template.toml").read_text(encoding="utf-8")
    for place, names in (("sides", boundaries()), ("operators", OPERATORS), ("solid_operators", SOLID_OPERATORS),
                         ("weightings", WEIGHTINGS), ("contact_laws", LAWS)):  # fmt: skip
        text = text.replace(f"{{{place}}}", " | ".join(names))
    return text


def features() -> Mapping[str, Callable[[Path, float | None], AnyArray]]:
    """What a trade study may read of a run besides its tables."""
    from porescale.analysis.features import FEATURES

    return FEATURES


PACKAGE = Package.of(
    PROGRAM,
    summary="Round grains in a viscous fluid at the scale of single pores: DEM, lattice Boltzmann, and films of both.",
    template=template,
    validations=discovered("porescale.validation", "VALIDATIONS"),
    benchmarks=discovered(BENCHMARKS, "BENCHMARKS"),
    peers=discovered(BENCHMARKS, "PEERS"),
    case=Path(__file__).resolve().parents[2] / "cases" / "column_collapse",
    stability=discovered(BENCHMARKS, "STABILITY"),
    convergence=discovered("porescale.validation", "LADDERS"),
    endurance=discovered(BENCHMARKS, "ENDURANCES"),
    parts=discovered(BENCHMARKS, "KINDS"),
    also={demseg.PACKAGE: demseg.show},
    features=features,
)


def commands() -> App:
    """All commands: those that every package has, `piv`, `demseg`, `homogenise` and `study volume`."""
    app = application.application(PACKAGE)
    app.command(piv.command())
    app.command(demseg.command())
    app.command(homogenise.homogenise)
    app["study"].command(homogenise_volume.volume)
    return app


def main() -> int:
    """Run ``porescale`` with the arguments of the process; returns the exit code."""
    return application.main(commands())
