"""The command line, with a toy package: what it does and says, how it ends; what people, disks and bugs do to it."""

import io
import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

from porescale.common.api.report import Report
from porescale.common.cli.application import application, main
from porescale.common.core.version import VERSION
from porescale.common.evidence.benchmarks import Row
from porescale.common.evidence.benchmarks import table as rates_table
from porescale.common.schema.sections import load
from tests.reference.toy_package import TEMPLATE, TOY, ToyModel, ToyScene
from tests.reference.waiting import done, running, talked


def card(folder: str = "runs/decay") -> dict[str, Any]:
    return json.loads((Path(folder) / "card.json").read_text())


@pytest.fixture
def decay(toy):
    """Runs a command line in a folder that holds the new scene "decay"."""
    assert toy("new", "decay")[0] == 0
    return toy


def refused(toy, *tokens: str) -> str:
    """The one line that a command line of wrong use or input is answered with."""
    code, out, err = toy(*tokens)
    assert (code, out, len(err)) == (2, "", 1)
    assert "Traceback" not in err[0]
    return err[0]


def test_a_new_scene_checks_and_runs_as_it_is(toy) -> None:
    assert toy("new", "decay")[0] == 0
    assert load("decay", ToyScene).duration == 2.0
    code, out, err = toy("check", "decay")
    assert (code, err) == (0, [])
    assert "of 0.1 s" in out
    code, out, err = toy("run", "decay")
    assert (code, err) == (0, [])
    assert "finished at t = 2 s, step 10" in out
    assert "runs/decay: card.json" in out
    assert card()["scene"] == {"decay": {"rate": 3.0, "start": 1.0}, "noise": None, "duration": 2.0, "trouble": ""}
    assert card()["quality"] is None
    code, out, err = toy("show", "runs/decay")
    assert (code, out) == (0, "runs/decay/end.png\n")


def test_new_never_overwrites(decay) -> None:
    Path("decay/scene.toml").write_text("mine")
    assert "exists already" in refused(decay, "new", "decay")
    assert Path("decay/scene.toml").read_text() == "mine"


def test_options_reach_the_run(decay) -> None:
    tokens = "run decay --out elsewhere --quality fine --set decay.rate=7 --set duration='5 s' --threads 1 --quiet"
    said = refused(decay, *tokens.replace("'", "").replace("5 s", "5_s").split())  # 5_s is no quantity
    assert said == "--set: duration = '5_s': unknown unit '_s' (allowed: > 0 s); give it in s, as 1.5 or \"1.5 s\""
    assert decay(*tokens.replace("'5 s'", "5").split()) == (0, "", [])
    made = card("elsewhere")
    assert made["scene"]["decay"] == {"rate": 7.0, "start": 2.0}
    assert made["scene"]["duration"] == 5.0
    assert made["quality"] == "fine"
    assert made["settings"] == ["decay.rate=7", "duration=5"]


def test_options_may_stand_anywhere_and_values_may_be_negative(decay) -> None:
    assert decay("run", "--set", "decay.rate=1", "decay", "--set=decay.start=-1", "--quiet")[0] == 0
    assert card()["scene"]["decay"] == {"rate": 1.0, "start": -1.0}


def test_an_existing_run_is_refused_resumed_or_overwritten(decay) -> None:
    assert "holds no run to resume" in refused(decay, "run", "decay", "--resume")
    decay("run", "decay")
    said = refused(decay, "run", "decay")
    assert "already holds a run; choose another --out, --resume the run, or --overwrite it" in said
    assert decay("run", "decay", "--resume")[0] == 0
    assert card()["resumed"] is True
    assert card()["overwrite"] is False
    assert decay("run", "decay", "--overwrite")[0] == 0
    assert card()["resumed"] is False
    assert card()["overwrite"] is True
    assert "contradicts" in decay("run", "decay", "--overwrite", "--resume")[2][0]
    assert "is not empty" in decay("run", "decay", "--out", "decay")[2][0]
    assert "is a file" in decay("run", "decay", "--out", "decay/scene.toml")[2][0]


