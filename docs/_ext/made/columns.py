"""Every file of a run, and every column of its tables: name, unit, meaning, from where the column is made.

The docstring of the function that makes a row describes its columns, a line each: ``front (m) : foremost edge``.  Words
in capitals stand for what a scene names or counts.
"""

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from docs._ext.docstring import ROOT
from docs._ext.made.text import code, escaped, slug, table

LINE = re.compile(r"^(?P<name>\S.*?) \((?P<unit>[^()]*)\) : (?P<about>.+)$", re.MULTILINE)
COLUMN = re.compile(r"^.* \([^()]*\)$")
_P, _C = "porescale/builders", "continuum_sph/builders"
TABLES: dict[str, dict[str, list[str]]] = {
    "porescale": {
        "series.csv": [
            f"{_P}/simulation.py", f"{_P}/parts/grain_series.py", f"{_P}/parts/flow_series.py",
            f"{_P}/parts/flow_fields.py", f"{_P}/parts/cell.py", f"{_P}/parts/bonds.py", f"{_P}/parts/sleep.py",
            f"{_P}/parts/rectangles.py", f"{_P}/parts/energy.py", "porescale/dem/measures/energy.py",
        ],
        "probes.csv": [f"{_P}/parts/flow_instruments.py:_probe_row", f"{_P}/parts/flow_instruments.py:_mean_row"],
        "flux.csv": [f"{_P}/parts/flow_instruments.py:_flux_row"],
        "loads.csv": [f"{_P}/parts/flow_instruments.py:row", f"{_P}/parts/flow_instruments.py:rectangle_loads"],
        "regions.csv": [f"{_P}/parts/grain_instruments.py:region_row"],
        "forces.csv": [f"{_P}/parts/grain_instruments.py:_forces", f"{_P}/initial/walls.py"],
        "control.csv": [f"{_P}/parts/control.py"],
        "rock.csv": [f"{_P}/parts/rock.py"],
        "permeability.csv": ["porescale/analysis/bed_permeability.py"],
        "lines.csv": ["porescale/output/lines.py"],
        "profile.csv": ["porescale/output/surface.py"],
        "breaks.csv": ["porescale/output/breaks.py"],
        "packing.csv": ["porescale/dem/prepare/compaction.py"],
    },
    "continuum_sph": {
        "series.csv": [
            f"{_C}/simulation.py", f"{_C}/parts/water.py", f"{_C}/parts/soil.py", f"{_C}/parts/mixture.py:row",
            f"{_C}/parts/reservoirs.py", f"{_C}/parts/faces.py",
            f"{_C}/parts/sheet_pile.py", f"{_C}/parts/suction.py", f"{_C}/parts/air.py",
            f"{_C}/parts/inclusion.py",
        ],
        "probes.csv": [f"{_C}/parts/instruments.py:probe_row", f"{_C}/parts/instruments.py:mean_row"],
        "levels.csv": [f"{_C}/parts/instruments.py:level_row", f"{_C}/parts/mixture.py:tables"],
        "phreatic.csv": [f"{_C}/parts/phreatic.py"],
    },
}  # fmt: skip
"""The tables of a run, and the files, or functions in them, whose docstrings describe their columns."""
ABOUT = {
    "series.csv": "a row every `output.series_interval`; the columns of what the scene has",
    "probes.csv": "one set for each `[[probe]]`, with the rows of series.csv",
    "flux.csv": "one set for each `[[flux]]`, with the rows of series.csv",
    "loads.csv": "one set for each body that `[loads]` names, with the rows of series.csv",
    "regions.csv": "one set for each `[[region]]`: the region's name stands before the column's",
    "forces.csv": "with `output.forces`: a set for each wall, plate, rectangle and held disc",
    "control.csv": "a set for each body whose `[[control]]` or container records",
    "rock.csv": "of `[rock]`, with the rows of series.csv",
    "permeability.csv": "of `[permeability]`: a row each for the first and the last snapshot",
    "lines.csv": "of each `[[line]]`: a row for each point of each snapshot",
    "profile.csv": "a row for each snapshot",
    "breaks.csv": "a row for each bond that broke, by time",
    "packing.csv": "grains and held discs of the last snapshot, a row each; another scene can read it",
    "levels.csv": "one set for each `[[level]]`, with the rows of series.csv",
    "phreatic.csv": "of soil with water, with the rows of series.csv",
}
"""When a table is written, and what its rows are."""
COMMON = {
    "card.json": "the whole scene with its defaults, versions, commit, machine, threads and seeds",
    "checkpoint.h5": "the state; `--resume` goes on from it",
    "montage.png, final.png": "pictures of the run",
    "film.mp4": "a film of the run",
}
"""Files of a run of either package."""
FILES = {
    "porescale": {
    "fields.vtkhdf": "snapshots of the fluid in cells: velocity, pressure, solid fraction, what `output.fields` asks",
    "grains.vtkhdf": "snapshots of the grains as points",
    "frames.vtkhdf": "snapshots of polygons and segments",
    "bonds.vtkhdf": "snapshots of bonds as lines",
    "grain_fields.vtkhdf": "snapshots of the fields of `[coarse_graining]`",
    "contacts.vtkhdf": "snapshots of contacts, where the scene records them",
    "streamlines.png": "the flow of the last snapshot",
    "chains.png, coordination.png, rose.png, chains.vtp": "pictures of contacts, where the scene records them",
    "rock.png": "stress over strain of `[rock]`",
    },
    "continuum_sph": {
    "particles.vtkhdf": "snapshots of all particles",
    "water.vtkhdf, soil.vtkhdf": "snapshots of each, where soil and water are there together",
    },
}  # fmt: skip
"""Further files of a run of each package, and when they are there."""


