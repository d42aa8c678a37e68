"""`study levels SCENE`: which points of its front the quality levels of a scene are to be, and whether they are."""

from collections.abc import Callable

from porescale.common.cli.options import Scene
from porescale.common.cli.package import Package


def command(package: Package) -> Callable[..., int]:
    """The `study levels` command of a package."""

    def levels(scene: Scene, /) -> int:
        """Pick draft, standard and fine from the scene's front, and fail where its levels are something else.

        Draft is the cheapest point whose error is allowed, standard the most accurate, fine the reference.
        """
        from porescale.common.schema.scene_file import find
        from porescale.common.studies.levels import APART, apart, compared

        rows = compared(package, find(scene))
        print("\n".join(row.line() for row in rows))
        near = apart(rows) < APART
        print(f"fine costs {apart(rows):.3g} times a draft" + (f", less than {APART:g} times" if near else ""))
        return 1 if near or any(row.wrong for row in rows) else 0

    return levels
