"""``python -m porescale``."""

import sys

from porescale.cli.main import main

sys.exit(main())
