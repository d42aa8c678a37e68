"""`report`: one page of one run or more, complete in itself."""

from __future__ import annotations

import json
import zlib
from base64 import b64encode
from collections.abc import Iterator, Sequence
from functools import cache
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from porescale.common.core.atomic import write_bytes
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.picked import every_so_many, spread
from porescale.common.page.frames import pack
from porescale.common.page.meta import meta
from porescale.common.page.quantise import Precision
from porescale.common.page.scripts import filled, joined, static
from porescale.common.page.tables import table
from porescale.common.record.card import FINISHED, plain

if TYPE_CHECKING:
    from porescale.common.api.open_run import Run
    from porescale.common.api.program import Program
    from porescale.common.record.model import Snapshot

NAME = "report.html"
MEBIBYTES = 5.0
"""Largest page, if frames can be held coarsely enough."""
SCRIPTS = ("source.js", "values.js", "colours.js", "raster.js", "flow.js", "draw.js", "charts.js", "controls.js",
           "view.js", "player.js", "profile.js", "panels.js", "report.js")  # fmt: skip
"""Files of static, each after those that it imports."""
LADDER = (Precision(16), Precision(8), Precision(8, 2), Precision(8, 3), Precision(8, 4),
          *(Precision(8, 4, thin) for thin in (2, 4, 8, 16, 32, 64, 128)))  # fmt: skip
"""Ever coarser ways to hold a run."""
PROBED = 3
"""Frames whose size tells that of all."""
BASE64 = 4 / 3


def report(runs: Sequence[Run], path: Path | None = None, *, full: bool = False, mebibytes: float = MEBIBYTES) -> Path:
    """Write the page of ``runs``, whole, to ``path`` (None: report.html in the folder of the first); returns its path.

    full : float32 of every cell and snapshot, however large;  mebibytes : size to stay below, as far as coarser cells
    and fewer frames can.  InputError where there is no snapshot and no table, and where the boxes of runs differ.
    """
    require_alike(runs)
    share = mebibytes / len(runs)
    entries = [list(_entries(run, Precision(full=True) if full else fitting(run, share))) for run in runs]
    target = runs[0].folder / NAME if path is None else Path(path)
    title = " and ".join(str(run.card["scene"].get("title") or run.name) for run in runs)
    write_bytes(target, page(title, entries).encode())
    return target


def write_report(folder: Path, program: Program) -> Path:
    """Write the page of the run in ``folder`` into it, as at a run's end; returns its path."""
    from porescale.common.api.open_run import open_run

    run = open_run(folder, program)
    run.card["outcome"] = FINISHED  # the card says so once the page, the last of its files, is there
    return report([run])


def require_alike(runs: Sequence[Run]) -> None:
    """InputError unless the runs can be shown in one box."""
    for run in runs:
        if not run.tables:
            run.require_snapshots()
    first = runs[0]
    for run in runs[1:]:
        if run.card.get("package") != first.card.get("package"):
            problem = f"is a run of {run.card.get('package')}, {first.folder} one of {first.card.get('package')}"
            raise InputError(Fault("run folder", str(run.folder), problem, repair="report on each by itself"))
        one, other = (_box(each) for each in (first, run))
        if one is not None and other is not None and not np.allclose(one, other, rtol=1e-6, atol=0.0):
            problem = f"its box ({_size(other)}) is not that of {first.folder} ({_size(one)})"
            raise InputError(Fault("run folder", str(run.folder), problem, repair="report on each by itself"))


def _box(run: Run) -> tuple[float, float] | None:
    """Width and height of the box, m."""
    box = run.program.look(run).whole
    return None if box is None else (box[1] - box[0], box[3] - box[2])


def _size(box: tuple[float, float]) -> str:
    return f"{box[0]:.6g} x {box[1]:.6g} m"


def fitting(run: Run, mebibytes: float) -> Precision:
    """The finest of LADDER with which the run's frames take no more than about ``mebibytes``; the last if none does."""
    if not len(run):
        return LADDER[0]
    room = 0.9 * mebibytes * 2**20 - 200_000.0  # the scripts, the tables and the texts
    look, probed = run.program.look(run), list(run.snapshots(None, spread(len(run), PROBED)))
    for precision in LADDER:
        packs = (pack(it, look, precision, probed[0] if k else None) for k, it in enumerate(probed))
        sizes = [len(_packed(content)) for content in packs]
        if BASE64 * float(np.mean(sizes)) * len(every_so_many(len(run), precision.thin)) <= room:
            return precision
    return LADDER[-1]


def _packed(content: bytes) -> bytes:
    return zlib.compress(content, 6)


def _entries(run: Run, precision: Precision) -> Iterator[tuple[str, bytes]]:
    """Names and deflated contents of what a page holds of a run: frames, tables, and then "meta"."""
    errors: dict[str, float] = {}
    look = run.program.look(run)
    first: Snapshot | None = None
    for i, snapshot in enumerate(run.snapshots(None, every_so_many(len(run), precision.thin))):
        content = pack(snapshot, look, precision, first)
        first = first or snapshot
        _largest(errors, content)
        yield f"frame {i}", _packed(content)
    about = meta(run, precision) | {"errors": errors}
    for name in about["tables"]:
        yield f"table {name}", _packed(compact(table(run, name)).encode())
    yield "meta", _packed(compact(plain(about)).encode(errors="backslashreplace"))


def _largest(errors: dict[str, float], content: bytes) -> None:
    """Take the errors of a frame into the largest of all, by "grid or cloud / array"."""
    head = json.loads(content[4 : 4 + int.from_bytes(content[:4], "little")])
    for blocks in (head["grids"], head["clouds"]):
        for name, block in blocks.items():
            for array, spec in block["arrays"].items():
                key = f"{name}/{array}"
                errors[key] = max(errors.get(key, 0.0), spec.get("error", 0.0))


def compact(value: Any) -> str:
    """``value`` as JSON that browsers read, without a space; ValueError for a number that is none."""
    return json.dumps(value, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def page(title: str, runs: Sequence[Sequence[tuple[str, bytes]]]) -> str:
    """The text of the page that holds ``runs``, each names and deflated contents, in base64 one after the other."""
    index: list[dict[str, tuple[int, int]]] = []
    texts: list[str] = []
    at = 0
    for entries in runs:
        places = {}
        for name, content in entries:
            texts.append(b64encode(content).decode())
            places[name] = (at, len(texts[-1]))
            at += len(texts[-1])
        index.append(places)
    parts = {"title": escape(title), "css": static("page.css"), "script": script(), "data": "".join(texts),
             "index": json.dumps(index).replace("<", "\\u003c")}  # fmt: skip
    return filled(static("page.html"), parts)


@cache
def script() -> str:
    """All of static's JavaScript as one module."""
    return joined(static(name) for name in SCRIPTS)
