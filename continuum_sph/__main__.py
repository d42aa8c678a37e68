"""Entry point of the command ``python -m continuum_sph``."""

import sys

from continuum_sph.cli import main

sys.exit(main())
