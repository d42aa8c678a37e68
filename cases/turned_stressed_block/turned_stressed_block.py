"""A stressed block turned by a right angle: its stress has to turn with it; with eq. 38 as printed it does not."""

import math
from pathlib import Path

import numpy as np

from continuum_sph.soil import Material
from continuum_sph.validation.soil import bodies, setups
from porescale.common.neighbors import square_lattice
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
SPACING = 0.05  # m
STRESS = (3e3, 1e4, 2e3, 3.9e3)  # Pa: xx, yy, xy, zz
METHODS: dict[str, dict[str, bool]] = {
    "as computed": {},
    "sign of eq. 38": {"printed_spin": True},
    "gradients of eq. 37": {"corrected": False},
}


def main() -> int:
    """Turn it, compare with expected.toml, draw."""
    words = options(__doc__ or "", HERE, steps=(int, 2000, "steps of the turn", 2))
    x = square_lattice((-0.5, -0.25), (0.5, 0.25), SPACING)
    figure, (left, right) = stage(2, 10.0, 4.0)
    numbers = {}
    for name, law in METHODS.items():
        flow = setups.body(x, SPACING, Material(1e7, 1590.0, yields=False), STRESS, **law)
        angles, errors = bodies.turn(flow, 0.5 * math.pi, words.steps)
        left.semilogy(np.degrees(angles), np.maximum(errors, 1e-17), label=name)
        numbers[f"on the way, {name}"] = float(errors.max())
        numbers[f"at 90 degrees, {name}"] = float(errors[-1])
        if not law:
            at, stress = flow.soil.x, flow.soil.stress
            dots = right.scatter(at[:, 0], at[:, 1], c=stress[:, 0] / 1e3, s=14, vmin=3.0, vmax=10.0)
            figure.colorbar(dots, ax=right, label="σ_xx (kPa), 3 before the turn")
    left.set_xlabel("turned by (degrees)")
    left.set_ylabel("largest change of stress in the block's frame")
    left.legend(fontsize=8)
    right.scatter(x[:, 0], x[:, 1], facecolors="none", edgecolors="#bbbbbb", s=14)
    right.set_aspect("equal")
    return conclude(HERE, numbers, figure, words.out)


if __name__ == "__main__":
    raise SystemExit(main())
