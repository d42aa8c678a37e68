"""`measure RUN SECTIONS`: probes and other instruments, read from the snapshots of a finished run."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from porescale.common.api.folders import require_writable
from porescale.common.cli.package import Package


def command(package: Package) -> Callable[..., int]:
    """The `measure` command of a package."""

    def measure(
        run: Annotated[Path, Parameter(help="run folder")],
        sections: Annotated[Path, Parameter(help="TOML file with the sections to measure; a scene, too")],
        /,
        *,
        out: Annotated[Path | None, Parameter(help="folder of the tables; the run folder if not given")] = None,
    ) -> int:
        """Measure a finished run at its snapshots, as if its scene had had the sections.

        The tables have the names and columns of a run that measures itself; none is replaced.
        """
        from porescale.common.api.measure import register, write_tables
        from porescale.common.api.open_run import open_run

        opened = open_run(run, package)
        opened.require_own()
        folder = run if out is None else out
        require_writable(folder, "--out")
        tables = opened.measure(sections)
        paths = write_tables(tables, folder)
        if out is None:
            register(opened, tables)
        for path in paths:
            print(path)
        return 0

    return measure