@pytest.mark.parametrize(
    ("tokens", "words"),
    [
        ("rum decay", 'Unknown command "rum". Did you mean "run"?'),
        ("run decay --qualty fine", "Unknown option: --qualty. Did you mean --quality?"),
        ("run decay --quality finest", "fine"),
        ("run decay --quality draft", "this scene has no such level (allowed: fine)"),
        ("run", "SCENE requires"),
        ("run nowhere", "looked for a file or folder nowhere"),
        ("run decay extra", "extra"),
        ("run decay --threads 0", "--threads = 0: is out of range (allowed: 1 to "),
        ("run decay --threads 5000", "--threads = 5000: is out of range (allowed: 1 to "),
        ("verify --threads 5000", "--threads = 5000: is out of range (allowed: 1 to "),
        ("bench --threads 5000", "--threads = 5000: is out of range (allowed: 1 to "),
        ("run decay --threads two", "two"),
        ("check decay --set decay.rat=1", "did you mean 'rate'?"),
        ("check decay --set decay.rate=101", "beyond the stable limit"),
        ("show decay", "no run here (card.json is missing)"),
        ("verify toy.god", "did you mean 'toy.good'?"),
        ("bench toi", "did you mean 'toy'?"),
        ("bench --dtype float16", "float"),
    ],
)
def test_wrong_use_is_one_line_and_code_2(decay, tokens: str, words: str) -> None:
    assert words in refused(decay, *tokens.split())


def test_all_faults_of_a_scene_are_lines_of_their_own(toy) -> None:
    Path("bad.toml").write_text("[decay]\nrate = 0\nstrat = 1\n")
    code, _, err = toy("run", "bad.toml")
    assert code == 2
    assert len(err) == 2
    assert all(line.startswith("bad.toml: decay.") for line in err)


def test_check_as_json(decay) -> None:
    assert json.loads(decay("check", "decay", "--json")[1])["groups"]["time"][0]["value"] == 10


def test_verify_fails_when_a_row_fails(toy) -> None:
    code, out, _ = toy("verify")
    assert code == 0
    assert "1 passed, 0 failed, 1 slow ones left out" in out
    for option in ("--slow", "--all"):
        code, out, _ = toy("verify", option, "--json")
        assert code == 1
        assert [row["passed"] for row in json.loads(out)] == [True, False]
    assert toy("verify", "toy.bad")[0] == 1
    assert toy("verify", "--list")[1].splitlines() == ["toy.good: exact", "toy.bad (slow): exact"]
    rows = json.loads(toy("verify", "--list", "--json")[1])
    assert rows[1] == {"name": "toy.bad", "slow": True, "source": "exact"}


def test_bench_as_json_and_table(toy) -> None:
    code, out, _ = toy("bench", "toy", "--size", "5", "--threads", "1", "--json")
    assert code == 0
    assert json.loads(out)[0]["size"] == 5
    assert "toys/s" in toy("bench")[1]
    assert toy("bench", "--list")[1] == "toy\n"
    assert json.loads(toy("bench", "--list", "--json")[1]) == [{"name": "toy"}]
    assert toy("bench", "tyo", "--list")[0] == 2  # a name that is none, listed or not


def test_help_and_version(toy) -> None:
    code, out, _ = toy("--help")
    assert code == 0
    assert all(name in out for name in ("run", "check", "show", "new", "sweep", "verify", "bench"))
    assert toy("run", "--help")[0] == 0
    assert toy("--version")[1] == f"{VERSION}\n"
    assert "--no-" not in toy("run", "--help")[1]


def test_no_option_has_two_defaults_in_its_help(toy) -> None:
    """Threads were those of all cores "if not given", and 1 by default."""
    for command in (("run",), ("sweep",), ("verify",), ("bench",), ("study", "trade")):
        shown = " ".join(toy(*command, "--help")[1].replace("│", "").split())
        options = shown.split(" --")[1:]
        assert options, command
        twice = [it for it in options if "if not given" in it and "[default:" in it]
        assert not twice, command


