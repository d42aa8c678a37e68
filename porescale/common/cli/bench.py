"""`bench [NAME…]`: rates in updates per second."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from porescale.common.cli.options import Json, List, Threads, print_json, print_list, say
from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError

if TYPE_CHECKING:
    from porescale.common.evidence.benchmarks import Benchmarks


def command(package: Package) -> Callable[..., int]:
    """The `bench` command of a package."""

    def bench(
        *names: Annotated[str, Parameter(help="benchmarks; all if not given")],
        size: Annotated[int | None, Parameter(help="cells along a side, discs, …; each one's own if not given")] = None,
        threads: Threads = None,
        dtype: Annotated[Literal["float32", "float64"], Parameter(help="type of the fields")] = "float64",
        device: Annotated[Literal["cpu", "gpu"], Parameter(help="gpu: those that there are for it")] = "cpu",
        against: Annotated[str | None, Parameter(help="program of others that does the same work in turns")] = None,
        list_: List = False,
        json: Json = False,
    ) -> int:
        """Measure rates, in updates per second, and their share of the memory bandwidth measured beside them."""
        from porescale.common.studies.budget_check import benchmark

        if against is None:
            register = package.benchmarks()
            register.include(benchmark(package, package.case) if package.case else ())
        else:
            register, names = peer(package, against, names), (against,)
        if list_:
            print_list(({"name": row.name} for row in register.chosen(() if against else names)), "{name}", json)
            return 0
        rows = []
        for row in register.run(names, size=size, threads=threads, dtype=dtype, device=device):
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


def peer(package: Package, against: str, names: tuple[str, ...]) -> Benchmarks:
    """The benchmarks beside programs of others.  InputError without any of that name, or where others are named too."""
    if package.peers is None:
        raise InputError(Fault("--against", against, f"{package.name} is held against no other program"))
    if names:
        repair = "leave the names out: each program stands for one kind of work"
        raise InputError(Fault("--against", against, "was given with benchmarks", repair=repair))
    return package.peers()
