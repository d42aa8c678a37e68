"""`study trade` and `levels SCENE`, `study stability [FLOW…]`: where it stays stable and is right, `study extremes`."""

import json as json_text
import sys
import time
from collections.abc import Callable
from dataclasses import asdict
from typing import Annotated

from cyclopts import App, Parameter

from porescale.common.cli import endurance, levels, parts, trade
from porescale.common.cli.folders import study_folder
from porescale.common.cli.options import Json, Threads, use_threads
from porescale.common.cli.package import Package


def command(package: Package) -> App:
    """The `study` command of a package, with a command for each kind of study."""
    app = App(name="study", help="Measure what accuracy costs, and where it can be trusted.")
    app.command(trade.command(package))
    app.command(levels.command(package))
    if package.stability is not None:
        app.command(_stability(package))
    if package.extremes is not None:
        app.command(_extremes(package))
    if package.endurance is not None:
        app.command(endurance.command(package))
    if package.parts is not None:
        app.command(parts.command(package))
    return app


def _extremes(package: Package) -> Callable[..., int]:
    """The `study extremes` command."""

    def extremes(
        *names: Annotated[str, Parameter(help="what is varied; all if not given")],
        out: Annotated[str, Parameter(help="folder of extremes.json, .md and .png")] = "runs/extremes",
        list_: Annotated[bool, Parameter(name="--list", help="only say what is varied")] = False,
        threads: Threads = 1,
        json: Json = False,
    ) -> int:
        """Try more and more extreme input: what is stable, what is refused before it starts, what is stopped, and
        why."""
        from porescale.common.evidence import extremes as made

        assert package.extremes is not None
        tries = package.extremes().chosen(names)
        if list_:
            print("\n".join(dict.fromkeys(it.axis for it in tries)))
            return 0
        folder = study_folder(out)
        use_threads(threads)
        rows = []
        for it in tries:
            rows.append(it.tried())
            print(f"{it.axis} {it.value}: {rows[-1].end} ({len(rows)} of {len(tries)})", file=sys.stderr, flush=True)
        asked = " ".join(["study extremes", *(json_text.dumps(name) for name in names)])
        made.write(folder, f"{package.name} {asked}", rows)
        if json:
            print(json_text.dumps([asdict(row) for row in rows], indent=1, allow_nan=False))
        else:
            print(f"{len(rows)} tries; {folder / made.NAME}.md, .png")
        return 0

    return extremes


def _stability(package: Package) -> Callable[..., int]:
    """The `study stability` command."""

    def stability(
        *names: Annotated[str, Parameter(help="flows, or rooms for all of theirs; all if not given")],
        out: Annotated[str, Parameter(help="folder of stability.json, .csv, .md and .png")] = "runs/stability",
        quick: Annotated[bool, Parameter(help="few laws at few values: seconds")] = False,
        list_: Annotated[bool, Parameter(name="--list", help="only say which flows there are")] = False,
        threads: Threads = 1,
        json: Json = False,
    ) -> int:
        """Map where each law stays stable and where it is right, over flows that go from mild to extreme."""
        from porescale.common.evidence import stability_files as study_files

        assert package.stability is not None
        flows = package.stability().chosen(names)
        if list_:
            print("\n".join(f"{flow.name}: {flow.title}" for flow in flows))
            return 0
        folder = study_folder(out)
        use_threads(threads)
        rows, start, done = [], time.perf_counter(), 0
        total = sum(flow.count(quick) for flow in flows)
        for flow in flows:
            for law in flow.laws(quick):
                for y in flow.y.chosen(quick):
                    rows += flow.run(law, y, quick)
                    done += 1
                spent = time.perf_counter() - start
                left = f"{done} of {total}, about {spent / done * (total - done):.0f} s left"
                print(f"{flow.name}: {law} ({left})", file=sys.stderr, flush=True)
        asked = " ".join(["study stability", *names, *(["--quick"] if quick else [])])
        study_files.write(folder, f"{package.name} {asked}", package.version, flows, rows, quick)
        if json:
            print(json_text.dumps([row.as_dict() for row in rows], indent=1, allow_nan=False))
        else:
            print(f"{len(rows)} tries in {time.perf_counter() - start:.0f} s; {folder / study_files.NAME}.md, .png")
        return 0

    return stability
