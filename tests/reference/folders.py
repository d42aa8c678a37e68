"""Where things lie in a checkout, scripts of cases as modules, and what a command says besides its results."""

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).resolve().parents[2]
CASES, DOCS, SAMPLES = ROOT / "cases", ROOT / "docs", ROOT / "tests" / "samples"

PROGRESS = re.compile(r"[^:]+: .+, t = \S+ of \S+ s \(")


def complaints_in(said: str) -> list[str]:
    """Lines on stderr that are neither empty nor a warning, nor the progress that slow runs print."""
    lines = (line for line in said.splitlines() if line)
    return [line for line in lines if not line.startswith("warning: ") and not PROGRESS.match(line)]


def allowed(case: str, name: str) -> tuple[float, float]:
    """Value and tolerance of a row of a case's expected.toml."""
    from porescale.output.case import expected  # brings matplotlib, which most tests do without

    (found,) = [it for it in expected(CASES / case) if it["name"] == name]
    return found["value"], found["tolerance"]


def script(case: str, name: str = "") -> ModuleType:
    """A new module of the script of a case, or of its script ``name``."""
    path = CASES / case / f"{name or case}.py"
    spec = importlib.util.spec_from_file_location(f"case_{path.stem}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module
