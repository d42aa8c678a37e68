"""What is of no use to a measurement is refused in a line with what is allowed, whatever its type is."""

import numpy as np
import pytest

from porescale import piv
from porescale.common.core.errors import InputError
from porescale.piv import Camera, Settings, estimate
from porescale.piv.images import flows

MADE = piv.pair(flows.uniform(2.0, 1.0), Camera(size=(64, 64)), 1)
A, B = MADE.first, MADE.second
SOLID = np.zeros((64, 64), bool)
HALF = A.astype(float)
HALF[3, 4] = np.nan


def refused(wrong) -> str:
    """The line in which ``wrong`` is refused."""
    with pytest.raises(InputError) as caught:
        wrong()
    (line,) = str(caught.value).splitlines()
    return line


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"mask": SOLID.tolist()}, "mask: is neither a path nor an array but list (allowed: a path, or an array"),
        ({"mask": np.array([SOLID] * 3)}, "mask = '3 x 64 x 64 of bool': is no bitmap"),
        ({"mask": np.where(SOLID, 1, np.nan)}, "mask = '64 x 64 of float64': is no bitmap"),
        ({"reject": SOLID.tolist()}, "reject: is neither a path nor an array but list"),
        ({"reject": np.array([SOLID] * 3)}, "reject = '3 x 64 x 64 of bool': is no bitmap"),
        ({"window": "16"}, "window = '16': is no number (allowed: whole, >= 4 and <= 64 px)"),
        ({"window": 16.0}, "window = 16.0 px: is no whole number"),
        ({"window": 18.5}, "window = 18.5 px: is no whole number"),
        ({"window": 66}, "window = 66 px: is not a window of these pictures (allowed: even, 4 to 64 px)"),
        ({"search": 4.5}, "search = 4.5 px: is no whole number (allowed: whole, >= 1 and <= 256 px)"),
        ({"search": True}, "search = 'True': is no number"),
        ({"overlap": "half"}, "overlap = 'half': is no number (allowed: >= 0 and < 1)"),
        ({"overlap": float("nan")}, "overlap = nan: is not finite (allowed: >= 0 and < 1)"),
        ({"start": 1.5}, "start = 1.5: is no whole number (allowed: whole, >= 0)"),
        ({"end": 3.0}, "end = 3.0: is no whole number"),
        ({"step": "2"}, "step = '2': is no number"),
        ({"region": (0.0, 0.0, 40.0, 40.0)}, "region = '0.0,0.0,40.0,40.0': is no region (allowed: left, top, right"),
        ({"region": (0, 0, 40)}, "region = '0,0,40': is no region"),
        ({"region": "0,0,40,40"}, "region = '0,0,40,40': is no region"),
        ({"region": 40}, "region = '40': is no region"),
        ({"region": (50, 0, 20, 40)}, "region = '50,0,20,40': is empty (allowed: left below right, and top below"),
        ({"polygon": [(1, 2), (30, 2), (30, 40)]}, 'is no list of texts but list (allowed: ["x,y x,y x,y …", …]'),
        ({"polygon": np.eye(3)}, "is no list of texts but ndarray"),
        ({"polygon": "1,2 30,2 30,40"}, "polygon = '1,2 30,2 30,40': is no list of texts but str"),
        ({"out": 3}, "out = '3': is no path but int"),
        ({"overlay": True}, "overlay: has no folder to be written to; give out"),
    ],
)
def test_arguments_of_a_wrong_type_are_refused_in_a_line(wrong, said):
    line = refused(lambda: piv.measure(A, B, **wrong))
    assert said in line
    assert "--" not in line


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda: piv.measure(A, B * 1e30), "+32 (allowed: -1e+07 to 1e+07); divide"),
        (lambda: piv.measure(3), "film = '3': is no film but int"),
        (lambda: piv.measure(A[:2], B[:2]), "pictures = '64 x 2': are too small (allowed: 4 a side and more px)"),
        (
            lambda: estimate.measure(HALF, B),
            "pictures = 'first: 64 x 64 of float64': is no grey picture (allowed",
        ),
        (lambda: estimate.measure(A, B[None]), "pictures = 'second: 1 x 64 x 64 of uint8': is no grey picture"),
        (lambda: estimate.measure(A.tolist(), B), "pictures = 'first: list': is no array"),
        (lambda: estimate.measure(A, B, SOLID.astype(int)), "is no array of flags (allowed: (rows, columns), True in"),
        (lambda: estimate.measure(A, B, settings=Settings(updates=1.5)), "updates = 1.5: is no whole number"),
        (lambda: piv.compare("a", "b"), "reference = 'a': is no field but str; give fields of piv.measure"),
        (lambda: piv.compare(piv.measure(A, B), piv.measure(A, B), factor=1), "factor = 1: is out of range (allowed"),
        (lambda: piv.pair(flows.uniform(1.0, 0.0), seed=-1), "seed = -1: is out of range (allowed: whole, >= 0)"),
        (lambda: piv.pair(flows.uniform(1.0, 0.0), Camera(noise="3")), "noise = '3': is no number"),
        (lambda: piv.pair(flows.uniform(1.0, 0.0), Camera(size=(64.0, 64))), "size = 64.0 px: is no whole number"),
    ],
)
def test_pictures_fields_and_cameras_of_no_use_are_refused_in_a_line(wrong, said):
    assert said in refused(wrong)


def test_the_brightest_pictures_allowed_are_measured():
    # The check that must fail, were the bound too high for single precision: the same vectors at 1e7 as at 255.
    bright = 1e7 / max(A.max(), B.max())
    one, other = piv.measure(A, B), piv.measure(A * bright, B * bright)
    assert np.abs(one.u - other.u).max() < 1e-3
    assert other.uncertainty[other.valid] == pytest.approx(one.uncertainty[one.valid], rel=0.02)


def test_whole_numbers_of_numpy_and_lists_are_taken():
    field = piv.measure(A, B, window=np.int64(16), region=[8, 8, 56, 56])
    other = piv.measure(A, B, region=np.array([8, 8, 56, 56]))
    assert np.array_equal(field.u, other.u)
