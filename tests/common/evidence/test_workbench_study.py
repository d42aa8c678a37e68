"""The register of studies, the halving of monotone flows, and the files of a map."""

import csv
import json
import math
from dataclasses import replace

import pytest

from porescale.common.core.errors import InputError
from porescale.common.evidence.stability import RIGHT, STABLE, UNSTABLE, Axis, Row, Stability, Tried, holds_up_to
from porescale.common.evidence.stability_files import csv_text, markdown, require_quick, stored, write

X = Axis("strain", (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0), (1.0, 64.0))
Y = Axis("heat", (0.1, 0.2), (0.1,))
BREAKS = {"steel": 20.0, "glass": 3.0, "air": 0.5}


def register(tried: list[float] | None = None, **parts) -> Stability:
    """One flow: a law holds below its breaking strain times 1 - heat, and its error is a hundredth of the strain."""
    made = Stability()

    @made.flow(
        "toy.pull", title="Pulled", x=X, y=Y, laws=lambda quick: list(BREAKS)[: 1 if quick else 3], right=0.02,
        because="two hundredths", limit="strain", **parts,
    )  # fmt: skip
    def _(law: str, x: float, y: float) -> Tried:
        if tried is not None:
            tried.append(x)
        return Tried(x < BREAKS[law] * (1 - y), x / 100, {"strain": x})

    return made


def verdicts(rows: list[Row]) -> str:
    return "".join(row.verdict[0] for row in rows)


def test_right_needs_a_known_error_within_the_tolerance():
    (flow,) = register().chosen()
    rows = flow.run("steel", 0.1, False)
    assert verdicts(rows) == "rrsssuu"
    assert [row.error for row in rows[:3]] == [0.01, 0.02, 0.04]
    assert all(row.ran for row in rows)


@pytest.mark.parametrize("law", list(BREAKS))
def test_halving_finds_what_trying_everything_finds(law):
    whole = register().chosen()[0].run(law, 0.1, False)
    tried: list[float] = []
    rows = register(tried, monotone=True, judged=0.0).chosen()[0].run(law, 0.1, False)
    assert [row.verdict == UNSTABLE for row in rows] == [row.verdict == UNSTABLE for row in whole]
    assert len(tried) <= 3  # 7 values: log2(8)
    assert sorted(row.x for row in rows if row.ran) == sorted(tried)


def test_a_monotone_flow_tries_all_with_a_known_error_and_no_further_where_one_of_them_fails():
    tried: list[float] = []
    (flow,) = register(tried, monotone=True, judged=4.0).chosen()
    assert verdicts(flow.run("steel", 0.1, False)) == "rrsssuu"
    assert {1.0, 2.0, 4.0} <= set(tried)
    tried.clear()
    assert verdicts(flow.run("glass", 0.1, False)) == "rruuuuu"
    assert max(tried) == 4.0


def test_what_is_not_a_number_is_never_right():
    made = Stability()
    made.flow("a.b", title="t", x=X, y=Y, laws=lambda quick: ["l"], right=1.0, because="c")(
        lambda law, x, y: Tried(True, float("nan"))
    )
    row = made.chosen()[0].run("l", 0.1, True)[0]
    assert row.verdict == STABLE
    assert row.as_dict()["error"] is None


def test_the_limit_is_the_last_value_below_the_first_failure():
    rows = register().chosen()[0].run("steel", 0.1, False)
    assert holds_up_to(rows, "strain") == (16.0, 32.0)
    assert holds_up_to(rows[:3], "strain") == (4.0, float("inf"))
    assert holds_up_to(rows[-1:], "strain") == (0.0, 64.0)


def test_names_are_chosen_as_of_other_registers():
    with pytest.raises(InputError, match="no such flow"):
        register().chosen(["toy.push"])
    assert [flow.name for flow in register().chosen(["toy"])] == ["toy.pull"]
    with pytest.raises(AssertionError):
        register().include(register())


def test_the_files_say_the_same_thing(tmp_path):
    flows = register().chosen()
    rows = [row for law in BREAKS for y in Y.values for row in flows[0].run(law, y, False)]
    write(tmp_path / "map", "toy study stability", flows, rows, quick=False)
    folder = tmp_path / "map"
    assert {file.name for file in folder.iterdir()} == {f"stability.{kind}" for kind in ("json", "csv", "md", "png")}
    assert (folder / "stability.png").read_bytes().startswith(b"\x89PNG")
    kept = json.loads((folder / "stability.json").read_text())
    assert kept["flows"][0]["x"] == {"name": "strain", "values": list(X.values)}
    lines = list(csv.DictReader((folder / "stability.csv").read_text().splitlines()))
    assert [(line["law"], line["verdict"]) for line in lines] == [(it["law"], it["verdict"]) for it in kept["rows"]]
    text = (folder / "stability.md").read_text()
    assert "| glass | ●● | ●● | ×× | ×× | ×× | ×× | ×× | 2 | 4 |" in text
    assert "strain: holds up to | fails from" in text
    assert csv_text(rows).count("\n") == len(rows) + 1
    assert markdown("again", flows, rows, False).splitlines()[4:] == text.splitlines()[4:]
    assert {row.verdict for row in rows} == {RIGHT, STABLE, UNSTABLE}


def test_a_map_keeps_the_flows_that_are_as_they_were(tmp_path):
    flows = register().chosen()
    rows = [row for law in BREAKS for y in Y.values for row in flows[0].run(law, y, False)]
    rows[0] = replace(rows[0], numbers={"strain": math.nan})
    write(tmp_path, "toy study stability", flows, rows, quick=False)
    kept = stored(tmp_path, flows, False)
    assert [row.as_dict() for row in kept[1:]] == [row.as_dict() for row in rows[1:]]
    assert csv_text(kept) == csv_text(rows)
    assert stored(tmp_path / "none", flows, False) == []
    assert stored(tmp_path, flows, True) == []  # the check that must fail: other values are another map


def test_a_quick_map_does_not_replace_a_whole_one(tmp_path):
    flows = register().chosen()
    require_quick(tmp_path)
    for quick in (True, False):
        rows = [row for law in flows[0].laws(quick) for y in Y.chosen(quick) for row in flows[0].run(law, y, quick)]
        write(tmp_path, "toy study stability", flows, rows, quick=quick)
        if quick:
            require_quick(tmp_path)
    with pytest.raises(InputError, match="--quick: would replace the whole map"):
        require_quick(tmp_path)


@pytest.mark.parametrize("text", ["", '{"rows": [', "[]", '{"rows": [{"flow": "toy.pull"}]}'])
def test_a_torn_map_is_refused_in_one_line(tmp_path, text):
    (tmp_path / "stability.json").write_text(text)
    with pytest.raises(InputError, match="cannot be read as a file of this study; remove it"):
        stored(tmp_path, register().chosen(), False)
