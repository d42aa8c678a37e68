"""`check SCENE`: what a scene means, before any of it runs."""

import json as json_text
from collections.abc import Callable

from porescale.common.cli.options import Json, Quality, Scene, Settings, require_scene
from porescale.common.cli.package import Package


def command(package: Package) -> Callable[..., int]:
    """The `check` command of a package."""

    def check(scene: Scene, /, *, quality: Quality = None, settings: Settings = None, json: Json = False) -> int:
        """Say what a scene means (resolution, stability, cost) without running it; warn or refuse."""
        from porescale.common.schema.sections import open_scene

        opened = open_scene(
            require_scene(scene, package.name), package.scene(), quality=quality, overrides=settings or ()
        )
        report = package.report(opened.scene)
        if json:
            print(json_text.dumps(report.as_dict(), indent=1))
        else:
            report.show()
        return 0

    return check
