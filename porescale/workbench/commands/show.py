"""`show RUN`: pictures and a film of a run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from porescale.ground.card import NAME as CARD
from porescale.ground.card import read_card
from porescale.ground.check import Fault, InputError
from porescale.workbench.package import Package


def command(package: Package) -> Callable[..., int]:
    """The `show` command of a package."""

    def show(run: Annotated[Path, Parameter(help="run folder")], /) -> int:
        """Make pictures and a film of a run, finished or not."""
        scene, needed = read_card(run, package.name)["scene"], package.scene().model_fields
        missing = [name for name, field in needed.items() if field.is_required() and name not in scene]
        if missing:
            problem = f"{CARD} is damaged or not that of {package.name} (its scene has no {', '.join(missing)})"
            raise InputError(Fault("run folder", str(run), problem, repair="name another folder"))
        for path in package.show(run):
            print(path)
        return 0

    return show
