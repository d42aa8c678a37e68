"""`new NAME`: a commented scene to start from."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from porescale.ground.check import Fault, InputError
from porescale.workbench.package import Package


def command(package: Package) -> Callable[..., int]:
    """The `new` command of a package."""

    def new(name: Annotated[Path, Parameter(help="folder to make")], /) -> int:
        """Write a commented scene to start from."""
        file = name / "scene.toml"
        if file.exists() or (name.exists() and not name.is_dir()):
            taken = file if file.exists() else name
            raise InputError(Fault(str(taken), None, "exists already", repair="choose another name or remove it"))
        name.mkdir(parents=True, exist_ok=True)
        with file.open("x", encoding="utf-8") as stream:  # "x": never over a file that came in between
            stream.write(package.template())
        print(f"{file}\nnext: {package.name} check {name}; {package.name} run {name}")
        return 0

    return new
