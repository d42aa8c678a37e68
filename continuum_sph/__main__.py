"""``python -m continuum_sph``."""

import sys

from continuum_sph.app import main

sys.exit(main())
