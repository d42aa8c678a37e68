"""The pages that are served: that of `report` with a source that asks the server, those of a sweep and of nothing."""

from __future__ import annotations

from functools import cache
from html import escape

from porescale.common.page.page import script
from porescale.common.page.scripts import filled, joined
from porescale.common.page.scripts import static as of_report

START = {
    "run": "await follow(page, new Remote(ask));",
    "point": 'await follow(page, new Remote(ask), { back: "../../" });',
    "sweep": "await openSweep(page, page.dataset.title);",
    "nothing": 'page.textContent = "Nothing is written here yet. This page shows the run as soon as it begins.";\n'
    'await again(async () => JSON.parse(new TextDecoder().decode(await ask("kind"))) !== "nothing", () => {});\n'
    "location.reload();",
}
"""What each kind of page does when it is open."""


def shell(kind: str, title: str) -> str:
    """The page of a "run", a "point" of a sweep, a "sweep" or "nothing"."""
    parts = {"title": escape(title), "css": css(), "script": live_script(), "start": START[kind]}
    return filled(static("live.html"), parts)


@cache
def live_script() -> str:
    """The JavaScript of `report`, and of what keeps its page new, as one module without exports."""
    return "\n".join([script(), joined([static("live.js"), static("sweep.js")])])


@cache
def css() -> str:
    """The styles of `report`, and of what this adds."""
    return of_report("page.css") + static("live.css")


def static(name: str) -> str:
    """The text of a file of these pages."""
    return of_report(name, "porescale.common.watch")
