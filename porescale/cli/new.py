"""``porescale new``: a commented scene to start from."""

from importlib.resources import files


def template() -> str:
    """The text of the scene that ``new`` writes."""
    return files("porescale.cli").joinpath("template.toml").read_text(encoding="utf-8")
