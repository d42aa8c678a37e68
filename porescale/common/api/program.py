"""Interface of a program to all that runs scenes, from Python and from the command line.

Every part is a function, so that nothing is imported before it is needed: `--help` must not wait for a compiler.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from porescale.common.core.errors import Fault, InputError

if TYPE_CHECKING:
    from porescale.common.api.report import Report
    from porescale.common.pictures.look import Look
    from porescale.common.record.drive import Outcome
    from porescale.common.record.open_run import Run
    from porescale.common.schema.scene import SceneBase


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


@dataclass(frozen=True, kw_only=True)
class Program:
    """What runs scenes of one kind.

    name : of the command and on run cards;  module : its Python package;  scene : gives the scene type;
    build : scene -> model, of scenes that report accepts;  drive : runs it;  report : scene -> the report of `check`,
    warnings and all (it may raise InputError);
    show : makes pictures and a film in a run folder and gives their paths;  look : how they show a run;
    seeds : of all that a scene draws at random, by key, what repeats of a run are numbered by; none: nothing is drawn;
    measured : sections of a scene that can be measured on a finished run, by key;  measure : measures those of a scene
    (that of the run, with them in place of its own), the tables by name, each columns by name;
    widget : shows a run in notebooks;
    rehearsed : context within which kernels of a scene are compiled by a second process, too;
    formerly : tables like those of a scene, with what was done before keys were there whose defaults do something else.
    """

    name: str
    module: str
    scene: Callable[[], type[SceneBase]]
    build: Callable[[Any], Any]
    drive: Drive
    report: Callable[[Any], Report]
    show: Callable[[Path], Iterable[Path]]
    look: Callable[[Run], Look]
    seeds: Callable[[Any], Mapping[str, int]] | None = None
    measured: Sequence[str] = ()
    measure: Callable[[Run, Any], Mapping[str, Mapping[str, Sequence[float]]]] | None = None
    widget: Callable[[Run], Any] | None = None
    rehearsed: Callable[[Any], AbstractContextManager[None]] = nullcontext
    formerly: Mapping[str, Any] = field(default_factory=dict)

    def report_of(self, scene: SceneBase) -> Report:
        """The report of a scene; InputError whose faults name the scene's file, or --set where that gave the key."""
        from porescale.common.schema.messages import parse_key
        from porescale.common.schema.scene_file import parse_setting

        try:
            return self.report(scene)
        except InputError as refused:
            keys = [parse_setting(text)[0] for text in scene.source.settings]
            given = [any(parse_key(it.key)[: len(key)] == key for key in keys) for it in refused.faults]
            faults = [replace(it, file=it.file or "--set" * own) for it, own in zip(refused.faults, given, strict=True)]
            raise InputError(faults).in_file(str(scene.source.file or "")) from None

    def required(self, scene: Any) -> Any:
        """``scene``; InputError unless it is one of this program."""
        if isinstance(scene, self.scene()):
            return scene
        whose = type(scene).__module__.partition(".")[0]
        given = type(scene).__name__ if whose == "builtins" else f"{whose}.{type(scene).__name__}"
        repair = "give a scene; load makes one of a path or the name of a case"
        raise InputError(Fault("scene", given, f"is no scene of {self.name}", repair=repair))
