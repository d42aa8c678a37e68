"""Building the manual, and what is wrong with what was built."""

import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

from tests.reference.folders import DOCS, ROOT

SITE = ROOT / "build" / "manual"
"""Where the manual goes unless another folder is named; git ignores it."""
FRONT = '<!doctype html><meta charset="utf-8"><meta http-equiv="refresh" content="0; url=docs/index.html">'
LOADED = {"script": "src", "link": "href", "img": "src", "iframe": "src", "video": "src", "source": "src"}
"""What a browser loads by itself as it shows a page, by the attribute that names it."""
STYLE_URL = re.compile(r"url\(\s*['\"]?(?:https?:)?//|@import\s+['\"]?(?:url\()?['\"]?(?:https?:)?//")
NO_LOAD = {"canonical", "next", "prev", "search", "index", "genindex", "author"}
"""Relations of a ``link`` that load nothing."""


def build(out: Path, quiet: bool = True) -> tuple[int, str, float]:
    """Build the manual into a folder with warnings as errors: exit code, what Sphinx says, seconds."""
    start = time.perf_counter()
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-c", str(DOCS), "-d", str(out / ".doctrees")]
    done = subprocess.run(
        [*command, *(["-q"] if quiet else []), str(ROOT), str(out)], cwd=ROOT, capture_output=True, text=True
    )
    if done.returncode == 0:
        (out / "index.html").write_text(FRONT, encoding="utf-8")
        for page in (ROOT / "runs").glob("*/report.html"):  # that the gallery links to
            if (ROOT / "cases" / page.parent.name).is_dir():
                (out / "runs" / page.parent.name).mkdir(parents=True, exist_ok=True)
                shutil.copyfile(page, out / "runs" / page.parent.name / page.name)
    said = "\n".join(dict.fromkeys((done.stdout + done.stderr).splitlines()))  # some warnings come once for each page
    return done.returncode, said, time.perf_counter() - start


class Page(HTMLParser):
    """The anchors of a page, what it links to, what it loads, and styles in it that load from the network."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loads: list[str] = []
        self.styles: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {key: value or "" for key, value in attrs}
        self.anchors.update(given[key] for key in ("id", "name") if given.get(key))
        if tag == "a" and "href" in given:
            self.links.append(given["href"])
        if given.get(LOADED.get(tag, "")) and not (tag == "link" and given.get("rel", "") in NO_LOAD):
            self.loads.append(given[LOADED[tag]])
        if STYLE_URL.search(given.get("style", "")):
            self.styles.append(given["style"])


def read(site: Path) -> dict[Path, Page]:
    """The pages of a site that was built, by their places."""
    return {path.resolve(): Page(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))}


def from_elsewhere(site: Path, pages: dict[Path, Page] | None = None) -> Iterator[str]:
    """Pages and styles that load something from the network, with what.  pages : those of the site, if read."""
    for path, page in (pages or read(site)).items():
        for load in [it for it in page.loads if urlsplit(it).netloc] + page.styles:
            yield f"{path.relative_to(site.resolve())}: {load}"
    for path in sorted(site.rglob("*.css")):
        if STYLE_URL.search(path.read_text(encoding="utf-8")):
            yield f"{path.relative_to(site)}: {STYLE_URL.pattern}"


def dead_links(site: Path, pages: dict[Path, Page] | None = None) -> Iterator[str]:
    """Links of pages to files of the site, or anchors of them, that are not there.  pages : the site's, if read."""
    pages, top = pages or read(site), site.resolve()

    @cache
    def found(folder: Path, name: str) -> Path | None:
        """The file of the site that a link in a folder leads to."""
        there = (folder / unquote(name)).resolve()
        return there if there.is_file() and there.is_relative_to(top) else None

    for path, page in pages.items():
        for link in {*page.links, *page.loads}:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc or link == "#":
                continue
            there = found(path.parent, parts.path) if parts.path else path
            sound = there is not None
            if there in pages and parts.fragment:
                sound = unquote(parts.fragment) in pages[there].anchors
            if not sound:
                yield f"{path.relative_to(top)}: {link}"


def faults(site: Path) -> list[str]:
    """All that is wrong with a site that was built."""
    pages = read(site)
    return [*(f"loads from the network: {it}" for it in from_elsewhere(site, pages)),
            *(f"dead link: {it}" for it in dead_links(site, pages))]  # fmt: skip
