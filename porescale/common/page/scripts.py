"""Files of pages, and JavaScript put together without a build step."""

import re
from collections.abc import Iterable, Mapping
from functools import cache
from importlib.resources import files


@cache
def static(name: str, package: str = "porescale.common.page") -> str:
    """The text of a file of the folder ``static`` of a package."""
    return files(package).joinpath("static", name).read_text(encoding="utf-8")


def filled(text: str, parts: Mapping[str, str]) -> str:
    """A page with each {{name}} of its ``text`` replaced by the part of that name; KeyError for one without."""
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], text)


def joined(texts: Iterable[str]) -> str:
    """Files, each after those that it imports, as one module: imports between them left out, exports kept as names."""
    text = re.sub(r"^import [^;]*? from \"\./[^;]*;\n", "", "\n".join(texts), flags=re.MULTILINE)
    return re.sub(r"^export (?=(async )?(function|class|const))", "", text, flags=re.MULTILINE)
