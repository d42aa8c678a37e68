"""Long runs hold mass, momentum, places and memory, find nothing wrong, and would be found out if they did not."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from porescale.benchmarks import endurance
from porescale.cli.main import PACKAGE
from porescale.common.cli.application import application, main
from porescale.common.core.errors import InputError, Unstable
from porescale.common.evidence import endurance as common
from porescale.common.evidence.endurance import (
    FOUND,
    MARKS,
    MEMORY,
    Endurance,
    Endurances,
    Held,
    Line,
    endure,
    finished,
    markdown,
    picture,
    write,
)
from porescale.common.record import drive
from porescale.common.record.checkpoint import read_checkpoint, write_checkpoint
from porescale.validation.coupling import endurance as verify_endurance
from porescale.validation.coupling.setups import handful


def test_a_weight_of_a_millionth_of_what_makes_a_heap_is_found():
    it = endurance.ENDURANCES["flying grains"]
    leaky = replace(it, start=lambda: endurance.Watched(handful(acceleration=(2e-10, 0.0)), periodic=True))
    lines = {line.quantity: line for line in endure(leaky, 200)}
    assert not lines["momentum x over Σ mv at the start ()"].holds


def test_a_heap_that_is_not_yet_down_is_not_settled():
    assert verify_endurance.share(endure(endurance.ENDURANCES["settled heap"], 400)).error > 1.0


class Counter:
    """Counts steps, and is well up to ``sound`` of them."""

    def __init__(self, sound: int = 10_000) -> None:
        self.steps, self.sound = 0, sound

    def advance(self, steps: int) -> None:
        """More."""
        self.steps += steps

    def check(self) -> None:
        """Whether it is well."""
        if self.steps > self.sound:
            raise Unstable("counter", "steps", self.steps, "", self.steps, 0.0, "too many")

    def read(self) -> dict[str, float]:
        """How many."""
        return {"steps ()": float(self.steps)}

    def state(self) -> dict[str, Any]:
        """How many."""
        return {"steps": self.steps}

    def restore(self, state: dict[str, Any]) -> None:
        """So many."""
        self.steps = state["steps"]


class Killed(Exception):
    """The process is gone."""


@pytest.fixture
def kept_always(monkeypatch):
    """A flow is kept after every block of seven steps, but for those that end at marks."""
    monkeypatch.setattr(common, "KEEP_EVERY", 0.0)
    monkeypatch.setattr(common, "CHECK_EVERY", 7)


def killed(it: Endurance, steps: int, kept: Path, after: int) -> None:
    """Run it until ``after`` blocks of steps, of which all are kept but those at marks."""
    run, blocks = it.start(), iter(range(after))
    advance = run.advance

    def step(count: int) -> None:
        advance(count)
        if next(blocks, None) is None:
            raise Killed

    run.advance = step
    with pytest.raises(Killed):
        endure(replace(it, start=lambda: run), steps, kept=kept)


def numbers(lines: list[Line]) -> list[Line]:
    """The lines but for seconds and memory, which are the machine's."""
    return [replace(line, seconds=0.0) for line in lines if line.quantity != MEMORY]


@pytest.mark.parametrize("name", ["settled heap", "sleeping heap"])
def test_killed_twice_it_ends_with_the_same_numbers(name, tmp_path, kept_always):
    it, kept = replace(endurance.ENDURANCES[name], share=1.0, before=120), tmp_path / "kept.h5"
    killed(it, 400, kept, 1)  # before the first mark
    killed(it, 400, kept, 40)
    assert 0 < read_checkpoint(kept)["noted"]["done"] < 400
    assert numbers(endure(it, 400, kept=kept)) == numbers(endure(it, 400))


class Forgetful(Counter):
    """A counter that begins anew where it should go on."""

    def restore(self, state: dict[str, Any]) -> None:
        """Nothing."""


@pytest.mark.parametrize("kind", [Counter, Forgetful])
def test_what_does_not_go_on_is_found(kind, tmp_path, kept_always):  # the second is the twin that must fail
    held = (Held("steps ()", lambda steps: 0.0, "because"),)
    it = Endurance("counter", "counts", kind, held)
    killed(it, 1000, tmp_path / "kept.h5", 5)
    same = numbers(endure(it, 1000, kept=tmp_path / "kept.h5")) == numbers(endure(it, 1000))
    assert same == (kind is Counter)


def test_faults_and_seconds_of_all_processes_count(tmp_path, kept_always):
    it = Endurance("counter", "counts", lambda: Counter(450), ())
    kept = tmp_path / "kept.h5"
    killed(it, 1000, kept, 15)
    content = read_checkpoint(kept)
    content["noted"]["seconds"] += 1000.0
    write_checkpoint(kept, content)
    wrong, memory = endure(it, 1000, kept=kept)
    assert wrong.values == [0.0] * 10 + [8.0 * k for k in range(1, 12)]  # beyond step 450, eight blocks a mark
    assert memory.seconds > 1000.0