def test_a_narrow_table_of_rates_keeps_its_numbers() -> None:
    row = Row("corrected", 20000, 1, "float64", 6.634e6, "particles/s", 0.151, 0.0, None)
    console = Console(width=80, file=io.StringIO())
    console.print(rates_table([row]))
    said = console.file.getvalue()
    assert all(it in said for it in ("corrected", "6.634e+06", "particles/s"))


def test_asking_for_help_imports_nothing_heavy() -> None:
    code = (
        "import sys; from porescale.common.cli.application import application, main\n"
        "from porescale.common.cli.package import Package\n"
        "f = lambda *a, **k: 1 / 0\n"
        "names = ('scene', 'build', 'drive', 'report', 'show', 'look', 'template', 'validations', 'benchmarks')\n"
        "toy = Package(name='toy', module='toy', summary='s', **dict.fromkeys(names, f))\n"
        "code = main(application(toy), ['--help'])\n"
        "heavy = {'numba', 'numpy', 'pint', 'pydantic', 'matplotlib', 'h5py'} & set(sys.modules)\n"
        "sys.exit(code or (str(heavy) if heavy else 0))"
    )
    it = done([sys.executable, "-c", code])
    assert it.returncode == 0, it.stderr


def test_a_reader_that_leaves_is_no_traceback(tmp_path: Path) -> None:
    code = (
        "import sys; from porescale.common.cli.application import application, main\n"
        "from porescale.common.cli.package import Package\n"
        "from porescale.common.schema.sections import Section\n"
        "f = lambda *a, **k: 1 / 0\n"
        "show = lambda folder: (folder / str(i) for i in range(100000))\n"
        "names = ('build', 'drive', 'report', 'look', 'template', 'validations', 'benchmarks')\n"
        "toy = Package(name='toy', module='toy', summary='s', scene=lambda: Section, show=show, "
        "**dict.fromkeys(names, f))\n"
        "sys.exit(main(application(toy), ['show', '.']))"
    )
    read, write = os.pipe()
    os.close(read)
    (tmp_path / "card.json").write_text(json.dumps({"package": "toy", "scene": {}}))
    command = [sys.executable, "-c", code]
    with running(command, stdout=write, stderr=subprocess.PIPE, text=True, cwd=tmp_path) as process:
        os.close(write)
        _, said = talked(process)
    assert (process.returncode, said) == (1, "")


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
def test_a_folder_that_cannot_be_written_is_refused_before_the_model_is_built(decay, monkeypatch, folder, words):
    monkeypatch.setattr(ToyModel, "__init__", None)
    for command in (("run", "decay", "--out", folder), ("new", folder)):
        said = refused(decay, *command)
        assert words in said
        assert len(said) < 250
    assert [path.name for path in Path().iterdir()] == ["decay"]
    Path("odd/card.json").mkdir(parents=True)
    for option in ("--overwrite", "--resume"):
        assert "card.json there is a folder" in refused(decay, "run", "decay", "--out", "odd", option)
    assert refused(decay, "check", LONG) == "SCENE: cannot be read (File name too long); name another"
    assert refused(decay, "report", LONG) == f"{LONG}/card.json: File name too long"


def test_a_folder_that_the_system_withholds_is_wrong_input_and_nothing_is_left(decay, monkeypatch) -> None:
    def withheld(path: Path, **_: Any) -> None:
        raise PermissionError(1, "Operation not permitted", str(path))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "touch", withheld)
        said = refused(decay, "run", "decay", "--out", "deep/er")
    assert said == "--out = 'deep/er': cannot be written (Operation not permitted); name another folder"
    assert not Path("deep").exists()
    assert decay("run", "decay", "--out", "deep/er")[0] == 0  # the twin


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
def test_a_damaged_or_foreign_card_is_one_line(decay, content: str, words: str) -> None:
    decay("run", "decay")
    assert decay("show", "runs/decay")[0] == 0  # the twin
    Path("runs/decay/card.json").write_text(content, encoding="latin-1")
    for command in (("show", "runs/decay"), ("run", "decay", "--resume")):
        assert words in refused(decay, *command)
    assert decay("run", "decay", "--overwrite")[0] == 0


