"""Where things lie in a checkout."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CASES, DOCS, SAMPLES = ROOT / "cases", ROOT / "docs", ROOT / "tests" / "samples"