def test_growth_of_all_processes_adds_up_and_what_they_begin_with_does_not_count(tmp_path, kept_always, monkeypatch):
    it, kept = Endurance("counter", "counts", Counter, ()), tmp_path / "kept.h5"
    for begins_with in (100, 500):  # MiB; grows by one at every mark
        peaks = iter(range(begins_with, 1000))
        monkeypatch.setattr(common, "peak_bytes", lambda peaks=peaks: next(peaks) * 2**20)
        if begins_with == 100:
            killed(it, 1000, kept, 8 * 8 + 3)  # eight blocks a mark; mark 8 was noted
    memory = endure(it, 1000, kept=kept)[-1]
    assert memory.values == [*map(float, range(100, 109)), *map(float, range(108, 120))]
    assert memory.off == 18.0  # 19 from mark 1 to 20, less one where the second process began
    assert not memory.holds


def test_what_is_kept_of_another_number_of_steps_begins_anew(tmp_path):
    it, kept = Endurance("counter", "counts", Counter, ()), tmp_path / "kept.h5"
    endure(it, 500, kept=kept)
    assert numbers(endure(it, 1000, kept=kept)) == numbers(endure(it, 1000))


def test_a_state_that_does_not_fit_is_refused(tmp_path):
    kept = tmp_path / "kept.h5"
    endure(Endurance("counter", "counts", Counter, ()), 500, kept=kept)
    write_checkpoint(kept, read_checkpoint(kept) | {"state": {"steps": "many"}})
    with pytest.raises(InputError, match="does not fit"):
        endure(Endurance("counter", "counts", Counter, ()), 500, kept=kept)


def test_commands_of_other_flows_write_one_table(tmp_path, monkeypatch, capsys):
    flows = [
        replace(endurance.ENDURANCES["settled heap"], name=name, start=Counter, held=(), least=100) for name in "abc"
    ]
    package = replace(PACKAGE, endurance=lambda: Endurances(flows))
    for name in "bca":
        words = ["study", "endurance", name, "--steps", "100", "--resume", "--out", str(tmp_path)]
        assert main(application(package), words) == 0
    assert list(finished(tmp_path)) == ["a", "b", "c"]
    assert not list(tmp_path.glob("*.h5"))
    assert main(application(package), [*words[:5], "--out", str(tmp_path)]) == 0
    assert list(finished(tmp_path)) == ["a"]  # the twin: without --resume it begins anew


def test_too_few_steps_to_come_to_rest_in_are_refused_with_the_flows_that_need_more(tmp_path, capsys):
    words = ["study", "endurance", "--out", str(tmp_path / "out"), "--steps"]
    assert main(application(PACKAGE), [*words, "2000"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("--steps = 2000: is too few for settled heap, sleeping heap (allowed: >= 1000000)")
    assert main(application(PACKAGE), [*words, "1999", "flying grains"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line == "--steps = 1999: is too few for flying grains (allowed: >= 2000)"
    assert not (tmp_path / "out").exists()
    assert main(application(PACKAGE), [*words, "2000", "flying grains"]) == 0  # the twin


def test_marks_lie_apart_evenly_and_count_from_where_it_has_settled():
    held = (Held("steps ()", lambda steps: 0.5 * steps, "because"),)
    found, wrong, memory = endure(Endurance("counter", "counts", Counter, held, settles=10), 1000)
    assert found.at == [1000 * k // MARKS for k in range(MARKS + 1)]
    assert found.off == 500.0
    assert found.holds
    assert wrong.holds
    assert memory.holds
    assert "| counter | 1000 | steps () | 50, 1000 | 500 | 500 | because |" in markdown("x", [found])
    assert picture([found, memory])[:4] == b"\x89PNG"


def test_what_is_found_wrong_on_the_way_is_said():
    said: list[str] = []
    lines = endure(Endurance("counter", "counts", lambda: Counter(1900), ()), 2000, said.append)
    wrong = {line.quantity: line for line in lines}[FOUND]
    assert not wrong.holds
    assert wrong.values[-1] == 1.0  # asked at step 2000
    assert any("counter" in text for text in said)


def test_what_a_call_has_finished_is_read_back(tmp_path):
    lines = endure(Endurance("counter", "counts", Counter, ()), 100)
    write(tmp_path, {"command": "x"}, lines)
    assert finished(tmp_path) == {"counter": lines}
    (tmp_path / "endurance.json").write_text("{}")
    assert finished(tmp_path) == {}


def test_it_is_checked_as_often_as_a_run_is():
    assert common.CHECK_EVERY == drive.CHECK_EVERY
