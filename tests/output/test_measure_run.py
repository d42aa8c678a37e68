"""A finished run is measured at its snapshots: the numbers and columns of the run that measured itself."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import continuum_sph
import porescale
from porescale.builders.build import build
from porescale.common.core.errors import InputError, PorescaleWarning
from porescale.common.record.drive import drive
from porescale.common.schema.sections import scene_as_dict
from porescale.lbm.collision.entry import MAGIC_MIDWAY_WALL
from porescale.scene.measures.probe import Probe
from porescale.scene.measures.region import Region
from porescale.validation.lbm.channels import steady_steps
from tests.reference.scenes import column as bed
from tests.reference.scenes import dry, water

EPS = 2.0**-24
"""Relative error of a number that is stored in single precision."""
PROBES = [{"name": "tap", "x": 0.001, "y": 0.002}, {"x": 0.0061, "y": 0.0051},
          {"name": "bed", "x": 0.004, "y": 0.004, "width": 0.0041, "height": 0.0021}]  # fmt: skip
FLUX = [{"start": [0.006, 0.0], "end": [0.006, 0.008]}, {"name": "out", "start": [0.006, 0.008], "end": [0.006, 0.0]}]
LINE = [{"start": [0.006, 0.0], "end": [0.006, 0.008], "points": 5}]
REGIONS = [{"lower": [0.006, 0.0], "upper": [0.0119, 0.004]}, {"name": "low", "lower": [0.007, 0.0],
            "upper": [0.010, 0.0012]}]  # fmt: skip


def driven(scene: Any, folder: Path, **card: Any) -> porescale.Run:
    """The run of a scene with rows at its five snapshots."""
    interval = scene.time.end / 4
    card = {"package": "porescale", "scene": scene_as_dict(scene), **card}
    drive(build(scene), folder, scene.time.end, snapshot_interval=interval, series_interval=interval, card=card,
          quiet=True)  # fmt: skip
    return porescale.open_run(folder)


@pytest.fixture(scope="module")
def wet(tmp_path_factory):
    disc = {"x": 0.004, "y": 0.004, "diameter": 0.002}
    scene = water(disc=[disc], probe=PROBES, flux=FLUX, time__end=0.008)
    return driven(scene, tmp_path_factory.mktemp("wet"))


@pytest.fixture(scope="module")
def heap(tmp_path_factory):
    scene = dry(region=REGIONS, output__contacts=True, time__end=0.04)
    return driven(scene, tmp_path_factory.mktemp("heap"))


@pytest.mark.filterwarnings("ignore:not measured")
def test_probes_and_fluxes_are_those_of_the_run(wet):
    tables = wet.measure(probe=PROBES, flux=FLUX)
    assert tables.keys() == {"probes", "flux"}
    pressure = max(float(np.abs(it["pressure"]).max()) for it in wet)
    speed = max(float(np.abs(it["velocity"]).max()) for it in wet)
    # Weights of cells sum to 1: what is interpolated is off by no more than what was stored; a pressure a second time
    # where shares of solid, stored so too, weigh it.  A flux adds one such error over its length, 8 mm.
    bounds = {
        "pressure (Pa)": 2 * EPS * pressure,
        "(m/s)": EPS * speed,
        "(m²/s)": 2 * EPS * speed * 0.008,
        "share ()": EPS,
    }
    for name, table in tables.items():
        own = wet.table(name)
        assert own["time (s)"].tolist() == table["time (s)"].tolist()
        assert [it for it in own if "of solid" not in it] == list(table)
        for column in list(table)[1:]:
            bound = next(value for end, value in bounds.items() if column.endswith(end))
            assert np.abs(own[column] - table[column]).max() <= bound
            if "velocity y" not in column:  # which may be next to nothing
                assert np.abs(own[column] - 1.001 * table[column]).max() > bound  # the check that must fail


def test_lines_are_those_that_show_writes(wet):
    from porescale.output.lines import profiles

    table = wet.measure(line=LINE)["lines"]
    assert len(table["time (s)"]) == 5 * 5
    assert table["velocity x (m/s)"][-3] == pytest.approx(wet[-1]["velocity"][19:21, 29:31, 0].mean(), rel=1e-6)
    assert {name: list(column) for name, column in table.items()} == profiles(wet, LINE)


def test_lines_and_probes_across_a_channel_are_the_exact_parabola_up_to_its_walls(tmp_path):
    # Ten cells of h between two walls; at magic 3/16 the parabola solves the discrete equations exactly.
    rows, h, step, tau = 10, 2e-4, 4e-5, 1.0
    height, viscosity = rows * h, (tau - 0.5) / 3 * h**2 / step
    force = 1000 * 8 * viscosity * 0.01 / height**2  # peak 1 cm/s
    steps = steady_steps(rows, (tau - 0.5) / 3, MAGIC_MIDWAY_WALL)
    at = np.linspace(0.0, height, 4 * rows + 1)  # walls, centres, and halves between them
    points = [{"name": f"p{k}", "x": 0.0004, "y": float(it)} for k, it in enumerate(at)]
    line = {"start": [0.0004, 0.0], "end": [0.0004, height], "points": len(at)}
    scene = water(
        domain__width=4 * h, domain__height=height, domain__top="wall", fluid__viscosity=viscosity,
        fluid__body_force=[force, 0.0], time__end=steps * step, probe=points, line=[line],
    )  # fmt: skip
    run = driven(scene, tmp_path)
    table, row = run.measure(line=[line])["lines"], run.table("probes")
    parabola = 0.01 * 4 * at * (height - at) / height**2
    # Linear in pieces between nodes of the parabola: below it by u''/2 (y - a)(b - y), a and b at wall or centre.
    nodes = np.array([0.0, *((np.arange(rows) + 0.5) * h), height])
    below = np.clip(np.searchsorted(nodes, at, side="right") - 1, 0, rows)
    exact = parabola - 0.5 * 0.08 / height**2 * (at - nodes[below]) * (nodes[below + 1] - at)
    # A step rounds by eps over the Mach number of 1e-3 and is remembered for rows²/viscosity steps (poiseuille of
    # validation/lbm/channels.py); what is stored is off by EPS of the peak.
    bound = 0.01 * np.finfo(float).eps / 1e-3 * rows**2 / ((tau - 0.5) / 3)
    probed = np.array([row[f"p{k} velocity x (m/s)"][-1] for k in range(len(at))])
    assert np.abs(probed - exact).max() < bound
    found = np.array(table["velocity x (m/s)"])[-len(at) :]
    assert np.abs(found - exact).max() < bound + EPS * 0.01
    assert found[[0, -1]].tolist() == [0.0, 0.0]
    # The check that must fail: the velocity of the first centre, h/2 away.
    assert parabola[2] > 0.0019
    # Pressure across it, at the walls too, is rho g times depth.  Two stored numbers count 3/2 and 1/2 there; a step of
    # the lattice rounds by eps of rho c².
    still, rounded = 1000 * 9.81 * (height - at), np.finfo(float).eps * 1000 * (h / step) ** 2 / 3 * steps
    assert np.abs(np.array(table["pressure (Pa)"])[-len(at) :] - still).max() < 2 * EPS * still.max() + rounded
    assert 1000 * 9.81 * h / 2 > 1e5 * EPS * still.max()  # the check that must fail: that of the first centre


def test_lines_end_with_the_velocity_of_the_sides(tmp_path):
    sides = {"left": "wall", "right": {"kind": "wall", "speed": 0.02}, "top": {"kind": "wall", "speed": -0.01}}
    level = {"start": [0.0, 0.001], "end": [0.002, 0.001], "points": 3}
    upright = {"start": [0.001, 0.0], "end": [0.001, 0.002], "points": 3}
    size = {"domain__width": 0.002, "domain__height": 0.002, "domain__bottom": "slip"}
    scene = water(**{f"domain__{name}": it for name, it in sides.items()}, **size, time__end=0.004,
                  line=[level, upright], fluid__body_force=None)  # fmt: skip
    table = driven(scene, tmp_path).measure(line=[level, upright])["lines"]
    x, y = (np.array(table[f"velocity {axis} (m/s)"])[-6:] for axis in "xy")
    assert (y[0], y[2], x[5]) == (0.0, 0.02, -0.01)
    assert (x[0], x[2], y[3], y[5]) == (0.0, 0.0, 0.0, 0.0)
    assert x[3] != 0.0  # along a line of symmetry the fluid slides


def test_regions_are_those_of_the_run(heap):
    table, own = heap.measure(region=REGIONS)["regions"], heap.table("regions")
    assert list(own) == list(table)
    assert own["low contacts ()"].max() > 1
    for column in own:  # grains and contacts are stored in double precision
        assert np.array_equal(own[column], table[column], equal_nan=True), column
    moved = [{**it, "lower": [it["lower"][0] + 1e-4, 0.0]} for it in REGIONS]
    other = heap.measure(region=moved)["regions"]  # the check that must fail
    assert not np.array_equal(own["low porosity ()"], other["low porosity ()"])


def test_a_grain_moved_in_all_components_is_none_of_the_grains_afterwards_either(tmp_path):
    whole = [{"name": "box", "lower": [0.0, 0.0], "upper": [0.012, 0.008]}]
    still = {"velocity": 0.0}
    control = [{"grain": 0, "x": {"velocity": 0.005}, "y": still, "rotation": still}]
    run = driven(dry(region=whole, output__contacts=True, time__end=0.005, control=control), tmp_path)
    table, own = run.measure(region=whole)["regions"], run.table("regions")
    for column in own:
        assert np.array_equal(own[column], table[column], equal_nan=True), column


def test_regions_of_grains_in_fluid_carry_the_hydraulic_radius_ratio(tmp_path):
    run = driven(bed(region=REGIONS, output__contacts=True, time__end=0.004), tmp_path)
    table, own = run.measure(region=REGIONS)["regions"], run.table("regions")
    assert list(own) == list(table)
    assert list(own)[:2] == ["time (s)", "hydraulic radius ratio ()"]
    assert set(table["hydraulic radius ratio ()"]) == set(own["hydraulic radius ratio ()"]) == {0.8}


def test_regions_without_contacts_have_what_needs_none(heap, tmp_path):
    run = driven(dry(time__end=0.04), tmp_path)
    with pytest.warns(PorescaleWarning, match=r"not measured: .*output\.contacts = true"):
        table = run.measure(region=REGIONS)["regions"]
    own = heap.table("regions")
    assert len(table) == 1 + 2 * 11
    for column in table:
        assert np.array_equal(own[column], table[column], equal_nan=True), column


@pytest.mark.filterwarnings("ignore:not measured")
def test_sections_are_given_as_objects_tables_scenes_and_files(wet, heap, tmp_path):
    expected = dict(wet.measure(probe=PROBES)["probes"])
    file = tmp_path / "sections.toml"
    bed = '[[probe]]\nname = "bed"\nx = 0.004\ny = 0.004\nwidth = 0.0041\nheight = 0.0021\n'
    file.write_text('[[probe]]\nname = "tap"\nx = "1 mm"\ny = 0.002\n[[probe]]\nx = 0.0061\ny = 0.0051\n' + bed)
    objects = [Probe(**it) for it in PROBES]
    scene = water(probe=PROBES)
    for found in (wet.measure(*objects), wet.measure(file), wet.measure(scene), wet.measure({"probe": PROBES})):
        assert found.keys() == {"probes"}
        assert all(np.array_equal(found["probes"][name], expected[name]) for name in expected)
    assert wet.measure(probe=PROBES[0])["probes"].keys() < expected.keys()
    one = heap.measure(Region(lower=(0.006, 0.0), upper=(0.0119, 0.004)))
    assert np.array_equal(one["regions"]["region 0 porosity ()"], heap.table("regions")["region 0 porosity ()"])


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({}, "sections: nothing to measure (allowed: [[probe]], [[flux]], [[line]], [[region]])"),
        ({"prob": PROBES}, "prob: is no section that can be measured afterwards; did you mean 'probe'?"),
        ({"loads": {"discs": [0]}}, "loads: is no section that can be measured afterwards"),
        ({"probe": {"x": 1.0, "y": 0.0}}, "probe[0]"),
        ({"probe": {"x": 0.001}}, "probe[0].y: is missing"),
        ({"probe": {"x": "1 s", "y": 0.0}}, "probe[0].x = '1 s'"),
        ({"region": REGIONS[0] | {"upper": [0.0, 0.0]}}, "region[0].upper"),
    ],
)
def test_what_cannot_be_measured_is_refused_in_one_line(wet, asked, said):
    with pytest.raises(InputError) as caught:
        wet.measure(**asked)
    assert said in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_a_dry_run_has_no_probes_and_bodies_no_regions(heap, tmp_path):
    with pytest.raises(InputError, match="probe"):
        heap.measure(probe=PROBES)
    clump = {"discs": [[0.0, 0.0, 0.0005], [0.0006, 0.0, 0.0005]], "at": [[0.003, 0.004]]}
    run = driven(dry(clump=[clump], time__end=0.002), tmp_path)
    with pytest.raises(InputError, match=r"^region: cannot be measured afterwards in a run with \[clump\]; put "):
        run.measure(region=REGIONS)


def test_the_command_writes_tables_and_replaces_none(wet, tmp_path):
    file = tmp_path / "sections.toml"
    file.write_text("[[probe]]\nx = 0.001\ny = 0.002\n[[line]]\nstart = [0.006, 0.0]\nend = [0.006, 0.008]\n")

    def asked(*words: str) -> subprocess.CompletedProcess[str]:
        told = [sys.executable, "-m", "porescale", "measure", str(wet.folder), str(file), *words]
        return subprocess.run(told, capture_output=True, text=True, check=False, timeout=300)

    kept = (wet.folder / "probes.csv").read_bytes()
    refused = asked()
    assert refused.returncode == 2
    assert refused.stderr.count("\n") == 1
    assert "is there already" in refused.stderr
    assert (wet.folder / "probes.csv").read_bytes() == kept
    assert not (wet.folder / "lines.csv").exists()  # nothing, where not all can be written
    done = asked("--out", str(tmp_path / "out"))
    assert done.returncode == 0, done.stderr
    assert sorted(it.name for it in (tmp_path / "out").iterdir()) == ["lines.csv", "probes.csv"]
    written = (tmp_path / "out" / "probes.csv").read_text().splitlines()
    table = wet.measure(probe={"x": 0.001, "y": 0.002})["probes"]
    assert written[0].split(",") == list(table)
    assert [float(it) for it in written[-1].split(",")] == [column[-1] for column in table.values()]


def test_a_run_that_replaces_a_measured_one_leaves_no_table_of_it(tmp_path):
    from porescale.cli.main import commands
    from porescale.common.cli.application import main

    scene = water(time__end=0.004)
    driven(scene, tmp_path / "run")
    (tmp_path / "sections.toml").write_text("[[probe]]\nx = 0.001\ny = 0.002\n")
    assert main(commands(), ["measure", str(tmp_path / "run"), str(tmp_path / "sections.toml")]) == 0
    assert porescale.open_run(tmp_path / "run").tables == ["series", "probes"]
    driven(scene, tmp_path / "run")
    assert porescale.open_run(tmp_path / "run").tables == ["series"]


TANK = """
[tank]
width = 0.4
height = 0.4
[time]
end = 0.02
[output]
snapshot_interval = 0.005
series_interval = 0.005
[numerics]
spacing = 0.02
[[water.column]]
left = 0.0
bottom = 0.0
width = 0.2
height = 0.2
"""
INSTRUMENTS = '[[probe]]\nx = 0.1\ny = 0.05\n[[level]]\nname = "left"\nx = 0.05\n'


def test_a_tank_of_water_is_measured_to_the_bit(tmp_path):
    (tmp_path / "scene.toml").write_text(TANK + INSTRUMENTS)
    (tmp_path / "sections.toml").write_text(INSTRUMENTS)
    run = continuum_sph.run(continuum_sph.load(tmp_path / "scene.toml"), tmp_path / "run", progress=False)
    tables = run.measure(tmp_path / "sections.toml")
    assert tables.keys() == {"probes", "levels"}
    for name, table in tables.items():
        own = run.table(name)
        assert list(own) == list(table)
        for column in own:
            assert np.array_equal(own[column], table[column], equal_nan=True), column
    other = run.measure(probe={"x": 0.12, "y": 0.05})["probes"]  # the check that must fail
    assert not np.array_equal(other["probe 0 pressure (Pa)"], tables["probes"]["probe 0 pressure (Pa)"])
