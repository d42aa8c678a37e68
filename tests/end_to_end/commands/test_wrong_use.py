"""What newcomers get wrong, and the one line of each error message: to the point, with a way out."""

import json
from pathlib import Path

import pytest

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import commands
from porescale.common.cli.application import application, main
from tests.reference.folders import ROOT
from tests.reference.programs import SOIL
from tests.reference.scenes import COLUMN, write

CASE = str(ROOT / "cases" / "column_collapse")
WRONG: dict[tuple[str, ...], str] = {
    # the other program's scenes and commands
    ("porescale", "check", "soil.toml"): "tank: is a section of scenes of continuum-sph; continuum-sph check soil.toml",
    ("porescale", "run", "soil.toml"): "is a section of scenes of continuum-sph",
    ("porescale", "homogenise", "soil.toml"): "is a section of scenes of continuum-sph",
    ("continuum", "check", "good.toml"): "domain: is a section of scenes of porescale; porescale check good.toml",
    ("continuum", "sweep", "good.toml", "--vary", "time.end=1,2"): "is a section of scenes of porescale",
    ("continuum", "study", "stability"): 'Unknown command "stability"',
    ("continuum", "verify", "lbm.poiseuille"): "no such validation",
    ("porescale", "swim", "good.toml"): "swim",
    # names of scenes
    ("porescale", "run", "nowhere"): "no scene here",
    ("porescale", "check", "good"): "no scene here; did you mean good.toml?",
    ("porescale", "check", "good.txt"): "no scene here; did you mean good.toml?",
    ("porescale", "check", "folder.toml"): "looked for the file folder.toml/scene.toml",
    ("porescale", "check", "link.toml"): "no scene here",
    ("porescale", "check", "words.toml"): "Expected '=' after a key",
    ("porescale", "check", "https://example.org/a.toml"): "no scene here",
    # numbers
    ("porescale", "run", "good.toml", "--threads", "0"): "--threads",
    ("porescale", "run", "good.toml", "--threads", "1.5"): '"1.5" is no whole number',
    ("porescale", "run", "good.toml", "--threads", "2.0"): '"2.0" is no whole number',
    ("porescale", "sweep", "good.toml", "--vary", "time.end=1,2", "--threads", "0"): "--threads = 0: is out of range",
    ("continuum", "sweep", "soil.toml", "--vary", "time.end=1,2", "--threads", "-1"): "--threads = -1: is out of range",
    ("porescale", "study", "trade", "good.toml", "--threads", "0"): "--threads = 0: is out of range",
    ("porescale", "homogenise", "good.toml", "--threads", "0"): "--threads = 0: is out of range",
    ("porescale", "run", "good.toml", "--threads", "many"): 'unable to convert "many" into int',
    ("porescale", "sweep", "good.toml", "--vary", "time.end=1,2", "--jobs", "1.5"): '"1.5" is no whole number',
    ("porescale", "bench", "dem", "--size", "1000000000000"): "(allowed: 1 to 10000000)",
    ("porescale", "bench", "lbm", "--size", "0"): "(allowed: 1 to 10000000)",
    ("continuum", "bench", "water", "--size", "1e9"): 'unable to convert "1e9" into int',
    ("porescale", "check", "good.toml", "--set", "fluid.viscosity=1,5e-5"): "has a comma; write a number with a point",
    ("porescale", "check", "good.toml", "--set", "fluid.viscosity 2e-5"): "is not section.key=value",
    ("porescale", "run", "good.toml", "--set", "fluid.viscosity"): "--set",
    ("porescale", "run", "good.toml", "--set", "fluid.viscosity=-1"): "--set",
    ("porescale", "run", "good.toml", "--set", "fluid.hue=1"): "fluid.hue",
    ("porescale", "check", "good.toml", "--set", "gravity=-9.81"): "is not a list",
    ("continuum", "check", "soil.toml", "--set", "gravity=-9.81"): "free fall (downwards) in this range",
    ("porescale", "check", "good.toml", "--set", "domain.left=Wall"): "did you mean 'wall'?",
    ("porescale", "run", "good.toml", "--quality", "fine"): "no such level",
    ("porescale", "check", "good.toml", "--set", "quality_default=[1,2,3]"): "--quality chooses one of its levels",
    ("porescale", "verify", "no.such.row", "--out", "good.toml"): "no such validation",
    ("porescale", "verify", "dem.static_stack", "--out", "good.toml"): "cannot be written (Not a directory)",
    ("porescale", "run", "good.toml", "--quality", "finest"): "quality",
    ("porescale", "check", "good.toml", "--quality", "Draft"): 'Did you mean "draft"?',
    ("porescale", "run", "good.toml", "--speed", "3"): "--speed",
    # options that contradict, or ask for what is not there
    ("continuum", "run", "soil.toml", "--device", "gpu"): "--device: is of porescale: continuum-sph runs on the CPU",
    ("porescale", "run", "good.toml", "--resume", "--overwrite"): "contradicts --overwrite",
    ("porescale", "run", CASE, "--error", "5%", "--quality", "fine"): "contradicts --error",
    ("porescale", "run", CASE, "--error", "1e-9%"): "is below the best point measured",
    ("porescale", "run", CASE, "--budget", "soon"): "write it as 3min, 90s or 2h",
    ("porescale", "run", "good.toml", "--error", "5%"): "no front was measured for this scene",
    ("porescale", "study", "trade", "good.toml"): "trade.toml: is no file",
    ("porescale", "study", "trade", "good.toml", "--plan", "a" * 300): "is no file",
    ("porescale", "run", "good.toml", "--out", "good.toml"): "is a file",
    ("porescale", "run", "good.toml", "--resume", "--out", "nowhere"): "holds no run to resume",
    # tables of sweeps
    ("porescale", "sweep", "good.toml", "none.csv"): "none.csv: table: cannot be read (No such file or directory)",
    ("porescale", "sweep", "good.toml", "latin.csv"): "latin.csv: line 2: is not UTF-8 text; save it as UTF-8",
    ("porescale", "sweep", "good.toml", "."): "cannot be read",
    ("porescale", "sweep", "good.toml"): "varies nothing",
    ("continuum", "sweep", "soil.toml", "--repeat", "3"): "repeats the same run: the scene draws nothing at random",
    ("porescale", "sweep", "good.toml", "--repeat", "0"): "(allowed: 1 to 10000)",
    ("porescale", "sweep", "good.toml", "--vary", "time.end"): "write it as --vary contact.friction=0.2,0.5",
    # folders that are no runs
    ("porescale", "show", "nowhere"): "no run here (card.json is missing)",
    ("porescale", "show", "good.toml"): "no run here (card.json is missing)",
    ("porescale", "show", "half"): "card.json is damaged or not that of a run",
    ("continuum", "show", "half"): "card.json is damaged or not that of a run",
    ("porescale", "show", "other"): "holds a run of continuum-sph, not of porescale",
    ("porescale", "measure", "deck", "probe.toml"): "to measure, run its scene (porescale demseg convert makes one)",
    ("porescale", "measure", "begun", "probe.toml"): "has no snapshots; let it run until its first snapshot",
    ("porescale", "measure", "gone", "probe.toml"): "(*.vtkhdf) are missing; put them back, or run its scene again",
    ("porescale", "show", "gone"): "(*.vtkhdf) are missing; put them back, or run its scene again with --overwrite",
    ("porescale", "show", "gone", "--every", "2"): "(*.vtkhdf) are missing; put them back, or run its scene again",
    ("porescale", "demseg", "run", "good.toml"): "in_gm.dat: cannot be read (Not a directory)",
    ("porescale", "piv", "measure", "good.toml"): "cannot be read",
}


