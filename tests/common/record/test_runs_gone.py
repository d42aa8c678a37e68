"""Folders that are moved, removed, locked away or wanted by two while a run writes: clear words, nothing damaged."""

import errno
import shutil
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from porescale.common.core.errors import InputError, PorescaleError
from porescale.common.record import card as cards
from porescale.common.record.checkpoint import read_checkpoint
from porescale.common.record.open_run import open_run
from porescale.common.record.record import Gone
from porescale.common.record.stop import Interrupted
from tests.reference.faults.failing_disk import Disk, failing, whole
from tests.reference.same_run import differences
from tests.reference.toy_model import Toy, run_toy
from tests.reference.waiting import awaited


class Watched(Toy):
    """A toy during whose step 60 something happens."""

    def __init__(self, happens: Callable[[], object], **options: float) -> None:
        super().__init__(**options)  # type: ignore[arg-type]
        self.happens: Callable[[], object] | None = happens
        self.later = 0

    def advance(self, steps: int) -> None:
        super().advance(steps)
        self.later += self.happens is None
        if self.step >= 60 and self.happens:
            self.happens()
            self.happens = None


@pytest.fixture
def untouched(tmp_path) -> Path:
    run_toy(tmp_path / "untouched")
    return tmp_path / "untouched"


def test_a_folder_that_is_removed_is_named_and_not_made_again(tmp_path):
    folder = tmp_path / "run"
    with pytest.raises(Gone, match=r"run: the run folder was moved or removed while the run was writing"):
        run_toy(folder, model=Watched(lambda: shutil.rmtree(folder)))
    assert not folder.exists()


def test_a_folder_that_is_moved_keeps_its_run_and_goes_on_where_it_lies_now(tmp_path, untouched):
    folder, other = tmp_path / "run", tmp_path / "other"
    with pytest.raises(Gone):
        run_toy(folder, model=Watched(lambda: folder.rename(other)), checkpoint_seconds=0.0)
    assert not folder.exists()
    whole(other)
    run_toy(other, resume=True)
    assert differences(other, untouched) == []


def test_a_folder_that_takes_its_place_is_left_alone(tmp_path):
    folder = tmp_path / "run"

    def replace() -> None:
        folder.rename(tmp_path / "other")
        folder.mkdir()
        (folder / "mine.txt").write_text("mine")

    with pytest.raises(Gone):
        run_toy(folder, model=Watched(replace))
    assert [path.name for path in folder.iterdir()] == ["mine.txt"]


def test_a_folder_that_may_no_longer_be_written_ends_the_run_which_goes_on_later(tmp_path, untouched):
    folder = tmp_path / "run"
    run_toy(folder, duration=0.04, checkpoint_seconds=0.0)  # how far it was when the folder became read-only
    disk = Disk(folder, 0, errno.EROFS, True)
    with failing(disk), pytest.raises(OSError, match="Read-only file system"):
        run_toy(folder, resume=True)
    whole(folder)
    run_toy(folder, resume=True)
    assert differences(folder, untouched) == []


@pytest.mark.parametrize("options", [{}, {"resume": True}, {"overwrite": True}])
def test_a_second_run_in_the_same_folder_is_refused_and_the_first_ends_as_if_alone(tmp_path, untouched, options):
    folder, said = tmp_path / "run", []

    def second() -> None:
        with pytest.raises(InputError) as caught:
            run_toy(folder, model=Toy(beads=3), **options)
        said.extend(fault.line() for fault in caught.value.faults)

    run_toy(folder, model=Watched(second))
    (line,) = said
    assert "another run is writing here" in line
    assert differences(folder, untouched) == []


