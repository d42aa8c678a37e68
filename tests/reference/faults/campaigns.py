"""What long campaigns came to: rows of docs/develop/campaigns.json, and the table of them in docs/develop/testing.md.

`nearly` and `killing` add a row with `--record`; one that goes on, or that ends early, has what it came to by then.
`python -m tests.reference.faults.campaigns campaigns.json` adds the rows of another machine's file.
"""

import json
import sys
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from porescale.common.core.atomic import write_text
from porescale.common.evidence.files import json_text, markdown_table
from porescale.common.record.card import mark
from tests.reference.folders import ROOT

DOCS = ROOT / "docs" / "develop"
BEGIN, END = "<!-- campaigns -->", "<!-- end of campaigns -->"
HEADER = ("campaign", "date", "commit", "seed", "tries", "how they ended", "found wrong")


made_at = cache(mark)
"""Date and commit of the campaign: asked for once, since its own record changes the tree."""


def record(campaign: str, seed: int, ends: Mapping[str, int], found: int, docs: Path = DOCS) -> None:
    """Keep what a campaign came to, in place of what the same one (of this commit and seed) came to before."""
    row: dict[str, Any] = {"campaign": campaign, **made_at(), "seed": seed}
    add({**row, "tries": sum(ends.values()), "ends": dict(sorted(ends.items())), "found": found}, docs)


def add(row: Mapping[str, Any], docs: Path = DOCS) -> None:
    """Keep a row in place of that of the same campaign, commit and seed."""
    file = docs / "campaigns.json"
    rows = json.loads(file.read_text(encoding="utf-8")) if file.exists() else []
    same = ("campaign", "commit", "seed")
    rows = [*(it for it in rows if any(it[key] != row[key] for key in same)), row]
    write_text(file, json_text(rows))
    page = docs / "testing.md"
    write_text(page, with_table(page.read_text(encoding="utf-8"), rows))


def with_table(text: str, rows: list[dict[str, Any]]) -> str:
    """A page with the table of these rows between its marks."""
    cells = []
    for row in rows:
        ends = ", ".join(f"{count} {name}" for name, count in row["ends"].items())
        cells.append([row[key] for key in HEADER[:5]] + [ends, row["found"]])
    before, _, rest = text.partition(BEGIN)
    after = rest.partition(END)[2]
    return "\n".join([f"{before}{BEGIN}", "", *markdown_table(HEADER, cells), "", f"{END}{after}"])


if __name__ == "__main__":
    here, there = (
        json.loads(Path(file).read_text(encoding="utf-8")) for file in (DOCS / "campaigns.json", sys.argv[1])
    )
    for one in (row for row in there if row not in here):
        add(one if one["commit"] else one | {"commit": made_at()["commit"]})  # there it was no checkout
