"""`bench [NAME…]`: rates in updates per second."""

import sys
from collections.abc import Callable
from dataclasses import asdict
from typing import Annotated, Literal

from cyclopts import Parameter

from porescale.common.cli.options import Json, List, Threads, print_json, say
from porescale.common.cli.package import Package


def command(package: Package) -> Callable[..., int]:
    """The `bench` command of a package."""

    def bench(
        *names: Annotated[str, Parameter(help="benchmarks; all if not given")],
        size: Annotated[int | None, Parameter(help="cells along a side, discs, …; each one's own if not given")] = None,
        threads: Threads = None,
        dtype: Annotated[Literal["float32", "float64"], Parameter(help="type of the fields")] = "float64",
        list_: List = False,
        json: Json = False,
    ) -> int:
        """Measure rates, in updates per second, and their share of the memory bandwidth measured beside them."""
        from porescale.common.studies.budget_check import benchmark

        register = package.benchmarks()
        register.include(benchmark(package, package.case) if package.case else ())
        if list_:
            print("\n".join(row.name for row in register))
            return 0
        rows = []
        for row in register.run(names, size=size, threads=threads, dtype=dtype):
            rows.append(row)
            say(f"{row.name}: {row.rate:.4g} {row.unit}")
        if json:
            print_json(map(asdict, rows))
        else:
            from rich.console import Console

            from porescale.common.evidence.benchmarks import table

            Console().print(table(rows))
        for remark in register.remarks:
            print(remark, file=sys.stderr if json else sys.stdout)
        return 0

    return bench
