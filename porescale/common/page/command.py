"""`report RUN`: one page of a run, complete in itself; of several runs, one over the other with their difference."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from porescale.common.api.folders import require_file, require_writable
from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card

LEAST, MOST = 0.5, 5.0
"""MiB of a page: the scripts and texts take a part of it; and what it stays below if nothing is said."""


def command(package: Package) -> Callable[..., int]:
    """The `report` command of a package."""

    def report(
        run: Annotated[Path, Parameter(help="run folder, or the folder of a sweep")],
        /,
        *against: Annotated[Path, Parameter(help="further runs in the same box, to compare with")],
        out: Annotated[Path | None, Parameter(help="file; report.html in the run folder if not given")] = None,
        size: Annotated[
            float | None, Parameter(help=f"MiB to stay below, by coarser cells and fewer frames; {MOST:g} if not given")
        ] = None,
        full: Annotated[bool, Parameter(help="float32 of every cell and snapshot, however large")] = False,
    ) -> int:
        """Write a page of a run or sweep, finished or not, that a browser shows without a network."""
        from porescale.common.api.open_run import open_run
        from porescale.common.page.page import report as write

        folders = [run, *against]
        if not against and is_sweep(run):
            given = {"--size": size} if size is not None else {}
            refuse(given | ({"--full": None} if full else {}))
            print(_of_sweep(package, run, out))
            return 0
        for folder in folders:
            require_own(package, folder)
        most = MOST if size is None else size
        if not most >= LEAST:
            raise InputError(Fault("--size", size, "is out of range", "MiB", f">= {LEAST}"))
        require_page(run, out)
        print(write([open_run(folder, package) for folder in folders], out, full=full, mebibytes=most))
        return 0

    return report


def is_sweep(folder: Path) -> bool:
    """Whether a folder holds no run, but folders with one each."""
    return not (folder / CARD).exists() and folder.is_dir() and any(folder.glob(f"[!.]*/{CARD}"))


def refuse(given: dict[str, float | None]) -> None:
    """InputError where options of the page of a run are ``given`` with a sweep."""
    problem, repair = "is not for the page of a sweep", "leave it out, or name one of its runs"
    if given:
        raise InputError([Fault(key, value, problem, repair=repair) for key, value in given.items()])


def _of_sweep(package: Package, folder: Path, out: Path | None) -> Path:
    """Write the page of a sweep, whose first run tells of which package it is."""
    from porescale.common.watch.sweep_report import write_sweep_report

    require_own(package, min(folder.glob(f"[!.]*/{CARD}")).parent)
    require_page(folder, out)
    return write_sweep_report(folder, package, out)


def require_page(folder: Path, out: Path | None) -> None:
    """InputError unless the page can be written: to ``out``, or into the folder where it is None."""
    from porescale.common.page.page import NAME

    if out is None:
        require_writable(folder, "--out")
    else:
        require_file(out, "--out", str(out / NAME))


def require_own(package: Package, folder: Path) -> None:
    """InputError unless a run of the package lies in ``folder``, or one of its other commands."""
    card = read_card(folder)
    if card.get("package") not in package.also:
        read_card(folder, package.name)