def test_a_look_at_a_living_run_disturbs_nothing(tmp_path, untouched):
    folder, seen = tmp_path / "run", []
    run_toy(folder, model=Watched(lambda: seen.append(len(open_run(folder)))))
    assert seen == [3]  # at 0, 0.02 and 0.04 s; that of the present step is yet to be written
    assert differences(folder, untouched) == []


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_polite_stop_saves_at_the_end_of_the_step_that_it_falls_into(tmp_path, untouched, number):
    # Steps of a block take at most 0.2 s together, or one step: what is asked is that no other block begins.
    folder = tmp_path / "run"
    model = Watched(lambda: signal.raise_signal(number))
    with pytest.raises(Interrupted, match="resume to continue") as caught:
        run_toy(folder, model=model)
    assert caught.value.code == 130
    assert model.later == 0
    saved = read_checkpoint(folder / "checkpoint.h5")
    assert saved["step"] == model.step < 120
    assert saved["state"]["beads"]["x"].tobytes() == model.x.tobytes()
    assert open_run(folder).card["outcome"] == "interrupted"
    run_toy(folder, resume=True)
    assert differences(folder, untouched) == []


def test_a_stop_before_the_first_step_leaves_a_run_that_can_be_gone_on_with(tmp_path, untouched, monkeypatch):
    # It falls between the making of the folder and the first step: into the writing of the card.
    folder, write = tmp_path / "run", cards.write_card

    def interrupted(*given: Any) -> None:
        """The card is written, and Ctrl-C comes."""
        write(*given)
        monkeypatch.undo()
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(cards, "write_card", interrupted)
    model = Watched(lambda: None)
    with pytest.raises(Interrupted, match=r"interrupted at step 0 .* resume to continue"):
        run_toy(folder, model=model)
    assert model.calls == []
    whole(folder)
    assert open_run(folder).card["outcome"] == "interrupted"
    run_toy(folder, resume=True)
    assert differences(folder, untouched) == []


def test_a_slow_step_is_the_longest_that_a_stop_waits(tmp_path):
    # From the second block on, a block of steps of 0.25 s has one step.
    model = Watched(lambda: None, pause=0.25)
    model.step, model.time = 57, 0.057
    run_toy(tmp_path / "run", model=model, duration=0.062)
    assert model.calls == [1, 1, 1, 1, 1]


def test_a_second_stop_does_not_wait_and_loses_nothing(tmp_path, untouched):
    folder = tmp_path / "run"

    def twice() -> None:
        first = signal.getsignal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        awaited(lambda: signal.getsignal(signal.SIGINT) is not first)  # two pending together would be taken as one
        signal.raise_signal(signal.SIGINT)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it
    try:
        with pytest.raises(KeyboardInterrupt):
            run_toy(folder, model=Watched(twice), checkpoint_seconds=0.0)
    finally:
        signal.signal(signal.SIGINT, before)
    whole(folder)
    assert read_checkpoint(folder / "checkpoint.h5")["step"] <= 60
    run_toy(folder, resume=True)
    assert differences(folder, untouched) == []


def test_a_run_without_the_watch_would_have_ended_well_without_its_folder(tmp_path, monkeypatch):
    # The twin that must fail: what happened before runs looked after their folder.
    from porescale.common.record.record import Record

    folder = tmp_path / "run"
    monkeypatch.setattr(Record, "require_present", lambda self: None)
    run_toy(folder, model=Watched(lambda: shutil.rmtree(folder)))
    assert not (folder / "series.csv").exists()
    assert issubclass(Gone, PorescaleError)


def test_a_file_of_snapshots_that_was_removed_is_missed_before_the_others_lose_theirs(tmp_path):
    """A run that went on without it left the later snapshots alone in every file."""
    folder = tmp_path / "run"
    run_toy(folder)
    one, *others = sorted(folder.glob("*.vtkhdf"))
    assert others
    kept = one.read_bytes()
    one.unlink()
    before = {path: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    with pytest.raises(InputError, match=rf"{one.name}.*is missing, and there are earlier snapshots; put it back"):
        run_toy(folder, duration=0.2, resume=True)
    assert {path: path.read_bytes() for path in folder.iterdir() if path.is_file()} == before
    one.write_bytes(kept)
    run_toy(folder, duration=0.2, resume=True)
    assert len(open_run(folder)) == 11
