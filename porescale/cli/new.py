"""``porescale new``: a commented scene to start from."""

from importlib.resources import files


def template() -> str:
    """The text of the scene that ``new`` writes, with the names that the registers offer."""
    from porescale.coupling.solid.choose import SOLID_OPERATORS
    from porescale.coupling.weighting.choose import WEIGHTINGS
    from porescale.dem.contact.choose import LAWS
    from porescale.lbm.boundary.choose import boundaries
    from porescale.lbm.collision.choose import OPERATORS

    text = files("porescale.cli").joinpath("template.toml").read_text(encoding="utf-8")
    for place, names in (("sides", boundaries()), ("operators", OPERATORS), ("solid_operators", SOLID_OPERATORS),
                         ("weightings", WEIGHTINGS), ("contact_laws", LAWS)):  # fmt: skip
        text = text.replace(f"{{{place}}}", " | ".join(names))
    return text
