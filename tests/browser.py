"""Fixtures that look at pages in headless Chromium, of the system, and run their JavaScript in node.

def test_of_a_page(page, heard, axe, file):
    page.goto(file.as_uri())
    page.keyboard.press("ArrowRight")
    assert heard.requests == [file.as_uri()]      # nothing else was loaded
    assert axe(page) == []

Wait with `playwright.sync_api.expect`, not with `wait_for_function`, which pages forbid (it evaluates text).  A page
with an error on its console at its test's end, or that asked for anything outside this machine, fails the test.
"""

import json
import os
import shutil
import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
OPTIONS = (
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",  # what is not routed below reaches nobody either
    "--force-color-profile=srgb",  # a pixel's colour is that of the page
)
HERE = ("file", "data", "blob", "about", "")
SERIOUS = ("serious", "critical")


@dataclass
class Heard:
    """What a page did: errors of its console and scripts, URLs that it asked for, and of these the ones refused."""

    errors: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)
    refused: list[str] = field(default_factory=list)

    def listen(self, page: Any) -> None:
        """Hear all that a page of playwright does from now on, and refuse what leaves this machine."""
        page.on("console", lambda it: self.errors.append(f"{it.text} ({it.location})") if it.type == "error" else None)
        page.on("pageerror", lambda it: self.errors.append(str(it)))
        page.on("websocket", lambda it: self.asked(it.url))
        page.route("**/*", lambda it: it.continue_() if self.asked(it.request.url) else it.abort())

    def asked(self, url: str) -> bool:
        """Note a URL; whether it stays on this machine."""
        parts = urlsplit(url)
        stays = parts.scheme in HERE or parts.hostname == "127.0.0.1"
        if parts.scheme not in ("data", "blob", "about"):
            self.requests.append(url)
        if not stays:
            self.refused.append(url)
        return stays


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """A headless Chromium, one for a file of tests: with playwright's loop open no other test can run asyncio."""
    from playwright.sync_api import sync_playwright

    path = next(filter(None, map(shutil.which, NAMES)), None)
    if path is None:
        pytest.skip("no Chromium here, pages are not looked at: apt-get install chromium")
    with sync_playwright() as driver:
        # Root has no sandbox; its own /dev/shm may be too small in a container.
        options = [*OPTIONS, "--disable-dev-shm-usage", *(["--no-sandbox"] if os.geteuid() == 0 else [])]
        running = driver.chromium.launch(executable_path=path, args=options)
        yield running
        running.close()


@pytest.fixture
def heard() -> Heard:
    """What the pages of this test did."""
    return Heard()


@pytest.fixture
def open_page(browser: Any, heard: Heard) -> Iterator[Callable[..., Any]]:
    """Opens pages with playwright's options of a context: viewport, color_scheme, has_touch, device_scale_factor …"""
    with ExitStack() as stack:

        def opened(**options: Any) -> Any:
            context = browser.new_context(**{"viewport": {"width": 1280, "height": 900}, **options})
            stack.callback(context.close)
            found = context.new_page()
            found.set_default_timeout(20_000)  # ms, on a machine that does other work
            heard.listen(found)
            return found

        yield opened
    assert heard.errors == [], "errors on the console of the page"
    assert heard.refused == [], "requests that left the page"


@pytest.fixture
def page(open_page: Callable[..., Any]) -> Any:
    """A page of 1280 x 900 px, light; `emulate_media` and `set_viewport_size` make it dark, printed, a phone's."""
    return open_page()


@pytest.fixture(scope="session")
def axe() -> Callable[[Any], list[str]]:
    """A function that gives what axe-core finds serious or critical on a page, a line each."""
    from axe_playwright_python.sync_playwright import Axe

    def violations(page: Any) -> list[str]:
        # Preloading would ask for style sheets anew, which pages from disk may not.
        found = Axe().run(page, options={"preload": False}).response["violations"]
        return [
            f"{it['id']} ({it['impact']}): {it['help']}: {', '.join(str(node['target'][0]) for node in it['nodes'])}"
            for it in found
            if it["impact"] in SERIOUS
        ]

    return violations


@pytest.fixture(scope="session")
def node() -> Callable[..., Any]:
    """A function (expression, *files) that loads scripts as a page does, in one scope, and gives its value.

    It goes through JSON.  There is no document: only what computes can be run.  AssertionError with node's words
    for a wrong script or expression.
    """
    from playwright._impl._driver import compute_driver_executable

    program = shutil.which("node") or str(compute_driver_executable()[0])  # playwright brings one

    def value(expression: str, *files: Path | str) -> Any:
        loads = [f"vm.runInThisContext(fs.readFileSync({json.dumps(str(it))}, 'utf8'), {json.dumps(str(it))});"
                 for it in files]  # fmt: skip
        text = f"const vm = require('vm'), fs = require('fs');{''.join(loads)}"
        text += f"process.stdout.write(JSON.stringify(vm.runInThisContext({json.dumps(f'({expression})')})));"
        done = subprocess.run([program, "-"], input=text, capture_output=True, text=True, timeout=120, check=False)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return value
