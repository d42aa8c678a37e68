"""Interface of a package to the common commands.  Every part is a function, so that nothing is
imported before a command needs it: `--help` must not wait for a compiler.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from porescale.common.cli.report import Report
    from porescale.common.core.types import AnyArray
    from porescale.common.evidence.benchmarks import Benchmarks
    from porescale.common.evidence.endurance import Endurances
    from porescale.common.evidence.extremes import Extremes
    from porescale.common.evidence.overhead import SceneKinds
    from porescale.common.evidence.stability import Stability
    from porescale.common.evidence.validations import Validations
    from porescale.common.record.drive import Outcome
    from porescale.common.schema.sections import Section


class Drive(Protocol):
    """Takes a model through the time of its scene, keeping the record in a run folder."""

    def __call__(
        self,
        model: Any,
        folder: Path,
        scene: Any,
        *,
        card: dict[str, Any],
        resume: bool,
        quiet: bool,
        overwrite: bool = False,
    ) -> Outcome:
        """Run, or go on with the run in ``folder``.

        card : what card.json must hold of the request: package, name, scene (full, with defaults), scene_file,
        quality, settings;  quiet : no progress;  overwrite : replace the run there, whatever it cost.
        """


def run_table(folder: Path, name: str) -> Mapping[str, AnyArray]:
    """Columns of a table of the run in ``folder``, "series" for series.csv; {} when there is none."""
    from porescale.common.record.series import read_series

    return read_series(folder / f"{name}.csv")


@dataclass(frozen=True)
class Package:
    """A simulator's parts.

    name : of the command;  summary : one line for --help;  version;
    scene : gives the scene type;  template : gives the commented scene.toml that `new` writes;
    build : scene -> model, of scenes that report accepts;  drive : runs it;  report : scene -> the report of `check`,
    warnings and all (it may raise InputError);
    show : makes pictures and a film in a run folder and gives their paths;
    table : columns of a table of a run folder by its name, "series" for series.csv;
    also : the same as show for runs of other commands, by the names in their cards;
    validations, benchmarks : give the registers;  case : folder of a case whose front `bench` measures again, or None;
    stability : flows of a stability map;  extremes : tries of `study extremes`;  endurance : flows of `study
    endurance`;  parts : scenes of `study parts`;  each None if there are none;
    formerly : tables like those of a scene, with what was done before keys were there whose defaults do something else;
    features : what trade studies read of a run folder at a time (None: its last snapshot), by name, None if there is
    nothing.
    """

    name: str
    summary: str
    version: str
    scene: Callable[[], type[Section]]
    template: Callable[[], str]
    build: Callable[[Any], Any]
    drive: Drive
    report: Callable[[Any], Report]
    show: Callable[[Path], Iterable[Path]]
    validations: Callable[[], Validations]
    benchmarks: Callable[[], Benchmarks]
    table: Callable[[Path, str], Mapping[str, AnyArray]] = run_table
    case: Path | None = None
    stability: Callable[[], Stability] | None = None
    extremes: Callable[[], Extremes] | None = None
    endurance: Callable[[], Endurances] | None = None
    parts: Callable[[], SceneKinds] | None = None
    formerly: Mapping[str, Any] = field(default_factory=dict)
    also: Mapping[str, Callable[[Path], Iterable[Path]]] = field(default_factory=dict)
    features: Callable[[], Mapping[str, Callable[[Path, float | None], AnyArray]]] | None = None
