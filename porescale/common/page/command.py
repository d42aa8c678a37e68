"""`report RUN`: one page of a run, complete in itself; of several runs, one over the other with their difference."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from porescale.common.api.folders import require_writable
from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError
from porescale.common.record.read_card import NAME as CARD
from porescale.common.record.read_card import read_card

LEAST = 0.5
"""MiB: the scripts and texts take a part of it."""


def command(package: Package) -> Callable[..., int]:
    """The `report` command of a package."""

    def report(
        run: Annotated[Path, Parameter(help="run folder, or the folder of a sweep")],
        /,
        *against: Annotated[Path, Parameter(help="further runs in the same box, to compare with")],
        out: Annotated[Path | None, Parameter(help="file; report.html in the run folder if not given")] = None,
        size: Annotated[float, Parameter(help="MiB to stay below, by coarser cells and fewer frames")] = 5.0,
        full: Annotated[bool, Parameter(help="float32 of every cell and snapshot, however large")] = False,
    ) -> int:
        """Write a page of a run or sweep, finished or not, that a browser shows without a network."""
        from porescale.common.api.open_run import open_run
        from porescale.common.page.page import report as write

        folders = [run, *against]
        if not against and is_sweep(run):
            print(_of_sweep(package, run, out))
            return 0
        for folder in folders:
            require_own(package, folder)
        if not size >= LEAST:
            raise InputError(Fault("--size", size, "is out of range", "MiB", f">= {LEAST}"))
        require_file(run, out)
        print(write([open_run(folder, package) for folder in folders], out, full=full, mebibytes=size))
        return 0

    return report


def is_sweep(folder: Path) -> bool:
    """Whether a folder holds no run, but folders with one each."""
    return not (folder / CARD).exists() and folder.is_dir() and any(folder.glob(f"[!.]*/{CARD}"))


def _of_sweep(package: Package, folder: Path, out: Path | None) -> Path:
    """Write the page of a sweep."""
    from porescale.common.watch.sweep_report import write_sweep_report

    require_file(folder, out)
    return write_sweep_report(folder, package, out)


def require_file(folder: Path, out: Path | None) -> None:
    """InputError unless the page can be written: to ``out``, or into the folder where it is None."""
    from porescale.common.page.page import NAME

    if out is not None and out.is_dir():
        raise InputError(Fault("--out", str(out), "is a folder", repair=f"name a file, as {out / NAME}"))
    require_writable(folder if out is None else out.parent, "--out")


def require_own(package: Package, folder: Path) -> None:
    """InputError unless a run of the package lies in ``folder``, or one of its other commands."""
    card = read_card(folder)
    if card.get("package") not in package.also:
        read_card(folder, package.name)
