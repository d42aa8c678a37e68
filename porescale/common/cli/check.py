"""`check SCENE`: what a scene means, before any of it runs, and what it looks like."""

import json as json_text
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter

from porescale.common.api.folders import require_file
from porescale.common.cli.options import Json, Quality, Scene, Settings, require_scene
from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError

Drawing = Annotated[
    list[Path] | None,
    Parameter(
        help="draw the built initial state into this PNG file, scene.png if none is named", consume_multiple=(0, 1)
    ),
]


def command(package: Package) -> Callable[..., int]:
    """The `check` command of a package."""

    def check(
        scene: Scene,
        /,
        *,
        quality: Quality = None,
        settings: Settings = None,
        json: Json = False,
        picture: Drawing = None,
    ) -> int:
        """Say what a scene means (resolution, stability, cost) without running it; warn or refuse."""
        from porescale.common.record.progress import Watch
        from porescale.common.schema.sections import load

        file = None if picture is None else drawing(*picture)
        read = load(require_scene(scene, package.name), package.scene(), quality=quality, overrides=settings or ())
        with Watch(read.name, 0.0, 0.0):  # a packing may have to be made to know what stands in it
            report = package.report_of(read)
        if json:
            print(json_text.dumps(report.as_dict(), indent=1))
        else:
            report.show()
        if file is not None:
            draw(read, file, aside=json)
        return 0

    return check


def drawing(file: Path = Path("scene.png")) -> Path:
    """The file of a picture; InputError unless it is a PNG file that can be written."""
    if file.suffix.lower() != ".png":
        raise InputError(Fault("--picture", str(file), "is no PNG file", repair=f"name it {file.stem or 'scene'}.png"))
    require_file(file, "--picture")
    return file


def draw(scene: Any, file: Path, *, aside: bool = False) -> None:
    """Write the picture of a scene and name it, on stderr where it must not be among what is printed (``aside``)."""
    scene.picture().save(file)
    print(file, file=sys.stderr if aside else sys.stdout)
