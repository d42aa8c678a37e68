"""``python -m tests.manual [--out DIR]``: build the manual, warnings as errors, and check its links.

Needs ``pip install -e '.[docs]'``.  Open DIR/index.html (build/manual) with any browser, without a network.
"""

import argparse
import sys
from pathlib import Path

from tests.manual.build import SITE, build, faults


def main() -> int:
    """Exit code 1 where Sphinx warns, a link is dead, or a page loads something from the network."""
    parser = argparse.ArgumentParser(prog="python -m tests.manual", description=__doc__)
    parser.add_argument("--out", type=Path, default=SITE, help="folder for the site")
    parser.add_argument("--verbose", action="store_true", help="all that Sphinx says")
    options = parser.parse_args()
    code, said, seconds = build(options.out, quiet=not options.verbose)
    found = faults(options.out) if code == 0 else []
    print("\n".join([said.strip(), *found]).strip())
    print(f"manual: {seconds:.0f} s, {options.out / 'index.html'}")
    return 1 if code or found else 0


if __name__ == "__main__":
    sys.exit(main())
