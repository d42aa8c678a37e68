"""Pages of the manual that show functions of the source: what stands between two marks is what the source says.

    <!-- porescale/benchmarks/minimal_lbm.py: plain_cells, copy_links -->
    ```python
    …
    ```
    <!-- end -->

`python -m tests.architecture.quotes` puts the functions and classes named in the first mark between the two, anew.
"""

import ast
import re
from pathlib import Path

from tests.architecture.sources import ROOT

PAGES = ROOT / "docs" / "methods"
QUOTE = re.compile(r"<!-- (?P<path>\S+\.py): (?P<names>[\w, ]+) -->\n(?P<text>.*?)<!-- end -->", re.DOTALL)


def quoted(path: Path, names: list[str]) -> str:
    """The source of functions and classes of a file, with their decorators, in the order of ``names``."""
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    found = {it.name: it for it in ast.parse(text).body if isinstance(it, ast.FunctionDef | ast.ClassDef)}
    parts = []
    for name in names:
        node = found[name]
        first = min([node.lineno, *(it.lineno for it in node.decorator_list)])
        parts.append("\n".join(lines[first - 1 : node.end_lineno]))
    return "```python\n" + "\n\n\n".join(parts) + "\n```\n"


def renewed(page: str, root: Path = ROOT) -> str:
    """A page with every quotation as the source has it."""

    def put(match: re.Match[str]) -> str:
        """One quotation, with its marks."""
        names = [it.strip() for it in match["names"].split(",")]
        text = quoted(root / match["path"], names)
        return f"<!-- {match['path']}: {match['names']} -->\n{text}<!-- end -->"

    return QUOTE.sub(put, page)


def main() -> None:
    """Renew every page, and name those that changed."""
    for page in sorted(PAGES.glob("*.md")):
        before = page.read_text(encoding="utf-8")
        after = renewed(before)
        if after != before:
            page.write_text(after, encoding="utf-8")
            print(page.relative_to(ROOT))


if __name__ == "__main__":
    main()
