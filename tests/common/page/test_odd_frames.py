"""Frames with values that are no numbers, and whole numbers of every size, are read as they were written."""

import json
import re

import numpy as np
import pytest

from porescale.common.page.frames import FINE, pack
from porescale.common.page.page import script
from porescale.common.page.quantise import Packed, Precision
from porescale.common.pictures.look import Look
from porescale.common.record.model import Cloud, Snapshot


@pytest.mark.parametrize("precision", [FINE, Precision(full=True)])
@pytest.mark.parametrize("value", [np.inf, -np.inf, np.nan])
def test_a_frame_with_values_that_are_no_numbers_has_a_head_that_browsers_read(precision, value):
    cloud = Cloud(np.array([[0.0, 1.0], [value, 2.0]]), {"angle": np.array([0.5, value])}, {})
    look = Look(marks=lambda snapshot: [((value, 0.0), (1.0, 1.0))])
    content = pack(Snapshot(0.1, 1, {}, {"grains": cloud}), look, precision)
    text = content[4 : 4 + int.from_bytes(content[:4], "little")]
    assert not re.search(rb"NaN|Infinity", text)  # Python would read these words, JSON has none
    error = json.loads(text)["clouds"]["grains"]["arrays"]["angle"]["error"]
    assert error == 0.5 * 2.0**-24  # one value that is finite: no step, and half an ulp of float32


def test_node_decodes_whole_numbers_of_four_bytes_in_cells(node, tmp_path):
    (tmp_path / "page.js").write_text(script(), encoding="utf-8")
    numbers = np.array([[0, 3_000_000_000, 1], [4_000_000_000, 5, 2_147_483_648]])
    packed = Packed(bytearray())
    spec = packed.add(numbers, 16, cells=True, full=False)
    code = f"Array.from(decode(Uint8Array.from({list(packed.content)}).buffer, 0, {json.dumps(spec)}, 6)[0])"
    assert node(code, tmp_path / "page.js") == numbers.ravel().tolist()
