"""A second process that compiles nothing: it writes its number to the file that it is given, and waits to be ended."""

import os
import time
from pathlib import Path

from porescale.common.compiled.ahead import serve
from porescale.common.core.atomic import write_text


def wait_to_be_ended(file: str) -> None:
    """Write the number, then wait; not for ever."""
    write_text(Path(file), str(os.getpid()))
    time.sleep(600)


if __name__ == "__main__":
    serve(wait_to_be_ended)
