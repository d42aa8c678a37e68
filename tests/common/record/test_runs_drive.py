"""The loop: output never changes the physics, resumed runs are the uninterrupted ones, ends are told."""

import json
import math
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest

from porescale.common.compiled import jit
from porescale.common.core.atomic import owned
from porescale.common.core.errors import InputError, PorescaleWarning, Unstable
from porescale.common.duration.threads import Threads
from porescale.common.record import card as cards
from porescale.common.record import drive, snapshots
from porescale.common.record.checkpoint import read_checkpoint
from porescale.common.record.model import Model
from porescale.common.record.open_run import open_run
from porescale.common.record.stop import polite_stop
from tests.reference.toy_model import Toy, run_toy
from tests.reference.waiting import PATIENCE


def bits(model: Toy) -> bytes:
    """The whole state of a toy."""
    numbers = np.array([model.step, model.time]).tobytes()
    return model.x.tobytes() + model.v.tobytes() + model.field.tobytes() + numbers


def files(folder):
    """Series and snapshots as bytes."""
    run = open_run(folder)
    shots = [
        shot.grids["fields"].cells["velocity"].tobytes() + shot.clouds["grains"].position.tobytes()
        for shot in run.snapshots()
    ]
    return (folder / "series.csv").read_bytes(), shots, run.times.tolist(), run.steps.tolist()


@contextmanager
def refused(words: str) -> Iterator[None]:
    """Expects an InputError of one line with ``words`` in it."""
    with pytest.raises(InputError, match=words) as caught:
        yield
    assert len(str(caught.value).splitlines()) == len(caught.value.faults) == 1


def test_the_toy_is_a_model():
    assert isinstance(Toy(), Model)


def test_a_run_says_what_its_steps_took_and_ends_with_the_threads_it_had(tmp_path, monkeypatch):
    told, before = [], jit.threads()

    class Told(Threads):
        def spent(self, steps: int, seconds: float) -> None:
            told.append((steps, seconds))
            self.take(1)

    monkeypatch.setattr(drive, "Threads", Told)
    run_toy(tmp_path, duration=0.1)
    assert sum(steps for steps, _ in told) == 100
    assert min(seconds for _, seconds in told) > 0.0
    assert jit.threads() == before


@pytest.mark.parametrize("varying", [False, True])
def test_output_never_changes_the_physics(tmp_path, varying):
    ends = []
    for number, (rows, shots) in enumerate([(0.005, 0.02), (0.0007, math.inf), (math.inf, 0.0031)]):
        model = Toy(varying=varying)
        folder = tmp_path / str(number)
        run_toy(folder, model=model, duration=0.06, series_interval=rows, snapshot_interval=shots)
        ends.append(bits(model))
    assert ends[0] == ends[1] == ends[2]


def test_events_fall_on_their_steps(tmp_path):
    run_toy(tmp_path, duration=0.1, series_interval=0.0025, snapshot_interval=0.03)
    run = open_run(tmp_path)
    assert run.steps.tolist() == [0, 30, 60, 90, 100]
    # Every 2.5 steps, rounded half to even: the rounding does not accumulate.
    assert np.rint(run.series["time (s)"] * 1000)[:9].tolist() == [0, 2, 5, 8, 10, 12, 15, 18, 20]
    assert run.series["time (s)"][-1] == 0.1


def test_with_a_varying_step_records_are_the_first_at_or_after_their_time(tmp_path):
    model = Toy(varying=True)
    run_toy(tmp_path, model=model, duration=0.1, series_interval=0.01)
    times = open_run(tmp_path).series["time (s)"]
    late = times - 0.01 * np.arange(len(times))
    # A step lasts at most 1.5 ms (toy model); SLACK allows 1e-9 of an interval before the event.
    assert (late > -1e-9 * 0.01).all()
    assert (late < 1.5e-3).all()
    assert set(model.calls) == {1}


def test_the_model_is_checked_at_least_every_hundred_steps(tmp_path):
    checked = []

    class Watched(Toy):
        def check(self) -> None:
            checked.append(self.step)

    model = Watched()
    run_toy(tmp_path, model=model, duration=0.95, series_interval=math.inf, snapshot_interval=math.inf)
    assert checked[-1] == 950
    assert max(np.diff(checked)) <= 100


@pytest.mark.parametrize("varying", [False, True])
def test_a_run_extended_later_is_the_run_that_was_longer_from_the_start(tmp_path, varying):
    long, grown = Toy(varying=varying), Toy(varying=varying)
    run_toy(tmp_path / "long", model=long, duration=0.12)
    run_toy(tmp_path / "grown", model=Toy(varying=varying), duration=0.073)
    run_toy(tmp_path / "grown", model=grown, duration=0.12, resume=True)
    assert bits(grown) == bits(long)
    assert files(tmp_path / "grown") == files(tmp_path / "long")


