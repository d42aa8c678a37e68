"""Measuring a finished run: sections of a scene, given as such, as tables or in a file, read from the snapshots."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from porescale.common.core.atomic import write_text
from porescale.common.core.errors import Fault, InputError
from porescale.common.record.columns import Columns
from porescale.common.record.read_card import scene_folder
from porescale.common.schema import scene_file
from porescale.common.schema.messages import nearest
from porescale.common.schema.sections import Section, validate
from porescale.common.schema.written import plain

if TYPE_CHECKING:
    from porescale.common.api.program import Program
    from porescale.common.record.open_run import Run

Tables = Mapping[str, Columns]
ALSO = ("quality", "quality_default")
"""Keys of a scene's file that are no sections."""


def measure(run: Run, program: Program, given: Sequence[Any], sections: Mapping[str, Any]) -> dict[str, Columns]:
    """The tables of `Run.measure`."""
    asked: dict[str, list[Any]] = {}
    for table in [*(_tables(program, it) for it in given), sections]:
        for key, value in table.items():
            if key not in program.measured:
                known = nearest(key, program.measured, "sections")
                raise InputError(Fault(key, None, "is no section that can be measured afterwards", repair=known))
            asked.setdefault(key, []).extend(plain(value if isinstance(value, list | tuple) else [value]))
    asked = {key: value for key, value in asked.items() if value}
    if not asked or program.measure is None:
        allowed = ", ".join(f"[[{key}]]" for key in program.measured)
        raise InputError(Fault("sections", None, "nothing to measure", allowed=allowed, repair="give one of them"))
    run.require_snapshots()
    card = run.card
    kept = {key: value for key, value in card["scene"].items() if key not in program.measured}
    tables = {**scene_file.merge(program.formerly, kept), **asked}
    scene = validate(program.scene(), tables, folder=scene_folder(card))
    found = program.measure(run, scene)
    return {name: Columns({key: np.array(column) for key, column in table.items()}, name)
            for name, table in found.items()}  # fmt: skip


def write_tables(tables: Tables, folder: Path) -> list[Path]:
    """Write each as <name>.csv into ``folder``; their paths.  InputError, and nothing written, where one is there."""
    paths = {name: folder / f"{name}.csv" for name in tables}
    for path in paths.values():
        if path.exists():
            problem = "is there already, of the run itself or an earlier measurement"
            raise InputError(Fault("table", str(path), problem, repair="name another folder (out), or remove it"))
    for name, table in tables.items():
        from porescale.common.evidence.files import csv_text

        rows = [[repr(value) for value in row] for row in zip(*(it.tolist() for it in table.values()), strict=True)]
        write_text(paths[name], csv_text(list(table), rows))
    return list(paths.values())


def register(run: Run, tables: Tables) -> None:
    """Name tables that were written into the run folder on its card: a run that replaces this one removes them."""
    from porescale.common.record.card import RUNNING, write_card
    from porescale.common.record.record import TABLES

    if run.card.get("outcome") != RUNNING:
        run.card[TABLES] = sorted({*run.card.get(TABLES, []), *tables})
        write_card(run.folder, run.card)


def _tables(program: Program, given: Any) -> Mapping[str, Any]:
    """The measuring sections of what was given, by key."""
    scene_type = program.scene()
    if isinstance(given, str | Path):
        return _of_file(program, scene_file.find(Path(given)))
    if isinstance(given, scene_type):
        return {key: list(getattr(given, key)) for key in program.measured if getattr(given, key)}
    if isinstance(given, Mapping):
        return given
    for key in program.measured:
        if isinstance(given, _section_of(scene_type, key)):
            return {key: [given]}
    problem, repair = "is neither a section, a scene nor a file", "give sections by key: probe={...}"
    raise InputError(Fault("sections", type(given).__name__, problem, repair=repair))


def _section_of(scene_type: type[Section], key: str) -> Any:
    """The type of the sections under a key: a tuple of them in the scene."""
    annotation: Any = scene_type.model_fields[key].annotation
    return annotation.__args__[0]


def _of_file(program: Program, file: Path) -> dict[str, Any]:
    """The measuring sections of a TOML file; the other sections of a scene may stand there too."""
    table = scene_file.read(file)
    known = {*program.scene().model_fields, *ALSO}
    wrong = [
        Fault(key, None, "unknown key", repair=nearest(key, program.measured)) for key in table if key not in known
    ]
    if wrong:
        raise InputError(wrong).in_file(str(file))
    found = {key: table[key] for key in program.measured if key in table}
    if not found:
        allowed = ", ".join(f"[[{key}]]" for key in program.measured)
        raise InputError(Fault("sections", None, "has nothing to measure", allowed=allowed, file=str(file)))
    return found
