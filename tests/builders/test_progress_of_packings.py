"""`check` and `run` name a packing that is being made, and say how long it takes, where that is longer than 2 s."""

import pytest

from porescale.builders.initial import grains
from porescale.builders.report import report
from porescale.cli.main import PACKAGE
from porescale.common.cli.application import application, main
from porescale.common.duration.doing import NOW
from porescale.common.record.progress import Watch
from tests.reference.scenes import dry, grain, table, write

BED = {"left": 0.0, "width": 0.012, "height": 0.005, "diameter": 0.0008, "packing_fraction": 0.7, "settle": True}


@pytest.fixture
def named(monkeypatch):
    """What is named by progress each time that a packing is made, with the seconds left, by the function."""
    said = []
    for name in ("prepared", "prepared_among", "compressed"):
        made = getattr(grains, name)

        def noted(*given, made=made, name=name, **more):
            said.append((name, NOW[-1].name, NOW[-1].left()))
            return made(*given, **more)

        monkeypatch.setattr(grains, name, noted)
    return said


def test_a_packing_that_check_makes_is_named_with_the_time_left(named):
    report(dry(grains__packing=BED, grains__grain=[grain(0.006, 0.002, 0.0015)]))
    ((name, what, left),) = named
    assert (name, what) == ("prepared_among", "settling the packing")
    assert left > 0.0
    assert NOW == []
    named.clear()
    report(dry(grains__packing=BED))  # the check that fails: nothing stands in it, and check makes no packing
    assert named == []


def test_more_grains_and_more_layers_take_longer():
    # Grains times layers at 25 000 a second: 9869 grains in 80 layers took 35 s of a core.
    packing = dry(grains__packing={**BED, "height": 0.064}).grains.packing
    assert grains.settling_seconds(packing, 9869) == pytest.approx(9869 * 80 / 25e3)


def test_the_command_watches_what_check_makes(named, tmp_path, monkeypatch, capsys):
    watched = []
    enter = Watch.__enter__
    monkeypatch.setattr(Watch, "__enter__", lambda self: watched.append(self) or enter(self))
    monkeypatch.setattr("porescale.common.record.progress.PATIENCE", 0.0)
    monkeypatch.setattr("porescale.common.record.progress.LINE_EVERY", 0.01)
    whole = table(fluid=None, grains={"density": 2500, "packing": BED, "grain": [grain(0.006, 0.002, 0.0015)]},
                  gate=None)  # fmt: skip
    assert main(application(PACKAGE), ["check", str(write(tmp_path / "bed.toml", whole))]) == 0
    assert [name for name, *_ in named] == ["prepared_among"]
    assert [watch.end for watch in watched] == [0.0]
    said = capsys.readouterr().err.splitlines()
    assert all(line.startswith("bed: ") for line in said if " so far" in line)