@pytest.fixture
def place(tmp_path, monkeypatch) -> Path:
    """A folder with scenes of both programs and what is none."""
    write(tmp_path / "good.toml", COLUMN)
    write(tmp_path / "soil.toml", SOIL)
    (tmp_path / "folder.toml").mkdir()
    (tmp_path / "link.toml").symlink_to("link.toml")
    (tmp_path / "words.toml").write_text("domain:\n  width: 1\n")
    (tmp_path / "latin.csv").write_bytes("name,title\na,Körner\n".encode("latin-1"))
    (tmp_path / "probe.toml").write_text("[[probe]]\nx = 0.01\ny = 0.01\n")
    scene = {"package": "porescale", "scene": {"domain": {"width": 0.1, "height": 0.1}, "time": {}, "output": {}}}
    cards = {
        "half": {}, "other": {"package": "continuum-sph", "scene": {}}, "begun": scene, "gone": {**scene, "time": 0.01},
        "deck": {"package": "porescale demseg", "scene": {}},
    }  # fmt: skip
    for name, card in cards.items():
        (tmp_path / name).mkdir()
        (tmp_path / name / "card.json").write_text(json.dumps(card))
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("words", WRONG, ids=" ".join)
def test_wrong_use_is_answered_in_one_line_with_a_way_out(place, complaints, words):
    before = sorted(place.rglob("*"))
    app = application(CONTINUUM) if words[0] == "continuum" else commands()
    assert main(app, words[1:]) == 2
    (line,) = complaints()
    assert WRONG[words] in line
    assert len(line) < 600
    assert sorted(place.rglob("*")) == before


def test_there_are_thirty_of_them():
    assert len(WRONG) >= 30


def test_what_is_right_is_not_refused(place):  # the twin that must not fail
    assert main(commands(), ["check", "good.toml", "--set", "fluid.viscosity=20 cSt"]) == 0
    assert main(application(CONTINUUM), ["check", "soil.toml", "--set", "gravity=9.7"]) == 0
    assert main(commands(), ["piv", "synth", "--help"]) == 0
