"""One element of soil in biaxial compression and in confined compression: strength, dilatancy, pressure at rest."""

import math
from pathlib import Path

import numpy as np

from continuum_sph.soil import XX, YY, Material
from continuum_sph.validation.soil import element
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
PRESSURE = 1e5  # Pa
KINDS = {
    "m = 0": Material(3e7, 1590.0),
    "m = 0.5": Material(3e7, 1590.0, exponent=0.5),
    "psi = 10 degrees": Material(3e7, 1590.0, sin_dilatancy=math.sin(math.radians(10.0))),
    "c = 10 kPa": Material(3e7, 1590.0, cohesion_intercept=1e4 * math.cos(math.radians(30.0))),
}


def main() -> int:
    """Measure, compare with expected.toml, draw."""
    words = options(__doc__ or "", HERE, steps=(int, 400, "steps of strain", 1))
    figure, (left, middle, right) = stage(3, 12.0, 3.8)
    numbers = {}
    for name, material in KINDS.items():
        _, rows = element.biaxial(material, PRESSURE, 0.02, words.steps)
        upright, across, major, minor = rows.T
        left.plot(100.0 * upright, major / minor, label=name)
        middle.plot(100.0 * upright, 100.0 * (upright + across), label=name)
        numbers[f"stress ratio at failure, {name}"] = major[-1] / minor[-1]
        late = np.diff(rows[-10:, :2], axis=0).mean(axis=0)
        numbers[f"dilatancy, {name}"] = -(late[0] + late[1]) / (late[0] - late[1])
    numbers = {key: value for key, value in numbers.items() if key.startswith("stress") or "psi" in key}
    for label, material in (
        ("plane strain", Material(1e7, 1590.0)),
        ("eq. 43", Material(1e7, 1590.0, modulus="printed")),
        ("eq. 43, elastic", Material(1e7, 1590.0, modulus="printed", yields=False)),
    ):
        stresses = np.array([element.confined(material, strain).stress for strain in np.linspace(1e-4, 0.01, 20)])
        right.plot(stresses[:, YY] / 1e3, stresses[:, XX] / 1e3, label=label)
        numbers[f"pressure at rest, {label}"] = float(stresses[-1, XX] / stresses[-1, YY])
    for panel, x, y in (
        (left, "strain upright (%)", "σ1/σ3"),
        (middle, "strain upright (%)", "volume strain (%), compression positive"),
        (right, "σ_yy (kPa), confined", "σ_xx (kPa)"),
    ):
        panel.set_xlabel(x)
        panel.set_ylabel(y)
        panel.legend(fontsize=8)
    return conclude(HERE, numbers, figure, words.out)


if __name__ == "__main__":
    raise SystemExit(main())
