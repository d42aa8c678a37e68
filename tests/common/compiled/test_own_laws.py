"""Laws of a user's file: found by name, known by all that they stand on, compiled anew when that changes."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from porescale.common.compiled.own import body_force, contact_law, inflow
from porescale.common.compiled.own_file import law_of
from porescale.common.compiled.own_kernel import compile_for, kernel_of
from porescale.common.compiled.turns import TURNS
from porescale.common.core.errors import InputError
from tests.reference.folders import ROOT
from tests.reference.own_laws import write_laws

FILE = """
import porescale as ps
{imports}

FACTOR = {factor}


def half(x):
    return 0.5 * x


@ps.inflow
def pulse(s, t):
    return FACTOR * half({call}(s)), 0.0
"""
HELPER = """
POWER = {power}


def shape(s):
    return s**POWER
"""


def pulse(folder: Path, call: str = "shape", factor: float = 2.0, power: int = 2, name: str = "laws.py") -> float:
    """The velocity at s = 3 of a law that stands on two files: factor/2 3^power."""
    imports = "from helper import shape" if call == "shape" else "import helper"
    write_laws(folder, HELPER.format(power=power), "helper.py")
    write_laws(folder, FILE.format(imports=imports, factor=factor, call=call), name)
    law = law_of(f"{name}:pulse", folder, "inflow")
    return float(compile_for(law, 3.0, 0.0, count=2)(3.0, 0.0)[0])


@pytest.mark.parametrize("call", ["shape", "helper.shape"])
def test_an_edited_file_an_edited_helper_and_an_edited_constant_give_a_new_result(tmp_path: Path, call: str) -> None:
    assert pulse(tmp_path, call) == 9.0
    first = law_of("laws.py:pulse", tmp_path, "inflow")
    assert pulse(tmp_path, call, factor=4.0) == 18.0  # a constant of the file
    assert pulse(tmp_path, call, factor=4.0, power=3) == 54.0  # a constant of the file that it imports
    assert law_of("laws.py:pulse", tmp_path, "inflow").hash != first.hash
    assert pulse(tmp_path, call) == 9.0
    assert law_of("laws.py:pulse", tmp_path, "inflow") == first


def test_two_files_of_one_name_do_not_mix(tmp_path: Path) -> None:
    assert pulse(tmp_path / "one") == 9.0
    assert pulse(tmp_path / "two", power=3) == 27.0
    assert pulse(tmp_path / "one") == 9.0
    assert "helper" not in sys.modules


@pytest.mark.parametrize("name", ["random.py", "numpy.py"])
def test_a_file_may_be_called_as_a_library_is(tmp_path: Path, name: str) -> None:
    assert pulse(tmp_path, name=name) == 9.0
    assert pulse(tmp_path, factor=4.0, name=name) == 18.0


IN_ANOTHER_PROCESS = """
import sys
from pathlib import Path
from porescale.common.compiled.jit import kernel
from porescale.common.compiled.own_file import law_of
from porescale.common.compiled.own_kernel import kernel_of

law = law_of("laws.py:pulse", Path(sys.argv[1]), "inflow")
at = kernel_of(law.function)


@kernel
def used(s):
    return at(s, 0.0)[0]


