"""`report` of a sweep: the page of its points and ensembles as it stands, complete in itself."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from porescale.common.core.atomic import write_bytes
from porescale.common.core.errors import InputError
from porescale.common.core.html import data_url
from porescale.common.page.page import NAME, compact
from porescale.common.page.scripts import filled
from porescale.common.page.tables import table
from porescale.common.record.card import plain
from porescale.common.watch.shell import css, live_script, static
from porescale.common.watch.sweep import Points

if TYPE_CHECKING:
    from porescale.common.api.program import Program


def write_sweep_report(folder: Path, program: Program, path: Path | None = None) -> Path:
    """Write the page of the sweep in ``folder``, whole, to ``path`` (None: report.html there); returns its path.

    Points that have a page of their own are linked to, where it lies.
    """
    target = folder / NAME if path is None else path
    text = compact(plain(_data(Points(folder, program), target)))
    start = (
        f"const data = {text.replace('<', chr(92) + 'u003c')};\nawait openSweep(page, page.dataset.title, held(data));"
    )
    parts = {"title": escape(folder.resolve().name), "css": css(), "script": live_script(), "start": start}
    write_bytes(target, filled(static("live.html"), parts).encode())
    return target


def _data(points: Points, target: Path) -> dict[str, Any]:
    """What the page asks for: answers by name as a server gives them, pages and pictures of points by their names."""
    rows = points.rows()
    answers: dict[str, Any] = {"points": rows, "ensembles": points.ensembles()}
    pages, pictures = {}, {}
    for row in rows:
        name = row["name"]
        if "series" in ((row["state"] or {}).get("tables") or {}):
            growing = points.run(name)
            try:
                found = None if growing is None else table(growing.run(), "series")
            except (InputError, OSError):
                found = None
            answers[f"run/{quote(name, safe=SAFE)}/table/series"] = found or {"data": []}
        own = points.folder / name / NAME
        if own.is_file():
            pages[name] = _link(own, target)
        picture = points.picture(name) if row["picture"] else None
        row["picture"] = picture is not None
        if picture:
            pictures[name] = data_url("image/png", picture)
    for one in answers["ensembles"]:
        answers[f"band/{quote(one['name'], safe=SAFE)}"] = points.band(one["name"])
    return {"json": answers, "pages": pages, "pictures": pictures}


SAFE = "!~*'()"
"""What the page leaves as it is in a name (encodeURIComponent), besides letters, digits and _.-~."""


def _link(page: Path, target: Path) -> str:
    """A relative link from one page to another, where there is one."""
    from os.path import relpath

    return quote(Path(relpath(page.resolve(), target.resolve().parent)).as_posix())
