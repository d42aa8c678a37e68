"""A run in a notebook as the page of `report`: the same JavaScript, which asks the kernel for frames and tables.

Jupyter, VS Code and marimo show it by anywidget (extra "widget").
"""

from __future__ import annotations

import json
from functools import cache
from typing import TYPE_CHECKING, Any

from porescale.common.core.errors import InputError
from porescale.common.core.extras import extra
from porescale.common.watch.growing import Growing
from porescale.common.watch.shell import css, live_script, static
from porescale.common.watch.site import Data

if TYPE_CHECKING:
    from pathlib import Path

    from porescale.common.api.program import Program


def widget(folder: Path, program: Program) -> Any:
    """The page of a run as a widget, kept new while the run is written; InputError where anywidget is not installed."""
    return _type()(Data(Growing(folder, program)))


def esm() -> str:
    """The widget's module: the page's JavaScript with a `render` that asks the kernel."""
    return f"{live_script()}\nconst CSS = {json.dumps(css())};\n{static('widget.js')}"


def answer(data: Data, name: str) -> tuple[dict[str, Any], list[bytes]]:
    """The reply to a question of the page, by name as of a server: {"status"}, and the bytes."""
    try:
        found = data(name.split("/", 1))
    except (InputError, OSError) as error:
        return {"status": 409}, [" ".join(str(error).split()).encode()]
    return ({"status": 404}, [b"nothing here"]) if found is None else ({"status": 200}, [found.body])


@cache
def _type() -> type[Any]:
    """The widget's class; anywidget is imported when one is first made."""

    class RunWidget(extra("anywidget").AnyWidget):  # type: ignore[misc]
        """A run's page in a notebook."""

        _esm = esm()

        def __init__(self, data: Data) -> None:
            super().__init__()
            self._data = data
            self.on_msg(self._answer)

        def _answer(self, _: object, content: dict[str, Any], buffers: object) -> None:
            """Reply to a message of the page."""
            said, parts = answer(self._data, str(content["name"]))
            self.send({"id": content["id"], **said}, parts)

    return RunWidget
