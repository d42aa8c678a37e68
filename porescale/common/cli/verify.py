"""`verify [NAME…]`: the validations."""

from collections.abc import Callable
from typing import Annotated

from cyclopts import Parameter

from porescale.common.cli.options import Json, List, Threads, print_json, say, use_threads
from porescale.common.cli.package import Package


def command(package: Package) -> Callable[..., int]:
    """The `verify` command of a package."""

    def verify(
        *names: Annotated[str, Parameter(help="validations, or rooms for all of theirs; all if not given")],
        slow: Annotated[bool, Parameter(alias="--all", help="the slow ones too")] = False,
        list_: List = False,
        threads: Threads = None,
        json: Json = False,
    ) -> int:
        """Run validations: reference, measured, error, tolerance and its reason.  Exit code 1 if one fails."""
        register = package.validations()
        if list_:
            for item in register.chosen(names, slow=True):
                print(f"{item.name}{' (slow)' if item.slow else ''}: {item.source}")
            return 0
        chosen = register.chosen(names, slow=slow)
        use_threads(threads)
        rows = []
        for item in chosen:
            rows.append(item.run())
            verdict = "pass" if rows[-1].passed else "FAIL"
            say(f"{verdict} {item.name} ({rows[-1].seconds:.1f} s)")
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
