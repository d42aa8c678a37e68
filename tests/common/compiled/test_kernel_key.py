"""Kernels kept on disk: an edit compiles anew what contains the edited text, and nothing else."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from porescale.common.compiled import jit
from porescale.common.compiled.jit import Kernel, inline, kernel, law_function, precision_constants
from porescale.common.compiled.kernel_key import Unknown, key_of
from porescale.common.compiled.simd import row_gatherer

ROOT = Path(jit.__file__).resolve().parents[3]

PACKAGE = {
    "__init__.py": "",
    "laws.py": '''
"""What a law is."""
from typing import NamedTuple
from porescale.common.compiled.jit import law_function
class Soft(NamedTuple):
    stiffness: float
class Hard(NamedTuple):
    stiffness: float
@law_function
def force(overlap, law):
    """Force."""
''',
    "soft.py": '''
from toy.laws import Soft, force
@force.of(Soft)
def soft_force(overlap, law):
    """Linear."""
    return law.stiffness * overlap
''',
    "hard.py": '''
from toy.laws import Hard, force
POWER = 2
@force.of(Hard)
def hard_force(overlap, law):
    """Not linear."""
    return law.stiffness * overlap**POWER
''',
    "helpers.py": '''
from porescale.common.compiled.jit import inline
SHIFT = 0.0
@inline
def half(x):
    """Half."""
    return 0.5 * x
''',
    "sweep.py": '''
from porescale.common.compiled.jit import kernel
from toy.helpers import half
from toy.laws import force
@kernel
def sweep(overlap, law):
    """Half a force."""
    return half(force(overlap, law))
''',
    "report.py": '''
"""No kernel."""
WORDS = "words"
''',
}
"""Two contact laws whose bodies no caller imports, a sweep over either, a function merged into it, and a report."""

ASK = """
import json, sys
sys.path.insert(0, sys.argv[1])
import toy.hard, toy.soft, toy.report
from toy.laws import Hard, Soft
from toy.sweep import sweep
found = {}
for law in (Soft(3.0), Hard(3.0)):
    before = sum(sweep.stats.cache_hits.values())
    value = sweep(4.0, law)
    found[type(law).__name__] = [value, sum(sweep.stats.cache_hits.values()) - before]
print(json.dumps(found))
"""


class Stretch(NamedTuple):
    """A law."""

    stiffness: float


class Twist(NamedTuple):
    """Another."""

    stiffness: float


class Toy:
    """A package in a folder, and what its sweep gives in a new process: force and whether it came from disk, by law."""

    def __init__(self, folder: Path, kernels: Path) -> None:
        self.folder, self.kernels = folder, kernels
        (folder / "toy").mkdir(parents=True)
        for name, text in PACKAGE.items():
            (folder / "toy" / name).write_text(text)

    def edit(self, name: str, old: str, new: str) -> None:
        """Replace a text of one file, which must be there."""
        path = self.folder / "toy" / name
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new))

    def run(self, ask: str = ASK, **variables: str) -> dict[str, list[float]]:
        """Values and whether they came from disk, by law."""
        environment = os.environ | {"NUMBA_CACHE_DIR": str(self.kernels), "PYTHONDONTWRITEBYTECODE": "1"} | variables
        words = [sys.executable, "-c", ask, str(self.folder)]
        done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True, cwd=ROOT)
        assert done.stderr == ""
        return dict(json.loads(done.stdout))


@pytest.fixture(scope="module")
def kept(tmp_path_factory) -> Path:
    """The package's kernels, compiled by a process of which nothing else is left."""
    place = tmp_path_factory.mktemp("kept")
    made = Toy(place / "one", place / "kernels")
    assert made.run() == {"Soft": [6.0, 0], "Hard": [24.0, 0]}
    return made.kernels


@pytest.fixture
def toy(kept: Path, tmp_path: Path) -> Toy:
    """The package, its kernels compiled and on disk."""
    shutil.copytree(kept, tmp_path / "kernels")
    return Toy(tmp_path / "one", tmp_path / "kernels")


def test_what_is_compiled_once_is_read_by_the_next_process_also_from_a_copy_elsewhere(toy, tmp_path):
    assert toy.run() == {"Soft": [6.0, 1], "Hard": [24.0, 1]}
    kept = sorted(path.name for path in toy.kernels.iterdir())
    again = Toy(tmp_path / "two", toy.kernels)
    assert again.run() == {"Soft": [6.0, 1], "Hard": [24.0, 1]}
    assert sorted(path.name for path in toy.kernels.iterdir()) == kept
    assert toy.run(NUMBA_OPT="2")["Soft"] == [6.0, 0]  # the twin: a variable that changes what is compiled


def test_an_edit_of_a_report_or_a_comment_compiles_nothing_anew(toy):
    toy.edit("report.py", "words", "other words")
    toy.edit("hard.py", "POWER = 2", "# a comment, which moves the lines below\nPOWER = 2\nUNUSED = 5")
    toy.edit("hard.py", "Not linear", "By a power")
    assert toy.run() == {"Soft": [6.0, 1], "Hard": [24.0, 1]}


