"""Ensembles of a watched sweep: means and bands of what has finished, live and on a page that needs no server."""

import json
import shutil

import numpy as np
import pytest

from porescale.common.cli.application import application, main
from porescale.common.core.statistics import half_width
from porescale.common.record.series import run_table
from porescale.common.studies import sweep_files
from porescale.common.studies.ensemble import Repeats
from porescale.common.studies.parameter_table import Point, named, repeats, varied
from porescale.common.studies.runner import Ended
from porescale.common.watch.sweep import Points
from porescale.common.watch.sweep_report import write_sweep_report
from tests.common.watch.test_watch_page import SOON, shows, watched
from tests.reference.toy_model import Toy
from tests.reference.watched import PROGRAM, asked, served, told, toy_run

ROWS = [{"name": "energy", "column": "energy (J)", "at": "end", "unit": "J", "value": 0.0, "tolerance": 1e-9}]
ENERGY = "energy (J)"


def members(of: Point, count: int = 4) -> list[Point]:
    return named(repeats(of, Repeats(None, f"toy.seed={','.join(map(str, range(count)))}").choices(None, None)))


def run(folder, point: Point) -> Ended:
    """A toy that starts at rest from places that its seed draws."""
    toy = Toy()
    toy.x = np.random.default_rng(int(point.value("toy.seed"))).random(toy.x.shape)
    toy_run(folder / point.name, model=toy, settings=list(point.settings))
    return Ended(point, folder / point.name, "finished", {})


def written(folder, points, ends) -> None:
    sweep_files.write(folder, "toy sweep", ends, ROWS, run_table, points)


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """What `swept` is a copy of."""
    folder = tmp_path_factory.mktemp("swept")
    one, other = varied(["toy.rate=1,2"])
    points = [*members(one), *members(other)]
    ends = [run(folder, point) for point in points if point.name != "rate=1,seed=3"]
    sweep_files.write(folder, "toy sweep", ends, ROWS, run_table, points)
    return folder


@pytest.fixture
def swept(runs, tmp_path):
    """Two combinations of four toys, of which the first three of one and all of the other have finished."""
    shutil.copytree(runs, tmp_path, dirs_exist_ok=True)
    return tmp_path


def test_what_is_known_of_ensembles_is_told_while_they_run(swept):
    with served(swept) as server:
        one, other = told(server, "ensembles")
        assert (one["name"], one["said"]) == ("rate=1", "3 of 4 finished")
        assert one["finished"] == ["rate=1,seed=0", "rate=1,seed=1", "rate=1,seed=2"]
        assert (other["said"], other["lines"][0]["n"], other["lines"][0]["verdict"]) == ("4 of 4 finished", 4, "fail")
        band = told(server, "band/rate%3D2")
        column = [f"{it['name']} ({it['unit']})" for it in band["columns"]].index(ENERGY)
        ends = [Points(swept, PROGRAM).run(name).run().series[ENERGY][-1] for name in other["finished"]]
        assert band["data"][column][-1] == pytest.approx(np.mean(ends), rel=1e-6)
        assert band["half"][column][-1] == pytest.approx(half_width(ends), rel=1e-6)
        assert told(server, "band/rate%3D3") is None
        assert asked(server, "bands/rate%3D3")[0] == 404


def test_members_are_none_but_the_runs_in_the_folder(swept, tmp_path):
    path = swept / "ensemble.csv"
    path.write_text(path.read_text().replace("rate=1,seed=0", "../../etc"))
    one, _ = Points(swept, PROGRAM).ensembles()
    assert one["said"] == "2 of 4 finished"


def test_the_page_shows_means_with_bands_and_members_thin(page, heard, swept):
    with watched(page, swept) as server:
        page.goto(server.link)
        page.wait_for_selector("#ensembles li", timeout=SOON)
        page.wait_for_selector("path.band", timeout=SOON)
        charts = page.locator("figure.chart").count()
        assert page.locator("path.band").count() == 2 * charts
        assert page.locator("path.curve.thin").count() == 7 * charts
        assert page.locator("#ensembles li").all_inner_texts() == ["rate=1: 3 of 4 finished", "rate=2: 4 of 4 finished"]
        assert "fail" in page.inner_text("#ensembles table")
        last = run(swept, members(varied(["toy.rate=1"])[0])[3])
        assert last.outcome == "finished"
        shows(page, "document.querySelector('#ensembles li').textContent === 'rate=1: 4 of 4 finished'")
    assert not heard.errors


def test_the_page_of_ensembles_without_a_band_still_has_its_table(page, heard, swept, monkeypatch):
    from porescale.common.watch import sweep

    monkeypatch.setattr(sweep, "band", lambda curves: None)  # as of members whose rows are no curves over time
    with watched(page, swept) as server:
        assert told(server, "band/rate%3D2") is None
        page.goto(server.link)
        page.wait_for_selector("#points tbody tr", timeout=SOON)
        page.wait_for_selector("#ensembles li", timeout=SOON)
        assert page.locator("path.band").count() == 0
    assert not heard.errors


@pytest.mark.parametrize(
    ("words", "said"),
    [(["--size", "3"], ["--size = 3.0"]), (["--full"], ["--full"]), (["--full", "--size", "3"], ["--size", "--full"])],
)
def test_options_of_the_page_of_a_run_are_refused_with_a_sweep(swept, capsys, words, said):
    assert main(application(PROGRAM), ["report", str(swept), *words]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == len(said)
    assert all(it in line and "is not for the page of a sweep" in line for it, line in zip(said, lines, strict=True))
    assert not (swept / "report.html").exists()


def test_a_sweep_of_another_package_is_refused(swept, capsys):
    for card in swept.glob("*/card.json"):
        card.write_text(card.read_text().replace('"package": "toy"', '"package": "other"'))
    assert main(application(PROGRAM), ["report", str(swept)]) == 2
    assert "holds a run of other" in capsys.readouterr().err


def test_a_page_of_a_sweep_is_complete_in_itself(page, heard, swept, tmp_path):
    (swept / "rate=2,seed=0" / "report.html").write_text("<p>a run</p>")
    path = write_sweep_report(swept, PROGRAM)
    page.goto(path.as_uri())
    page.wait_for_selector("path.band", timeout=SOON)
    assert page.locator("#ensembles li").count() == 2
    links = page.locator("#points tbody a[href]").evaluate_all("(all) => all.map((it) => it.getAttribute('href'))")
    assert links == ["rate%3D2%2Cseed%3D0/report.html"]
    assert all(it.startswith("file:") or it.startswith("data:") for it in heard.requests)
    assert json.dumps("</script>") not in path.read_text()
