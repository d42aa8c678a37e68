"""Log lines and warnings of the library, which a command prints and Python can silence and catch."""

import logging
import re
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from porescale.common.core.errors import PorescaleWarning

LOGGERS = ("porescale", "continuum_sph")
"""Above all loggers of the packages: each module has its own, by its name."""

LACKING = re.compile(r"Glyph (\d+) .*missing from font")
"""What matplotlib warns of a character that the font of pictures lacks, by its number; it draws a box in its place."""


class _Lines(logging.Handler):
    """Writes the bare text of a record to stderr, whichever that is now."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print the message of ``record`` as one line, without its level or logger."""
        print(record.getMessage(), file=sys.stderr, flush=True)


@contextmanager
def printed() -> Iterator[None]:
    """Print on stderr, in a line each, what the packages log from INFO on, and every `PorescaleWarning`; at the end, in
    one, the characters that pictures could not show."""
    handler, before = _Lines(logging.INFO), {}
    lacking: dict[str, None] = {}
    with warnings.catch_warnings():
        usual = warnings.showwarning

        def show(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
            """One line of our own warnings; others as ever."""
            if issubclass(category, PorescaleWarning):
                print(f"warning: {message}", file=sys.stderr)
            elif found := LACKING.match(str(message)):
                sign = chr(int(found[1]))
                lacking[sign if sign.isprintable() else f"U+{ord(sign):04X}"] = None
            else:
                usual(message, category, *place, **more)

        warnings.simplefilter("always", PorescaleWarning)
        warnings.showwarning = show
        for logger in map(logging.getLogger, LOGGERS):
            before[logger] = logger.level, logger.propagate
            logger.addHandler(handler)
            logger.setLevel(logging.INFO)
            logger.propagate = False
        try:
            yield
        finally:
            if lacking:
                print(f"warning: pictures show a box for what their font lacks: {' '.join(lacking)}", file=sys.stderr)
            for logger, (level, propagate) in before.items():
                logger.removeHandler(handler)
                logger.setLevel(level)
                logger.propagate = propagate
