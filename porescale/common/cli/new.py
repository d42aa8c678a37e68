"""`new NAME`: a commented scene to start from, or a copy of a case."""

import shutil
from collections.abc import Callable
from pathlib import Path
from shlex import quote
from typing import Annotated

from cyclopts import Parameter

from porescale.common.api.folders import unusable
from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError

From = Annotated[str | None, Parameter(name="--from", help="name of a case (see `cases`) to copy instead")]


def command(package: Package) -> Callable[..., int]:
    """The `new` command of a package."""

    def new(name: Annotated[str, Parameter(help="folder to make")], /, *, from_: From = None) -> int:
        """Write a commented scene to start from, or copy a case with the files that it needs."""
        if not name:
            raise InputError(Fault("NAME", name, "is empty", repair="name a folder"))
        folder = Path(name)
        if folder.suffix.lower() == ".toml":
            problem, repair = "names a file", f"name the folder to make: {folder.stem}; scene.toml will be in it"
            raise InputError(Fault("NAME", name, problem, repair=repair))
        try:
            if from_ is not None:
                _copy(package, from_, folder)
                return 0
            _write(folder, package.template())
            _draw(package, folder)
        except OSError as error:
            raise unusable(folder, "NAME", error) from error
        words = quote(str(folder))
        print(f"{folder / 'scene.toml'}\nnext: {package.name} check {words}; {package.name} run {words}")
        return 0

    return new


def _write(folder: Path, text: str) -> None:
    """Write the scene into ``folder``; InputError where there is one."""
    file = folder / "scene.toml"
    if file.exists() or (folder.exists() and not folder.is_dir()):
        _refuse(file if file.exists() else folder)
    folder.mkdir(parents=True, exist_ok=True)
    with file.open("x", encoding="utf-8", newline="\n") as stream:  # "x": never over a file that came in between
        stream.write(text)


def _copy(package: Package, name: str, folder: Path) -> None:
    """Copy what the case needs to run to ``folder``, all of it or nothing; print what is there and what runs it."""
    from porescale.common.api.shipped import LEFT_OUT, cases, nearest_case
    from porescale.common.core.atomic import whole_folder

    case = next((it for it in cases() if it.name == name), None)
    if case is None:
        near = nearest_case(name)
        every = f"`{package.name} cases` lists all"
        repair = f"did you mean {near!r}? {every}" if near else every
        raise InputError(Fault("--from", name, "is no case", repair=repair))
    if folder.exists():
        _refuse(folder)
    with whole_folder(folder) as beside:
        try:
            shutil.copytree(case.path, beside, ignore=shutil.ignore_patterns(*LEFT_OUT), copy_function=shutil.copyfile)
        except shutil.Error as error:  # of every file that failed: source, target, why
            raise OSError(error.args[0][0][2]) from error
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            print(path)
    words = quote(str(folder))
    if case.kind == "script":
        print(f"next: python {quote(str(folder / f'{case.name}.py'))}")
    elif case.kind == "deck":
        print(f"next: porescale demseg run {words}")
    else:
        if case.package == package.name:
            _draw(package, folder)
        print(f"next: {case.package} check {words}; {case.package} run {words}")


def _draw(package: Package, folder: Path) -> None:
    """Draw the scene in ``folder`` into scene.png, where it takes no longer than to look at it; else say what does."""
    from porescale.common.cli.check import draw
    from porescale.common.schema.sections import load

    if not (folder / "scene.toml").is_file():
        return
    scene = load(folder, package.scene())
    if scene.drawn_at_once:
        draw(scene, folder / "scene.png")
    else:
        print(f"see it: {package.name} check {quote(str(folder))} --picture")


def _refuse(taken: Path) -> None:
    """InputError: nothing that is there is written over."""
    raise InputError(Fault(str(taken), None, "exists already", repair="choose another name or remove it"))
