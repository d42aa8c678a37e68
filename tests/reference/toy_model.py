"""A model without physics that runs can be tested on: beads on springs, a diffusing field, random kicks."""

import time
from pathlib import Path
from typing import Any

import numpy as np

from porescale.common.core.errors import Unstable
from porescale.common.record.drive import Outcome, drive
from porescale.common.record.model import Cloud, Grid, Snapshot


class Toy:
    """Beads in a box and a field on a grid, kicked by a generator whose state is part of the state."""

    step_seconds = 1e-3

    def __init__(self, beads: int = 7, pause: float = 0.0, breaks_at: int = 1 << 60, varying: bool = False) -> None:
        self.random = np.random.default_rng(1)
        self.x = self.random.random((beads, 2))
        self.v = np.zeros((beads, 2))
        self.field = self.random.random((6, 8))
        self.step, self.time = 0, 0.0
        self.pause, self.breaks_at, self.variable_step = pause, breaks_at, varying
        self.calls: list[int] = []

    def advance(self, steps: int) -> None:
        self.calls.append(steps)
        for _ in range(steps):
            time.sleep(self.pause)
            dt = self.step_seconds
            self.v += dt * (0.5 - self.x) * 40 + 1e-3 * self.random.normal(size=self.v.shape)
            self.x += dt * self.v
            self.field += 0.1 * (np.roll(self.field, 1, 1) - self.field)
            self.step += 1
            if self.variable_step:
                self.time += dt
                self.step_seconds = 1e-3 * (1 + 0.5 * float(np.tanh(self.v[0, 0])))
            else:
                self.time = self.step * dt

    def check(self) -> None:
        if self.step >= self.breaks_at:
            raise Unstable("bead 3", "speed", 1e9, "m/s", self.step, self.time, "as it was told to")

    def series(self) -> dict[str, float]:
        energy = float((self.v**2).sum())
        return {"time (s)": self.time, "energy (J)": energy, "mean (1)": float(self.field.mean())}

    def tables(self) -> dict[str, dict[str, float]]:
        return {"beads": {"time (s)": self.time, "x of bead 0 (m)": float(self.x[0, 0])}}

    def snapshot(self) -> Snapshot:
        velocity = np.zeros((*self.field.shape, 3), np.float32)
        velocity[..., 0] = self.field
        fields = Grid((0.0, 0.0), (0.125, 1 / 6), {"velocity": velocity}, {"velocity": "m/s"})
        data = {"radius": np.full(len(self.x), 0.05), "velocity": np.pad(self.v, ((0, 0), (0, 1)))}
        grains = Cloud(self.x, data, {"radius": "m", "velocity": "m/s"})
        return Snapshot(self.time, self.step, {"fields": fields}, {"grains": grains})

    def state(self) -> dict[str, Any]:
        return {
            "random": self.random.bit_generator.state,
            "beads": {"x": self.x, "v": self.v},
            "field": self.field,
            "step": self.step,
            "time": self.time,
            "step_seconds": self.step_seconds,
        }

    def restore(self, state: dict[str, Any]) -> None:
        self.random.bit_generator.state = state["random"]
        self.x[:], self.v[:] = state["beads"]["x"], state["beads"]["v"]
        self.field[:] = state["field"]
        self.step, self.time, self.step_seconds = state["step"], state["time"], state["step_seconds"]


def run_toy(folder: Path, *, model: Toy | None = None, duration: float = 0.12, **options: Any) -> Outcome:
    """Drive a toy with short intervals; ``options`` as for ``drive``, ``scene`` for the card."""
    scene = options.pop("scene", {"toy": {"beads": 7}, "run": {"duration": duration}})
    settings: dict[str, Any] = {
        "snapshot_interval": 0.02,
        "series_interval": 0.005,
        "checkpoint_seconds": 60.0,
        "quiet": True,
        "card": {"name": "toy", "scene": scene, "seeds": {"toy": 1}},
    }
    return drive(model or Toy(), folder, duration, **(settings | options))