def test_a_finished_run_is_left_alone(tmp_path, capsys):
    run_toy(tmp_path)
    before = files(tmp_path), (tmp_path / "card.json").read_bytes()
    model = Toy()
    outcome = run_toy(tmp_path, model=model, resume=True, quiet=False)
    assert outcome.outcome == "already finished"
    assert model.calls == []
    assert (files(tmp_path), (tmp_path / "card.json").read_bytes()) == before
    assert "nothing to do" in capsys.readouterr().err


def test_resuming_without_a_checkpoint_starts_from_the_beginning(tmp_path):
    run_toy(tmp_path / "one")
    assert run_toy(tmp_path / "two", resume=True).outcome == "finished"
    assert files(tmp_path / "one") == files(tmp_path / "two")


def test_a_changed_scene_is_refused_with_the_keys_that_differ(tmp_path):
    run_toy(tmp_path)
    scene = {"toy": {"beads": 9}, "run": {"duration": 0.4}}
    with refused(r"toy\.beads = 9: was 7"):
        run_toy(tmp_path, scene=scene, duration=0.4, resume=True)


def test_an_unfinished_run_cannot_become_shorter(tmp_path):
    with pytest.raises(Unstable):
        run_toy(tmp_path, model=Toy(breaks_at=100), checkpoint_seconds=0.0)
    with pytest.raises(InputError, match="already at t"):
        run_toy(tmp_path, duration=0.05, resume=True)


def test_an_unstable_run_keeps_its_last_good_state_and_names_it(tmp_path):
    with pytest.raises(Unstable, match="last good state") as caught:
        run_toy(tmp_path, model=Toy(breaks_at=75), checkpoint_seconds=0.0)
    run = open_run(tmp_path)
    assert run.card["outcome"] == "unstable"
    assert run.card["problem"] == str(caught.value)
    assert len(str(caught.value).splitlines()) == 1
    saved = read_checkpoint(tmp_path / "checkpoint.h5")
    assert f"step {saved['step']}," in str(caught.value)
    assert 0 < saved["step"] < 75
    assert run.steps.max() < 75
    untouched, healed = Toy(), Toy()
    run_toy(tmp_path / "good", model=untouched)
    run_toy(tmp_path, model=healed, resume=True)
    assert bits(healed) == bits(untouched)
    assert files(tmp_path) == files(tmp_path / "good")


def test_a_checkpoint_that_is_damaged_or_of_another_model_is_one_clear_line(tmp_path):
    run_toy(tmp_path)
    with refused("does not fit"):
        run_toy(tmp_path, model=Toy(beads=3), duration=0.4, resume=True)
    (tmp_path / "checkpoint.h5").write_bytes(b"no")
    with refused("damaged"):
        run_toy(tmp_path, duration=0.4, resume=True)


def test_a_new_run_replaces_a_finished_one(tmp_path):
    run_toy(tmp_path, duration=0.06)
    (tmp_path / "final.png").write_bytes(b"old")
    (tmp_path / "notes.txt").write_text("mine")
    run_toy(tmp_path, duration=0.04)
    run_toy(tmp_path.with_name("fresh"), duration=0.04)
    assert files(tmp_path) == files(tmp_path.with_name("fresh"))
    assert not (tmp_path / "final.png").exists()
    assert (tmp_path / "notes.txt").exists()


def test_a_dear_unfinished_run_is_not_overwritten(tmp_path, monkeypatch):
    def interrupted_by_a_crash(folder):
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        run_toy(tmp_path, after=interrupted_by_a_crash)
    card = open_run(tmp_path).card
    assert card["outcome"] == "failed"
    assert card["problem"] == "OSError: disk full"
    monkeypatch.setattr("porescale.common.record.record.WORTH_KEEPING", 0.0)
    with pytest.raises(InputError, match=r"unfinished run.*--overwrite"):
        run_toy(tmp_path)
    assert run_toy(tmp_path, resume=True).outcome == "finished"


def test_a_dear_unfinished_run_is_overwritten_on_request_and_nothing_of_it_stays(tmp_path, monkeypatch):
    monkeypatch.setattr("porescale.common.record.record.WORTH_KEEPING", 0.0)
    with pytest.raises(Unstable):
        run_toy(tmp_path, model=Toy(breaks_at=75), checkpoint_seconds=0.0)
    card = json.loads((tmp_path / "card.json").read_text()) | {"outcome": "running"}  # as a kill leaves it
    (tmp_path / "card.json").write_text(json.dumps(card))
    for name in ("profile.csv", "streamlines.png", "film.webm", "notes.txt"):
        (tmp_path / name).write_text("old")
    with pytest.raises(InputError, match="unfinished run"):
        run_toy(tmp_path)
    run_toy(tmp_path, overwrite=True)
    run_toy(tmp_path / "fresh")
    assert files(tmp_path) == files(tmp_path / "fresh")
    names = {path.name for path in tmp_path.iterdir()} - {"fresh"}
    assert names == {path.name for path in (tmp_path / "fresh").iterdir()} | {"notes.txt"}


