"""The command line ``continuum-sph``, made of the same parts as ``porescale``."""

from pathlib import Path

from continuum_sph.program import PROGRAM
from porescale.common.cli import application
from porescale.common.cli.package import Package
from porescale.common.evidence.register import discovered

BENCHMARKS = "continuum_sph.benchmarks"


def template() -> str:
    """The text of the scene that ``new`` writes."""
    return Path(__file__).with_name("template.toml").read_text(encoding="utf-8")


PACKAGE = Package.of(
    PROGRAM,
    summary="Soil, water and air as layers of smoothed particles (water and soil in a tank, seepage, bubbles).",
    template=template,
    validations=discovered("continuum_sph.validation", "VALIDATIONS"),
    benchmarks=discovered(BENCHMARKS, "BENCHMARKS"),
    case=Path(__file__).resolve().parents[1] / "cases" / "collapsing_water_column",
    extremes=discovered(BENCHMARKS, "EXTREMES"),
    convergence=discovered("continuum_sph.validation", "LADDERS"),
    endurance=discovered(BENCHMARKS, "ENDURANCES"),
    parts=discovered(BENCHMARKS, "KINDS"),
)


def main() -> int:
    """Run ``continuum-sph`` with the arguments of the process; returns the exit code."""
    return application.main(application.application(PACKAGE))
