"""``python -m porescale``."""

import sys

from porescale.app.main import main

sys.exit(main())
