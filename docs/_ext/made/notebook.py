"""A notebook of docs/notebooks as a page: its text, its code, and what it showed when it was last run."""

import json
import re
from typing import Any

from docs._ext.docstring import ROOT

WIDEST = 4000
"""Characters of printed output that are shown."""


def joined(text: Any) -> str:
    """Lines of a notebook file as one text."""
    return "".join(text) if isinstance(text, list) else str(text)


def fenced(text: str, kind: str) -> str:
    """A fence around text that holds none as long."""
    fence = "`" * max(3, *(len(it) + 1 for it in re.findall(r"`{3,}", text)), 3)
    return f"{fence}{kind}\n{text.rstrip()}\n{fence}\n"


def shown(output: dict[str, Any]) -> str:
    """One output of a cell: HTML, a picture, or text."""
    if output["output_type"] == "stream":
        return fenced(joined(output["text"])[:WIDEST], "text")
    data = output.get("data", {})
    if "text/html" in data:
        html = re.sub(r"\n\s*\n", "\n", joined(data["text/html"]))
        return fenced(f'<div class="output">{html}</div>', "{raw} html")
    if "image/png" in data:
        image = joined(data["image/png"]).replace("\n", "")
        return fenced(f'<div class="output"><img alt="" src="data:image/png;base64,{image}"></div>', "{raw} html")
    return fenced(joined(data.get("text/plain", ""))[:WIDEST], "text")


def page(name: str) -> str:
    """The cells of a notebook, its first heading left to the page that names it."""
    book = json.loads((ROOT / "docs" / "notebooks" / f"{name}.ipynb").read_text(encoding="utf-8"))
    made = []
    for cell in book["cells"]:
        text = joined(cell["source"])
        if cell["cell_type"] == "markdown":
            made.append(re.sub(r"^# .*\n?", "", text, count=1) if not made else text)
        elif cell["cell_type"] == "code":
            made.append(fenced(text, "python"))
            made += [shown(it) for it in cell.get("outputs", ())]
    return "\n\n".join(made)
