"""Computing cost of a run: core-seconds of its steps, memory at most.

Wall-clock time depends on the load of the machine; the time that the process spent on cores hardly does.  The
first blocks of every session compile kernels or read them from the cache (steps in place have two kinds, even and odd,
and the first block is a step long), so that they are left out and the rest stands for them: a run costs
(core-seconds counted) × (steps)/(steps counted), and besides what rows, snapshots, pictures and film take.
"""

import time
from dataclasses import dataclass, field
from typing import Any

UNCOUNTED = 3
"""Blocks at the start of a session that are not counted."""
PACED = 2.0
"""Core-seconds at the beginning of a run that its pace is taken over: a machine that is tried later can do the same."""


@dataclass
class Cost:
    """Steps counted so far and what they took of all cores together, all sessions of a run.

    paced_steps, paced_seconds : the first of them;  earlier : core-seconds besides steps, of earlier sessions;
    stepping : core-seconds of all steps of this session;  began : core-seconds of the process when it began.
    """

    steps: int = 0
    core_seconds: float = 0.0
    paced_steps: int = 0
    paced_seconds: float = 0.0
    earlier: float = 0.0
    blocks: int = 0
    stepping: float = 0.0
    began: float = field(default_factory=time.process_time)

    def block(self, steps: int, core_seconds: float) -> None:
        """Count a block of steps, but for the first ones of a session."""
        self.blocks += 1
        self.stepping += core_seconds
        if self.blocks > UNCOUNTED:
            self.steps += steps
            self.core_seconds += core_seconds
            if self.paced_seconds < PACED:
                self.paced_steps += steps
                self.paced_seconds += core_seconds

    def of(self, steps: int) -> float | None:
        """Core-seconds of a run of so many steps; None if nothing was counted."""
        return self.core_seconds * steps / self.steps if self.steps else None

    def pace(self) -> float | None:
        """Core-seconds of a step as the run began; None if nothing was counted."""
        return self.paced_seconds / self.paced_steps if self.paced_steps else None

    def besides(self) -> float:
        """Core-seconds of all sessions so far that went into other things than steps."""
        return self.earlier + max(0.0, time.process_time() - self.began - self.stepping)

    def state(self) -> dict[str, Any]:
        """Seconds counted so far, for a checkpoint."""
        return {
            "steps": self.steps, "core_seconds": self.core_seconds, "besides": self.besides(),
            "paced_steps": self.paced_steps, "paced_seconds": self.paced_seconds,
        }  # fmt: skip

    @classmethod
    def restored(cls, state: dict[str, Any]) -> "Cost":
        """What a checkpoint kept; nothing counted where it is of a version that did not."""
        return cls(
            int(state.get("steps", 0)), float(state.get("core_seconds", 0.0)), int(state.get("paced_steps", 0)),
            float(state.get("paced_seconds", 0.0)), float(state.get("besides", 0.0)),
        )  # fmt: skip
