"""The command line, with a toy package: what it does, what it says, how it ends."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from porescale.common.schema.sections import load
from tests.reference.toy_package import ToyScene
from tests.reference.waiting import done, running, talked


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
    assert card()["overwrite"] is False
    assert toy("run", "decay", "--overwrite")[0] == 0
    assert card()["resumed"] is False
    assert card()["overwrite"] is True
    assert "contradicts" in toy("run", "decay", "--overwrite", "--resume")[2][0]
    assert "is not empty" in toy("run", "decay", "--out", "decay")[2][0]
    assert "is a file" in toy("run", "decay", "--out", "decay/scene.toml")[2][0]


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
    assert all(name in out for name in ("run", "check", "show", "new", "sweep", "verify", "bench"))
    assert toy("run", "--help")[0] == 0
    assert toy("--version")[1] == "1.2.3\n"
    assert "--no-" not in toy("run", "--help")[1]


def test_asking_for_help_imports_nothing_heavy() -> None:
    code = (
        "import sys; from porescale.common.cli.application import application, main\n"
        "from porescale.common.cli.package import Package\n"
        "f = lambda *a, **k: 1 / 0\n"
        "code = main(application(Package('toy', 's', '1', f, f, f, f, f, f, f, f)), ['--help'])\n"
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
        "toy = Package('toy', 's', '1', lambda: Section, f, f, f, f, show, f, f)\n"
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