@pytest.mark.parametrize("content", ["{", "[]", "{}", '{"scene": []}'])
def test_a_damaged_card_is_one_clear_line_for_all_who_read_it(tmp_path, content):
    run_toy(tmp_path)
    (tmp_path / "card.json").write_text(content)
    for read in (lambda: open_run(tmp_path), lambda: run_toy(tmp_path, duration=0.4, resume=True)):
        with refused(r"card\.json is damaged"):
            read()
    assert run_toy(tmp_path).outcome == "finished"  # nothing that could be resumed is lost


def test_a_run_of_another_package_is_not_resumed_and_named(tmp_path):
    scene = {"toy": {"beads": 7}}
    run_toy(tmp_path, card={"package": "toys", "scene": scene})
    with refused("holds a run of toys, not of games"):
        run_toy(tmp_path, duration=0.4, card={"package": "games", "scene": {"game": 1}}, resume=True)
    assert run_toy(tmp_path, duration=0.2, card={"package": "toys", "scene": scene}, resume=True).step == 200


@pytest.mark.filterwarnings("error")
def test_going_on_with_other_sources_or_versions_is_warned_of_and_every_session_is_on_the_card(tmp_path, monkeypatch):
    monkeypatch.setattr("porescale.common.compiled.jit.source_hash", lambda: "aaa")
    run_toy(tmp_path, duration=0.05)
    run_toy(tmp_path, duration=0.1, resume=True)  # the check that must fail: nothing changed, no warning
    monkeypatch.setattr("porescale.common.compiled.jit.source_hash", lambda: "bbb")
    versions = {**cards.versions(), "numpy": "0.1", "h5py": "0.2"}  # h5py moves bits, it does not make them
    monkeypatch.setattr("porescale.common.record.card.versions", lambda: versions)
    with pytest.warns(PorescaleWarning) as caught:
        run_toy(tmp_path, duration=0.15, resume=True)
    (line,) = (str(it.message) for it in caught)
    assert line.startswith("resumed with other sources aaa -> bbb, numpy ")
    assert line.endswith("-> 0.1: not promised to go on bit for bit")
    run_toy(tmp_path, duration=0.2, resume=True)  # said once: it is the last session that counts
    card = open_run(tmp_path).card
    assert card["sources"] == "aaa"
    assert [entry["sources"] for entry in card["resumed"]] == ["aaa", "bbb", "bbb"]
    assert card["resumed"][1]["versions"]["numpy"] == "0.1"
    assert {"at", "step", "time", "threads", "versions", "commit", "sources", "machine"} == set(card["resumed"][0])


def test_a_folder_in_use_is_refused(tmp_path):
    with owned(tmp_path), pytest.raises(InputError, match="another run is writing here"):
        run_toy(tmp_path)


@pytest.mark.parametrize("key", ["duration", "snapshot_interval", "series_interval"])
def test_times_that_make_no_sense_are_named(tmp_path, key):
    with pytest.raises(InputError, match=key):
        run_toy(tmp_path / "run", **{key: -1.0})
    assert not (tmp_path / "run").exists()


def test_pictures_are_made_once_the_data_are_there(tmp_path):
    seen = []

    def after(folder):
        seen.append((len(open_run(folder)), list(snapshots.parts(folder))))

    outcome = run_toy(tmp_path, duration=0.1, after=after)
    assert seen == [(6, [])]
    assert outcome.snapshots == 6


def test_a_folder_without_a_run_is_one_clear_line(tmp_path):
    for folder in (tmp_path, tmp_path / "absent"):
        with refused("no run here"):
            open_run(folder)


def test_a_damaged_snapshot_file_is_one_clear_line(tmp_path):
    run_toy(tmp_path)
    (tmp_path / "fields.vtkhdf").write_bytes(b"no")
    with refused("damaged"):
        open_run(tmp_path)


def test_a_run_is_read_by_name_and_nearest_time(tmp_path):
    run_toy(tmp_path, duration=0.1)
    run = open_run(tmp_path)
    assert (run.name, run.grids, run.clouds) == ("toy", ["fields"], ["grains"])
    assert run.nearest(0.041).step == 40
    assert run.snapshot(-1).time == run.times[-1] == 0.1
    with pytest.raises(IndexError):
        run.snapshot(len(run))


def test_outside_the_main_thread_a_run_still_runs(tmp_path):
    outcomes = []
    thread = threading.Thread(target=lambda: outcomes.append(run_toy(tmp_path, duration=0.05)))
    thread.start()
    thread.join(PATIENCE)
    assert outcomes[0].outcome == "finished"
    with polite_stop() as stop:
        assert not stop
