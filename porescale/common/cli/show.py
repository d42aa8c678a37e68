"""`show RUN`: pictures and a film of a run."""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card


def command(package: Package) -> Callable[..., int]:
    """The `show` command of a package."""

    def show(run: Annotated[Path, Parameter(help="run folder")], /) -> int:
        """Make pictures and a film of a run, finished or not."""
        also = package.also.get(str(read_card(run).get("package")))
        if also is not None:
            _say(also(run))
            return 0
        scene, needed = read_card(run, package.name)["scene"], package.scene().model_fields
        missing = [name for name, field in needed.items() if field.is_required() and name not in scene]
        if missing:
            problem = f"{CARD} is damaged or not that of {package.name} (its scene has no {', '.join(missing)})"
            raise InputError(Fault("run folder", str(run), problem, repair="name another folder"))
        _say(package.show(run))
        return 0

    return show


def _say(paths: Iterable[Path]) -> None:
    for path in paths:
        print(path)
