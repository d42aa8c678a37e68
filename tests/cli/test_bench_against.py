"""`bench --against`: work that a program of others does, in turns with ours."""

import sys
from dataclasses import replace

import pytest

from continuum_sph import cli as continuum
from porescale.cli.main import PACKAGE
from porescale.common.cli import bench
from porescale.common.core.errors import InputError
from porescale.common.evidence.benchmarks import Benchmark, Benchmarks, Work


def against(name, *names, package=PACKAGE, **options):
    return bench.command(package)(*names, against=name, **options)


def test_the_peers_are_those_of_the_folder():
    assert [row.name for row in PACKAGE.peers()] == ["lammps", "lbmpy", "openpiv"]


@pytest.mark.parametrize(
    ("library", "peer", "command"),
    [("lbmpy", "lbmpy", "porescale[peers]"), ("openpiv.settings", "openpiv", "porescale[piv]")],
)
def test_a_peer_that_is_not_installed_is_one_line_with_the_command(monkeypatch, library, peer, command):
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(InputError, match=f"{peer}.*is not installed") as raised:
        against(peer, size=64)
    assert len(raised.value.faults) == 1
    assert command in str(raised.value)


@pytest.mark.parametrize(
    ("names", "peer", "package", "message"),
    [
        ((), "lbmp", PACKAGE, "no such benchmark.*lbmpy"),
        (("lbm",), "lbmpy", PACKAGE, "was given with benchmarks"),
        ((), "lbmpy", continuum.PACKAGE, "no other program"),
    ],
)
def test_what_cannot_be_compared_is_one_line(names, peer, package, message):
    with pytest.raises(InputError, match=message) as raised:
        against(peer, *names, package=package)
    assert len(raised.value.faults) == 1


@pytest.mark.slow
def test_both_rates_and_their_ratio_are_printed(monkeypatch, capsys):
    works = [Work(lambda: None, 2.0, "cells/s", 3, variant="ours"),
             Work(lambda: None, 2.0, "cells/s", 3, variant="peer", yardstick=True)]  # fmt: skip
    monkeypatch.setattr("porescale.common.evidence.benchmarks.interleaved", lambda a, b: 1.25)
    package = replace(PACKAGE, peers=lambda: Benchmarks([Benchmark("other", lambda *_: works)]))
    assert against("other", package=package, threads=1) == 0
    printed = capsys.readouterr().out
    assert "other.ours: 1.25 of the rate of other.peer, in turns" in printed
