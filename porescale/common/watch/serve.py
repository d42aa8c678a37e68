"""`watch`: serve the page of a folder until Ctrl-C."""

from __future__ import annotations

import os
import signal
import sys
import threading
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING

from porescale.common.core.errors import Fault, InputError
from porescale.common.record.stop import interrupted_by
from porescale.common.watch.server import Server
from porescale.common.watch.site import Site, kind_of

if TYPE_CHECKING:
    from porescale.common.api.program import Program

READING = 5.0
"""Seconds that the end waits for an answer that is being read: HDF5 must not be left in the middle."""


def watch(folder: Path, program: Program, *, port: int = 0, wait: bool = False, show: bool = True) -> None:
    """Serve the page of a run or sweep and print its link, until Ctrl-C or SIGTERM.

    wait : for a folder that is not there yet;  show : open the page in a browser, where there is a screen.  InputError
    for a folder that holds something else, and for a port that cannot be used.
    """
    if not folder.exists() and not wait:
        raise InputError(Fault("folder", str(folder), "is not there", repair="begin the run first, or add --wait"))
    kind_of(folder)
    with Server(Site(folder, program), port) as server:
        try:
            with interrupted_by(signal.SIGINT, signal.SIGTERM):
                print(f"watch {folder} at {server.link} (Ctrl-C ends it)", flush=True)
                if show and _has_screen():
                    threading.Thread(target=webbrowser.open, args=(server.link,), daemon=True).start()
                server.serve_forever()
        except KeyboardInterrupt:
            server.reading.acquire(timeout=READING)
    print("no longer watched; the run itself was not touched")


def _has_screen() -> bool:
    """Whether a browser would have a window here, not the text of this terminal."""
    return sys.platform in ("darwin", "win32") or any(os.environ.get(it) for it in ("DISPLAY", "WAYLAND_DISPLAY"))
