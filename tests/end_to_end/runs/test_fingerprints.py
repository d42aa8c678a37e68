"""Fingerprints of states: equal for the same bits on any number of threads, and for no others; none is left out."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.fingerprints import places, record
from tests.fingerprints.cases import NO_SUBJECT, SCENES, SCRIPTS, unnamed
from tests.fingerprints.digest import fingerprint
from tests.fingerprints.names import QUICK, SUBJECTS
from tests.fingerprints.subjects import CASES, ROOT

HANDFUL = ("fluid/trt", "contact/linear", "script/bouncing_disc")
STATE: dict[str, Any] = {"step": 3, "grains": {"x": np.arange(6.0).reshape(3, 2), "held": np.zeros(3, np.uint8)}}


def command(*words: str) -> subprocess.CompletedProcess[str]:
    line = [sys.executable, "-m", "tests.fingerprints", *words]
    return subprocess.run(line, cwd=ROOT, capture_output=True, text=True, check=False)


def changed(**grains: Any) -> dict[str, Any]:
    return {**STATE, "grains": {**STATE["grains"], **grains}}


def test_the_order_of_keys_does_not_count() -> None:
    turned = {"grains": dict(reversed(STATE["grains"].items())), "step": np.int64(3)}
    assert fingerprint(turned) == fingerprint(STATE)


def test_nor_does_how_an_array_lies_in_memory() -> None:
    assert fingerprint(changed(x=np.asfortranarray(STATE["grains"]["x"]))) == fingerprint(STATE)


@pytest.mark.parametrize(
    "other",
    [
        changed(x=np.nextafter(STATE["grains"]["x"], 9.0)),
        changed(x=np.where(STATE["grains"]["x"] == 0.0, -0.0, STATE["grains"]["x"])),
        changed(x=STATE["grains"]["x"].reshape(2, 3)),
        changed(held=np.zeros(3, np.int8)),
        changed(spin=np.zeros(0)),
        {**STATE, "step": 3.0},
        {"step": 3, "discs": STATE["grains"]},
    ],
    ids=["bits", "sign of zero", "shape", "type", "one array more", "type of a number", "key"],
)
def test_all_else_does(other: dict[str, Any]) -> None:
    assert fingerprint(other)[0] != fingerprint(STATE)[0]


def test_one_bit_of_one_array_is_found_in_its_part() -> None:
    x = STATE["grains"]["x"].copy()
    x.view(np.uint64)[2, 1] ^= 1
    now, then = fingerprint({"state": changed(x=x)})[1], fingerprint({"state": STATE})[1]
    assert [part for part in now if now[part] != then[part]] == ["state/grains"]


def test_what_has_no_bits_is_refused() -> None:
    with pytest.raises(TypeError, match="grains/law: object"):
        fingerprint(changed(law=object()))


def test_every_scene_and_script_of_cases_has_one() -> None:
    files = {it.relative_to(CASES).as_posix() for it in (*CASES.glob("*/*.toml"), *CASES.glob("*/*.py"))}
    files = {it for it in files if not it.endswith("/expected.toml")}
    assert files == {*SCENES, *unnamed(), *(it.file for it in SCRIPTS.values()), *NO_SUBJECT}


def test_all_are_recorded_on_one_thread_and_on_two() -> None:
    known = record.read()["fingerprints"]
    new = {f"scene/{it.removesuffix('/scene.toml')}" for it in unnamed()}  # recorded once they have come to stay
    assert set(known) == set(SUBJECTS) - new
    assert set(QUICK) <= set(SUBJECTS)
    columns = {"1", "2", "steps", "seconds", "parts"}
    assert all(set(row) - {"libraries"} == columns for row in known.values())


def test_every_place_is_there() -> None:
    single = (places.MACHINE, places.SET_THREADS, places.CONCLUDE, places.MEASURE, places.READ_SCENE)
    for place in (*single, places.CONTINUUM_TYPE, places.CONTINUUM_BUILD, *places.STEPPERS):
        assert callable(places.fetch(place))


@pytest.mark.slow
def test_states_come_again_and_a_changed_record_is_found(tmp_path: Path) -> None:
    """A record made here, for bits hold on one kind of processor; that of the repository too where it is the same."""
    path = tmp_path / "recorded.json"
    made = command("write", *HANDFUL, "--record", str(path))
    assert made.returncode == 0, made.stdout + made.stderr
    again = command("compare", "contact/linear", "--record", str(path))
    assert again.returncode == 0, again.stdout
    rows, theirs = record.read(path), record.read()
    if rows["processor"] == theirs["processor"]:
        assert {name: rows["fingerprints"][name]["1"] for name in HANDFUL} == {
            name: theirs["fingerprints"][name]["1"] for name in HANDFUL
        }
    first = rows["fingerprints"]["fluid/trt"]["2"]
    path.write_text(path.read_text().replace(f'"2": "{first}"', f'"2": "{first[::-1]}"'))
    wrong = command("compare", *HANDFUL, "--record", str(path))
    assert wrong.returncode == 1
    assert "fluid/trt: DIFFERS on 2 threads" in wrong.stdout
    assert wrong.stdout.count(": same") == len(HANDFUL) - 1


def test_what_is_not_recorded_fails_at_once(tmp_path: Path) -> None:
    ended = command("compare", "fluid/trt", "--record", str(tmp_path / "none.json"))
    assert ended.returncode == 1
    assert ended.stdout.splitlines()[-2] == "fluid/trt: fails: not recorded"
    assert ended.stdout.splitlines()[-1].startswith("0 names made, 1 not as they should be")
