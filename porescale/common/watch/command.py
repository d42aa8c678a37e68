"""`watch RUN|SWEEP`: the page of a run while it is written, or of the runs of a sweep, in a browser of this machine."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from porescale.common.cli.package import Package
from porescale.common.page.command import require_own


def command(package: Package) -> Callable[..., int]:
    """The `watch` command of a package."""

    def watch(
        folder: Annotated[Path, Parameter(help="run folder, or the folder of a sweep")],
        /,
        *,
        port: Annotated[int, Parameter(help="of 127.0.0.1; one that is free if not given")] = 0,
        wait: Annotated[bool, Parameter(help="for a folder that is not there yet")] = False,
        no_open: Annotated[bool, Parameter(help="only print the link")] = False,
    ) -> int:
        """Show a run in a browser while it is written, or the runs of a sweep; Ctrl-C ends it.

        The page is that of `report`; new frames and rows appear seconds after they are written.  Only this machine can
        open the link, and nothing is written to the folder.
        """
        from porescale.common.watch.serve import watch as serve
        from porescale.common.watch.site import RUN, kind_of

        if kind_of(folder) == RUN:
            require_own(package, folder)
        serve(folder, package, port=port, wait=wait, show=not no_open)
        return 0

    return watch
