"""Long runs hold mass, momentum, places and memory, find nothing wrong, and would be found out if they did not."""

from dataclasses import replace

from porescale.benchmarks import endurance
from porescale.common.core.errors import Unstable
from porescale.common.evidence import endurance as common
from porescale.common.evidence.endurance import (
    FOUND,
    MARKS,
    Endurance,
    Held,
    endure,
    finished,
    markdown,
    picture,
    write,
)
from porescale.common.record import drive
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
