"""The program ``porescale``, also ``python -m porescale``."""

import sys

from porescale.common.cli.entry import command


def main() -> int:
    """Run ``porescale`` with the arguments of the process; returns the exit code."""
    return command("porescale.cli.main")


if __name__ == "__main__":
    sys.exit(main())
