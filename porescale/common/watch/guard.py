"""Who may ask a server on this machine for what: the host that is named, the token in the link, the parts of a path."""

from __future__ import annotations

import hmac
import re
from urllib.parse import unquote_to_bytes

HOST = "127.0.0.1"
"""The only address that is listened at."""
NAMES = (HOST, "localhost")
"""Hosts that a request may name.  A page elsewhere whose name was made to point here (DNS rebinding) names its own;
any port, since tunnels (`ssh -L`) forward others."""
METHODS = ("GET", "HEAD")
LONGEST = 4096
"""Characters of a path."""


def of_this_machine(host: str | None) -> bool:
    """Whether the Host header of a request names this machine."""
    found = re.fullmatch(r"([a-z0-9.-]+)(:[0-9]{1,5})?", (host or "").strip().lower())
    return found is not None and found[1] in NAMES


def parts_of(target: str) -> list[str] | None:
    """The parts of a request's path, decoded once each; None where it cannot be one of ours.

    A part may hold anything but control characters: it is compared with names that are known, never joined to a path.
    """
    path = target.partition("?")[0]
    if len(target) > LONGEST or not path.startswith("/"):  # "http://other/…", as proxies are asked
        return None
    try:
        parts = [unquote_to_bytes(part).decode() for part in path[1:].split("/")]
    except UnicodeDecodeError:
        return None
    return None if any(re.search(r"[\x00-\x1f\x7f]", part) for part in parts) else parts


def same(token: str, given: str) -> bool:
    """Whether the token is the one given, in a time that does not tell how much of it is."""
    return hmac.compare_digest(token.encode(), given.encode())
