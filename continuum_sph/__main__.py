"""The program ``continuum-sph``, also ``python -m continuum_sph``."""

import sys

from porescale.common.cli.entry import command


def main() -> int:
    """Run ``continuum-sph`` with the arguments of the process; returns the exit code."""
    return command("continuum_sph.cli")


if __name__ == "__main__":
    sys.exit(main())
