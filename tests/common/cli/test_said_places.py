"""What commands say names the file, the key and the folder of the one who reads it: faults of a report, `new`."""

import pytest

from continuum_sph.cli import PACKAGE
from porescale.common.cli import new
from porescale.common.core.errors import InputError
from porescale.common.schema.sections import load
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
    scene = load(file, PACKAGE.scene(), overrides=settings)
    with pytest.raises(InputError, match=rf"{place}water\.sound_speed = .* Mach"):
        PACKAGE.report_of(scene)
    with pytest.raises(InputError, match=rf"a, .*{place}water\.sound_speed"):
        check_points(PACKAGE, file, [Point("a", settings)], None, ())
    PACKAGE.report_of(load(file, PACKAGE.scene(), overrides=["water.sound_speed=30"]))


def test_new_names_its_own_commands_with_the_folder_as_a_shell_takes_it(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    new.command(PACKAGE)("name with space")
    assert "next: continuum-sph check 'name with space'; continuum-sph run 'name with space'" in capsys.readouterr().out
    with pytest.raises(InputError, match=r"is no case; .*`continuum-sph cases` lists all"):
        new.command(PACKAGE)("other", from_="no such case")
