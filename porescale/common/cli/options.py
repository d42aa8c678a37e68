"""Options that several commands share."""

import json
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from cyclopts import Parameter

from porescale.common.core.errors import Fault, InputError

Scene = Annotated[Path, Parameter(help="TOML file, folder with scene.toml, or name of a case (see `cases`)")]
Quality = Annotated[
    Literal["draft", "standard", "fine"] | None,
    Parameter(help="level of the scene's [quality.…] tables; its quality_default if not given"),
]
Settings = Annotated[
    list[str] | None, Parameter(name="--set", help="section.key=value, over the scene and its quality; repeatable")
]
Threads = Annotated[int | None, Parameter(help="most threads of the kernels; all cores if not given")]
ThreadsOfEach = Annotated[int | None, Parameter(help="threads of the kernels")]
"""Of what runs on one thread if not told otherwise."""
Json = Annotated[bool, Parameter(name="--json", help="print JSON instead of tables")]
List = Annotated[bool, Parameter(name="--list", help="only say which there are")]


def say(text: str) -> None:
    """Write one line of progress to stderr."""
    print(text, file=sys.stderr, flush=True)


def print_json(rows: Iterable[Mapping[str, Any]]) -> None:
    """Print rows as a JSON list."""
    print(json.dumps(list(rows), indent=1, allow_nan=False))


def print_list(rows: Iterable[Mapping[str, Any]], line: str, as_json: bool) -> None:
    """Print what `--list` found: a ``line`` with the keys of a row in braces for each, or all as a JSON list."""
    if as_json:
        print_json(rows)
        return
    for row in rows:
        print(line.format(**row))


def use_threads(count: int | None) -> int:
    """Set the number of kernel threads and give it; InputError when this machine has no such number."""
    from porescale.common.compiled.jit import set_threads

    return set_threads(count)


def each_threads(count: int | None) -> int:
    """The number of threads of each run of many, 1 where none is given; InputError below 1.  Where they run, another
    machine may be, has the last word on how many there are."""
    if count is not None and count < 1:
        raise InputError(Fault("--threads", count, "is out of range", "", ">= 1"))
    return count or 1


def require_scene(given: Path, program: str) -> Path:
    """The scene file that ``given`` leads to: a file, a folder, or the name of a case that ``program`` runs.

    InputError unless it is TOML: raised at once, before the sections of a scene and the compiler that their packages
    register are imported.
    """
    from porescale.common.api.shipped import scene_path
    from porescale.common.schema import scene_file

    file = scene_file.find(scene_path(given, program))
    scene_file.read(file)
    return file
