"""`study volume` compares what material files say, packing by packing."""

import math

import pytest

from porescale.cli.homogenise_volume import checked, measured, write
from porescale.common.core.errors import InputError
from porescale.common.studies.parameter_table import Point, ladders
from tests.reference.folders import ROOT

BED = ROOT / "cases" / "micro_to_macro" / "bed.toml"


def file(values, seeds=(1, 2, 3, 4)):
    angle = {"values": [math.radians(it) for it in values], "unit": "rad", "interval": math.radians(1.0)}
    return {"made": {"seeds": list(seeds)}, "measured": {"critical_friction_angle": angle}}


def compared(first, second, **more):
    before = measured(Point("a", ("homogenise.grains=150",)), file(first), {})
    return before, measured(Point("b", ("homogenise.grains=600",)), file(second, **more), before)


def test_a_change_is_that_of_the_same_packings():
    # 10, 12, 14, 16 degrees and each 1 ± 0.1 more: packings are 2.6 degrees apart, their differences 0.12
    _, after = compared((10, 12, 14, 16), (11.1, 12.9, 15.1, 16.9))
    seen = after["critical_friction_angle"]
    assert (seen.sample.mean, seen.change) == pytest.approx((14.0, 1.0))
    assert seen.change_half == pytest.approx(3.1824 * 0.11547 / 2.0, rel=1e-4)  # t of three degrees of freedom
    assert seen.verdict == "resolved"
    assert seen.sample.deviation == pytest.approx(2.6, abs=0.1)


def test_the_same_change_of_other_packings_is_not_resolved():  # the twin that must fail
    _, after = compared((10, 12, 14, 16), (16.9, 11.1, 15.1, 12.9))
    assert after["critical_friction_angle"].change == pytest.approx(1.0)
    assert after["critical_friction_angle"].verdict == "not resolved"
    _, after = compared((10, 12, 14, 16), (11, 13, 15, 17), seeds=(5, 6, 7, 8))
    assert after["critical_friction_angle"].verdict == ""  # no packing in common


def test_the_files_say_so(tmp_path):
    before, after = compared((10, 12, 14, 16), (11.1, 12.9, 15.1, 16.9))
    write(tmp_path, "porescale study volume scene", [*before.values(), *after.values()])
    assert "| homogenise.grains | 600 | critical angle, degrees | 4 | 14 | 1 |" in (tmp_path / "volume.md").read_text()
    assert (tmp_path / "volume.png").read_bytes().startswith(b"\x89PNG")
    assert len((tmp_path / "volume.csv").read_text().splitlines()) == 3


def test_two_keys_of_one_last_part_have_folders_of_their_own():
    (first, _), (second,) = ladders(["homogenise.pressure=100,300", "contact.pressure=100"])
    assert (first.name, second.name) == ("pressure=100", "pressure=100-2")
    with pytest.raises(InputError, match="grains: is given twice"):
        ladders(["homogenise.grains=150", "homogenise.grains=600"])


@pytest.mark.parametrize(
    ("settings", "wrong", "message"),
    [
        ((), "homogenise.grains=200,20", "grains=20, --set: homogenise.grains = 20: is out of range"),
        ((), "contact.fricton=0.1", "fricton=0.1, --set: contact.fricton = 0.1: unknown key"),
        (("contact.friction=0.3",), "contact.friction=0.1", "--set: contact.friction = '0.3': is varied, too"),
    ],
)
def test_all_values_are_looked_at_before_the_first_is_measured(settings, wrong, message):
    assert checked(BED, ladders(["homogenise.pressure=100"]), "draft", settings) == "bed"
    with pytest.raises(InputError, match=message):
        checked(BED, ladders(["homogenise.pressure=100", wrong]), "draft", settings)
