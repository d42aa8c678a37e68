"""`verify [NAME…]`: the validations."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from porescale.common.api.folders import output_folder
from porescale.common.cli.options import Json, List, Threads, print_json, say, use_threads
from porescale.common.cli.package import Package

if TYPE_CHECKING:
    from porescale.common.evidence.validations import Row, Validation


def command(package: Package) -> Callable[..., int]:
    """The `verify` command of a package."""

    def verify(
        *names: Annotated[str, Parameter(help="validations, or rooms for all of theirs; all if not given")],
        out: Annotated[str | None, Parameter(help="folder for verify.json, .md, and a figure of each topic")] = None,
        slow: Annotated[bool, Parameter(alias="--all", help="the slow ones too")] = False,
        list_: List = False,
        threads: Threads = None,
        json: Json = False,
    ) -> int:
        """Run validations: reference, measured, error, tolerance and its reason.  Exit code 1 if one fails.

        With --out, rows that are not run stay in the files as they were.
        """
        register = package.validations()
        if list_:
            found = register.chosen(names, slow=True)
            if json:
                print_json({"name": it.name, "slow": it.slow, "source": it.source} for it in found)
            for item in () if json else found:
                print(f"{item.name}{' (slow)' if item.slow else ''}: {item.source}")
            return 0
        chosen = register.chosen(names, slow=slow)
        folder = None if out is None else output_folder(out)  # refused before what takes long
        use_threads(threads)
        rows = []
        for item in chosen:
            rows.append(item.run())
            verdict = "pass" if rows[-1].passed else "FAIL"
            say(f"{verdict} {item.name} ({rows[-1].seconds:.1f} s)")
        if folder is not None:
            _keep(folder, list(register), rows)
        failed = sum(not row.passed for row in rows)
        if json:
            print_json(row.as_dict() for row in rows)
        else:
            from rich.console import Console

            from porescale.common.evidence.validations import table

            Console().print(table(rows))
            left = len(register.chosen(names, slow=True)) - len(rows)
            hint = f", {left} slow ones left out (--slow)" if left else ""
            print(f"{len(rows) - failed} passed, {failed} failed{hint}")
        return 1 if failed else 0

    return verify


def _keep(folder: Path, register: Sequence[Validation], rows: Sequence[Row]) -> None:
    """Put rows into the files in ``folder`` beside those that other runs left, in the order of the register."""
    from porescale.common.evidence import validation_files as files
    from porescale.common.record.card import mark

    known = files.stored(folder / f"{files.NAME}.json")
    topics, made = {item.name: {"topic": item.topic} for item in register}, mark()
    known |= {row.name: row.as_dict() | topics[row.name] | made for row in rows}
    files.write(folder, [known[name] for name in topics if name in known])