def test_an_edited_law_is_compiled_anew_and_the_other_is_not(toy):
    toy.edit("hard.py", "return law.stiffness *", "return 2 * law.stiffness *")
    assert toy.run() == {"Soft": [6.0, 1], "Hard": [48.0, 0]}
    assert toy.run() == {"Soft": [6.0, 1], "Hard": [48.0, 1]}
    toy.edit("hard.py", "POWER = 2", "POWER = 3")  # a constant of the law's file
    assert toy.run() == {"Soft": [6.0, 1], "Hard": [192.0, 0]}
    toy.edit("hard.py", "POWER = 3", "POWER = 2")  # what was once compiled is still there
    assert toy.run() == {"Soft": [6.0, 1], "Hard": [48.0, 1]}


def test_an_edited_function_in_another_file_gives_the_new_result_under_every_law(toy):
    toy.edit("helpers.py", "0.5 * x", "0.25 * x")
    assert toy.run() == {"Soft": [3.0, 0], "Hard": [12.0, 0]}
    toy.edit("helpers.py", "0.25 * x", "0.25 * x + SHIFT")
    assert toy.run() == {"Soft": [3.0, 0], "Hard": [12.0, 0]}
    toy.edit("helpers.py", "SHIFT = 0.0", "SHIFT = 1.0")
    assert toy.run() == {"Soft": [4.0, 0], "Hard": [13.0, 0]}


def test_a_law_with_another_field_is_compiled_anew(toy):
    toy.edit(
        "laws.py",
        "Hard(NamedTuple):\n    stiffness: float",
        "Hard(NamedTuple):\n    stiffness: float\n    power: int = 3",
    )
    toy.edit("hard.py", "POWER\n", "law.power\n")
    assert toy.run() == {"Soft": [6.0, 1], "Hard": [96.0, 0]}


def test_a_users_own_kernel_outside_the_packages_is_compiled_anew_when_it_is_edited(toy):
    mine = toy.folder / "mine.py"
    text = "from porescale.common.compiled.jit import kernel\nfrom toy.helpers import half\n"
    text += "@kernel\ndef quarter(x):\n    return half(half(x))\n"
    ask = "import json, sys; sys.path.insert(0, sys.argv[1]); from mine import quarter; "
    ask += "value = quarter(8.0); print(json.dumps({'it': [value, sum(quarter.stats.cache_hits.values())]}))"
    mine.write_text(text)
    assert toy.run(ask) == {"it": [2.0, 0]}
    assert toy.run(ask) == {"it": [2.0, 1]}
    mine.write_text(text.replace("half(half(x))", "half(half(half(x)))"))
    assert toy.run(ask) == {"it": [1.0, 0]}
    toy.edit("helpers.py", "0.5 * x", "x")  # a file that it stands on
    assert toy.run(ask) == {"it": [8.0, 0]}


def test_a_broken_cache_folder_is_made_again(toy):
    shutil.rmtree(toy.kernels)
    assert toy.run() == {"Soft": [6.0, 0], "Hard": [24.0, 0]}


def key(function: Kernel, *given: object) -> str:
    """Key of a kernel among the same surroundings."""
    return key_of(function.py_func, function.options, given, "here", {"prange": (range,)})


def made(factor: float) -> Kernel:
    """A kernel made within a function."""

    @kernel
    def times(x):
        """Multiplied."""
        return factor * x

    return times


def test_a_kernel_made_within_a_function_has_the_key_of_what_it_was_made_from():
    assert key(made(2.0)) == key(made(2.0))
    assert len({key(made(2.0)), key(made(3.0)), key(made(2)), key(made(True))}) == 4  # values and their types


def test_numbers_by_precision_and_widths_of_rows_count():
    def user(chosen):
        """A kernel that calls what it is given."""

        @kernel
        def calls(x):
            return chosen(x, 0)

        return calls

    assert key(user(row_gatherer(4))) == key(user(row_gatherer(4))) != key(user(row_gatherer(8)))
    third, again, half = (precision_constants(lambda real, n=n: (real(1 / n),)) for n in (3, 3, 2))
    assert key(user(third)) == key(user(again)) != key(user(half))


def test_a_body_counts_under_its_law_only_and_bodies_may_call_for_other_laws():
    def force(x, law):
        """Force."""

    def users(second):
        """A sweep whose stretch depends on ``second`` by way of a twist that its body makes."""
        outer, inner = law_function(force), law_function(force)

        @inner.of(Twist)
        def twisted(x, law):
            return second * x

        @outer.of(Stretch)
        def stretched(x, law):
            return inner(x, Twist(x))

        @outer.of(Twist)
        def straight(x, law):
            return x

        @kernel
        def sweep(x, law):
            return outer(x, law)

        return sweep

    one, other = users(1.0), users(2.0)
    assert key(one, Stretch) != key(other, Stretch)
    assert key(one) == key(other)
    assert len({key(one), key(one, Stretch), key(one, Twist)}) == 3


def test_what_cannot_be_followed_has_no_key():
    class Hidden(NamedTuple):
        """A law that no other process finds."""

        stiffness: float

    @inline
    def plain(x):
        return x

    with pytest.raises(Unknown, match="Hidden"):
        key(plain, Hidden)
    assert key(plain, Stretch)  # the twin

    def unfollowed(x):
        """Not a kernel: numba may hold any overload for it."""
        return x

    @kernel
    def calls(x):
        return unfollowed(x)

    with pytest.raises(Unknown, match="unfollowed"):
        key(calls)
