"""A file that is put into a folder of validations is offered without another line."""

import os
import shutil
import subprocess
import sys

import pytest

from tests.reference.folders import ROOT

DROPPED = '''"""A row of one file."""

from porescale.common.evidence.validations import Measured, Validations

VALIDATIONS = Validations()


@VALIDATIONS.row("{name}", source="exact", because="nothing rounds", tolerance=0.0)
def row() -> Measured:
    """One is one."""
    return Measured(1.0, 1.0, 0.0)
'''
CASES = [
    ("porescale", "porescale.cli.main", "lbm/dropped.py", "lbm.dropped_in"),
    ("continuum_sph", "continuum_sph.cli", "water/dropped.py", "continuum.dropped_in"),
]


@pytest.mark.parametrize(("package", "module", "file", "name"), CASES, ids=[it[0] for it in CASES])
def test_a_file_dropped_into_the_folder_is_offered(tmp_path, package, module, file, name):
    for it in ("porescale", "continuum_sph"):
        shutil.copytree(ROOT / it, tmp_path / it, ignore=shutil.ignore_patterns("__pycache__"))
    call = [sys.executable, "-c", f"from {module} import main; raise SystemExit(main())", "verify", "--list"]
    settings = os.environ | {"PYTHONPATH": str(tmp_path)}

    def offered() -> list[str]:
        """Names of rows that the copy offers."""
        done = subprocess.run(call, cwd=tmp_path, env=settings, capture_output=True, text=True, timeout=300, check=True)
        return [line.split()[0].rstrip(":") for line in done.stdout.splitlines() if line.strip()]

    assert name not in offered()  # the check that must fail
    (tmp_path / package / "validation" / file).write_text(DROPPED.format(name=name), encoding="utf-8")
    assert name in offered()
