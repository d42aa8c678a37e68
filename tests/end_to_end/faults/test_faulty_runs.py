"""A run that goes wrong says so, keeps its last good state, and has recorded nothing that is wrong."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from porescale import open_run
from porescale.common.record.checkpoint import read_checkpoint
from porescale.common.record.drive import CHECK_EVERY
from porescale.common.schema.sections import load
from tests.reference.faults.seeded import INF, NAN, put
from tests.reference.programs import KINDS, PACKAGES, program

AT = 50
STEPS: dict[str, list[int]] = {}
"""Where a fault was put."""


def seeded(name: str, place: str, index: Any, value: float) -> Callable[[Any], None]:
    """Writes ``value`` into the model and remembers when."""

    def fault(model: Any) -> None:
        STEPS[name] = [model.step]
        put(place, index, value)(model)

    return fault


FAULTS = {
    "tank": [("flow.layer.v", (AT, 0), NAN, "velocity"), ("flow.layer.density", AT, -1.0, "density")],
    "soil": [("flow.soil.stress", (AT, 1), INF, "stress"), ("flow.soil.x", (AT, 1), 3.0, "way since the last look")],
    "bubble": [("flow.layer.v", (AT, 0), INF, "velocity"), ("flow.layer.density", AT, 0.0, "density")],
    "air": [("flow.water.layer.density", -1, -1.0, "density"), ("flow.water.layer.density", -1, NAN, "density"),
            ("flow.ground.soil.stress", (AT, 2), NAN, "stress")],
}  # fmt: skip
"""By scene: array, index, value, and the quantity that is named."""
CASES = [
    pytest.param(name, *fault, id=f"{name} {fault[0].split('.')[-1]} {fault[2]:g}",
                 marks=[pytest.mark.slow] if name != "tank" else [])
    for name, faults in FAULTS.items() for fault in faults
]  # fmt: skip


@pytest.mark.parametrize(("name", "place", "index", "value", "quantity"), CASES)
def test_a_run_that_goes_wrong_keeps_its_last_good_state(tmp_path, complaints, name, place, index, value, quantity):
    one, out = program(name, tmp_path), tmp_path / "run"
    often = ("--set", "output.checkpoint_seconds=0.005")  # before the fault, in the shortest of them, too
    assert one.run(out, *often, happens=lambda: None, fault=seeded(name, place, index, value)) == 3
    (line,) = complaints()
    (put_at,) = STEPS[name]
    run = open_run(out)
    stopped = run.card["step"]
    assert put_at <= stopped <= put_at + CHECK_EVERY
    assert line.startswith(f"unstable at step {stopped} ")
    assert quantity in line
    assert run.card["outcome"] == "unstable"
    assert len(run) >= 2
    for snapshot in run.snapshots():
        assert snapshot.step <= put_at
        for cloud in snapshot.clouds.values():
            assert all(np.isfinite(values).all() for values in (cloud.position, *cloud.data.values()))
    saved = read_checkpoint(out / "checkpoint.h5")
    assert 0 < saved["step"] <= put_at
    assert f"step {saved['step']}" in line.rpartition(";")[2]
    package = PACKAGES[KINDS[name][0]]
    model = package.build(load(one.scene, package.scene()))
    model.restore(saved["state"])
    model.check()
    assert one.run(tmp_path / "sound") == 0  # the twin that must not fail
