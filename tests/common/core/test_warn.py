"""A warning points at the line that called the package, however deep in it it is given."""

import warnings

from porescale.common.core.errors import PorescaleWarning, warn


def within(module, body):
    """What the ``body`` of a module of that name defines."""
    made = {"__name__": module, "warn": warn}
    exec(compile(body, f"{module}.py", "exec"), made)
    return made


def place_of(call):
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        call()
    (one,) = given
    assert one.category is PorescaleWarning
    return one.filename


def test_a_warning_points_at_the_caller_of_the_package():
    inner = within("porescale.low", "def low(): warn('x')")["low"]
    outer = within("porescale.high", "def high(call): call()")["high"]
    assert place_of(inner) == __file__
    assert place_of(lambda: outer(inner)) == __file__


def test_a_caller_outside_of_the_package_is_the_place_itself():
    inner = within("porescale.low", "def low(): warn('x')")["low"]
    other = within("mine.script", "def run(call): call()")["run"]
    assert place_of(lambda: other(inner)) == "mine.script.py"
