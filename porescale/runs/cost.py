"""What a run costs whoever waits for the machine: core-seconds of its steps, memory at most.

Wall-clock time depends on who else works on the machine; the time that the process spent on cores hardly does.  The
first blocks of every session compile kernels or read them from the cache (steps in place have two kinds, even and odd,
and the first block is a step long), so that they are left out and the rest stands for them: a run costs
(core-seconds counted) × (steps)/(steps counted).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

UNCOUNTED = 3
"""Blocks at the start of a session that are not counted."""


@dataclass
class Cost:
    """Steps counted so far and what they took of all cores together, all sessions of a run."""

    steps: int = 0
    core_seconds: float = 0.0
    blocks: int = 0

    def block(self, steps: int, core_seconds: float) -> None:
        """Count a block of steps, but for the first ones of a session."""
        self.blocks += 1
        if self.blocks > UNCOUNTED:
            self.steps += steps
            self.core_seconds += core_seconds

    def of(self, steps: int) -> float | None:
        """Core-seconds of a run of so many steps; None if nothing was counted."""
        return self.core_seconds * steps / self.steps if self.steps else None

    def state(self) -> dict[str, Any]:
        """What a checkpoint keeps."""
        return {"steps": self.steps, "core_seconds": self.core_seconds}

    @classmethod
    def restored(cls, state: dict[str, Any]) -> Cost:
        """What a checkpoint kept; nothing counted where it is of a version that did not."""
        return cls(int(state.get("steps", 0)), float(state.get("core_seconds", 0.0)))
