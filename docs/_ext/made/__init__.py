"""Parts of pages that are made from the source when the manual is built, so that they cannot fall behind.

A page has the line ``<!-- made: NAME ARGUMENT -->``; its place is taken by Markdown.
"""

import re
from collections.abc import Callable
from typing import Any

from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

LINE = re.compile(r"^<!-- made: (\w+) ?([^\n]*?) -->$", re.MULTILINE)


def makers() -> dict[str, Callable[[str], str]]:
    """What a page can name, and the function that makes it; imported when first wanted."""
    from docs._ext.made import columns, commands, gallery, messages, names, notebook, scene_keys

    return {
        "scene_keys": scene_keys.page,
        "commands": commands.page,
        "names": names.page,
        "messages": messages.page,
        "columns": columns.page,
        "gallery": gallery.page,
        "notebook": notebook.page,
    }


def filled(text: str) -> str:
    """The text of a page with what is made in its place."""
    if not LINE.search(text):
        return text
    known = makers()
    return LINE.sub(lambda match: known[match[1]](match[2]), text)


def on_read(app: Sphinx, name: str, source: list[str]) -> None:
    """Fill a page as it is read."""
    source[0] = filled(source[0])


def outdated(app: Sphinx, env: BuildEnvironment, *_: Any) -> list[str]:
    """Pages that hold what is made: read at every build."""
    return [name for name in env.found_docs if LINE.search(env.doc2path(name).read_text(encoding="utf-8"))]


def setup(app: Sphinx) -> dict[str, Any]:
    """Listen to pages being read."""
    app.connect("source-read", on_read)
    app.connect("env-get-outdated", outdated)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
