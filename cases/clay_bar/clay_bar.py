"""A bar of clay that spins bears tension: in one piece with repulsion, in pieces without."""

from pathlib import Path

from continuum_sph.validation.soil import bodies
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
PULLS = (0.0045, 0.018)  # tension in the middle over E'
METHODS = {"with repulsion": 10.0, "without": 0.0}


def main() -> int:
    """Spin, compare with expected.toml, draw."""
    words = options(
        __doc__ or "", HERE, rows=(int, 30, "particles over the length", 2), turns=(float, 1.5, "turns", 1e-3)
    )
    figure, axes = stage(len(METHODS), 9.0, 4.0)
    numbers = {}
    for panel, (name, strength) in zip(axes, METHODS.items(), strict=True):
        for pull in PULLS:
            flow = bodies.bar_that_spins(pull, rows=words.rows, repulsion=strength)
            numbers[f"elongation, {name}, pull {pull:g}"] = bodies.elongation(flow, pull, words.turns)
            if pull == PULLS[0]:
                x, stress = flow.soil.x, flow.soil.stress
                dots = panel.scatter(x[:, 0], x[:, 1], c=-0.5e-3 * (stress[:, 0] + stress[:, 1]), s=8, vmin=0, vmax=3)
        panel.set(title=name, aspect="equal", xlabel="x (m)")
    figure.colorbar(dots, ax=axes, label="mean tension (kPa)")
    for key, value in numbers.items():
        print(f"{key}: {value:.4g}")
    return conclude(HERE, numbers, figure, words.out)


if __name__ == "__main__":
    raise SystemExit(main())
