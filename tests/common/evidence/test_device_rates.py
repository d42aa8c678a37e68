"""`bench --device gpu` in numba's simulator: rates of nothing, but all that leads to them."""

import json

import numpy as np
import pytest

from continuum_sph import cli as continuum
from porescale.benchmarks import lbm
from porescale.benchmarks.psm import bench_psm
from porescale.cli.main import PACKAGE
from porescale.common.cli import bench
from porescale.common.compiled import cuda
from porescale.common.core.errors import InputError
from porescale.common.evidence.benchmarks import PLAIN, Benchmarks
from porescale.common.evidence.device_bandwidth import DeviceCopy


def test_the_copy_goes_over_all_of_the_memory_in_place():
    copy = DeviceCopy(9 * 5 * 8)
    assert copy.bytes == 2 * 9 * 5 * 8
    copy._flip(copy.nine)
    assert (copy.nine.copy_to_host() == np.full((9, 5), 0.75)).all()
    copy.seconds()
    assert (copy.nine.copy_to_host() == 0.75).all()  # once in each form


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_the_rate_of_the_fluid_names_the_device(dtype, monkeypatch, capsys):
    monkeypatch.setattr(lbm, "SMALLEST", 3)
    assert bench.command(PACKAGE)("lbm", size=3, dtype=dtype, threads=1, device="gpu", json=True) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert row["device"] == cuda.describe()[0]
    assert (row["name"], row["size"], row["dtype"], row["bytes"]) == ("lbm", 3, dtype, lbm.bytes_of(dtype))
    assert 0 < row["share_of_bandwidth"] <= 1


def test_the_fluid_with_discs_is_timed_beside_the_fluid_alone(monkeypatch):
    monkeypatch.setattr(lbm, "SMALLEST", 3)
    works = bench_psm(6, 1, "float32", device="gpu")
    assert [work.variant for work in works] == ["", PLAIN]
    for work in works:
        work.call()
        assert (work.gpu, work.updates) == (True, lbm.steps_on("gpu", 6**2) * 6**2)
    assert not any(work.gpu for work in bench_psm(6, 1, "float32"))


def test_on_the_cpu_a_row_says_so(monkeypatch, capsys):
    """The check that must fail: the same command without the option."""
    monkeypatch.setattr(lbm, "SMALLEST", 3)
    monkeypatch.setattr(lbm, "MOST_STEPS", 2)
    assert bench.command(PACKAGE)("lbm", size=3, threads=1, json=True) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert row["device"] == "cpu"


@pytest.mark.parametrize(
    ("names", "package", "message"),
    [(("dem", "lbm"), PACKAGE, "does not run dem"), ((), continuum.PACKAGE, "has no benchmark")],
)
def test_what_does_not_run_on_a_gpu_is_one_line(names, package, message):
    with pytest.raises(InputError, match=message) as refused:
        bench.command(package)(*names, device="gpu")
    assert len(str(refused.value).splitlines()) == 1
    assert refused.value.code == 2


def test_without_a_gpu_it_is_one_line(monkeypatch):
    monkeypatch.setattr(cuda, "simulated", lambda: False)
    monkeypatch.setattr(cuda, "cuda", lambda: type("Machine", (), {"is_available": staticmethod(lambda: False)}))
    with pytest.raises(InputError, match="there is no GPU here") as refused:
        bench.command(PACKAGE)("lbm", device="gpu")
    assert len(str(refused.value).splitlines()) == 1


def test_only_what_runs_there_runs_without_names(monkeypatch):
    made = Benchmarks()
    made.row("here")(lambda *_: pytest.fail("was run"))
    made.row("there", gpu=True)(lambda *_, device: pytest.fail(device))
    with pytest.raises(pytest.fail.Exception, match="gpu"):
        list(made.run(threads=1, device="gpu"))
