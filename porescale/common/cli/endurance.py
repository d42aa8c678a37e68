"""`study endurance [FLOW…]`: very long runs of small things, and what creeps in them."""

import json as json_text
import sys
from collections.abc import Callable
from dataclasses import asdict
from typing import Annotated

from cyclopts import Parameter

from porescale.common.cli.folders import study_folder
from porescale.common.cli.options import Json, Threads, use_threads
from porescale.common.cli.package import Package
from porescale.common.cli.trade import circumstances
from porescale.common.core.errors import Fault, InputError


def command(package: Package) -> Callable[..., int]:
    """The `study endurance` command."""

    def endurance(
        *names: Annotated[str, Parameter(help="what lasts; all if not given")],
        steps: Annotated[int, Parameter(help="of each")] = 1_000_000,
        out: Annotated[str, Parameter(help="folder of endurance.json, .md and .png")] = "runs/endurance",
        resume: Annotated[bool, Parameter(help="keep what an earlier call has finished there")] = False,
        list_: Annotated[bool, Parameter(name="--list", help="only say what there is")] = False,
        threads: Threads = 1,
        json: Json = False,
    ) -> int:
        """Run small things for a million steps: what creeps of mass, momentum, places, memory; what is found wrong."""
        from porescale.common.evidence import endurance as made

        assert package.endurance is not None
        chosen = package.endurance().chosen(names)
        if list_:
            print("\n".join(f"{it.name}: {it.title}" for it in chosen))
            return 0
        if steps < made.MARKS:
            raise InputError(Fault("--steps", steps, "is too few to look at", "", f">= {made.MARKS}"))
        folder = study_folder(out)
        use_threads(threads)
        kept = made.finished(folder) if resume else {}
        asked = " ".join([package.name, "study endurance", *map(json_text.dumps, names), f"--steps {steps}"])
        for it in chosen:
            if it.name in kept and kept[it.name][0].steps == it.steps(steps):
                print(f"{it.name}: kept", file=sys.stderr, flush=True)
                continue
            kept[it.name] = made.endure(it, steps, lambda text: print(text, file=sys.stderr, flush=True))
            ordered = [line for flow in package.endurance().chosen() for line in kept.get(flow.name, [])]
            made.write(folder, circumstances(package, asked, threads or 1), ordered)
        lines = [line for it in chosen for line in kept[it.name]]
        if json:
            print(json_text.dumps([asdict(line) for line in lines], indent=1, allow_nan=False))
        else:
            for line in lines:
                verdict = "holds" if line.holds else "CREEPS"
                print(f"{line.flow}: {line.quantity} {verdict}, off by {line.off:.3g} of {line.allowed:.3g} allowed")
        return 0 if all(line.holds for line in lines) else 1

    return endurance
