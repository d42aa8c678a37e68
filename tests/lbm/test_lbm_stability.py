"""Flows of the stability map: what holds, what does not, and the command that makes the map."""

import json
from dataclasses import replace

import numpy as np
import pytest

from porescale.benchmarks import stability_lbm as stability
from porescale.cli.main import PACKAGE
from porescale.common.cli.application import application, main
from porescale.common.evidence.stability import RIGHT, STABLE, UNSTABLE, Axis, Stability, Tried
from porescale.common.evidence.stability_files import stored
from porescale.lbm.collision.choose import OPERATORS
from porescale.lbm.fluid import Fluid
from porescale.lbm.sanity import sane


def test_every_operator_is_tried_in_every_way():
    variants = stability.variants(False)
    for name in OPERATORS:
        ways = [way for way in variants.values() if way["operator"] == name]
        assert any(way.get("smagorinsky") for way in ways)
        assert any(way.get("dtype") is np.float32 for way in ways)
        assert any(set(way) <= {"operator", "magic"} for way in ways)


def test_the_quick_variants_are_some_of_all():
    assert stability.variants(True).items() <= stability.variants(False).items()


def test_the_viscosity_is_right_where_it_should_be_and_known_to_fail_where_not():
    error = stability.decay_error("trt 3/16", 0.8, 0.05)
    # Second order in the wave number k = 2 pi/48: k²(1/12 + (tau - 1/2)²), 0.3 %, and Mach² of 0.05², 0.25 %.
    assert error is not None
    assert error < 0.006
    far = stability.decay_error("trt 3/16", 5.0, 0.05)  # the twin: (tau - 1/2)² k² = 0.35
    assert far is not None
    assert far > 0.05


def test_a_thin_layer_blows_up_with_little_viscosity_and_only_then():
    assert stability.shear_layer("trt 3/16", 0.8, 0.3)
    assert not stability.shear_layer("trt 3/16", 0.5001, 0.3)
    assert stability.shear_layer("central", 0.5001, 0.3)


def test_sense_ends_at_a_number_that_is_none_and_at_the_bounds():
    fluid = Fluid(4, 4, 0.8)
    assert sane(fluid)
    fluid.set_flow(0.34, 0.0)
    assert sane(fluid)
    fluid.set_flow(0.35, 0.0)  # Mach 0.606
    assert not sane(fluid)
    fluid.set_flow(0.0, 0.0, 1.51)
    assert not sane(fluid)
    fluid.set_flow(0.0, 0.0)
    fluid.populations[3, 2, 2] = np.nan
    assert not sane(fluid)


def test_the_quick_map_is_made_by_one_command(tmp_path, capsys):
    words = ["study", "stability", "--quick", "--json", "--out", str(tmp_path / "map")]
    assert main(application(PACKAGE), words) == 0
    said = capsys.readouterr()
    rows = json.loads(said.out)
    assert {row["verdict"] for row in rows} == {RIGHT, STABLE, UNSTABLE}
    assert {row["flow"].partition(".")[0] for row in rows} == {"lbm", "coupling"}
    assert "s left" in said.err.splitlines()[0]
    kept = json.loads((tmp_path / "map" / "stability.json").read_text())
    assert [(r["law"], r["verdict"]) for r in kept["rows"]] == [(r["law"], r["verdict"]) for r in rows]
    assert kept["quick"]


def test_a_map_that_is_interrupted_keeps_the_flows_that_are_done(tmp_path, capsys):
    def measure(law: str, x: float, y: float) -> Tried:
        if law == "b" and not done:
            raise KeyboardInterrupt
        return Tried(True, 0.0, {})

    def flows() -> Stability:
        made, axis = Stability(), Axis("x", (1.0, 2.0), (1.0,))
        for law in "ab":
            made.flow(
                f"toy.{law}", title="t", x=axis, y=axis, laws=lambda quick, law=law: [law], right=1.0, because="so"
            )(measure)
        return made

    done: list[bool] = []
    toy, out = application(replace(PACKAGE, stability=flows)), ["--out", str(tmp_path)]
    assert main(toy, ["study", "stability", *out]) == 130
    assert {row.flow for row in stored(tmp_path, flows(), False)} == {"toy.a"}
    done.append(True)
    assert main(toy, ["study", "stability", "toy.b", *out]) == 0
    assert {row.flow for row in stored(tmp_path, flows(), False)} == {"toy.a", "toy.b"}
    assert "Made by `porescale study stability`." in (tmp_path / "stability.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("words", "said"), [(["lbm.sheer"], "lbm.shear"), (["--out", ""], "is empty"), (["--threads", "0"], "--threads")]
)
def test_wrong_use_of_the_study_is_one_line(capsys, words, said):
    assert main(application(PACKAGE), ["study", "stability", "--quick", *words]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
