"""The page of a run: its data are those of the files within the error that it states; a browser shows them."""

import json
import os
import re
import shutil
import zlib
from base64 import b64decode, b64encode
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest

from porescale.common.api.open_run import open_run
from porescale.common.core.errors import InputError
from porescale.common.page.frames import frame
from porescale.common.page.meta import meta
from porescale.common.page.page import NAME, SCRIPTS, fitting, report, script, write_report
from porescale.common.page.quantise import Precision
from porescale.common.page.tables import table
from porescale.common.pictures.look import Look
from porescale.common.record.drive import drive
from porescale.common.record.model import Cloud, Snapshot
from tests.reference.toy_model import Toy
from tests.reference.toy_package import TOY

LOOK = Look(cloud="grains", colour="velocity", view=(0.0, 1.0, 0.0, 1.0))
PROGRAM = replace(TOY, look=lambda run: LOOK)
CARD = {"package": "toy", "name": "beads", "scene": {"decay": {"rate": 3.0}, "title": "Beads <b>"}}
FRAMES = 5


class Turning(Toy):
    """The toy, whose beads turn and touch, and which measures with what one does without."""

    def snapshot(self):
        plain = super().snapshot()
        grains = plain.clouds["grains"]
        grains.data |= {"angle": np.linspace(0.0, 3.0, len(self.x)), "number": np.arange(len(self.x))}
        grains.data["velocity"][0] = np.nan
        return plain


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A run of the toy: five snapshots, one bead whose velocity is no number."""
    made = tmp_path_factory.mktemp("page") / "run"
    drive(Turning(), made, 0.04, snapshot_interval=0.01, series_interval=0.002, card=CARD, quiet=True)
    (made / "breaks.csv").write_text("x (m),body ()\n0.5,disc <1>\n", encoding="utf-8")
    return made


@pytest.fixture(scope="module")
def run(folder):
    return open_run(folder, PROGRAM)


@pytest.fixture(scope="module")
def written(run, tmp_path_factory):
    return report([run], tmp_path_factory.mktemp("written") / NAME)


def held(path: Path) -> dict[str, bytes]:
    text = path.read_text(encoding="utf-8")
    index = json.loads(re.search(r'id="index">(.*?)</script>', text)[1])
    data = re.search(r'id="data">(.*?)</script>', text)[1]
    return {name: zlib.decompress(b64decode(data[at : at + size])) for name, (at, size) in index[0].items()}


def head(content: bytes) -> dict:
    return json.loads(content[4 : 4 + int.from_bytes(content[:4], "little")])


def decoded(content: bytes, block: str, array: str, kind: str = "clouds") -> tuple[np.ndarray, float]:
    """An array of a frame, (width, n), and its error: what values.js does, in numpy."""
    length, about = int.from_bytes(content[:4], "little"), head(content)[kind][block]
    spec = about["arrays"][array]
    count = about["count"] if kind == "clouds" else int(np.prod(about["shape"]))
    start, total = 4 + length + spec["at"], count * spec["width"]
    if spec["type"] == "f4":
        return np.frombuffer(content, "<f4", total, start).reshape(-1, count), spec["error"]
    size = int(spec["type"][1])
    planes = np.frombuffer(content, np.uint8, total * size, start).reshape(size, total).astype(np.int64)
    codes = (planes * 256 ** np.arange(size)[:, None]).sum(axis=0).reshape(spec["width"], count)
    if "across" in spec:
        rows = codes.reshape(spec["width"], -1, spec["across"])
        codes = (np.cumsum(rows, axis=2) % 256**size).reshape(spec["width"], count)
    values = np.array(spec["low"])[:, None] + np.array(spec["step"])[:, None] * codes
    return np.where((codes == 256**size - 1) & (not spec["whole"]), np.nan, values), spec["error"]


@pytest.mark.parametrize("precision", [Precision(), Precision(8), Precision(8, 2), Precision(full=True)])
def test_values_are_those_of_the_files_within_the_stated_error(run, precision):
    content, last = frame(run, FRAMES - 1, precision), run.snapshot(-1)
    grains, fields = last.clouds["grains"], last.grids["fields"]
    at = slice(precision.every // 2, None, precision.every)
    for found, exact in (
        (decoded(content, "grains", "position"), grains.position.T),
        (decoded(content, "grains", "velocity"), grains.data["velocity"][:, :2].T),
        (decoded(content, "grains", "angle"), grains.data["angle"][None]),
        (decoded(content, "fields", "velocity", "grids"), fields.cells["velocity"][at, at, :2].reshape(-1, 2).T),
    ):
        values, error = found
        assert np.array_equal(np.isnan(values), np.isnan(exact))
        # `error` is half a step and the rounding to float32, to which numpy adds that of low + step * code in float64
        assert np.nanmax(np.abs(values - exact)) <= error * (1 + 1e-9) + 1e-15
        assert error < np.nanmax(np.abs(exact)) / 200  # half of a 254th of the range, which is no wider than twice it
    numbers, error = decoded(content, "grains", "number")
    assert error == 0.0
    assert np.array_equal(numbers[0], np.arange(len(grains.position)))


def test_an_error_that_is_stated_too_small_is_found(run):
    values, error = decoded(frame(run, 1, Precision(8)), "fields", "velocity", "grids")
    exact = run.snapshot(1).grids["fields"].cells["velocity"][..., 0].ravel()
    assert np.abs(values[0] - exact).max() > error / 4


def test_a_page_holds_every_frame_table_and_text(run, written):
    parts = held(written)
    assert {f"frame {k}" for k in range(FRAMES)} | {"meta", "table series", "table beads", "table breaks"} == set(parts)
    about = json.loads(parts["meta"])
    assert about["times"] == run.times.tolist()
    assert about["card"]["scene"] == CARD["scene"]
    assert about["verdicts"]["rows"] == []
    assert about["quantities"]["clouds"]["grains"]["speed"]["unit"] == "m/s"
    assert about["errors"]["grains/position"] > 0.0
    series = json.loads(parts["table series"])
    assert series["columns"][1] == {"name": "energy", "unit": "J"}
    assert np.allclose(series["data"][1], run.series["energy (J)"], rtol=1e-6)  # seven digits are held
    assert table(run, "breaks")["data"] == [["0.5"], ["disc <1>"]]
    first, later = (head(parts[f"frame {k}"]) for k in (0, 2))  # what does not change is held once, in the first
    assert "at" in first["clouds"]["grains"]["arrays"]["radius"]
    assert later["clouds"]["grains"]["arrays"]["radius"] == {"same": 1}
    assert "same" not in later["clouds"]["grains"]["arrays"]["position"]


def test_a_run_that_has_not_ended_is_not_held_against_what_is_expected_of_its_end(run):
    running = open_run(run.folder, PROGRAM)
    running.card["outcome"] = "running"
    note = "What is expected is for the end of the run, which is running."
    assert meta(running)["verdicts"] == {"note": note, "rows": []}


def test_the_page_of_a_run_whose_name_is_no_utf_8_is_written(folder, tmp_path):
    named = shutil.copytree(folder, tmp_path / os.fsdecode(b"\xff"))
    assert write_report(named, PROGRAM).exists()


def test_the_page_of_a_run_that_ends_says_that_it_has(run, folder):
    before = (folder / "card.json").read_text(encoding="utf-8")
    (folder / "card.json").write_text(before.replace('"finished"', '"running"'), encoding="utf-8")
    path = write_report(folder, PROGRAM)
    (folder / "card.json").write_text(before, encoding="utf-8")
    assert json.loads(held(path)["meta"])["outcome"] == "finished"
    path.unlink()


def test_what_people_write_is_text_in_the_page(written):
    text = written.read_text(encoding="utf-8")
    assert "<title>Beads &lt;b&gt;</title>" in text
    assert "disc <1>" not in text
    rest = re.sub(r'id="data">.*?</script>', "", text, flags=re.DOTALL)
    assert set(re.findall(r"https?://[^\s\"]+", rest)) == {"http://www.w3.org/2000/svg"}  # the name of SVG, no address


def test_large_runs_are_held_more_coarsely(run):
    finest = fitting(run, 5.0)
    assert finest == Precision(16)
    thin = fitting(run, 0.19)  # less than what the scripts take: nothing is left for frames
    assert (thin.bits, thin.every) == (8, 4)
    assert meta(run, Precision(thin=3))["times"] == run.times[[0, 3, 4]].tolist()
    assert frame(run, 1, Precision(thin=3)) == frame(run, 3)


def test_runs_in_other_boxes_are_refused(run, tmp_path):
    other = open_run(run.folder, replace(TOY, look=lambda _: replace(LOOK, view=(0.0, 2.0, 0.0, 1.0))))
    with pytest.raises(InputError, match=r"its box \(2 x 1 m\) is not that of .* \(1 x 1 m\)"):
        report([run, other], tmp_path / "both.html")
    assert not (tmp_path / "both.html").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nothing"], "no run here (card.json is missing)"),
        (["RUN", "nothing"], "no run here (card.json is missing)"),
        (["RUN", "--size", "0.1"], "is out of range"),
        (["RUN", "--out", "."], "is a folder"),
    ],
)
def test_wrong_use_is_one_line(folder, words, said, capsys, tmp_path, monkeypatch):
    from porescale.common.cli.application import application, main

    monkeypatch.chdir(tmp_path)
    assert main(application(PROGRAM), ["report", *(str(folder) if it == "RUN" else it for it in words)]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert said in lines[0]
    assert list(tmp_path.iterdir()) == []


def test_the_command_says_where_the_page_is(folder, capsys, tmp_path):
    from porescale.common.cli.application import application, main

    assert main(application(PROGRAM), ["report", str(folder), str(folder), "--out", str(tmp_path / "both.html")]) == 0
    assert capsys.readouterr().out.strip() == str(tmp_path / "both.html")


def test_no_name_stands_twice_in_the_joined_script():
    named = re.findall(r"^(?:async )?(?:function|class|const|let) (\w+)", script(), flags=re.M)
    assert len(named) == len(set(named))
    assert not re.findall(r"^(?:import|export) ", script(), flags=re.M)
    assert "openReport" in named
    assert len(SCRIPTS) == len(list((Path(report.__code__.co_filename).parent / "static").glob("*.js")))


def test_node_decodes_what_python_packs(node, run, tmp_path):
    (tmp_path / "page.js").write_text(script(), encoding="utf-8")
    first, later = frame(run, 0), frame(run, 2, Precision(8), run.snapshot(0))
    texts = json.dumps([b64encode(it).decode() for it in (first, later)])
    code = f"""(([first, later]) => {{
      const bytes = (text) => Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0)).buffer;
      const frame = new Frame(bytes(later), new Frame(bytes(first)));
      const list = (values) => Array.from(values, (it) => (Number.isNaN(it) ? null : it));
      return {{
        x: list(frame.parts("clouds", "grains", "position")[0]), speed: list(frame.scalar("grids", "fields", "speed")),
        radius: list(frame.scalar("clouds", "grains", "radius")),
        v: list(frame.scalar("clouds", "grains", "velocity_y")),
        error: frame.error("grids", "fields", "speed"),
      }};
    }})({texts})"""
    found = node(code, tmp_path / "page.js")
    exact = run.snapshot(2)
    assert np.allclose(found["radius"], exact.clouds["grains"].data["radius"], rtol=1e-7)
    assert np.allclose(found["x"], decoded(later, "grains", "position")[0][0], rtol=1e-7)
    assert found["v"][0] is None
    speed = np.hypot(*np.moveaxis(exact.grids["fields"].cells["velocity"][..., :2], -1, 0)).ravel()
    assert np.abs(np.array(found["speed"]) - speed).max() <= found["error"] * (1 + 1e-6)


# ---------------------------------------------------------------- in a browser


def opened(page, path: Path) -> None:
    """Open a page and wait until it shows its first frame."""
    page.goto(path.as_uri())
    page.wait_for_selector("main[data-state=ready]")


def spot(page, x: float, y: float) -> tuple[float, float]:
    """Where a place (m) of the picture is in the window."""
    page.locator("canvas[tabindex]").scroll_into_view_if_needed()
    return tuple(page.evaluate(
        "([x, y]) => { const box = report.area.getBoundingClientRect(); const [i, j] = report.picture.project(x, y);"
        " return [box.left + i, box.top + j]; }", [x, y]))  # fmt: skip


def test_nothing_leaves_the_page_and_nobody_is_kept_out(page, heard, axe, written):
    opened(page, written)
    assert heard.requests == [written.as_uri()]
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        assert axe(page) == []
    page.set_viewport_size({"width": 390, "height": 844})
    page.evaluate("new Promise(then => requestAnimationFrame(() => requestAnimationFrame(then)))")  # canvases follow
    assert page.evaluate("document.documentElement.scrollWidth") <= 390


def test_hover_says_what_the_files_say(page, run, written):
    opened(page, written)
    k = 3
    page.evaluate("k => report.player.seek(k)", k)
    with h5py.File(run.folder / "grains.vtkhdf") as file:
        rows = slice(7 * k, 7 * k + 7)
        x, y = file["VTKHDF/Points"][rows][5, :2]
        speed = np.hypot(*file["VTKHDF/PointData/velocity"][rows][5, :2])
    page.mouse.move(*spot(page, x, y))
    said = page.locator(".hover").inner_text()
    number, value, error = re.search(r"grain (\d+) speed (\S+) m/s ± ([\d.e-]+)", said).groups()
    assert int(number) == 5
    assert abs(float(value) - speed) <= float(error) + 5e-6 * speed  # six digits are shown
    row, column, shown = re.search(r"cell \((\d+), (\d+)\) speed (\S+) m/s", said).groups()
    with h5py.File(run.folder / "fields.vtkhdf") as file:
        cell = np.hypot(*file["VTKHDF/CellData/velocity"][k, int(row), int(column), :2])
    assert (int(row), int(column)) == (int(y * 6), int(x * 8))
    assert abs(float(shown) - cell) <= 1e-4 * (abs(cell) + 1.0)  # 16 bits of a range of one


def test_the_pixel_of_a_grain_has_its_colour(page, run, written):
    import matplotlib

    opened(page, written)
    page.evaluate("report.player.seek(4)")
    page.evaluate("report.controls.setLimits('points', {low: 0, high: 2, map: 'viridis'})")
    grains = run.snapshot(4).clouds["grains"]
    for k in (2, 5):
        speed = np.hypot(*grains.data["velocity"][k, :2])
        pixel = page.evaluate(
            "([x, y]) => { const [i, j] = report.picture.device(x, y);"
            " return [...report.picture.context.getImageData(i - 0.5, j - 0.5, 1, 1).data]; }",
            grains.position[k].tolist(),
        )
        level = 255 * min(1.0, speed / 2)
        near = matplotlib.colormaps["viridis"](np.arange(max(0, int(level - 0.01)), min(255, int(level + 0.01)) + 1))
        assert any(np.abs(255 * colour[:3] - pixel[:3]).max() <= 1.0 for colour in near)


def test_slider_and_keys_move_frame_and_cursors_together(page, run, written):
    opened(page, written)
    cursor = page.locator(".chart .cursor").first
    places = []
    for key, at in (("End", 4), ("ArrowLeft", 3), ("Home", 0), ("ArrowRight", 1), ("PageDown", 4)):
        page.keyboard.press(key)
        page.wait_for_selector(f"output.time:text('{at + 1} of {FRAMES}')")
        page.evaluate("() => report.runs[0].frame(report.player.at)")
        assert page.evaluate("report.frame.time") == run.times[at]
        places.append((at, float(cursor.get_attribute("x1"))))
        assert page.get_by_label("frame", exact=True).input_value() == str(at)
    where = dict(places)
    assert where[0] < where[1] < where[3] < where[4]
    # the axis of times is linear: a quarter of the way at the second of five frames
    assert where[1] - where[0] == pytest.approx((where[4] - where[0]) / 4, rel=1e-3)
    page.keyboard.press("Home")
    page.keyboard.press(" ")
    page.wait_for_selector("button[aria-label=play]")  # it has played to the end
    assert page.evaluate("report.player.at") == FRAMES - 1


def test_all_controls_are_reached_by_tab_and_say_what_they_are(page, written):
    opened(page, written)
    reached = set()
    for _ in range(40):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("document.activeElement.ariaLabel || document.activeElement.textContent || ''"))
    assert {"play", "frame", "speed", "zoom in", "columns to show"} <= reached
    page.focus("canvas[tabindex]")
    before = page.evaluate("report.picture.place.scale")
    page.keyboard.press("+")
    assert page.evaluate("report.picture.place.scale") > before
    assert page.evaluate("getComputedStyle(report.area).outlineStyle") == "solid"


def test_a_line_shows_values_along_it(page, written):
    opened(page, written)
    page.get_by_role("button", name="line", exact=True).click()
    start, end = spot(page, 0.1, 0.5), spot(page, 0.9, 0.5)
    page.mouse.move(*start)
    page.mouse.down()
    page.mouse.move(*end)
    page.mouse.up()
    ends = page.evaluate("report.line")
    assert np.allclose(ends, [0.1, 0.5, 0.9, 0.5], atol=0.01)  # a pixel is 1/600 of the box
    assert "fields: speed (m/s)" in page.locator(".profile").inner_text()


def test_two_runs_lie_over_each_other_with_their_difference(page, run, tmp_path):
    path = report([run, run], tmp_path / "both.html")
    opened(page, path)
    page.get_by_label("Runs").select_option("minus 0")
    page.evaluate("report.player.seek(2)")
    page.evaluate("() => report.runs[1].frame(2)")
    assert page.evaluate("Math.max(...report.choice.values.cells)") == 0.0
    assert "the other run is shown at t = 0.02 s" in page.locator(".refused").inner_text()
    assert page.locator(".chart").first.locator(".curve").count() == 2


def test_a_page_without_snapshots_shows_its_tables(page, folder, tmp_path):
    bare = tmp_path / "bare"
    bare.mkdir()
    for name in ("card.json", "series.csv"):
        (bare / name).write_bytes((folder / name).read_bytes())
    opened(page, report([open_run(bare, PROGRAM)]))
    assert page.locator(".chart").count() == 2


def test_marks_and_bodies_are_drawn(page, folder, tmp_path, run):
    """Polygons, a line and a mark of a frame, as fields of a snapshot of bodies have them."""
    corners = np.array([[0.2, 0.2], [0.8, 0.2], [0.5, 0.8], [0.1, 0.9], [0.9, 0.9]])
    cloud = Cloud(corners, {"radius": np.full(5, 0.01), "body": np.array([0, 0, 0, 1, 1], np.int32)}, {"radius": "m"},
                  lines=np.array([[3, 4]]), polygons=(np.array([0, 3]), np.array([0, 1, 2])))  # fmt: skip

    class Bodies(Toy):
        def snapshot(self):
            return Snapshot(self.time, self.step, {}, {"frames": cloud})

    look = Look(cloud="grains", shapes="frames", marks=lambda _: [((0.1, 0.1), (0.9, 0.1))], view=LOOK.view)
    card = {**CARD, "name": "bodies"}
    drive(Bodies(), tmp_path / "run", 0.002, snapshot_interval=0.001, series_interval=0.001, card=card, quiet=True)
    opened(page, report([open_run(tmp_path / "run", replace(TOY, look=lambda _: look))]))
    page.mouse.move(*spot(page, 0.5, 0.4))
    assert "body 0" in page.locator(".hover").inner_text()
    pixel = page.evaluate(
        "() => { const [i, j] = report.picture.device(0.5, 0.1);"
        " return [...report.picture.context.getImageData(i, j, 1, 1).data]; }"
    )
    assert pixel[0] > 180
    assert pixel[1] < 90  # red, of a crack
