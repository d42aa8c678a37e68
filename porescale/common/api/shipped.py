"""The cases that come with the packages, by name."""

from pathlib import Path

from porescale.common.schema.scene_file import SCENE_FILE

CASES = Path(__file__).resolve().parents[3] / "cases"
"""Their folder, beside the packages."""


def find_case(name: str) -> Path | None:
    """Folder of the shipped case ``name`` that has a scene file; None if there is none of that name."""
    return CASES / name if name in case_names() else None


def case_names() -> list[str]:
    """Names of the shipped cases that have a scene file, sorted."""
    return sorted(file.parent.name for file in CASES.glob(f"*/{SCENE_FILE}"))
