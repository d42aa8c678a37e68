"""The command line ``porescale``."""

from pathlib import Path

from cyclopts import App

from porescale.cli import demseg, homogenise, piv, run, show
from porescale.common.cli import application
from porescale.common.cli.package import Package
from porescale.common.core.version import VERSION
from porescale.common.evidence.register import discovered

BENCHMARKS = "porescale.benchmarks"

PACKAGE = Package(
    name="porescale",
    summary="Round grains in a viscous fluid at the scale of single pores: DEM, lattice Boltzmann, and films of both.",
    version=VERSION,
    scene=run.scene_type,
    template=run.template,
    build=run.build,
    drive=run.drive,
    report=run.report,
    show=show.show,
    validations=discovered("porescale.validation", "VALIDATIONS"),
    benchmarks=discovered(BENCHMARKS, "BENCHMARKS"),
    case=Path(__file__).resolve().parents[2] / "cases" / "column_collapse",
    stability=discovered(BENCHMARKS, "STABILITY"),
    endurance=discovered(BENCHMARKS, "ENDURANCES"),
    parts=discovered(BENCHMARKS, "KINDS"),
    also={demseg.PACKAGE: demseg.show},
    features=run.features,
)


def commands() -> App:
    """All commands: those that every package has, `piv`, `demseg` and `homogenise`."""
    app = application.application(PACKAGE)
    app.command(piv.command())
    app.command(demseg.command())
    app.command(homogenise.homogenise)
    return app


def main() -> int:
    """Run ``porescale`` with the arguments of the process; returns the exit code."""
    return application.main(commands())
