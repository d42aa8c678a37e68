"""`study …`: what accuracy costs (trade, levels), where to trust it (stability, extremes, convergence, endurance), and
parts."""

import itertools
import json as json_text
import time
from collections.abc import Callable
from dataclasses import asdict
from typing import Annotated

from cyclopts import App, Parameter

from porescale.common.api.folders import output_folder
from porescale.common.cli import trade
from porescale.common.cli.options import (
    Json,
    List,
    Scene,
    ThreadsOfEach,
    print_json,
    print_list,
    require_scene,
    say,
    use_threads,
)
from porescale.common.cli.package import Package
from porescale.common.cli.trade import circumstances
from porescale.common.core.errors import Fault, InputError


def command(package: Package) -> App:
    """The `study` command of a package, with a command for each kind of study that it has."""
    app = App(name="study", help="Measure what accuracy costs, and where it can be trusted.")
    app.command(trade.command(package))
    app.command(_levels(package))
    offered = {_stability: package.stability, _extremes: package.extremes, _convergence: package.convergence,
               _endurance: package.endurance, _parts: package.parts}  # fmt: skip
    for study, register in offered.items():
        if register is not None:
            app.command(study(package))
    return app


def _command_line(package: Package, study: str, names: tuple[str, ...], *more: str) -> str:
    """The words that run a study of these names again."""
    return " ".join([package.name, "study", study, *map(json_text.dumps, names), *more])


def _levels(package: Package) -> Callable[..., int]:
    """The `study levels` command."""

    def levels(scene: Scene, /) -> int:
        """Pick draft, standard and fine from the scene's front, and fail where its levels are something else.

        Draft is the cheapest point whose error is allowed, standard the most accurate, fine the reference.
        """
        from porescale.common.studies.levels import APART, apart, compared

        rows = compared(package, require_scene(scene, package.name))
        print("\n".join(row.line() for row in rows))
        near = apart(rows) < APART
        print(f"fine costs {apart(rows):.3g} times a draft" + (f", less than {APART:g} times" if near else ""))
        return 1 if near or any(row.wrong for row in rows) else 0

    return levels


def _extremes(package: Package) -> Callable[..., int]:
    """The `study extremes` command."""

    def extremes(
        *names: Annotated[str, Parameter(help="what is varied; all if not given")],
        out: Annotated[str, Parameter(help="folder of extremes.json, .md and .png")] = "runs/extremes",
        list_: List = False,
        threads: ThreadsOfEach = 1,
        json: Json = False,
    ) -> int:
        """Try more and more extreme input: what is stable, what is refused before it starts, what is stopped, and
        why.

        The files are written after each axis.
        """
        from porescale.common.evidence import extremes as study

        assert package.extremes is not None
        tries = package.extremes().chosen(names)
        if list_:
            print_list(({"name": axis} for axis in dict.fromkeys(it.axis for it in tries)), "{name}", json)
            return 0
        folder = output_folder(out)
        use_threads(threads)
        rows = []
        for _, of_axis in itertools.groupby(tries, key=lambda it: it.axis):
            for it in of_axis:
                rows.append(it.tried())
                say(f"{it.axis} {it.value}: {rows[-1].end} ({len(rows)} of {len(tries)})")
            study.write(folder, _command_line(package, "extremes", names), rows)
        if json:
            print_json(map(asdict, rows))
        else:
            print(f"{len(rows)} tries; {folder / study.NAME}.md, .png")
        return 0

    return extremes


def _stability(package: Package) -> Callable[..., int]:
    """The `study stability` command."""

    def stability(
        *names: Annotated[str, Parameter(help="flows, or rooms for all of theirs; all if not given")],
        out: Annotated[str, Parameter(help="folder of stability.json, .csv, .md and .png")] = "runs/stability",
        quick: Annotated[bool, Parameter(help="few laws at few values: seconds")] = False,
        list_: List = False,
        threads: ThreadsOfEach = 1,
        json: Json = False,
    ) -> int:
        """Map where each law stays stable and where it is right, over flows that go from mild to extreme.

        The files are written after each flow; a map that the folder holds keeps its others.
        """
        from porescale.common.evidence import stability_files as study

        assert package.stability is not None
        flows = package.stability().chosen(names)
        if list_:
            print_list(({"name": flow.name, "title": flow.title} for flow in flows), "{name}: {title}", json)
            return 0
        folder, every = output_folder(out), list(package.stability())
        if quick:
            study.require_quick(folder)
        study.stored(folder, every, quick)  # a file that cannot be kept is found before anything runs
        use_threads(threads)
        rows, start, done = [], time.perf_counter(), 0
        total = sum(flow.count(quick) for flow in flows)
        for flow in flows:
            mine = []
            for law in flow.laws(quick):
                for y in flow.y.chosen(quick):
                    mine += flow.run(law, y, quick)
                    done += 1
                spent = time.perf_counter() - start
                left = f"{done} of {total}, about {spent / done * (total - done):.0f} s left"
                say(f"{flow.name}: {law} ({left})")
            rows += mine
            mapped = study.stored(folder, [it for it in every if it.name != flow.name], quick) + mine
            there = {row.flow for row in mapped}
            shown = [it for it in every if it.name in there]
            named = names if there <= {it.name for it in flows} else ()
            words = _command_line(package, "stability", named, *(["--quick"] if quick else []))
            study.write(folder, words, shown, mapped, quick)
        if json:
            print_json(row.as_dict() for row in rows)
        else:
            print(f"{len(rows)} tries in {time.perf_counter() - start:.0f} s; {folder / study.NAME}.md, .png")
        return 0

    return stability


