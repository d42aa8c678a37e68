"""`schema`: what scene files may say, for editors."""

import json
from collections.abc import Callable

from porescale.common.cli.package import Package


def command(package: Package) -> Callable[..., int]:
    """The `schema` command of a package."""

    def schema() -> int:
        """Print the JSON Schema of scene files: with it an editor completes keys, and shows units and ranges."""
        print(json.dumps(package.scene().json_schema(), indent=1, ensure_ascii=False))
        return 0

    return schema
