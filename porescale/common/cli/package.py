"""Interface of a package to the common commands: its program, and what commands need besides.

Every part is a function, so that nothing is imported before a command needs it: `--help` must not wait for a compiler.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from porescale.common.api.program import Program

if TYPE_CHECKING:
    from porescale.common.core.types import AnyArray
    from porescale.common.evidence.benchmarks import Benchmarks
    from porescale.common.evidence.convergence import Ladders
    from porescale.common.evidence.endurance import Endurances
    from porescale.common.evidence.extremes import Extremes
    from porescale.common.evidence.overhead import SceneKinds
    from porescale.common.evidence.stability import Stability
    from porescale.common.evidence.validations import Validations


@dataclass(frozen=True, kw_only=True)
class Package(Program):
    """A program and its commands.

    summary : one line for --help;  template : gives the commented scene.toml that `new` writes;
    also : the same as show for runs of other commands, by the names in their cards;
    validations, benchmarks : give the registers;  peers : benchmarks beside programs of others, or None;
    case : folder of a case whose front `bench` measures again, or None;
    stability : flows of a stability map;  extremes : tries of `study extremes`;  convergence : ladders of `study
    convergence`;  endurance : flows of `study endurance`;  parts : scenes of `study parts`;  each None if there are
    none;
    features : what trade studies read of a run folder at a time (None: its last snapshot), by name, None if there is
    nothing.
    """

    summary: str
    template: Callable[[], str]
    validations: Callable[[], Validations]
    benchmarks: Callable[[], Benchmarks]
    peers: Callable[[], Benchmarks] | None = None
    case: Path | None = None
    stability: Callable[[], Stability] | None = None
    extremes: Callable[[], Extremes] | None = None
    convergence: Callable[[], Ladders] | None = None
    endurance: Callable[[], Endurances] | None = None
    parts: Callable[[], SceneKinds] | None = None
    also: Mapping[str, Callable[[Path], Iterable[Path]]] = field(default_factory=dict)
    features: Callable[[], Mapping[str, Callable[[Path, float | None], AnyArray]]] | None = None

    @classmethod
    def of(cls, program: Program, **more: Any) -> Self:
        """The package of a program, with what commands need besides."""
        return cls(**{it.name: getattr(program, it.name) for it in fields(program)}, **more)
