"""Links to folders, as repository pages have them: they lead to the README.md or index.md of the folder."""

import re
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx

LINK = re.compile(r"(?<=\]\()([^()\s#:]+)(?=(#[^()\s]*)?\))")


def with_page(text: str, folder: Path) -> str:
    """The text of a page in ``folder``, each of its links to a folder made one to the folder's page."""

    def page(match: re.Match[str]) -> str:
        """The link itself, or with the page."""
        there = folder / match[1]
        if there.is_dir():
            for name in ("README.md", "index.md"):
                if (there / name).is_file():
                    return f"{match[1].rstrip('/')}/{name}"
        return match[1]

    return LINK.sub(page, text)


def on_read(app: Sphinx, name: str, source: list[str]) -> None:
    """Rewrite a page as it is read."""
    source[0] = with_page(source[0], (Path(app.srcdir) / name).parent)


def setup(app: Sphinx) -> dict[str, Any]:
    """Listen to pages being read."""
    app.connect("source-read", on_read)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
