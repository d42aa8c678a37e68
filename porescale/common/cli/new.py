"""`new NAME`: a commented scene to start from."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from porescale.common.cli.folders import unusable
from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError


def command(package: Package) -> Callable[..., int]:
    """The `new` command of a package."""

    def new(name: Annotated[str, Parameter(help="folder to make")], /) -> int:
        """Write a commented scene to start from."""
        if not name:
            raise InputError(Fault("NAME", name, "is empty", repair="name a folder"))
        folder = Path(name)
        file = folder / "scene.toml"
        try:
            if file.exists() or (folder.exists() and not folder.is_dir()):
                taken = file if file.exists() else folder
                raise InputError(Fault(str(taken), None, "exists already", repair="choose another name or remove it"))
            folder.mkdir(parents=True, exist_ok=True)
            with file.open("x", encoding="utf-8") as stream:  # "x": never over a file that came in between
                stream.write(package.template())
        except OSError as error:
            raise unusable(folder, "NAME", error) from error
        print(f"{file}\nnext: {package.name} check {folder}; {package.name} run {folder}")
        return 0

    return new
