"""A drop drawn out by 5 % swings back: its period against Lamb's, and the pressure in a drop at rest against σ/R."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from continuum_sph.exact import drop_period
from continuum_sph.scene import trials_fluids
from continuum_sph.scene.trials import run_until
from continuum_sph.scene.trials_fluids import OUTER, SOUND, TENSION
from porescale.scene.case import conclude, options, stage

HERE = Path(__file__).resolve().parent
RADIUS, AT_REST = 0.2, 0.25  # m
VISCOSITY, OUTER_VISCOSITY = 0.01, 0.001  # Pa s
PERIOD = drop_period(RADIUS, TENSION, 1.0, OUTER, SOUND)  # s
DAMPING = 4.0 * VISCOSITY / RADIUS**2  # 1/s, n = 2, of the drop alone


def swing(across: int, periods: float = 2.0) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and how far the drop is drawn out, see `trials_fluids.stretched`, at every tenth step."""
    flow = trials_fluids.drop(
        across, RADIUS, stretch=1.05, viscosity=VISCOSITY, outer_viscosity=OUTER_VISCOSITY
    )  # fmt: skip
    times, shapes = [0.0], [trials_fluids.stretched(flow)]
    while flow.time < periods * PERIOD:
        for _ in range(10):
            flow.advance()
        times.append(flow.time)
        shapes.append(trials_fluids.stretched(flow))
    return np.array(times), np.array(shapes)


def crossings(t: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Times (s) at which a drop is round."""
    turn = np.flatnonzero(s[:-1] * s[1:] < 0.0)
    found: np.ndarray = t[turn] - s[turn] * (t[turn + 1] - t[turn]) / (s[turn + 1] - s[turn])
    return found


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    given = options(__doc__ or "", HERE, across=(int, 50, "particles across the box of 1 m"))
    t, s = swing(given.across)
    still = run_until(trials_fluids.drop(40, AT_REST), 0.25)
    round_at = crossings(t, s)
    figure, (left, right) = stage(2)
    left.plot(t, s / s[0], color="#1f5fa8", label="computed")
    left.plot(t, np.exp(-DAMPING * t) * np.cos(2.0 * np.pi * t / PERIOD), "--", color="#777777", label="linear theory")
    left.set(xlabel="time (s)", ylabel="elongation over that at the start", title="a drop swings")
    left.legend()
    layer = still.layer
    r = np.hypot(layer.x[:, 0] - 0.5, layer.x[:, 1] - 0.5)
    right.plot(r / AT_REST, layer.pressure * AT_REST / TENSION, ".", markersize=2, color="#1f5fa8")
    outside = layer.pressure[r > 1.5 * AT_REST].mean() * AT_REST / TENSION
    right.step([0.0, 1.0, 2.0], [1.0 + outside, 1.0 + outside, outside], "--", color="#777777")
    right.set(xlabel="r/R", ylabel="p R/σ", title="and one at rest")
    numbers = {
        "period": float(round_at[2] - round_at[0]) / PERIOD,
        "pressure jump": trials_fluids.pressure_jump(still, AT_REST) * AT_REST / TENSION,
    }
    return conclude(HERE, numbers, figure, given.out)


if __name__ == "__main__":
    raise SystemExit(main())
