"""Ladders: errors over resolution, the order they give, what holds, and the files."""

import json
import math

import pytest

from porescale.common.core.errors import InputError
from porescale.common.evidence import convergence_files
from porescale.common.evidence.convergence import Ladders, Row, order_of

LEVELS = (8.0, 16.0, 32.0)
MARK = {"date": "2026-01-01", "commit": "0123abcd"}
ABOUT = {"command": "toy study convergence"}


def ladders(power: float = 2.0, within: float = 0.1) -> Ladders:
    """A ladder whose error is level^-power, said to be of second order, and one of which no order is expected."""
    made = Ladders()
    made.ladder("toy.falls", title="t", along="cells", levels=LEVELS, expected=2.0, within=within, because="so")(
        lambda level: level**-power
    )
    made.ladder("other.stays", title="t", along="cells", levels=LEVELS, because="none")(lambda _: 0.1)
    return made


def test_order_is_the_slope_of_the_logarithms():
    assert order_of(LEVELS, [3 * level**-1.5 for level in LEVELS]) == pytest.approx(1.5)
    assert order_of(LEVELS, [0.1, 0.0, 0.1]) is None
    assert order_of(LEVELS, [0.1, math.nan, 0.1]) is None


@pytest.mark.parametrize(("power", "holds"), [(2.0, True), (3.0, True), (1.91, True), (1.89, False), (0.0, False)])
def test_an_order_holds_down_to_what_it_may_lack(power: float, holds: bool):
    assert ladders(power)["toy.falls"].run().holds is holds


def test_no_order_is_judged_where_none_is_expected():
    row = ladders()["other.stays"].run()
    assert row.holds is None
    assert row.measured == pytest.approx(0.0, abs=1e-12)


def test_an_exact_answer_has_no_order_and_does_not_hold():
    made = Ladders()
    made.ladder("toy.exact", title="t", along="cells", levels=LEVELS, expected=2.0, because="so")(lambda _: 0.0)
    assert (made["toy.exact"].run().measured, made["toy.exact"].run().holds) == (None, False)


def test_levels_go_from_coarse_to_fine_and_are_three():
    for levels in ((8, 16), (16, 8, 4)):
        with pytest.raises(AssertionError):
            Ladders().ladder("toy.short", title="t", along="cells", levels=levels, because="so")


def test_files_keep_rows_and_show_what_fails(tmp_path):
    rows = [ladder.run().as_dict() | MARK for ladder in ladders(1.0)]
    convergence_files.write(tmp_path, ABOUT, rows)
    assert list(convergence_files.stored(tmp_path).values()) == json.loads(json.dumps(rows))
    text = (tmp_path / "convergence.md").read_text(encoding="utf-8")
    assert "| toy.falls **fails** |" in text
    assert "| other.stays |" in text
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "convergence.json", "convergence.md", "other.png", "toy.png",
    ]  # fmt: skip


@pytest.mark.parametrize("text", ["", "[]", '{"rows": [{"name": "toy.falls"}]}'])
def test_torn_files_are_refused_in_one_line(tmp_path, text):
    (tmp_path / "convergence.json").write_text(text)
    with pytest.raises(InputError, match="cannot be read as a file of this study; remove it"):
        convergence_files.stored(tmp_path)


def test_a_picture_shows_every_level(tmp_path):
    from porescale.common.evidence.files import new_figure

    row = Row.of(ladders()["toy.falls"].run().as_dict())
    axes = new_figure(3.0, 3.0).subplots()
    convergence_files.panel(axes, row)
    shown = [line.get_xydata().tolist() for line in axes.get_lines()]
    assert [[level, level**-2.0] for level in LEVELS] in shown  # the errors
    assert len(shown) == 2  # and the slope that is expected
    # The check that must fail: an error that is not a number is left out.
    axes = new_figure(3.0, 3.0).subplots()
    convergence_files.panel(axes, Row.of(row.as_dict() | {"errors": [0.1, None, 0.01]}))
    assert [[8.0, 0.1], [32.0, 0.01]] in [line.get_xydata().tolist() for line in axes.get_lines()]


def test_levels_stand_at_the_axis_in_full():
    from porescale.common.evidence.files import new_figure

    made = Ladders()
    made.ladder("toy.fine", title="t", along="steps", levels=(250, 1000, 4000), because="so")(lambda level: 1 / level)
    axes = new_figure(3.0, 3.0).subplots()
    convergence_files.panel(axes, made["toy.fine"].run())
    assert [label.get_text() for label in axes.get_xticklabels()] == ["250", "1000", "4000"]


def test_a_picture_has_ink_for_each_row():
    """A panel that stays empty is far paler than one with a line in it."""
    import io

    import numpy as np
    from PIL import Image

    def blue(content: bytes) -> int:
        """Pixels of the line's colour."""
        seen = np.asarray(Image.open(io.BytesIO(content)).convert("RGB")).astype(int)
        return int((np.abs(seen - (0x00, 0x72, 0xB2)).sum(axis=2) < 10).sum())

    rows = [ladder.run() for ladder in ladders()]
    assert blue(convergence_files.picture(rows)) > 1.5 * blue(convergence_files.picture(rows[:1])) > 150
