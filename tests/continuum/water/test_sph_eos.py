"""Equations of state: found by their files, and what each says of itself holds together."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from continuum_sph.water.eos.law import Given, pressure_of
from continuum_sph.water.eos.register import laws, offered

ROOT = Path(__file__).resolve().parents[3]
GIVEN = Given(density=1.2, sound_speed=None, pressure=1e5, exponent=1.4, stiffness=1e6)

LINEAR = '''
"""Linear: p = c0² (ρ - ρ0)."""

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

from continuum_sph.water.eos.law import pressure_of


class LinearNumbers(NamedTuple):
    density: float
    sound_speed: float
    least_density: float


@pressure_of.of(LinearNumbers)
def pressure_of_linear(ratio, law):
    return law.density * law.sound_speed * law.sound_speed * (ratio - 1.0), 1.0


@dataclass(frozen=True)
class Linear:
    gas: ClassVar[bool] = False
    density: float
    sound_speed: float

    @classmethod
    def of(cls, given):
        return cls(given.density, given.sound_speed)

    @property
    def least_density(self):
        return 0.8 * self.density

    @property
    def numbers(self):
        return LinearNumbers(self.density, self.sound_speed, self.least_density)

    def pressure(self, density):
        return self.sound_speed**2 * (density - self.density)

    def density_at(self, pressure):
        return self.density + pressure / self.sound_speed**2

    def sound_speed_at(self, density):
        return self.sound_speed + 0.0 * density


LAW = Linear
'''

RUNS = """
from continuum_sph import Scene, Simulation
from continuum_sph.builders.report import report
from porescale.common.schema.sections import validate

scene = validate(Scene, {
    "tank": {"width": 1.0, "height": 1.0},
    "water": {"sound_speed": 20.0, "column": [{"width": 1.0, "height": 1.0}]},
    "inclusion": {"law": "linear", "density": 500.0, "sound_speed": 30.0,
                  "disc": [{"x": 0.5, "y": 0.5, "radius": 0.3}]},
    "numerics": {"spacing": 0.05},
    "time": {"end": 1.0},
    "output": {"snapshot_interval": 1.0, "series_interval": 1.0},
})
rows = [row for row in report(scene).as_dict().values()]
simulation = Simulation(scene)
simulation.advance(3)
simulation.check()
layer = simulation.flow.layer
own = layer.material[: layer.fluid] == 1
state = simulation.flow.law.fluids[1].state
found, wanted = layer.pressure[: layer.fluid][own], state.pressure(layer.record[: layer.fluid, 4][own])
assert type(state).__name__ == "Linear"
assert abs(found - wanted).max() < 1e-9 * abs(wanted).max(), (found, wanted)
print("ran", own.sum())
"""


@pytest.mark.parametrize("name", offered())
def test_pressures_in_kernels_are_those_of_the_law(name):
    law = laws()[name].of(GIVEN)
    for ratio in (0.9, 1.0, 1.3):
        pressure, speed2 = pressure_of.py_func(ratio, law.numbers)
        rho = np.array(ratio * law.density)
        assert pressure == pytest.approx(float(law.pressure(rho)), rel=1e-12, abs=1e-9 * law.density)
        assert law.sound_speed * speed2**0.5 == pytest.approx(float(law.sound_speed_at(rho)), rel=1e-12)
    assert law.numbers[:3] == (law.density, law.sound_speed, law.least_density)


def test_laws_are_offered_by_the_names_of_their_files():
    assert offered() == ["adiabatic", "liquid", "printed"]
    assert offered(gas=True) == ["adiabatic", "printed"]


@pytest.mark.slow
def test_a_law_in_a_new_file_is_offered_and_runs(tmp_path):
    for package in ("porescale", "continuum_sph"):
        shutil.copytree(ROOT / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    (tmp_path / "continuum_sph" / "water" / "eos" / "linear.py").write_text(LINEAR, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-c", RUNS], cwd=tmp_path, env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True,
        timeout=600,
    )  # fmt: skip
    assert done.stdout.startswith("ran "), done.stderr
