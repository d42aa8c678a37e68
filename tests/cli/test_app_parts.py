"""The package's face: its API, its commands' parts, and what they leave alone."""

import re
import sys
import tomllib
from types import SimpleNamespace

import numpy as np
import pytest

import porescale
from porescale import Scene
from porescale.cli.main import PACKAGE
from porescale.common.core.errors import InputError
from porescale.common.duration.expected import COMPILING, LEARNT, Work
from porescale.common.record.model import Model, Snapshot
from porescale.common.schema.messages import every_key
from porescale.common.schema.sections import LEVELS, load, scene_as_dict
from porescale.output import show
from tests.reference.folders import ROOT
from tests.reference.scenes import column, dry, table, write
from tests.reference.waiting import done


def test_the_api_does_what_the_package_says(tmp_path):
    from porescale import Simulation, build, load, open_run

    assert porescale.__doc__
    assert "from porescale import build, load, open_run" in porescale.__doc__
    file = write(tmp_path / "scene.toml", table(quality={"draft": {"time": {"end": 0.001}}}))
    simulation = build(load(file, quality="draft"))
    assert isinstance(simulation, Simulation)
    assert isinstance(simulation, Model)
    assert isinstance(simulation.scene, porescale.Scene)
    simulation.advance(3)
    assert simulation.step == 3
    assert simulation.time == 3 * simulation.step_seconds
    with pytest.raises(InputError, match="no run here"):
        open_run(tmp_path)


def test_every_name_of_the_api_is_there_and_no_other():
    for name in porescale.__all__:
        assert getattr(porescale, name) is not None
    with pytest.raises(AttributeError, match="No porescale attribute sails"):
        porescale.sails  # noqa: B018


def test_the_package_and_its_help_wait_for_no_compiler():
    watch = "import sys; {}; sys.exit('numba' in sys.modules)"
    commands = (
        "import porescale",
        "from porescale.cli.main import PACKAGE; from porescale.common.cli.application import application, main; "
        "main(application(PACKAGE), ['--help'])",
    )
    for command in commands:
        words = [sys.executable, "-c", watch.format(command)]
        assert done(words, cwd=ROOT).returncode == 0
    words = [sys.executable, "-c", watch.format("import porescale.common.compiled.compiling")]
    assert done(words, cwd=ROOT).returncode == 1  # the twin: it would be seen


def test_the_template_states_every_section_and_is_a_scene(tmp_path):
    text = PACKAGE.template()
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    for level in (None, *LEVELS):
        assert load(tmp_path, Scene, quality=level).grains.packing is not None
    named = tomllib.loads(text)
    shown = set(named) | set(re.findall(r"^# \[+(\w+)", text, re.MULTILINE))
    assert set(scene_as_dict(column())) <= shown  # every section of a scene is shown, in comments if not in use
    for section in ("domain", "time", "fluid", "gate"):
        shown = set(named[section]) | set(named["quality"]["draft"].get(section, {}))
        in_comments = set(re.findall(r"^# (\w+) =", text, re.MULTILINE))
        missing = set(scene_as_dict(column())[section]) - shown - in_comments - {"relaxation_time"}
        assert not missing, f"{section}: {missing}"


def test_the_template_names_every_key_of_every_section():
    text = PACKAGE.template()
    keys = set(every_key(Scene))
    missing = [key for key in keys if not re.search(rf"(?<!\w){key[-1]}(?!\w)", text)]
    assert not missing
    assert len(keys) > 150
    assert not re.search(r"(?<!\w)diametre(?!\w)", text)  # the twin: a key that is none is not found


def test_every_validation_and_benchmark_has_a_name_of_its_own():
    names = [row.name for row in PACKAGE.validations()]
    assert len(names) == len(set(names)) > 10
    assert {name.partition(".")[0] for name in names} >= {"lbm", "dem"}
    assert {"lbm", "psm", "dem", "column"} <= {row.name for row in PACKAGE.benchmarks()}


def test_the_command_line_is_there_before_arrays_and_models_are():
    ask = "import porescale.cli.main, sys; print(sorted({'numpy', 'pydantic', 'numba'} & set(sys.modules)))"
    assert done([sys.executable, "-c", ask]).stdout.strip() == "[]"


