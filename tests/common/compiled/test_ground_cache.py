"""The cache's folder, the hash of sources, and what is thrown away."""

import os
import shutil
import sys
import time
import warnings
from pathlib import Path

import pytest

from porescale.common.compiled import jit
from porescale.common.compiled.cache import DAY, ROOM, cache_root, hash_of, keep_only_used, writable
from porescale.common.core.errors import PorescaleWarning
from tests.reference.folders import ROOT
from tests.reference.waiting import done


def aged(path: Path, days: float) -> Path:
    """``path``, last used so many days ago."""
    os.utime(path, (time.time() - days * DAY,) * 2)
    return path


def said(command: str, home: Path, kernels: object = "") -> tuple[str, str]:
    """What a new Python process prints whose caches are below ``home``, its kernels in ``kernels``, if named; and what
    it warns of."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(home), "NUMBA_CACHE_DIR": str(kernels)}
    ended = done([sys.executable, "-c", command], env=environment, cwd=ROOT)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout, ended.stderr


def printed(command: str, home: Path, kernels: object = "") -> str:
    """The first of these."""
    return said(command, home, kernels)[0]


def test_the_cache_lies_where_the_desktop_standard_says_and_an_empty_variable_counts_as_unset(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache_root() == tmp_path / "porescale"
    monkeypatch.setenv("XDG_CACHE_HOME", "")
    monkeypatch.setenv("HOME", str(tmp_path / "me"))
    assert cache_root() == tmp_path / "me" / ".cache" / "porescale"
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert cache_root() == tmp_path / "me" / ".cache" / "porescale"


def test_the_hash_is_that_of_names_and_contents_wherever_they_lie(tmp_path):
    one = tmp_path / "one" / "package"
    (one / "room").mkdir(parents=True)
    (one / "a.py").write_text("1")
    (one / "room" / "b.py").write_text("2")
    before = hash_of([one])
    assert len(before) == 12
    shutil.copytree(one, tmp_path / "two" / "package")
    assert hash_of([tmp_path / "two" / "package"]) == before
    (one / "notes.txt").write_text("no source")
    assert hash_of([one]) == before
    (one / "a.py").write_text("12")
    assert hash_of([one]) != before  # the twins: content, name, and where one file ends
    (one / "a.py").write_text("1")
    assert hash_of([one]) == before
    (one / "a.py").rename(one / "c.py")
    assert hash_of([one]) != before


def test_kernel_folders_unused_for_a_month_go_but_never_the_current_one(tmp_path):
    now = time.time()
    for name, days in {"kernels-old": 31, "kernels-young": 29, "kernels-current": 400, "packings": 400}.items():
        (tmp_path / name).mkdir()
        (tmp_path / name / "content").write_text("x")
        aged(tmp_path / name, days)
    current = tmp_path / "kernels-current"
    keep_only_used(current, "kernels-*")
    assert {path.name for path in tmp_path.iterdir()} == {"kernels-young", "kernels-current", "packings"}
    assert current.stat().st_mtime >= now - DAY  # it counts as used now
    keep_only_used(tmp_path / "nowhere" / "kernels-new", "kernels-*")  # nothing there: nothing to do


def test_kernels_unused_for_a_month_go_when_another_is_kept_but_not_from_a_folder_of_the_users_own(tmp_path):
    command = "from porescale.common.neighbors.cells import minimum_image as k; k(0.9, 1.0)"
    own, named = tmp_path / "porescale" / jit.cache_folder_name(), tmp_path / "named"
    now = time.time()
    for folder, given in ((own, ""), (named, str(named))):
        folder.mkdir(parents=True)
        for name, days in {"old.nbc": 31, "young.nbc": 29, "torn.nbc.tmp.1": 31, "other.txt": 400}.items():
            (folder / name).write_text("x")
            aged(folder / name, days)
        printed(command, tmp_path, given)
    (kernel,) = (path for path in own.iterdir() if "minimum_image" in path.name)
    assert {path.name for path in own.iterdir()} == {"young.nbc", "other.txt", kernel.name}
    assert len(list(named.iterdir())) == 5  # the twin
    aged(kernel, 400)
    printed(command, tmp_path)
    assert kernel.stat().st_mtime >= now - DAY  # read: it counts as used


def test_kernels_are_kept_below_the_cache_unless_a_folder_is_named(tmp_path):
    command = "from porescale.common.compiled import jit; print(jit.compiler().numba.config.CACHE_DIR)"
    old = tmp_path / "porescale" / "kernels-old"
    old.mkdir(parents=True)
    aged(old, 400)
    assert Path(printed(command, tmp_path, tmp_path / "named").strip()) == tmp_path / "named"
    assert old.exists()  # the twin: who names a folder of their own looks after it
    folder = Path(printed(command, tmp_path).strip())
    assert folder.parent == tmp_path / "porescale"
    assert folder.name.startswith("kernels-")
    assert not old.exists()


def test_kernels_work_where_no_cache_can_be_written(tmp_path):
    (tmp_path / "file").write_text("in the way")
    command = "from porescale.common.neighbors.cells import minimum_image as k; "
    command += "print(k(0.9, 1.0), type(k._cache).__name__)"
    for place, cache in (("file", "NullCache"), ("folder", "KernelCache")):  # the second is the twin
        text, warned = said(command, tmp_path / place)
        value, kind = text.split()
        assert abs(float(value) + 0.1) < 1e-15  # one rounding of 0.9 - 1
        assert kind == cache
        assert warned.count("compiled kernels cannot be kept there (Not a directory)") == (place == "file")
    assert (tmp_path / "file").read_text() == "in the way"


def test_why_kernels_are_not_kept_is_said(tmp_path, monkeypatch):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert writable(tmp_path / "made")  # the twin: nothing is said
    with pytest.warns(PorescaleWarning, match="the user has no home folder.*NUMBA_CACHE_DIR"):
        assert not writable(Path(os.devnull) / "porescale" / "kernels")
    with monkeypatch.context() as patch:
        patch.setattr(os, "access", lambda *_: False)  # as for a folder that others may write
        with pytest.warns(PorescaleWarning, match="Permission denied"):
            assert not writable(tmp_path / "made")
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: usage._replace(free=ROOM - 1))
    with pytest.warns(PorescaleWarning, match="less than 32 MiB are free"):
        assert not writable(tmp_path / "made")


def test_without_a_home_there_is_no_place_for_a_cache(monkeypatch):
    def unknown():
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(Path, "home", unknown)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    assert Path(os.devnull) in cache_root().parents
