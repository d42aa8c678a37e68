"""`show RUN`: pictures and a film of a run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from porescale.ground.check import Fault, InputError
from porescale.workbench.commands.run import CARD
from porescale.workbench.package import Package


def command(package: Package) -> Callable[..., int]:
    """The `show` command of a package."""

    def show(run: Annotated[Path, Parameter(help="run folder")], /) -> int:
        """Make pictures and a film of a run, finished or not."""
        if not (run / CARD).is_file():
            repair = f"no {CARD} there; name the folder that `{package.name} run` wrote"
            raise InputError(Fault(str(run), None, "is no run folder", repair=repair))
        for path in package.show(run):
            print(path)
        return 0

    return show
