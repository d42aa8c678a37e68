"""What a page says of a run besides its numbers: verdicts, what `check` said, the command that makes it again."""

from __future__ import annotations

import math
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

from porescale.common.core.errors import InputError, PorescaleError
from porescale.common.record.card import RUNNING
from porescale.common.record.read_card import scene_folder
from porescale.common.studies.quantities import measured
from porescale.common.studies.sweep import expected

if TYPE_CHECKING:
    from porescale.common.api.open_run import Run


def verdicts(run: Run) -> dict[str, Any]:
    """{"note", "rows": [{"name", "value", "expected", "tolerance", "unit", "because", "passed"}]} of expected.toml
    beside the run's scene; no rows where there is none, and why."""
    if run.outcome == RUNNING:
        return {"note": "What is expected is for the end of the run, which is running.", "rows": []}
    file = run.card.get("scene_file")
    if not file or not Path(file).parent.is_dir():
        return {"note": "The scene's folder is not known: no expected.toml was looked for.", "rows": []}
    try:
        rows = [row for row in expected(Path(file)) if "value" in row and "tolerance" in row]
    except InputError as error:
        return {"note": f"expected.toml cannot be read: {error.faults[0].line()}", "rows": []}
    if not rows:
        return {"note": "There is no expected.toml beside the scene.", "rows": []}
    changed = run.card.get("settings") or []
    note = f"The run was made with other settings than the bands are for: {', '.join(changed)}." if changed else ""
    return {"note": note, "rows": [_verdict(run, row) for row in rows]}


def _verdict(run: Run, row: dict[str, Any]) -> dict[str, Any]:
    """A row with the number that the run has; none where it lacks the table or column."""
    found: dict[str, Any] = {"name": row["name"], "expected": row["value"], "tolerance": row["tolerance"],
                             "unit": row.get("unit", ""), "because": row.get("because", "")}  # fmt: skip
    try:
        value = measured(run.table(row["file"]) if "file" in row else run.series, row)
    except (KeyError, IndexError, ValueError, InputError):
        return found | {"value": None, "passed": None}
    passed = bool(abs(value - row["value"]) <= row["tolerance"])
    return found | {"value": value if math.isfinite(value) else None, "passed": passed}


def check(run: Run) -> dict[str, Any]:
    """What `check` says of the run's scene, as `Report.as_dict`; "note" in place of it where it cannot."""
    from porescale.common.schema.sections import validate

    if "deck" in run.card["scene"]:
        return {"note": "A deck has no check."}
    try:
        scene = validate(run.program.scene(), run.card["scene"], folder=scene_folder(run.card))
        return run.program.report(scene).as_dict()
    except (PorescaleError, OSError) as error:
        return {"note": f"The scene on the card cannot be checked today: {' '.join(str(error).split())}"}


def again(run: Run) -> str:
    """The command that makes the run again, as far as the card tells."""
    card = run.card
    if not card.get("scene_file"):
        return " ".join(shlex.quote(str(word)) for word in card.get("command") or ())
    words = [str(card.get("package", run.program.name)), "run", str(card["scene_file"])]
    words += ["--quality", str(card["quality"])] if card.get("quality") else []
    for setting in card.get("settings") or ():
        words += ["--set", str(setting)]
    return shlex.join(words)
