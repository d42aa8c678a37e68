"""What people, disks and bugs can do to a command: one line and a code each, found as early as can be."""

from pathlib import Path
from typing import Any

import pytest

from tests.reference.toy_package import ToyModel

LONG = "a" * 300


@pytest.mark.parametrize(
    ("folder", "words"),
    [
        ("/proc/foo", "'/proc/foo': cannot be written (No such file or directory)"),
        ("/proc/foo/deep", "'/proc/foo/deep': cannot be written"),
        ("decay/scene.toml/sub", "Not a directory"),
        (LONG, "File name too long"),
        (f"{LONG}/sub", "File name too long"),
        ("", "is empty"),
    ],
)
def test_a_folder_that_cannot_be_written_is_wrong_input_found_before_the_model_is_built(
    toy, monkeypatch, folder: str, words: str
) -> None:
    toy("new", "decay")
    monkeypatch.setattr(ToyModel, "__init__", None)
    for command in (("run", "decay", "--out", folder), ("new", folder)):
        code, out, err = toy(*command)
        assert (code, out, len(err)) == (2, "", 1)
        assert words in err[0]
        assert len(err[0]) < 250
    assert [path.name for path in Path().iterdir()] == ["decay"]
    Path("odd/card.json").mkdir(parents=True)
    for option in ("--overwrite", "--resume"):
        assert "card.json there is a folder" in toy("run", "decay", "--out", "odd", option)[2][0]
    assert toy("check", LONG)[::2] == (2, ["SCENE: cannot be read (File name too long); name another"])


def test_a_folder_that_the_system_withholds_is_wrong_input_and_nothing_is_left(toy, monkeypatch) -> None:
    toy("new", "decay")

    def withheld(path: Path, **_: Any) -> None:
        raise PermissionError(1, "Operation not permitted", str(path))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "touch", withheld)
        code, _, err = toy("run", "decay", "--out", "deep/er")
    assert (code, err) == (2, ["--out = 'deep/er': cannot be written (Operation not permitted); name another folder"])
    assert not Path("deep").exists()
    assert toy("run", "decay", "--out", "deep/er")[0] == 0  # the twin


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("{", "card.json is damaged"),
        ("\xff", "card.json is damaged"),
        ("[" * 100000, "card.json is damaged"),
        ("[]", "it holds no scene"),
        ("{}", "it holds no scene"),
        ('{"scene": 3}', "it holds no scene"),
        ('{"package": "game", "scene": {"decay": {}}}', "holds a run of game, not of toy; use game"),
    ],
)
def test_a_damaged_or_foreign_card_is_one_line(toy, content: str, words: str) -> None:
    toy("new", "decay")
    toy("run", "decay")
    assert toy("show", "runs/decay")[0] == 0  # the twin
    Path("runs/decay/card.json").write_text(content, encoding="latin-1")
    for command in (("show", "runs/decay"), ("run", "decay", "--resume")):
        code, out, err = toy(*command)
        assert (code, out, len(err)) == (2, "", 1)
        assert words in err[0]
    assert toy("run", "decay", "--overwrite")[0] == 0


def test_a_card_whose_scene_lacks_what_every_scene_has_is_not_shown(toy) -> None:
    Path("card.json").write_text('{"package": "toy", "scene": {"duration": 1}}')
    code, _, err = toy("show", ".")
    assert (code, len(err)) == (2, 1)
    assert "its scene has no decay" in err[0]


@pytest.mark.parametrize(
    ("trouble", "code", "words"),
    [
        ("unstable", 3, "unstable at step 7"),
        ("failed", 1, "the film could not be made"),
        ("stopped", 130, "interrupted"),
        ("memory", 1, "not enough memory (12 GiB)"),
        ("disk", 1, "fields.vtkhdf: No space left"),
        ("lost", 1, "fields.vtkhdf: No such file"),
    ],
)
def test_every_end_has_its_code_and_one_line(toy, trouble: str, code: int, words: str) -> None:
    toy("new", "decay")
    given, _, err = toy("run", "decay", "--set", f"trouble={trouble}")
    assert given == code
    assert len(err) == 1
    assert words in err[0]


@pytest.mark.parametrize(("trouble", "kind"), [("bug", ZeroDivisionError), ("nameless", OSError)])
def test_our_own_bugs_keep_their_traceback(toy, trouble: str, kind: type[Exception]) -> None:
    toy("new", "decay")
    with pytest.raises(kind):
        toy("run", "decay", "--set", f"trouble={trouble}")