def test_the_parts_of_the_package_are_those_of_its_modules():
    assert PACKAGE.scene() is Scene
    assert PACKAGE.template().startswith("#")


def gate_at(time, step, **changes):
    scene = scene_as_dict(column(**changes))
    return show.gate_lines(scene)(Snapshot(time, step))


def test_the_gate_is_drawn_where_it_stands():
    # It opens at 2 ms and rises at 0.4 m/s through a box 8 mm high: at 7 ms it has risen by 2 mm, at 22 ms it is out.
    assert gate_at(0.0, 0) == [((0.008, 0.0), (0.008, 0.008))]
    ((low_x, low), high) = gate_at(0.007, 175)[0]
    assert (low_x, high) == (0.008, (0.008, 0.008))
    assert low == pytest.approx(0.002, rel=1e-12)
    assert gate_at(0.0221, 552) == []
    assert gate_at(0.003, 75, gate__lift_speed=None) == []
    assert gate_at(0.001, 25, gate__lift_speed=None) != []
    assert gate_at(0.0, 0, gate__lift_speed=None, gate__opens_at=0.0) != []  # the picture of the start shows it
    assert gate_at(0.0, 0, gate=None) == []


def test_a_dry_run_is_shown_without_a_fluid(tmp_path):
    from porescale import build
    from porescale.program import drive

    scene = dry(time__end=0.002, output__snapshot_interval=0.001)
    card = {"scene": scene_as_dict(scene), "name": "dry"}
    outcome = drive(build(scene), tmp_path / "run", scene, card=card, resume=False, quiet=True)
    assert outcome.outcome == "finished"
    names = {path.name for path in (tmp_path / "run").iterdir()}
    assert "grains.vtkhdf" in names
    assert "fields.vtkhdf" not in names
    assert "streamlines.png" not in names
    run = porescale.open_run(tmp_path / "run")
    fallen = run.snapshot(0).clouds["grains"].position - run.snapshot(-1).clouds["grains"].position
    # Free fall from where they were placed, g t^2/2 at most: 2e-5 m; some rest on others.
    assert 0 < np.max(fallen[:, 1]) < 1.01 * 0.5 * 9.81 * 0.002**2


def test_a_cache_that_cannot_be_written_fails_no_run(tmp_path, monkeypatch):
    from porescale import build
    from porescale.program import drive

    (tmp_path / "file").write_text("in the way")
    (tmp_path / "folder").mkdir()
    scene = dry(time__end=0.001, output__snapshot_interval=0.001)
    for place in ("file", "folder"):
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / place))
        out = tmp_path / f"run with a {place}"
        ended = drive(build(scene), out, scene, card={"scene": scene_as_dict(scene)}, resume=False, quiet=True)
        assert ended.outcome == porescale.open_run(out).card["outcome"] == "finished"
    assert list((tmp_path / "folder" / "porescale").glob("times2.json"))  # the twin: where it can be written, it is


@pytest.mark.parametrize("overwrite", [False, True])
def test_both_packages_hand_on_that_a_run_may_be_replaced(tmp_path, monkeypatch, overwrite):
    import continuum_sph.cli
    import porescale.cli.main

    class Asked(Exception):
        pass

    def asked(*_, **options):
        raise Asked(options["overwrite"])

    monkeypatch.setattr("porescale.common.record.drive.drive", asked)
    work = Work("", "", dict.fromkeys((COMPILING, *LEARNT), 1.0))
    monkeypatch.setattr("porescale.builders.cost.work", lambda *_: work)
    model = SimpleNamespace(derived=None)
    for part in (porescale.cli.main.PACKAGE, continuum_sph.cli.PACKAGE):
        (tmp_path / "scene.toml").write_text(part.template(), encoding="utf-8")
        scene = load(tmp_path, part.scene())
        with pytest.raises(Asked, match=str(overwrite)):
            part.drive(model, tmp_path, scene, card={}, resume=False, quiet=True, overwrite=overwrite)
