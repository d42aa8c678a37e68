"""The budget of energies is kept where a scene asks for it, costs nothing elsewhere, and moves nobody."""

import numpy as np
import pytest

from continuum_sph.builders.simulation import Simulation
from continuum_sph.validation.tanks import tank_scene
from porescale.common.core.errors import InputError
from porescale.common.evidence.overhead import bytes_of
from porescale.common.record.checkpoint import read_checkpoint, write_checkpoint

SHIFTED = {"numerics": {"spacing": 0.1, "gradient": "corrected", "shifting": 2.0}}
PULLED = {
    "numerics": {"spacing": 0.05, "shifting": 1.0},  # as of the bubble of test_sph_extremes, whose kernels these are
    "inclusion": {"density": 500.0, "law": "liquid", "surface_tension": 1.0,
                  "disc": [{"x": 0.25, "y": 0.5, "radius": 0.2}]},
}  # fmt: skip
TURNED = {"heat of viscosity (J/m)", "energy diffused (J/m)", "work of walls (J/m)", "work of surface tension (J/m)",
          "work of shifting (J/m)", "energy stopped at walls (J/m)", "total energy (J/m)",
          "energy balance (J/m)"}  # fmt: skip
ROWS = 2 * 6 * 8  # bytes of a particle's power and energy


def made(energy, sections):
    """A column that falls, with or without a budget."""
    output = {"snapshot_interval": 1.0, "series_interval": 1.0} | energy
    given = {"water": {"column": [{"width": 0.5, "height": 1.0}]}, "output": output}
    return Simulation(tank_scene(1.5, 1.5, 0.1, **given | sections))


def test_a_scene_that_does_not_ask_for_energies_has_no_budget():
    without, kept = made({}, {}), made({"energy": True}, {})
    assert without.scene.output.energy is False
    assert without.flow.layer.power.nbytes == without.flow.layer.energy.nbytes == 0
    assert bytes_of(kept) - bytes_of(without) == ROWS * kept.flow.layer.fluid
    assert kept.series().keys() - without.series().keys() == TURNED
    assert kept.flow.state()["layer"].keys() - without.flow.state()["layer"].keys() == {"power", "energy"}
    without.advance(20)
    kept.advance(20)
    assert without.flow.layer.energy.size == 0
    assert (kept.flow.layer.energy != 0.0).any(axis=0).sum() >= 3  # viscosity, diffusion, walls: the twin


@pytest.mark.parametrize("sections", [{}, SHIFTED, PULLED], ids=["plain", "shifted", "two fluids"])
def test_a_budget_moves_nobody(sections):
    without, kept = made({}, sections), made({"energy": True}, sections)
    without.advance(150)
    kept.advance(150)
    assert without.time == kept.time
    for name in ("x", "v", "density", "acceleration", "rate"):
        assert getattr(without.flow.layer, name).tobytes() == getattr(kept.flow.layer, name).tobytes(), name
    assert np.abs(kept.flow.layer.energy).sum() > 0.0


def test_a_run_with_a_budget_is_taken_up_again_to_the_bit(tmp_path):
    straight = made({"energy": True}, {})
    straight.advance(60)
    write_checkpoint(tmp_path / "c.h5", straight.state())
    straight.advance(60)
    resumed = made({"energy": True}, {})
    resumed.restore(read_checkpoint(tmp_path / "c.h5"))
    resumed.advance(60)
    assert resumed.flow.layer.energy.tobytes() == straight.flow.layer.energy.tobytes()
    assert resumed.series() == straight.series()


def test_a_budget_of_no_water_is_refused():
    soil = {"stiffness": 1e6, "permeability": 1e-3, "body": [{"outline": [[0, 0], [1, 0], [1, 1], [0, 1]]}]}
    with pytest.raises(InputError, match=r"output\.energy.*is of water"):
        made({"energy": True}, {"water": {}, "soil": soil})
