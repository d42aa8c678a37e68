"""What notebooks show: small HTML tables, and where widgets are shown."""

import sys
from base64 import b64encode
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

WIDGET = "application/vnd.jupyter.widget-view+json"


@dataclass(frozen=True, repr=False)
class Html:
    """HTML that notebooks display."""

    text: str

    def _repr_html_(self) -> str:
        return self.text


def in_kernel() -> bool:
    """Whether this process is the kernel of a notebook of Jupyter."""
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    return getattr(shell, "kernel", None) is not None


def widget_bundle(widget: Any) -> dict[str, Any]:
    """What Jupyter is given to show a widget."""
    return {WIDGET: {"version_major": 2, "version_minor": 1, "model_id": widget.model_id}}


def data_url(kind: str, content: bytes) -> str:
    """Content that a page holds within itself;  kind : as image/png."""
    return f"data:{kind};base64,{b64encode(content).decode()}"


def html_table(caption: str, head: Sequence[object], rows: Iterable[Sequence[object]]) -> str:
    """A table with a caption above it; every cell is escaped."""
    top = "".join(f"<th>{escape(str(cell))}</th>" for cell in head)
    body = "".join("<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows)
    title = f"<caption style='caption-side:top;text-align:left'>{escape(caption)}</caption>" if caption else ""
    return f"<table>{title}" + (f"<thead><tr>{top}</tr></thead>" if head else "") + f"<tbody>{body}</tbody></table>"
