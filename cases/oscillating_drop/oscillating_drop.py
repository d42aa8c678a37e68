"""A drop that was kicked swings: its period against the exact one, and the pressure in a drop at rest against σ/R."""

from pathlib import Path

import numpy as np

from continuum_sph.validation.water import drop_swing as exact_drop
from continuum_sph.validation.water import fluids, setups
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
RADIUS, AT_REST = 0.2, 0.25  # m
AMPLITUDE = 0.05  # of R


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    given = options(__doc__ or "", HERE, across=(int, 64, "particles across the box of 1 m", 7))
    flow, radius = fluids.kicked(given.across, RADIUS, AMPLITUDE)
    exact = fluids.exact_period(radius)
    t, s = fluids.swing(flow, 1.4 * exact)
    still = setups.run_until(fluids.drop(40, AT_REST), 0.25)
    figure, (left, right) = stage(2)
    swift = 2.0 * np.pi / fluids.exact_period(radius, viscous=False)
    # What sound adds is taken out.
    inert = exact_drop.swing_period(radius, fluids.TENSION, (1.0, fluids.OUTER), fluids.SWINGING) / exact
    tips = exact_drop.drop_swing(inert * t[1:], radius, fluids.TENSION, (1.0, fluids.OUTER), fluids.SWINGING)
    left.plot(t / exact, 0.5 * s / AMPLITUDE, color="#1f5fa8", label="computed")
    left.plot(t[1:] / exact, swift * tips, "--", color="#777777", label="exact")
    left.set(xlabel="time over the exact period", ylabel="elongation, 1 without viscosity", title="a drop swings")
    left.legend()
    layer = still.layer
    r = np.hypot(layer.x[:, 0] - 0.5, layer.x[:, 1] - 0.5)
    right.plot(r / AT_REST, layer.pressure * AT_REST / fluids.TENSION, ".", markersize=2, color="#1f5fa8")
    outside = layer.pressure[r > 1.5 * AT_REST].mean() * AT_REST / fluids.TENSION
    right.step([0.0, 1.0, 2.0], [1.0 + outside, 1.0 + outside, outside], "--", color="#777777")
    right.set(xlabel="r/R", ylabel="p R/σ", title="and one at rest")
    numbers = {
        "period": fluids.second_round(t, s, 0.7 * exact) / exact,
        "pressure jump": fluids.pressure_jump(still, AT_REST) * AT_REST / fluids.TENSION,
    }
    return conclude(HERE, numbers, figure, given.out)


if __name__ == "__main__":
    raise SystemExit(main())
