"""Runs of the toy model that are watched while they are written, and the server of them in this process.

As a script it is the command line of a program whose runs they are:  python -m tests.reference.watched watch FOLDER
"""

import http.client
import json
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from porescale.common.cli.application import application, main
from porescale.common.record.drive import Outcome
from porescale.common.watch.server import Server
from porescale.common.watch.site import Site
from tests.reference.toy_model import run_toy
from tests.reference.toy_package import TOY

PROGRAM = replace(TOY, name="toy")


def toy_run(folder: Path, duration: float = 0.03, **options: Any) -> Outcome:
    """A run of the toy with a snapshot every 0.01 s and a row every 1 ms."""
    card = {"scene": {"title": "A toy", "time": {"end": duration}}, "package": "toy", "name": folder.name}
    card |= {"settings": options.pop("settings", [])}
    return run_toy(folder, duration=duration, snapshot_interval=0.01, series_interval=1e-3, card=card, **options)


@contextmanager
def served(folder: Path) -> Iterator[Server]:
    """A server of the folder's page, in a thread."""
    with Server(Site(folder, PROGRAM)) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()


def asked(
    server: Server, path: str, method: str = "GET", host: str | None = None, **headers: str
) -> tuple[int, bytes, dict[str, str]]:
    """Status, body and headers of an answer; ``path`` is sent as it is, below the token where it has no leading /."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=60)
    connection.putrequest(method, path if path.startswith(("/", "http")) else f"/{server.token}/{path}", skip_host=True)
    if host != "":
        connection.putheader("Host", host or f"127.0.0.1:{server.server_port}")
    for name, value in headers.items():
        connection.putheader(name, value)
    connection.endheaders()
    answer = connection.getresponse()
    found = answer.status, answer.read(), dict(answer.getheaders())
    connection.close()
    return found


def told(server: Server, path: str) -> Any:
    """The JSON at a path below the token."""
    status, body, _ = asked(server, path)
    assert status == 200, (path, body)
    return json.loads(body)


if __name__ == "__main__":
    sys.exit(main(application(PROGRAM)))