@dataclass(frozen=True)
class Column:
    """A column as its docstring describes it."""

    name: str
    unit: str
    about: str

    @property
    def pattern(self) -> re.Pattern[str]:
        """What the column is called in a run: words in capitals stand for anything."""
        words = re.split(r"\b[A-Z]+\b", self.name)
        return re.compile("(.+)".join(map(re.escape, words)) + re.escape(f" ({self.unit})"))


@cache
def functions(path: Path) -> list[tuple[str, str]]:
    """Functions of a file whose docstrings describe columns: names, docstrings."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    found = [(it.name, ast.get_docstring(it) or "") for it in ast.walk(tree) if isinstance(it, ast.FunctionDef)]
    return [(name, doc) for name, doc in found if LINE.search(doc)]


def named(node: ast.AST, words: Mapping[str, Any]) -> Iterator[str]:
    """Names of columns in the keys of tables below a node; a null character stands for what a run fills in.

    words : constants of the file, by name.
    """
    for it in ast.walk(node):
        keys: list[ast.expr | None] = []
        if isinstance(it, ast.Dict):
            keys = list(it.keys)
        elif isinstance(it, ast.DictComp):
            keys = [it.key]
        elif isinstance(it, ast.Assign):
            keys = [target.slice for target in it.targets if isinstance(target, ast.Subscript)]
        for key in keys:
            if isinstance(key, ast.Constant) and isinstance(key.value, str) and COLUMN.match(key.value):
                yield key.value
            elif isinstance(key, ast.JoinedStr):
                text = "".join(str(p.value) if isinstance(p, ast.Constant) else str(
                    words.get(ast.unparse(p.value), "\0")) for p in key.values)  # fmt: skip
                if COLUMN.match(text):
                    yield text


def columns(package: str, name: str) -> list[Column]:
    """The described columns of a table of a run."""
    found = []
    for place in TABLES[package][name]:
        path, _, function = place.partition(":")
        for key, doc in functions(ROOT / path):
            if function in ("", key):
                found += [Column(it["name"], it["unit"], it["about"]) for it in LINE.finditer(doc)]
    return list(dict.fromkeys(found))


def undescribed() -> list[str]:
    """Columns that the source of a table names and no docstring of that file describes."""
    found = []
    for tables in TABLES.values():
        for places in tables.values():
            for path in {ROOT / place.partition(":")[0] for place in places}:
                docs = "\n".join(doc for _, doc in functions(path))
                known = [Column(it["name"], it["unit"], it["about"]) for it in LINE.finditer(docs)]
                tree = ast.parse(path.read_text(encoding="utf-8"))
                words = {it.targets[0].id: it.value.value for it in tree.body if isinstance(it, ast.Assign)
                         and isinstance(it.targets[0], ast.Name) and isinstance(it.value, ast.Constant)}  # fmt: skip
                found += [f"{path.relative_to(ROOT)}: {it}" for it in named(tree, words) if not is_known(it, known)]
    return sorted(set(found))


def is_known(text: str, known: list[Column]) -> bool:
    """Whether a column is described; a null character stands for what a run fills in."""
    return (
        text == "time (s)"
        or text.endswith(" (\0)")
        or any(it.pattern.fullmatch(text.replace("\0", "X")) for it in known)
    )


def page(package: str) -> str:
    """All tables and files of a run of a package."""
    made = []
    tables = TABLES[package]
    rows = [(f"[{code(name)}](#{slug(f'{package} {name}')})", escaped(ABOUT[name])) for name in tables]
    rows += [
        (", ".join(map(code, name.split(", "))), escaped(about)) for name, about in (COMMON | FILES[package]).items()
    ]
    made.append(table(("file", "holds"), rows))
    for name in tables:
        made.append(f"({slug(f'{package} {name}')})=\n## {name}\n\n{escaped(ABOUT[name])[0].upper()}"
                    f"{escaped(ABOUT[name])[1:]}.\n")  # fmt: skip
        lines = columns(package, name)
        if not any(it.name == "time" for it in lines) and name != "packing.csv":
            lines = [Column("time", "s", "time of the row, since the start"), *lines]
        cells = [(code(f"{it.name} ({it.unit})"), escaped(it.unit or "-"), escaped(it.about)) for it in lines]
        made.append(table(("column", "unit", "meaning"), cells))
    return "\n".join(made)