def _convergence(package: Package) -> Callable[..., int]:
    """The `study convergence` command."""

    def convergence(
        *names: Annotated[str, Parameter(help="ladders, or topics for all of theirs; all if not given")],
        out: Annotated[str, Parameter(help="folder of convergence.json, .md, and a .png for each topic")] = (
            "runs/convergence"
        ),
        list_: List = False,
        threads: ThreadsOfEach = 1,
        json: Json = False,
    ) -> int:
        """Run experiments with known answers at several resolutions: errors, and the order at which they fall.

        The files are written after each ladder; those that are not named stay in them as they were.  Exit code 1 if an
        order does not hold, or if a ladder ended with an exception.
        """
        from porescale.common.evidence import convergence_files as study
        from porescale.common.record.card import mark

        assert package.convergence is not None
        register = package.convergence()
        ladders = register.chosen(names)
        if list_:
            print_list(({"name": it.name, "title": it.title} for it in ladders), "{name}: {title}", json)
            return 0
        folder = output_folder(out)
        use_threads(threads)
        kept, made = study.stored(folder), []
        about = circumstances(package, _command_line(package, "convergence", ()), threads or 1)
        run = mark()
        for it in ladders:
            made.append(it.run())
            kept[it.name] = made[-1].as_dict() | run
            say(f"{it.name}: order {study.number(made[-1].measured)} ({made[-1].seconds:.1f} s)")
            study.write(folder, about, [kept[it.name] for it in register if it.name in kept])
        if json:
            print_json(row.as_dict() for row in made)
        else:
            print(f"ladders: {len(made)}; {folder / study.NAME}.md, .png of each topic")
        return 1 if any(row.holds is False for row in made) else 0

    return convergence


def _endurance(package: Package) -> Callable[..., int]:
    """The `study endurance` command."""

    def endurance(
        *names: Annotated[str, Parameter(help="what lasts; all if not given")],
        steps: Annotated[int, Parameter(help="of each")] = 1_000_000,
        out: Annotated[str, Parameter(help="folder of endurance.json, .md and .png")] = "runs/endurance",
        resume: Annotated[bool, Parameter(help="keep what has finished there, and go on with what has not")] = False,
        list_: List = False,
        threads: ThreadsOfEach = 1,
        json: Json = False,
    ) -> int:
        """Run small things for a million steps: what creeps of mass, momentum, places, memory; what is found wrong.

        A flow is kept in the folder every half minute: `--resume` goes on from there, to the same numbers.  Calls with
        `--resume` and other names may write to the same folder at the same time.
        """
        from porescale.common.core.atomic import owned
        from porescale.common.evidence import endurance as study

        assert package.endurance is not None
        chosen = package.endurance().chosen(names)
        if list_:
            print_list(({"name": it.name, "title": it.title} for it in chosen), "{name}: {title}", json)
            return 0
        if short := [it for it in chosen if steps < it.least]:
            problem, least = f"is too few for {', '.join(it.name for it in short)}", max(it.least for it in short)
            repair = "or name others, which --list has" if least > study.FEWEST else ""
            raise InputError(Fault("--steps", steps, problem, "", f">= {least}", repair))
        folder = output_folder(out)
        use_threads(threads)
        kept = study.finished(folder) if resume else {}
        words = _command_line(package, "endurance", () if resume else names, f"--steps {steps}")
        for it in chosen:
            if it.name in kept and kept[it.name][0].steps == it.steps(steps):
                say(f"{it.name}: kept")
                continue
            unfinished = study.kept_file(folder, it)
            if not resume:
                unfinished.unlink(missing_ok=True)
            lines = study.endure(it, steps, say, unfinished)
            with owned(folder, wait=True):
                kept = (study.finished(folder) if resume else kept) | {it.name: lines}
                ordered = [line for flow in package.endurance().chosen() for line in kept.get(flow.name, [])]
                study.write(folder, circumstances(package, words, threads or 1), ordered)
            unfinished.unlink()
        lines = [line for it in chosen for line in kept[it.name]]
        if json:
            print_json(map(asdict, lines))
        else:
            for line in lines:
                verdict = "holds" if line.holds else "CREEPS"
                print(f"{line.flow}: {line.quantity} {verdict}, off by {line.off:.3g} of {line.allowed:.3g} allowed")
        return 0 if all(line.holds for line in lines) else 1

    return endurance


def _parts(package: Package) -> Callable[..., int]:
    """The `study parts` command."""

    def parts(
        *names: Annotated[str, Parameter(help="kinds of scenes; all if not given")],
        out: Annotated[str, Parameter(help="folder of parts.json, .md and .png")] = "runs/parts",
        rounds: Annotated[int, Parameter(help="in which each is timed in turns with what it is held against")] = 15,
        list_: List = False,
        json: Json = False,
    ) -> int:
        """Measure what each kind of scene builds and costs, beside the smallest kernel for it, one thread.

        The files are written after each kind.
        """
        from porescale.common.evidence import overhead as study

        assert package.parts is not None
        kinds = package.parts().chosen(names)
        if list_:
            rows_of = ({"name": kind.name, "beside": kind.beside} for kind in kinds)
            print_list(rows_of, "{name} (beside {beside})", json)
            return 0
        if rounds < 1:
            raise InputError(Fault("--rounds", rounds, "is out of range", "", ">= 1"))
        folder = output_folder(out)
        use_threads(1)
        about, rows = circumstances(package, _command_line(package, "parts", names), 1), []
        for kind in kinds:
            rows.append(study.measure(kind, rounds))
            say(f"{kind.name}: {rows[-1].ratio:.3f} of {kind.beside}")
            study.write(folder, about, rows)
        if json:
            print_json(map(asdict, rows))
        else:
            print(f"{len(rows)} kinds; {folder / study.NAME}.md")
        return 0

    return parts
