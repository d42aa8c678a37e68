"""The live page and that of a sweep, in a browser: they grow with what is written, and ask this server alone."""

import time
from contextlib import contextmanager
from urllib.parse import urlsplit

import pytest

from porescale.common.watch.growing import Growing
from tests.reference.watched import PROGRAM, served, toy_run

SOON = 120_000
"""ms that the page has, on a machine that does other work."""


@contextmanager
def watched(page, folder):
    """The page of a folder, open while its server runs; gives the server."""
    with served(folder) as server:
        yield server
        page.close()  # a page whose server has ended says so on its console


def shows(page, expression):
    """Wait until an expression of the page is true; `report` is the report in it.

    It is asked from outside: the page itself may evaluate no text.
    """
    until = time.monotonic() + SOON / 1000
    while not page.evaluate(f"((report) => {expression})(document.getElementById('page')?.report)"):
        assert time.monotonic() < until, expression
        page.wait_for_timeout(50)


def test_frames_and_charts_grow_while_a_run_is_written(page, heard, tmp_path):
    rows, frames, cursors = [], [], []
    with watched(page, tmp_path / "run") as server:

        def meanwhile(folder):
            count = len(Growing(folder, PROGRAM).run())
            if count == 1:
                page.goto(server.link)
                shows(page, "report")
                page.evaluate("window.mark = 'never loaded again'")
            shows(page, f"report?.meta.times.length === {count} && report.drawn?.step === {10 * (count - 1)}")
            table = "report.tables.find((it) => it.name === 'series').charts.charts[0]"
            shows(page, f"{table}.curves[0].x.length >= {10 * (count - 1) + 1}")
            rows.append(
                page.evaluate(
                    f"document.getElementById('page').{table}.svg.querySelector('path.curve').getAttribute('d').length"
                )
            )
            frames.append(page.get_attribute("input[aria-label=frame]", "max"))
            cursors.append(page.inner_text(".player .time"))

        toy_run(tmp_path / "run", meanwhile=meanwhile)
        page.wait_for_selector(".live[data-state=finished]", timeout=SOON)
        assert page.inner_text(".live").startswith("finished · t = 0.03 of 0.03 s · 100 % · 4 frames")
        assert page.evaluate("window.mark") == "never loaded again"
    assert frames == ["0", "1", "2", "3"]
    assert rows == sorted(set(rows))
    assert cursors == ["t = 0 s · 1 of 1", "t = 0.01 s · 2 of 2", "t = 0.02 s · 3 of 3", "t = 0.03 s · 4 of 4"]
    assert {urlsplit(it).netloc for it in heard.requests} == {f"127.0.0.1:{server.server_port}"}


def test_a_frame_that_is_looked_at_stays_and_a_run_that_begins_anew_is_shown_anew(page, heard, tmp_path):
    toy_run(tmp_path)
    with watched(page, tmp_path) as server:
        page.goto(server.link)
        shows(page, "report?.drawn?.step === 30")
        page.focus("input[aria-label=frame]")
        page.keyboard.press("Home")
        shows(page, "report.drawn.step === 0")
        toy_run(tmp_path, 0.05, resume=True)
        shows(page, "report.meta.times.length === 6")
        assert page.evaluate("document.getElementById('page').report.player.at") == 0
        toy_run(tmp_path, 0.02, overwrite=True)
        shows(page, "report?.meta.times.length === 3 && report.drawn?.step === 20")
    # A table or frame may go between the answer that names it and the question for it: the browser notes a 404.
    heard.errors[:] = [line for line in heard.errors if "404" not in line]


def test_a_page_without_a_run_becomes_that_of_the_run(page, tmp_path):
    with watched(page, tmp_path / "run") as server:
        page.goto(server.link)
        page.get_by_text("Nothing is written here yet").wait_for(timeout=SOON)
        toy_run(tmp_path / "run")
        page.locator("canvas").first.wait_for(timeout=SOON)  # that page is loaded anew
        shows(page, "report?.drawn?.step === 30")


def test_a_sweep_sorts_and_leads_to_its_runs(page, heard, axe, tmp_path):
    for name, rate in (("fast", 10), ("slow", 2.5), ("middle", 5)):
        toy_run(tmp_path / name, settings=[f"decay.rate={rate}"])
    with watched(page, tmp_path) as server:
        page.goto(server.link)
        shows(page, "window.sweep?.charts?.charts.length === 2")
        assert axe(page) == []
        names = lambda: page.locator(".points tbody th span").all_inner_texts()  # noqa: E731
        assert names() == ["fast", "middle", "slow"]
        sort = page.get_by_role("button", name="sort by decay.rate")
        sort.click()
        assert names() == ["slow", "middle", "fast"]
        sort.click()
        assert names() == ["fast", "middle", "slow"]
        assert page.get_attribute("th[aria-sort]", "aria-sort") == "descending"
        assert page.locator(".chart").first.locator("path.curve").count() == 3
        page.locator(".points tbody tr").first.hover()
        assert page.locator(".chart").first.locator("path.curve:not(.faded)").count() == 1
        shows(page, "[...document.images].every((it) => it.complete && it.naturalWidth > 0)")
        toy_run(tmp_path / "later", settings=["decay.rate=7"])
        shows(page, "document.querySelectorAll('.points tbody tr').length === 4")
        page.get_by_role("link", name="slow").click()
        shows(page, "report?.drawn?.step === 30")
        assert page.url == f"{server.link}run/slow/"
    assert {urlsplit(it).netloc for it in heard.requests} == {f"127.0.0.1:{server.server_port}"}


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_live_page_is_accessible(open_page, axe, tmp_path, scheme):
    toy_run(tmp_path)
    page = open_page(color_scheme=scheme)
    with watched(page, tmp_path) as server:
        page.goto(server.link)
        shows(page, "report?.drawn?.step === 30")
        assert axe(page) == []
