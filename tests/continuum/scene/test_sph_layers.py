"""Ground of pieces with permeabilities of their own: flow along and across them, held, moving and with suction."""

import numpy as np
import pytest

from continuum_sph.builders.parts.pore_water import pore_law
from continuum_sph.builders.parts.soil import soil_particles
from continuum_sph.builders.report import report
from continuum_sph.builders.simulation import Simulation
from continuum_sph.validation.tanks import tank_scene
from continuum_sph.water.smoothing import kernel_value
from porescale.common.core.errors import InputError

K, RATIO, FALL = 1e-3, 0.1, 0.2  # m/s; of the other piece; of the head, m
WIDE, HIGH, ROWS = 0.5, 0.4, 8
SPACING = HIGH / ROWS


def box(left, right, bottom, top):
    return [[left, bottom], [right, bottom], [right, top], [left, top]]


def scene(pieces, soil=None, **changes):
    given = {
        "water": {"sound_speed": 100.0},
        "soil": {"held": True, "saturated": True, "permeability": K, "body": pieces} | (soil or {}),
        "face": [{"name": "high", "side": "left", "head": 1.0 + FALL}, {"name": "low", "side": "right", "head": 1.0}],
    }
    return tank_scene(WIDE, HIGH, SPACING, every=0.1, **given | changes)


def discharge(pieces):
    """Of the steady flow, m²/s, through both faces.

    What is left of the start falls slowest in a tight piece, as exp(-π² D t/L²), where D = k c²/g = 0.1 m²/s and L is
    0.25 m: of 16 in a second there are 8.
    """
    model = Simulation(scene(pieces))
    while model.time < 0.5:
        model.advance(50)
    model.check()
    row = model.series()
    return row["high flow in (m2/s)"], -row["low flow in (m2/s)"]


ACROSS = [{"outline": box(0.0, 0.25, 0.0, HIGH)}, {"outline": box(0.25, WIDE, 0.0, HIGH), "permeability": RATIO * K}]
ALONG = [{"outline": box(0.0, WIDE, 0.0, 0.2)}, {"outline": box(0.0, WIDE, 0.2, HIGH), "permeability": RATIO * K}]


def test_flow_across_two_pieces_has_the_harmonic_mean():
    """Each face is known to a twentieth of a spacing, and the tight piece, which has ten elevenths of the fall, is five
    spacings long: 2 %."""
    exact = 2.0 / (1.0 + 1.0 / RATIO) * K * FALL / WIDE * HIGH
    into, out = discharge(ACROSS)
    assert into == pytest.approx(exact, rel=0.02)
    assert out == pytest.approx(exact, rel=0.02)
    # the check that fails: all of one piece
    assert discharge([{"outline": box(0.0, WIDE, 0.0, HIGH)}])[0] == pytest.approx(exact / 0.1818, rel=0.0125)


def resisted(rows):
    """k over K of water in each of ``rows`` of ground, the upper half with RATIO: it meets the mean of what its
    partners resist, by the kernel."""
    given = scene(ALONG)
    law = pore_law(given, soil_particles(given)[0]).smoothing
    reach, h = np.arange(-5, 6), law.length / SPACING
    weight = np.array([sum(kernel_value(law.kind, np.hypot(i, j) / h, h) for i in reach) for j in reach])
    apart = np.subtract.outer(np.arange(rows), np.arange(rows))
    seen = np.where(np.abs(apart) <= 5, weight[np.clip(apart + 5, 0, 10)], 0.0)
    return seen.sum(axis=1) / (seen / np.where(np.arange(rows) < rows // 2, 1.0, RATIO)).sum(axis=1)


def test_flow_along_two_pieces_is_the_sum_but_for_a_row():
    """Arithmetic mean of k, but that water within a kernel of the tight piece is held back as by both, which takes 0.7
    rows of the permeable one at any spacing.  Faces as of one piece, 1.25 % of 3.7 rows, and what the two rows at the
    boundary lose besides, 0.06 of each, measured with 8, 16 and 32."""
    for rows in (8, 16, 32):
        assert rows * (0.5 * (1.0 + RATIO) - float(resisted(rows).mean())) == pytest.approx(0.7, abs=0.03)
    one = K * FALL / WIDE * HIGH / ROWS  # of a row of the permeable piece
    lost = [0.5 * (1.0 + RATIO) * ROWS - flow / one for flow in discharge(ALONG)]
    assert lost == pytest.approx([0.7 + 2.0 * 0.06] * 2, abs=0.05 + 2.0 * 0.06)


def test_the_last_of_pieces_that_overlap_holds():
    core = {"outline": box(0.1, 0.3, 0.0, 0.2), "permeability": 1e-5}
    shell = {"outline": box(0.0, WIDE, 0.0, HIGH)}
    soil = scene([shell, core]).soil
    points = np.array([[0.05, 0.1], [0.2, 0.1], [0.2, 0.3]])
    assert list(soil.permeability_at(points)) == [K, 1e-5, K]
    assert list(scene([core, shell | {"permeability": 2e-3}]).soil.permeability_at(points)) == [2e-3] * 3
    assert scene([shell, core]).soil.permeabilities == (1e-5, K)


@pytest.mark.parametrize(
    "soil",
    [{"saturated": True}, {"suction": {"alpha": "4 1/m", "n": 2.0, "residual": 0.1, "water_table": 0.1}}],
    ids=["moving", "suction"],
)
def test_each_particle_has_the_permeability_of_its_piece(soil):
    given = scene(ACROSS, {"held": False, "saturated": False} | soil, face=[])
    flow = Simulation(given).flow
    water = flow.water
    k = water.skeleton.permeability if hasattr(water, "skeleton") else water.permeability
    x = flow.ground.soil.x[: flow.ground.soil.soil, 0]
    assert (k == np.where(x < 0.25, K, RATIO * K)).all()


def test_report_takes_the_slower_piece_for_times_and_the_faster_for_steps():
    whole = [{"outline": box(0.0, WIDE, 0.0, HIGH)}]
    tight = report(scene(whole, {"permeability": RATIO * K}))
    both = report(scene(ACROSS))

    def steady(out):
        return next(
            row for group in out.groups.values() for row in group if row.name == "time until the flow is steady"
        )

    assert steady(both) == steady(tight)


@pytest.mark.parametrize("value", [0.0, -1.0, 11.0, "1 Pa"])
def test_a_permeability_that_no_ground_has_is_refused(value):
    with pytest.raises(InputError, match=r"soil\.body\[0\]\.permeability"):
        scene([{"outline": box(0.0, WIDE, 0.0, HIGH), "permeability": value}])


def test_a_watched_part_has_no_permeability():
    watched = {"name": "part", "outline": box(0.0, 0.2, 0.0, 0.2), "permeability": K}
    with pytest.raises(InputError, match="permeability"):
        scene([{"outline": box(0.0, WIDE, 0.0, HIGH)}], {"held": False, "watch": [watched]})