print(used(3.0), sum(used.compiled.stats.cache_hits.values()))
"""


def test_kernels_that_are_kept_know_what_was_edited(tmp_path: Path) -> None:
    def told() -> list[str]:
        command = [sys.executable, "-W", "error", "-c", IN_ANOTHER_PROCESS, str(tmp_path)]
        found = subprocess.run(command, capture_output=True, text=True, timeout=300, cwd=ROOT, check=False)
        assert found.returncode == 0, found.stderr
        return found.stdout.split()

    pulse(tmp_path, power=4)
    told()
    assert told() == ["81.0", "1"]  # kept
    pulse(tmp_path, power=3)
    assert told()[0] == "27.0"
    pulse(tmp_path, power=4)
    assert told() == ["81.0", "1"]  # still there


BROKEN = {
    "def f(:": "laws.py, line 3: invalid syntax",
    "import porescal": "laws.py, line 3: ModuleNotFoundError: No module named 'porescal'",
    "x = 1 / 0": "laws.py, line 3: ZeroDivisionError: division by zero",
    "raise SystemExit(3)": "laws.py, line 3: SystemExit: 3",
    "@ps.inflow\ndef wanted(s):\n    return s, 0.0": "laws.py, line 3: wanted: takes (s) (allowed: (s, t))",
    "@ps.body_force\ndef wanted(x, y, t):\n    return x, y": "wanted is made for @body_force, here @inflow is needed",
    "def wanted(s, t):\n    return s, t": "wanted of laws.py has no decorator",
    "@ps.inflow\ndef other(s, t):\n    return s, t": "laws.py has no 'wanted' (allowed: inflow of the file: other)",
    "@ps.contact_law\ndef f(a, b, c, d, e):\n    return a": "contact_law",
    "@ps.contact_law(keys={'a': 'Nm/q'})\ndef f(a, b, c, d, e):\n    return a": "unit of the key 'a'",
}


@pytest.mark.parametrize("text", BROKEN)
def test_what_is_wrong_with_a_file_is_said_in_one_line_with_its_place(tmp_path: Path, text: str) -> None:
    write_laws(tmp_path, f"import porescale as ps\n\n{text}\n")
    with pytest.raises(InputError) as caught:
        law_of("laws.py:wanted", tmp_path, "inflow")
    assert BROKEN[text] in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1


def test_a_file_that_is_not_there_is_said(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"there is no file .*laws\.py; paths count from the scene's folder"):
        law_of("laws.py:wanted", tmp_path, "inflow")


UNCOMPILED = {
    "return unknown * s, 0.0": "laws.py, line 2: NameError: name 'unknown' is not defined",
    "return s + 'a', 0.0": "laws.py, line 4: No implementation of function",
    "return s": "wanted returns 1.0, not 2 numbers",
    "s += 1": "wanted returns nothing, not 2 numbers",
    "return s, 'a'": "not 2 numbers",
}


@pytest.mark.parametrize("text", UNCOMPILED)
def test_what_cannot_be_compiled_is_said_in_one_line_with_its_place(tmp_path: Path, text: str) -> None:
    write_laws(tmp_path, f"import porescale as ps\n@ps.inflow\ndef wanted(s, t):\n    {text}\n")
    with pytest.raises(InputError) as caught:
        compile_for(law_of("laws.py:wanted", tmp_path, "inflow"), 1.0, 0.0, count=2)
    assert UNCOMPILED[text] in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1
    assert TURNS.name == ""  # progress of the next run names no kernel that nobody compiles


def test_functions_made_by_one_function_are_laws_of_their_own() -> None:
    def made(factor: float) -> Any:
        @inflow
        def pulse(s: float, t: float) -> tuple[float, float]:
            return factor * s, 0.0

        return pulse

    assert [kernel_of(made(it).function)(1.0, 0.0)[0] for it in (2.0, 3.0)] == [2.0, 3.0]


def test_a_function_of_a_session_has_its_text_on_the_card() -> None:
    names: dict[str, Any] = {"inflow": inflow, "FACTOR": 2.0}
    text = "@inflow\ndef pulse(s, t):\n    return FACTOR * s, 0.0\n"
    import linecache

    linecache.cache["<cell 1>"] = (len(text), None, text.splitlines(True), "<cell 1>")
    exec(compile(text, "<cell 1>", "exec"), names)
    law = names["pulse"]
    assert law.file is None
    assert law.card()["sources"] == {"pulse": text, "FACTOR": "FACTOR = 2.0"}
    assert law.reference == "notebook:pulse"


def test_a_decorated_function_is_still_a_function() -> None:
    @body_force
    def swirl(x: float, y: float, t: float) -> tuple[float, float]:
        return -y, x + t

    assert swirl(1.0, 2.0, 3.0) == (-2.0, 4.0)
    assert contact_law(keys={"a": "N/m"})(lambda d, v, r, m, p: d).keys == {"a": "N/m"}
