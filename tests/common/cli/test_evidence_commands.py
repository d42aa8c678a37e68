"""`verify --out` and `study convergence`: what they keep, what other runs leave, and their exit codes."""

import contextlib
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from porescale.common.cli.application import application, main
from porescale.common.evidence.convergence import Ladders
from porescale.common.evidence.extremes import Extreme, Extremes
from porescale.common.evidence.overhead import SMALLEST, BuiltScene, SceneKind, SceneKinds
from tests.reference.toy_package import TOY

LEVELS = (8.0, 16.0, 32.0)


def kept(file: str) -> dict[str, dict]:
    """Rows of a JSON file by name."""
    known = json.loads(Path(file).read_text(encoding="utf-8"))
    return {row["name"]: row for row in (known if isinstance(known, list) else known["rows"])}


def test_verify_keeps_what_it_ran_beside_what_other_runs_left(toy) -> None:
    assert toy("verify", "toy.bad", "--out", "seen")[0] == 1
    assert list(kept("seen/verify.json")) == ["toy.bad"]
    assert toy("verify", "toy.good", "--out", "seen")[0] == 0
    rows = kept("seen/verify.json")
    assert list(rows) == ["toy.good", "toy.bad"]  # as in the register
    assert [row["passed"] for row in rows.values()] == [True, False]
    assert all({"topic", "date", "commit"} <= set(row) for row in rows.values())
    assert "toy.bad **fails**" in Path("seen/verify.md").read_text(encoding="utf-8")
    assert Path("seen/toy.png").exists()


def ladders(power: float) -> Ladders:
    """Two ladders of second order whose errors fall with ``power``, and twice as fast."""
    made = Ladders()
    for name, times in (("toy.one", 1.0), ("toy.two", 2.0)):
        made.ladder(name, title="t", along="cells", levels=LEVELS, expected=2.0, because="so")(
            lambda level, times=times: level ** (-power * times)
        )
    return made


@pytest.fixture
def study(tmp_path: Path, monkeypatch, capsys) -> Callable[..., tuple[int, str]]:
    """`toy study convergence` with ladders of an order; exit code and what it prints."""
    monkeypatch.chdir(tmp_path)

    def run(power: float, *words: str) -> tuple[int, str]:
        package = replace(TOY, convergence=lambda: ladders(power))
        code = main(application(package), ["study", "convergence", *words])
        return code, capsys.readouterr().out

    return run


def test_convergence_keeps_ladders_and_fails_where_an_order_does_not_hold(study) -> None:
    code, out = study(2.5, "--out", "seen")
    assert (code, out.startswith("ladders: 2; ")) == (0, True)
    assert [round(row["measured"], 6) for row in kept("seen/convergence.json").values()] == [2.5, 5.0]
    assert study(1.5, "toy.one", "--out", "seen")[0] == 1  # the check that must fail
    rows = kept("seen/convergence.json")
    assert [round(row["measured"], 6) for row in rows.values()] == [1.5, 5.0]  # the other as it was
    assert [row["holds"] for row in rows.values()] == [False, True]
    assert "toy.one **fails**" in Path("seen/convergence.md").read_text(encoding="utf-8")


def test_a_ladder_that_raises_loses_no_other_and_fails(study, monkeypatch) -> None:
    def raises(level: float) -> float:
        if level > LEVELS[0]:
            raise ZeroDivisionError("nothing to divide by")
        return 0.5

    made = Ladders()
    for name, measure in (("toy.one", lambda level: level**-2.0), ("toy.two", raises), ("toy.six", lambda _: 0.1)):
        made.ladder(name, title="t", along="cells", levels=LEVELS, because="so")(measure)
    monkeypatch.setitem(globals(), "ladders", lambda power: made)
    assert study(2.0, "--out", "seen")[0] == 1
    rows = kept("seen/convergence.json")
    assert {name: row["holds"] for name, row in rows.items()} == {"toy.one": None, "toy.two": False, "toy.six": None}
    assert rows["toy.two"]["errors"] == [0.5, None, None]
    assert rows["toy.two"]["because"].startswith("ZeroDivisionError: nothing to divide by (raises, line ")
    assert study(2.0, "toy.one", "--out", "seen")[0] == 0  # the check that must fail: without it all is well


def test_convergence_keeps_each_ladder_as_soon_as_it_is_run(study, monkeypatch) -> None:
    def interrupted(level: float) -> float:
        raise KeyboardInterrupt

    made = Ladders()
    for name, measure in (("toy.one", lambda level: level**-2.0), ("toy.two", interrupted)):
        made.ladder(name, title="t", along="cells", levels=LEVELS, because="so")(measure)
    monkeypatch.setitem(globals(), "ladders", lambda power: made)
    with contextlib.suppress(KeyboardInterrupt):  # a command may answer it with an exit code
        study(2.0, "--out", "seen")
    assert list(kept("seen/convergence.json")) == ["toy.one"]


def test_extremes_keep_each_axis_as_soon_as_it_is_tried(tmp_path, monkeypatch) -> None:
    def interrupted() -> str:
        raise KeyboardInterrupt

    monkeypatch.chdir(tmp_path)
    tries = Extremes([Extreme("depth", "mild", lambda: "calm"), Extreme("speed", "high", interrupted)])
    with contextlib.suppress(KeyboardInterrupt):  # a command may answer it with an exit code
        main(application(replace(TOY, extremes=lambda: tries)), ["study", "extremes", "--out", "seen"])
    assert [row["value"] for row in json.loads(Path("seen/extremes.json").read_text(encoding="utf-8"))] == ["mild"]


def test_parts_keep_each_kind_as_soon_as_it_is_measured(tmp_path, monkeypatch) -> None:
    def interrupted() -> BuiltScene:
        raise KeyboardInterrupt

    def sum_up_to(count: int) -> None:
        sum(range(1000 * count))  # of nothing no ratio can be made

    def calm() -> BuiltScene:
        return BuiltScene(None, ["water"], 1, sum_up_to, sum_up_to)

    monkeypatch.chdir(tmp_path)
    kinds = SceneKinds([SceneKind(it.__name__, "cell", SMALLEST, it, 1) for it in (calm, interrupted)])
    with contextlib.suppress(KeyboardInterrupt):  # a command may answer it with an exit code
        words = ["study", "parts", "--out", "seen", "--rounds", "1"]
        main(application(replace(TOY, parts=lambda: kinds)), words)
    assert list(kept("seen/parts.json")) == ["calm"]


def test_convergence_lists_and_prints(study) -> None:
    assert study(2.0, "--list")[1] == "toy.one: t\ntoy.two: t\n"
    assert json.loads(study(2.0, "--list", "--json")[1])[1] == {"name": "toy.two", "title": "t"}
    code, out = study(2.5, "toy.two", "--json")
    assert code == 0
    assert [row["name"] for row in json.loads(out)] == ["toy.two"]


def test_an_unknown_ladder_suggests_the_nearest(study, capsys) -> None:
    assert study(2.0, "toy.on")[0] == 2
