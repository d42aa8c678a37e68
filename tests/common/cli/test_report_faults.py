"""What the report of a scene refuses names the scene's file, or --set where that gave the key."""

import pytest

from continuum_sph.cli import PACKAGE
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import open_scene
from porescale.common.studies.parameter_table import Point
from porescale.common.studies.sweep import check_points

SOFT = """
[tank]
width = 1.0
height = 0.5
[water]
sound_speed = 1
[[water.column]]
width = 0.5
height = 0.4
[numerics]
spacing = 0.1
[time]
end = 1.0
[output]
snapshot_interval = 1.0
series_interval = 1.0
"""


@pytest.mark.parametrize(("settings", "place"), [((), "soft.toml: "), (("water.sound_speed=2",), "--set: ")])
def test_a_fault_that_a_report_finds_names_where_the_key_stands(tmp_path, settings, place):
    file = tmp_path / "soft.toml"
    file.write_text(SOFT)
    opened = open_scene(file, PACKAGE.scene(), overrides=settings)
    with pytest.raises(InputError, match=rf"{place}water\.sound_speed = .* Mach"):
        PACKAGE.report_of(opened)
    with pytest.raises(InputError, match=rf"a, .*{place}water\.sound_speed"):
        check_points(PACKAGE, file, [Point("a", settings)], None, ())
    PACKAGE.report_of(open_scene(file, PACKAGE.scene(), overrides=["water.sound_speed=30"]))
