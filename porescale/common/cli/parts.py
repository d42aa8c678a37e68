"""`study parts [KIND…]`: what each kind of scene builds and costs."""

import json as json_text
import sys
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from porescale.common.cli.folders import require_writable
from porescale.common.cli.options import Json, use_threads
from porescale.common.cli.package import Package
from porescale.common.cli.trade import circumstances
from porescale.common.core.errors import Fault, InputError


def command(package: Package) -> Callable[..., int]:
    """The `study parts` command."""

    def parts(
        *names: Annotated[str, Parameter(help="kinds of scenes; all if not given")],
        out: Annotated[str, Parameter(help="folder of parts.json and .md")] = "runs/parts",
        rounds: Annotated[int, Parameter(help="in which each is timed in turns with what it is held against")] = 15,
        list_: Annotated[bool, Parameter(name="--list", help="only say which there are")] = False,
        json: Json = False,
    ) -> int:
        """Measure what each kind of scene builds and costs, beside the smallest kernel for it, one thread."""
        from porescale.common.evidence import overhead as made

        assert package.parts is not None
        kinds = package.parts().chosen(names)
        if list_:
            print("\n".join(f"{kind.name} (beside {kind.beside})" for kind in kinds))
            return 0
        faults = [
            Fault(option, value, problem, "", allowed)
            for option, value, wrong, problem, allowed in (
                ("--out", out, out == "", "is empty", "a folder"),
                ("--rounds", rounds, rounds < 1, "is out of range", ">= 1"),
            )
            if wrong
        ]
        if faults:
            raise InputError(faults)
        require_writable(Path(out), "--out")
        use_threads(1)
        rows = []
        for kind in kinds:
            rows.append(made.measure(kind, rounds))
            print(f"{kind.name}: {rows[-1].ratio:.3f} of {kind.beside}", file=sys.stderr, flush=True)
        asked = " ".join([package.name, "study parts", *(json_text.dumps(name) for name in names)])
        made.write(Path(out), circumstances(package, asked, 1), rows)
        if json:
            print(json_text.dumps([asdict(row) for row in rows], indent=1, allow_nan=False))
        else:
            print(f"{len(rows)} kinds; {Path(out) / made.NAME}.md")
        return 0

    return parts
