"""What tells a hook from another one: its text, and all that it uses as far as that can be seen."""

import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from porescale.common.api.hook_source import hash_of, source_of

BODY = "def hook(time):\n    return K * np.sin(time) + twice(time)\n\n\ndef twice(x):\n    return 2 * x\n"


def made(text=BODY, **names):
    """The function ``hook`` of a module, whose source cannot be read."""
    module = {"np": np, "__name__": "toy", "K": 1.0, **names}
    exec(text, module)
    return module["hook"]


def test_what_is_the_same_has_the_same_hash():
    assert hash_of(made()) == hash_of(made())
    assert source_of(made()) == ""
    assert hash_of(made(K=SimpleNamespace(a=1))) == hash_of(made(K=SimpleNamespace(a=2)))  # objects are not looked into


@pytest.mark.parametrize(
    "other",
    [
        made(BODY.replace("sin", "cos")), made(BODY.replace("2 * x", "3 * x")), made(BODY.replace("+", "-")),
        made(BODY.replace("(time):", "(time, more=1):")), made(K=2.0), made(K=np.float32(1.0)), made(K=None),
        made(K={"a": 1}), made(K={"a": 2}), made(K=[1.0]), made(K=np.arange(3)), made(K=np.arange(3.0)),
    ],
)  # fmt: skip
def test_what_is_another_has_another_hash(other):
    assert hash_of(other) != hash_of(made())


def test_closures_count_and_decorators_do_not():
    def hook_of(strength):
        @staticmethod
        def hook(time):
            return strength * time

        return hook.__func__

    assert hash_of(hook_of(1.0)) == hash_of(hook_of(1.0))
    assert hash_of(hook_of(1.0)) != hash_of(hook_of(2.0))
    assert source_of(hook_of(1.0)) == "def hook(time):\n    return strength * time\n"


def test_what_has_no_value_yet_when_a_hook_is_decorated_does_not_count():
    def hook_of(strength):
        hashes = []

        def kept(function):
            hashes.append(hash_of(function))
            return function

        @kept
        def hook(time):
            return strength * scale * time + hook.more  # of which scale and hook have no value yet

        scale = 2.0
        assert hash_of(hook) != hashes[0]
        return hashes[0]

    assert hook_of(1.0) == hook_of(1.0)
    assert hook_of(1.0) != hook_of(2.0)


def test_functions_that_call_each_other_come_to_an_end():
    text = "def hook(n):\n    return other(n)\n\n\ndef other(n):\n    return hook(n - 1)\n"
    assert hash_of(made(text)) == hash_of(made(text))


def test_the_order_of_sets_does_not_count():
    code = "from tests.common.api.test_hook_source import *; print(hash_of(made(K={'a', 'b', 'c', 'd'})))"
    found = {
        subprocess.run([sys.executable, "-c", code], env={"PYTHONHASHSEED": seed, "PYTHONPATH": ":".join(sys.path)},
                       capture_output=True, text=True, timeout=120, check=True).stdout
        for seed in ("1", "2", "3")
    }  # fmt: skip
    assert len(found) == 1