def test_a_place_that_cannot_be_written_is_refused_before_anything_is_drawn(decay) -> None:
    decay("run", "decay")
    Path("file").write_text("")
    assert "--out = 'file': cannot be written" in refused(decay, "show", "runs/decay", "--out", "file/own.png")
    assert "--picture = 'file': cannot be written" in refused(decay, "check", "decay", "--picture", "file/own.png")


def test_a_run_folder_that_cannot_be_written_is_shown_elsewhere(decay, monkeypatch) -> None:
    """A share that is only read: pictures ended in the name of a file that is being written, with exit code 1."""
    decay("run", "decay")
    before, touch = sorted(Path("runs/decay").iterdir()), Path.touch

    def withheld(path: Path, **words: Any) -> None:
        if path.parent.name == "decay":
            raise PermissionError(13, "Permission denied", str(path))
        touch(path, **words)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "touch", withheld)
        for options in ((), ("--times", "0.1")):
            assert refused(decay, "show", "runs/decay", *options) == (
                "run folder = 'runs/decay': cannot be written (Permission denied); "
                "write one figure or film elsewhere, with --out FILE"
            )
    assert sorted(Path("runs/decay").iterdir()) == before
    assert decay("show", "runs/decay")[0] == 0  # the twin


def test_a_card_whose_scene_lacks_what_every_scene_has_is_not_shown(toy) -> None:
    Path("card.json").write_text('{"package": "toy", "scene": {"duration": 1}}')
    assert "its scene has no decay" in refused(toy, "show", ".")


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
def test_every_end_has_its_code_and_one_line(decay, trouble: str, code: int, words: str) -> None:
    given, _, (line,) = decay("run", "decay", "--set", f"trouble={trouble}")
    assert given == code
    assert words in line


@pytest.mark.parametrize(("trouble", "kind"), [("bug", ZeroDivisionError), ("nameless", OSError)])
def test_our_own_bugs_keep_their_traceback(decay, trouble: str, kind: type[Exception]) -> None:
    with pytest.raises(kind):
        decay("run", "decay", "--set", f"trouble={trouble}")


def run_warned(*words: str) -> tuple[int, list[str]]:
    """Exit code of a run of a toy package that warns, and what it was called for, in order."""
    Path("scene.toml").write_text(TEMPLATE)
    calls: list[str] = []

    def report(scene: Any) -> Report:
        calls.append("report")
        made = TOY.report(scene)
        made.warn("mind the step")
        return made

    def build(scene: Any) -> Any:
        calls.append("build")
        return TOY.build(scene)

    app = application(replace(TOY, report=report, build=build))
    return main(app, ["run", "scene.toml", "--quiet", *words]), calls


@pytest.mark.usefixtures("toy")
def test_a_scene_is_checked_once_and_its_warnings_are_said_once(capsys):
    assert run_warned() == (0, ["report", "build"])
    assert capsys.readouterr().err == "warning: mind the step\n"


@pytest.mark.usefixtures("toy")
def test_what_the_report_refuses_is_not_built(capsys):
    assert run_warned("--set", "decay.rate=1000") == (2, ["report"])
    assert "beyond the stable limit" in capsys.readouterr().err


def test_a_terminal_without_signs_is_given_their_spelling(toy, monkeypatch) -> None:
    said = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr(sys, "stdout", said)
    app = application(replace(TOY, summary="m² ± 3 …"))
    app.command(lambda: print("0.1 ± 0.2 m²… ☃"), name="signs")
    assert main(app, ["signs"]) == 0
    assert said.buffer.getvalue() == b"0.1 +- 0.2 m^2... ?\n"
