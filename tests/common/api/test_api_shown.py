"""How simulations show themselves: fields by name, plots to scale, lines, tables and pictures of notebooks."""

import subprocess
import sys

import cv2
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure

import continuum_sph
import porescale
from porescale.common.core.errors import InputError
from tests.common.api.small import build, package_of, scene_of
from tests.fingerprints.digest import fingerprint
from tests.reference.scenes import dry, refusals, water

KINDS = ("coupled", "dry", "tank", "soil", "levee")
BAR = {"corners": [[0.006, 0.004], [0.008, 0.004], [0.008, 0.005]], "thickness": 0.0002, "density": 2500}


def axes():
    return Figure((6, 4)).add_subplot()


@pytest.mark.parametrize("kind", KINDS)
def test_three_lines_a_picture_and_a_table(kind):
    sim = build(scene_of(kind))
    before = fingerprint(sim.state())
    lines = repr(sim).splitlines()
    assert len(lines) == 3
    assert lines[1].startswith("t = 0 s, step 0 of ")
    assert ("cells of" in lines[2], "grains" in lines[2], "particles" in lines[2]) == (
        kind == "coupled", kind in ("coupled", "dry"), kind not in ("coupled", "dry"),
    )  # fmt: skip
    picture = cv2.imdecode(np.frombuffer(sim._repr_png_(), np.uint8), cv2.IMREAD_COLOR)
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 30  # more than a frame: something is painted
    html = sim._repr_html_()
    report = package_of(kind).check(sim.scene)
    assert "data:image/png;base64," in html
    assert report.title in html
    assert html.count("<b>warning:</b>") == len(report.warnings)
    assert fingerprint(sim.state()) == before  # looking changes nothing


def test_a_report_prints_and_shows_itself():
    report = porescale.check(scene_of("coupled"))
    assert len(repr(report).splitlines()) == 1
    assert "warnings" in repr(report)
    name = next(iter(report.groups.values()))[0].name
    assert name in str(report)
    assert name in report._repr_html_()


@pytest.mark.parametrize("kind", KINDS)
def test_fields_have_a_number_for_every_cell_or_particle(kind):
    sim = build(scene_of(kind)).run(steps=10)
    shape = (sim.fluid.ny, sim.fluid.nx) if kind == "coupled" else (len(sim.positions),)
    for name in sim.field_names:
        values = sim.field(name)
        assert values.shape == shape, name
        values[:] = -1  # a copy
        assert (sim.field(name) != values).any() or name in ("spin", "angle", "fluid")
    if kind != "coupled":
        assert sim.field("speed") == pytest.approx(np.hypot(*sim.velocities.T), rel=1e-12)
    else:
        excess, ux, _, _ = sim.fields()
        assert (sim.field("velocity_x") == ux).all()
        assert sim.field("density") == pytest.approx(1000.0 + excess, rel=1e-6)
    assert "did you mean 'speed'?" in refusals(lambda: sim.field("sped"))[0]
    assert "this simulation" in refusals(lambda: sim.plot(axes(), field="sped"))[0]


def test_a_scene_of_bodies_alone_has_no_field():
    sim = porescale.build(dry(grains={"density": 2500}, polygon=[BAR]))
    assert refusals(lambda: sim.field("speed")) == [
        "field: this scene has no fluid and no grains; snapshot() has its bodies of segments"
    ]
    assert len(sim.plot(axes()).collections) == 1  # the polygon


@pytest.mark.parametrize("kind", ["coupled", "dry", "tank"])
def test_discs_are_drawn_to_scale(kind):
    sim = build(scene_of(kind))
    given = axes()
    assert sim.plot(given) is given
    discs = next(it for it in given.collections if isinstance(it, EllipseCollection))
    factor = 1e3 if kind != "tank" else 1e2  # mm, cm
    assert discs.get_offsets() == pytest.approx(factor * sim.positions)
    assert discs.get_widths() == pytest.approx(2.0 * factor * sim.radii)
    assert given.get_xlabel() == ("x (mm)" if kind != "tank" else "x (cm)")
    assert given.get_aspect() == 1.0
    left, right = given.get_xlim()
    assert left <= 0.0 < right
    inside = discs.get_offsets()
    assert (inside[:, 0] > left).all()
    assert (inside[:, 0] < right).all()


def test_a_field_is_drawn_where_its_cells_are():
    sim = porescale.build(water()).run(steps=50)
    drawn = sim.plot(axes(), field="velocity_x", limits=(0.0, 1.0), title="A channel")
    (image,) = drawn.images
    assert np.asarray(image.get_array()) == pytest.approx(sim.field("velocity_x"), rel=1e-6)
    assert image.get_extent() == pytest.approx([0.0, 12.0, 0.0, 8.0])
    assert image.origin == "lower"
    assert image.get_clim() == (0.0, 1.0)
    assert drawn.get_title(loc="left") == "A channel"
    assert not sim.plot(axes(), bar=False).child_axes
    (bar,) = drawn.child_axes
    assert bar.get_ylabel() == "velocity x (m/s)"


def test_nothing_of_it_is_computed_unless_it_is_shown():
    code = "import porescale, continuum_sph, sys; porescale.Simulation; continuum_sph.Simulation; "
    code += "print([it for it in ('matplotlib.pyplot', 'pandas', 'rich') if it in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=True)
    assert "matplotlib.pyplot" not in done.stdout
    assert "pandas" not in done.stdout


def test_both_packages_have_the_same_names():
    names = [{it for it in dir(kind) if not it.startswith("_")}
             for kind in (porescale.Simulation, continuum_sph.Simulation)]  # fmt: skip
    assert names[1] - names[0] == {"variable_step"}
    assert names[0] - names[1] == {"angles", "spins", "fields"}
    assert issubclass(InputError, Exception)
