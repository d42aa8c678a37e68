"""The command line, with a toy package: what it does, what it says, how it ends."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from porescale.ground.check import Fault, InputError, PorescaleError, Unstable
from porescale.workbench.application import application, main
from porescale.workbench.benchmarks import Benchmarks, Work
from porescale.workbench.package import Package
from porescale.workbench.report import Report
from porescale.workbench.sections import Section, load, quantity
from porescale.workbench.validations import Measured, Validations


class Decay(Section):
    rate: float = quantity("1/s", gt=0, help="rate of decay")
    start: float = quantity("m", 1.0)


class ToyScene(Section):
    decay: Decay
    duration: float = quantity("s", 1.0, gt=0)
    trouble: str = ""


TEMPLATE = '# How fast it goes.\nduration = "2 s"\n[decay]\nrate = 3\n[quality.fine.decay]\nstart = 2\n'


@dataclass
class Ended:
    outcome: str
    step: int
    time: float
    seconds: float
    snapshots: int
    steps_per_second: float


class ToyModel:
    def __init__(self, scene: ToyScene) -> None:
        self.scene = scene


def drive(model: ToyModel, folder: Path, scene: ToyScene, *, card: dict[str, Any], resume: bool, quiet: bool) -> Ended:
    troubles = {
        "unstable": lambda: Unstable("cell (1, 2)", "speed", 9.0, "m/s", 7, 0.5, "a smaller step helps"),
        "failed": lambda: PorescaleError("the film\ncould not be made"),
        "stopped": KeyboardInterrupt,
        "bug": lambda: ZeroDivisionError("ours"),
        "memory": lambda: MemoryError("12 GiB"),
        "disk": lambda: OSError(28, "No space left on device", "fields.vtkhdf"),
        "lost": lambda: FileNotFoundError(2, "No such file", "fields.vtkhdf"),
        "nameless": lambda: OSError(22, "Invalid argument"),
    }
    if scene.trouble:
        raise troubles[scene.trouble]()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "card.json").write_text(json.dumps({**card, "resumed": resume}))
    return Ended("finished", 10, scene.duration, 0.5, 3, 20.0)


def report(scene: ToyScene) -> Report:
    if scene.decay.rate > 100:
        raise InputError(Fault("decay.rate", scene.decay.rate, "is beyond the stable limit", "1/s", "<= 100"))
    made = Report("toy")
    made.heading("time")
    made.row("steps", 10, "", "of 0.1 s")
    return made


def picture(folder: Path) -> list[Path]:
    return [folder / "end.png"]


def validations() -> Validations:
    made = Validations()

    @made.row("toy.good", source="exact", because="exact", tolerance=0.0)
    def _() -> Measured:
        return Measured(1.0, 1.0, 0.0)

    @made.row("toy.bad", source="exact", because="exact", tolerance=0.0, slow=True)
    def _() -> Measured:
        return Measured(1.0, 2.0, 1.0)

    return made


def benchmarks() -> Benchmarks:
    made = Benchmarks()

    @made.row("toy")
    def _(size: int | None, threads: int, dtype: str) -> Work:
        return Work(lambda: sum(range(1000)), 1.0, "toys/s", size or 1)

    return made


TOY = Package(
    name="toy",
    summary="A toy.",
    version="1.2.3",
    scene=lambda: ToyScene,
    template=lambda: TEMPLATE,
    build=ToyModel,
    drive=drive,
    report=report,
    show=picture,
    validations=validations,
    benchmarks=benchmarks,
)


@pytest.fixture
def toy(tmp_path: Path, monkeypatch, capsys):
    """Runs a command line in an empty folder; gives exit code, stdout, stderr lines."""
    monkeypatch.chdir(tmp_path)

    def _toy(*tokens: str) -> tuple[int, str, list[str]]:
        code = main(application(TOY), tokens)
        said = capsys.readouterr()
        return code, said.out, said.err.splitlines()

    return _toy


def card(folder: str = "runs/decay") -> dict[str, Any]:
    return json.loads((Path(folder) / "card.json").read_text())


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
    assert card()["scene"] == {"decay": {"rate": 3.0, "start": 1.0}, "duration": 2.0, "trouble": ""}
    assert card()["quality"] is None
    code, out, err = toy("show", "runs/decay")
    assert (code, out) == (0, "runs/decay/end.png\n")


def test_new_never_overwrites(toy) -> None:
    toy("new", "decay")
    Path("decay/scene.toml").write_text("mine")
    code, _, err = toy("new", "decay")
    assert code == 2
    assert "exists already" in err[0]
    assert Path("decay/scene.toml").read_text() == "mine"


def test_options_reach_the_run(toy) -> None:
    toy("new", "decay")
    tokens = "run decay --out elsewhere --quality fine --set decay.rate=7 --set duration='5 s' --threads 1 --quiet"
    code, out, err = toy(*tokens.replace("'", "").replace("5 s", "5_s").split())
    assert code == 2  # 5_s is no quantity
    assert err == ["--set: duration = '5_s': unknown unit '_s' (allowed: > 0 s); give it in s, as 1.5 or \"1.5 s\""]
    code, out, err = toy(*tokens.replace("'5 s'", "5").split())
    assert (code, out, err) == (0, "", [])
    made = card("elsewhere")
    assert made["scene"]["decay"] == {"rate": 7.0, "start": 2.0}
    assert made["scene"]["duration"] == 5.0
    assert made["quality"] == "fine"
    assert made["settings"] == ["decay.rate=7", "duration=5"]


def test_options_may_stand_anywhere_and_values_may_be_negative(toy) -> None:
    toy("new", "decay")
    assert toy("run", "--set", "decay.rate=1", "decay", "--set=decay.start=-1", "--quiet")[0] == 0
    assert card()["scene"]["decay"] == {"rate": 1.0, "start": -1.0}


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


def test_an_existing_run_is_refused_resumed_or_overwritten(toy) -> None:
    toy("new", "decay")
    assert "holds no run to resume" in toy("run", "decay", "--resume")[2][0]
    toy("run", "decay")
    code, _, err = toy("run", "decay")
    assert code == 2
    assert len(err) == 1
    assert "already holds a run; choose another --out, --resume the run, or --overwrite it" in err[0]
    assert toy("run", "decay", "--resume")[0] == 0
    assert card()["resumed"] is True
    assert toy("run", "decay", "--overwrite")[0] == 0
    assert card()["resumed"] is False
    assert "contradicts" in toy("run", "decay", "--overwrite", "--resume")[2][0]
    assert "is not empty" in toy("run", "decay", "--out", "decay")[2][0]
    assert "is a file" in toy("run", "decay", "--out", "decay/scene.toml")[2][0]


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
        ("run decay --threads 0", "--threads = 0: is out of range"),
        ("run decay --threads two", "two"),
        ("check decay --set decay.rat=1", "did you mean 'rate'?"),
        ("check decay --set decay.rate=101", "beyond the stable limit"),
        ("show decay", "is no run folder"),
        ("verify toy.god", "did you mean 'toy.good'?"),
        ("bench toi", "did you mean 'toy'?"),
        ("bench --dtype float16", "float"),
    ],
)
def test_wrong_use_is_one_line_and_code_2(toy, tokens: str, words: str) -> None:
    toy("new", "decay")
    code, _, err = toy(*tokens.split())
    assert code == 2
    assert len(err) == 1
    assert words in err[0]
    assert "Traceback" not in err[0]


def test_all_faults_of_a_scene_are_lines_of_their_own(toy) -> None:
    Path("bad.toml").write_text("[decay]\nrate = 0\nstrat = 1\n")
    code, _, err = toy("run", "bad.toml")
    assert code == 2
    assert len(err) == 2
    assert all(line.startswith("bad.toml: decay.") for line in err)


def test_check_as_json(toy) -> None:
    toy("new", "decay")
    assert json.loads(toy("check", "decay", "--json")[1])["groups"]["time"][0]["value"] == 10


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


def test_bench_as_json_and_table(toy) -> None:
    code, out, _ = toy("bench", "toy", "--size", "5", "--threads", "1", "--json")
    assert code == 0
    assert json.loads(out)[0]["size"] == 5
    assert "toys/s" in toy("bench")[1]
    assert toy("bench", "--list")[1] == "toy\n"


def test_help_and_version(toy) -> None:
    code, out, _ = toy("--help")
    assert code == 0
    assert all(name in out for name in ("run", "check", "show", "new", "verify", "bench"))
    assert toy("run", "--help")[0] == 0
    assert toy("--version")[1] == "1.2.3\n"
    assert "--no-" not in toy("run", "--help")[1]


def test_asking_for_help_imports_nothing_heavy() -> None:
    code = (
        "import sys; from porescale.workbench.application import application, main\n"
        "from porescale.workbench.package import Package\n"
        "f = lambda *a, **k: 1 / 0\n"
        "code = main(application(Package('toy', 's', '1', f, f, f, f, f, f, f, f)), ['--help'])\n"
        "heavy = {'numba', 'numpy', 'pint', 'pydantic', 'matplotlib', 'h5py'} & set(sys.modules)\n"
        "sys.exit(code or (str(heavy) if heavy else 0))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_reader_that_leaves_is_no_traceback(tmp_path: Path) -> None:
    code = (
        "import sys; from porescale.workbench.application import application, main\n"
        "from porescale.workbench.package import Package\n"
        "f = lambda *a, **k: 1 / 0\n"
        "show = lambda folder: (folder / str(i) for i in range(100000))\n"
        "sys.exit(main(application(Package('toy', 's', '1', f, f, f, f, f, show, f, f)), ['show', '.']))"
    )
    read, write = os.pipe()
    os.close(read)
    (tmp_path / "card.json").write_text("{}")
    done = subprocess.run(
        [sys.executable, "-c", code],
        stdout=write,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
        cwd=tmp_path,
    )
    os.close(write)
    assert (done.returncode, done.stderr) == (1, "")
