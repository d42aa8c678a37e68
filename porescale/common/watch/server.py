"""A small server of this machine alone: a token in every link, reading only, nothing but what a site names."""

from __future__ import annotations

import os
import secrets
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from porescale.common.core.errors import Fault, InputError
from porescale.common.watch import guard

HEADERS = {
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Content-Security-Policy": "default-src 'none'; connect-src 'self'; img-src 'self' data: blob:; "
    "style-src 'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'",
}
"""Said with every answer: nothing is kept, nothing of the link goes elsewhere, and the page asks this server alone."""
PATIENCE = 30.0
"""Seconds after which a connection that says nothing is closed."""


@dataclass(frozen=True)
class Answer:
    """What is sent.  status : of HTTP."""

    body: bytes
    kind: str = "text/plain; charset=utf-8"
    status: int = 200


Site = Callable[[Sequence[str]], Answer | None]
"""Gives the answer for the parts of a path after the token; None where there is nothing."""


class Server(ThreadingHTTPServer):
    """Serves a site at 127.0.0.1.  token : that links must hold;  reading : held while an answer is made, one at a
    time, which is what HDF5 does anyway."""

    daemon_threads = True
    block_on_close = False
    allow_reuse_address = os.name == "posix"  # a port just left may be taken again; elsewhere it means a port in use

    def __init__(self, site: Site, port: int = 0) -> None:
        """Listen at ``port``, 0: one that is free.  InputError where that cannot be."""
        self.site, self.token, self.reading = site, secrets.token_urlsafe(16), threading.Lock()
        if not 0 <= port <= 65535:
            raise InputError(Fault("--port", port, "is out of range", "", "0 to 65535"))
        try:
            super().__init__((guard.HOST, port), Handler)
        except OSError as error:
            problem = f"cannot be listened at ({error.strerror or error})"
            repair = "give another, or leave --port out: a free one is taken"
            raise InputError(Fault("--port", port, problem, repair=repair)) from None

    @property
    def link(self) -> str:
        """Where the page is."""
        return f"http://{guard.HOST}:{self.server_port}/{self.token}/"

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Nothing: a browser that leaves while it is answered is no news."""


class Handler(BaseHTTPRequestHandler):
    """Answers one request: 403 for another host or token, 405 for other methods, 404 for what is not there."""

    server: Server
    server_version, sys_version = "porescale", ""
    timeout = PATIENCE

    def do_GET(self) -> None:
        """Answer with head and body."""
        self._say(self._answer())

    do_HEAD = do_GET

    def _answer(self) -> Answer:
        if not guard.of_this_machine(self.headers.get("Host")):
            return Answer(b"this server is asked as 127.0.0.1 or localhost only\n", status=403)
        parts = guard.parts_of(self.path)
        if parts is None:
            return Answer(b"no such path\n", status=404)
        if not guard.same(self.server.token, parts[0]):
            return Answer(b"use the whole link that `watch` printed\n", status=403)
        try:
            with self.server.reading:
                found = self.server.site(parts[1:])
        except InputError as error:
            text = "\n".join(fault.line() for fault in error.faults)
            return Answer(text.encode(), status=409)
        except OSError as error:  # gone while it was read
            return Answer(f"{error.strerror or error}\n".encode(), status=409)
        return found or Answer(b"nothing here\n", status=404)

    def _say(self, answer: Answer) -> None:
        self.send_response(answer.status)
        for name, value in {**HEADERS, "Content-Type": answer.kind, "Content-Length": str(len(answer.body))}.items():
            self.send_header(name, value)
        if answer.status == 405:
            self.send_header("Allow", ", ".join(guard.METHODS))
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(answer.body)

    def send_error(self, code: int, message: str | None = None, explain: str | None = None) -> None:
        """What the base class refuses, in one plain line; a method that it has no function for is not allowed."""
        self.close_connection = True
        status = 405 if code == 501 else code
        self._say(Answer(f"{message or 'refused'}\n".encode(), status=status))

    def log_message(self, format: str, *args: Any) -> None:
        """Nothing: links hold the token."""
