"""`cases`: the cases that come with the packages, and the command that runs each."""

from collections.abc import Callable

from porescale.common.cli.options import Json, print_json
from porescale.common.cli.package import Package
from porescale.common.core.errors import PorescaleError


def command(package: Package) -> Callable[..., int]:
    """The `cases` command of a package."""

    def cases(*, json: Json = False) -> int:
        """List the cases of both packages: name, what it is about, and the command that runs it, from any folder."""
        from porescale.common.api.shipped import cases as shipped

        found = shipped()
        if not found:
            raise PorescaleError("no cases were installed with the packages")
        if json:
            print_json(case.as_dict() for case in found)
            return 0
        name, title = (max(len(getattr(case, key)) for case in found) for key in ("name", "title"))
        for case in found:
            print(f"{case.name:{name}}  {case.title:{title}}  {case.command}")
        return 0

    return cases
