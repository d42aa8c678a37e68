"""Upward flow through soil: Darcy's law over four decades of permeability, and the gradient at which soil boils."""

from pathlib import Path

from continuum_sph.validation.seepage import permeameter
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    given = options(__doc__ or "", HERE)
    fluxes = {k: permeameter.darcy(k) for k in permeameter.PERMEABILITIES}
    part, upright, speed = permeameter.ramp()
    found, _, _ = permeameter.boiling()
    figure, (left, right) = stage(2)
    left.axhline(1.0, color="#888888", linewidth=1.0)
    left.semilogx(list(fluxes), list(fluxes.values()), "o", color="#5b8fd0")
    left.set(xlabel="k (m/s)", ylabel="q / (k i)", ylim=(0.98, 1.02))
    right.plot(part, 1.0 - part, color="#888888", linewidth=1.0, linestyle="--", label="submerged weight less flow")
    right.plot(part, upright, color="#b8860b", label="mean upright stress")
    right.set(xlabel="i / i_c", ylabel="stress / that without flow", ylim=(-0.02, 0.18))
    other = right.twinx()
    other.plot(part, 1e3 * speed, color="#5b8fd0")
    other.set_ylabel("speed of the soil (mm/s)", color="#5b8fd0")
    right.axvline(1.0, color="#888888", linewidth=0.5)
    right.legend(fontsize=8, frameon=False, loc="upper center")
    numbers = {f"q/(k i), k = {k:g} m/s": value for k, value in fluxes.items()}
    numbers["gradient at which stress vanishes over i_c"] = found
    numbers["critical gradient"] = permeameter.BOILING.critical
    return conclude(HERE, numbers, figure, given.out)


if __name__ == "__main__":
    raise SystemExit(main())
