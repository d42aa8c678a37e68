"""Segments, polygons and containers of dry scenes: what is built of them, how it moves, and what refuses them."""

import csv
import math
from typing import Any

import numpy as np
import pytest

from porescale import Scene
from porescale.builders.build import build
from porescale.builders.derive import derive
from porescale.builders.initial.frames import placed_frames
from porescale.builders.report import report
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import InputError, Unstable
from porescale.common.schema.names import names_of
from porescale.common.schema.sections import scene_as_dict, validate
from porescale.output.features import features_of
from tests.reference.scenes import grain, refusals, warned, water
from tests.reference.scenes_of_grains import BOX, assert_same_bits, framed, lines, loose, resumed

SQUARE = {"corners": [[0, 0], [1e-3, 0], [1e-3, 1e-3], [0, 1e-3]], "thickness": 5e-5}
FLOOR = {"chain": [[1e-3, 1e-3], [9e-3, 1e-3]], "thickness": 1e-4, "name": "floor", "record": True}


def test_a_scene_without_such_sections_builds_nothing_of_them():
    simulation = build(loose(grain(0.002, 0.002)))
    assert not simulation.grains.steered
    assert simulation.grains.segments is None
    assert simulation.grains.bonds is None
    assert simulation.frames == []
    assert list(simulation.snapshot().clouds) == ["grains"]
    assert not any("bond" in name for name in simulation.series())
    assert simulation.tables() == {}


def test_a_polygon_weighs_what_its_outline_holds():
    # Two turned copies of an L: area 3 mm^2 by hand, centroid (5/6, 5/6) mm of its corner, so all to some eps.
    corners = [[0, 0], [2e-3, 0], [2e-3, 1e-3], [1e-3, 1e-3], [1e-3, 2e-3], [0, 2e-3]]
    at, angle = [[2e-3, 2e-3], [8e-3, 2e-3]], [0.0, 0.5 * math.pi]
    simulation = build(framed(polygon=[{"corners": corners, "thickness": 1e-4, "at": at, "angle": angle}]))
    bodies = simulation.grains.steering.clumps
    assert bodies.mass == pytest.approx(2500 * 3e-6, rel=1e-12)
    assert bodies.position[0] == pytest.approx([2e-3 + 5e-3 / 6, 2e-3 + 5e-3 / 6], rel=1e-12)
    assert bodies.position[1] == pytest.approx([8e-3 - 5e-3 / 6, 2e-3 + 5e-3 / 6], rel=1e-12)


def test_order_is_clumps_then_segments_polygons_containers():
    pair = {"discs": [[-2e-4, 0, 3e-4], [2e-4, 0, 3e-4]], "at": [[5e-3, 5e-3]]}
    stick = {"ends": [[2e-3, 3e-3, 3e-3, 3e-3]], "thickness": 1e-4}
    scene = framed(
        clump=[pair], segment=[stick], polygon=[{**SQUARE, "at": [[4e-3, 2e-3], [6e-3, 2e-3]], "velocity": [0.1, 0]}],
        container=[FLOOR], disc=[grain(1e-2, 6e-3)], grains={"grain": [grain(8e-3, 4e-3)]},
        control=[{"polygon": 1, "rotation": {"velocity": 2.0}, "record": True}, {"segment": 0, "x": {"force": 1e-3}}],
    )  # fmt: skip
    simulation = build(scene)
    table = simulation.grains.steering.clumps
    assert [it.kind for it in simulation.frames] == ["segment", "polygon", "polygon", "container"]
    assert table.count == 5
    assert table.mass[1] == pytest.approx(2500 * 1e-3 * 2e-4, rel=1e-12)  # a rod, 1 mm by twice its thickness
    assert table.held.tolist()[3:] == [[0, 0, 1], [1, 1, 1]]
    assert table.velocity[2:4].tolist() == [[0.1, 0.0], [0.1, 0.0]]
    assert simulation.grains.held.any(axis=1).nonzero()[0].tolist() == [3]  # the grain, the clump's two, the disc
    clouds = simulation.snapshot().clouds
    assert len(clouds["grains"].position) == 4
    assert clouds["frames"].polygons[0].tolist() == [0, 4, 8]
    assert len(clouds["frames"].lines) == 2
    simulation.advance(200)
    row = simulation.tables()["control"]
    assert row["polygon 1 displacement rotation (rad)"] == pytest.approx(2.0 * simulation.time, rel=1e-12)
    assert row["floor displacement x (m)"] == 0.0
    stick_speed = float(simulation.grains.steering.clumps.velocity[1, 0])
    assert stick_speed == pytest.approx(1e-3 / table.mass[1] * simulation.time, rel=1e-9)
    text = str(report(scene))
    assert "segment, polygon" in " ".join(text.split())


@pytest.fixture(scope="module")
def resting():
    """A square and a disc that came to rest on a held floor."""
    scene = framed(
        polygon=[{**SQUARE, "at": [[4e-3, 1.1495e-3]]}], container=[FLOOR], contact__restitution=0.2,
        grains={"grain": [grain(7e-3, 1.5995e-3)]},
    )  # fmt: skip
    simulation = build(scene)
    simulation.advance(round(0.03 / simulation.step_seconds))
    return simulation


def test_a_container_bears_the_weight_of_what_stands_in_it(resting):
    # 30 ms are some 40 contacts, each of which keeps a fifth of the speed: nothing is left; forces of springs at rest
    # are the weights to round-off of the sums, of positions 1e-2 m at overlaps of 1e-7 m, eps 1e5.
    weight = 2500 * GRAVITY * (1e-6 + 0.25 * math.pi * 1e-6)
    row = resting.tables()["control"]
    assert row["floor contact force y (N/m)"] == pytest.approx(-weight, rel=1e-6)
    own = 2500 * GRAVITY * 8e-3 * 2e-4  # the floor weighs as rods as wide as it
    assert row["floor control force y (N/m)"] == pytest.approx(weight + own, rel=1e-6)
    book = resting.series()
    # First order in the step, some 20 steps a contact: a twentieth of what turned over, and much less at rest.
    assert abs(book["residual (J/m)"]) < 0.05 * book["turned over (J/m)"]


def test_what_moves_as_told_is_none_of_the_grains(resting):
    row = resting.series()
    assert row["front (m)"] == pytest.approx(7.5e-3, rel=1e-6)  # the disc, not the floor at 9 mm
    masses = np.array([1.0, 0.25 * math.pi])
    x = resting.grains.discs.position[0, 0], resting.grains.steering.clumps.position[0, 0]
    assert row["centre of mass x (m)"] == pytest.approx(float(masses @ x[::-1] / masses.sum()), rel=1e-12)


def test_a_run_with_a_tipping_container_goes_on_to_the_bit():
    tray = {"chain": [[3e-3, 4e-3], [3e-3, 2e-3], [6e-3, 2e-3], [6e-3, 4e-3]], "thickness": 1e-4,
            "pivot": [4.5e-3, 2.5e-3], "rotation": {"velocity": 30.0}, "name": "tray", "record": True}  # fmt: skip
    scene = framed(container=[tray], polygon=[{"sides": 6, "diameter": 6e-4, "thickness": 5e-5,
                                               "number": 4, "within": [3.2e-3, 2.2e-3, 5.8e-3, 3.9e-3]}])  # fmt: skip
    one, other = resumed(scene, 200, 400)
    assert_same_bits(one, other)
    for name in ("frames", "bonds"):
        assert (name in one.snapshot().clouds) == (name == "frames")
    np.testing.assert_array_equal(one.snapshot().clouds["frames"].position, other.snapshot().clouds["frames"].position)
    turned = one.tables()["control"]["tray displacement rotation (rad)"]
    assert turned == pytest.approx(30.0 * one.time, rel=1e-12)
    assert one.grains.discs.force[:30].any()  # they did meet
    assert validate(Scene, scene_as_dict(scene)) == scene


def test_containers_and_walls_have_one_name_in_pictures_tables_and_messages():
    trays = [{**FLOOR, "name": ""}, {**FLOOR, "chain": [[1e-3, 5e-3], [9e-3, 5e-3]]}]
    scene = framed(container=trays, wall=[{"x": 5e-4, "y": 4e-3, "normal": [1, 0]}],
                   grains={"density": 2500, "grain": [grain(3e-3, 3e-3)]})  # fmt: skip
    names = names_of(scene.container, "container")
    assert names == ["container 0", "floor"]
    assert [it.name for it in placed_frames(scene)] == names
    labels = [it.label for it in features_of(scene)]
    assert set(names) < set(labels)
    assert f"{names_of(scene.wall, 'wall')[0]}, stands" in labels


def test_polygons_at_random_are_the_same_for_the_same_seed():
    many = {"sides": 5, "diameter": 1e-3, "thickness": 5e-5, "number": 12, "within": [1e-3, 1e-3, 9e-3, 7e-3],
            "size_spread": 0.3}  # fmt: skip
    one, same, other = (
        [it.frame.corners for it in placed_frames(framed(polygon=[{**many, "seed": seed}]))] for seed in (3, 3, 4)
    )
    assert one == same != other
    assert len(one) == 12
    sizes = [max(math.dist(a, b) for a in it for b in it) for it in one]
    assert max(sizes) / min(sizes) == pytest.approx((1 + 0.3 * 11 / 12) / (1 - 0.3 * 11 / 12), rel=1e-9)


def refused(**changes: Any) -> list[str]:
    """The refusals of a box with what is told."""
    return lines(**{"grains": {"density": 2500, "grain": [grain(2e-3, 2e-3)]}, "domain": BOX, **changes})


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"polygon": [{**SQUARE, "at": [[1.9e-3, 1.9e-3]]}]}, "polygon[0] = '(0.0024, 0.0024)': lies across"),
        ({"polygon": [{**SQUARE, "at": [[2.53e-3, 1.9e-3]]}]}, "polygon[0] = '(0.00303, 0.0024)': overlaps grain 0"),
        ({"polygon": [{**SQUARE, "at": [[5e-3, 2e-3], [5.5e-3, 2.5e-3]]}]}, "polygon[0] = '(0.006, 0.003)': lies"),
        ({"polygon": [{**SQUARE, "at": [[5e-3, 2e-3], [5.2e-3, 2.2e-3]], "angle": [0, 0.3]}]}, "polygon[0] ="),
        ({"polygon": [{"corners": [[5e-3, 5e-3], [6e-3, 6e-3], [6e-3, 5e-3], [5e-3, 6e-3]], "thickness": 1e-4}]},
         "polygon[0].corners = 'corners 0 and 2': the polygon crosses itself"),
        ({"polygon": [{"corners": [[5e-3, 5e-3], [6e-3, 5e-3], [7e-3, 5e-3], [6e-3, 5e-3], [6e-3, 6e-3]],
                       "thickness": 1e-4}]},
         "polygon[0].corners = 'corners 1 and 2': the polygon goes out and back along one line: a spike"),
        ({"polygon": [{"corners": [[5e-3, 5e-3], [7e-3, 5e-3], [6e-3, 5e-3], [6e-3, 6e-3]], "thickness": 1e-4}]},
         "polygon[0].corners = 'corners 0 and 1': the polygon goes out and back along one line: a spike"),
        ({"polygon": [{"corners": [[5e-3, 5e-3], [6e-3, 6e-3]], "thickness": 1e-4}]}, "polygon[0].corners = 2: are"),
        ({"polygon": [{**SQUARE, "sides": 4, "diameter": 1e-3}]}, "polygon[0].corners, sides: exactly one"),
        ({"polygon": [{**SQUARE, "number": 3}]}, "polygon[0].within: is needed with the other"),
        ({"polygon": [{**SQUARE, "number": 999, "within": [4e-3, 4e-3, 8e-3, 7e-3]}]}, "polygon[0].number = 999: do"),
        ({"polygon": [{**SQUARE, "at": [[11.5e-3, 2e-3]]}]}, "polygon[0] = '(0.0125, 0.002)': reaches out of the box"),
        ({"polygon": [{**SQUARE, "thickness": 0, "at": [[5e-3, 2e-3], [8e-3, 2e-3]]}]},
         "polygon[0].thickness = 0.0 m: two segments without thickness go through each other (allowed: > 0 m)"),
        ({"polygon": [{**SQUARE, "held": True, "spin": 1, "at": [[5e-3, 2e-3]]}]}, "polygon[0].held: and a velocity"),
        ({"polygon": [{**SQUARE, "material": "ice", "at": [[5e-3, 2e-3]]}]}, "polygon[0].material = 'ice': no such"),
        ({"segment": [{"chain": [[5e-3, 5e-3]], "thickness": 1e-4}]}, "segment[0].chain = 1: are too few"),
        ({"segment": [{"thickness": 1e-4}]}, "segment[0].chain, ends: exactly one of the two"),
        ({"segment": [{"ends": [[5e-3, 5e-3, 6e-3, 5e-3]], "thickness": 0}]}, "segment[0].width: rods without"),
        ({"container": [{**FLOOR, "pivot": [0, 0], "y": {"force": 1.0}}]},
         "container[0].pivot: must lie amid the points of its segments, as a force moves it"),
        ({"container": [FLOOR], "gate": {"x": 4e-3}}, "gate: does not go with [[container]]"),
        ({"control": [{"polygon": 0}]}, "control[0].polygon = 0: there is no such polygon (allowed: none"),
        ({"control": [{"polygon": 0, "grain": 0}]}, "control[0].grain, clump, segment, polygon: exactly one"),
        ({"bonds": {"at": 1e9}}, "bonds[0].at = 1000000000.0 s: is past the end"),
        ({"bonds": {"bodies": ["stone"]}}, "bonds.bodies[0] = 'stone': names no body"),
        ({"bonds": {"factor": 2, "tension": 1}}, "bonds.tension = 1.0 N/m: says nothing beside factor"),
        ({"rock": {"kind": "cells"}}, "rock.gap: is missing"),
    ],
)  # fmt: skip
def test_bodies_of_segments_that_cannot_be_are_refused_by_name(changes, line):
    found = refused(**changes) if "pivot" not in str(changes) else _built(**changes)
    assert found[0].startswith(line), found


@pytest.mark.parametrize(("overlap", "bears"), [(0.1, 0.25e-4), (0.02, 0.2e-4), (0.0, 0.0)])
def test_a_body_may_start_pressed_into_a_side_by_as_much_as_into_another_body(overlap, bears):
    # A share of its 1 mm, and a quarter of its thickness of 0.1 mm.
    def at(depth: float) -> dict[str, Any]:
        corners = [[5e-3, 1e-4 - depth], [6e-3, 1e-4 - depth], [6e-3, 11e-4 - depth], [5e-3, 11e-4 - depth]]
        grains = {"density": 2500, "grain": [grain(2e-3, 2e-3)], "overlap": overlap}
        return {"polygon": [{"corners": corners, "thickness": 1e-4}], "grains": grains, "domain": BOX}

    derive(framed(**at(0.99 * bears)))
    (line,) = lines(**at(1.01 * bears + 1e-9))
    assert "reaches out of the box" in line


def _built(**changes: Any) -> list[str]:
    """Refusals that only come with the grains."""
    return refusals(lambda: build(framed(grains={"grain": [grain(2e-3, 2e-3)]}, **changes)))


def test_a_wet_scene_says_that_bonds_are_dry():
    with pytest.raises(InputError) as caught:
        water(bonds={}, grains={"density": 2500, "hydraulic_radius_ratio": 1.0}, contact={"stiffness": 1})
    assert any(fault.key == "bonds" and "dry" in fault.problem for fault in caught.value.faults)


def test_thin_bodies_at_speed_are_warned_of():
    def through(thickness: float, **law: Any) -> bool:
        at = {"at": [[2e-3, 2e-3], [4e-3, 6e-3]], "thickness": thickness}
        return bool(warned(framed(polygon=[{**SQUARE, **at}], **(law or {"contact__stiffness": 1e4})), "go through"))

    # 0.4 m/s and 2.5 g/m on 1e4 N/m go v sqrt(m/2k) = 0.14 mm deep.
    assert through(5e-5)
    assert not through(5e-4)
    # By Hertz's law (15 m v^2/32 E sqrt(R))^(2/5) with R = 25 um and E = 5e6/0.91/2: 0.18 mm.
    hertz = {"law": "hertz", "young": 5e6, "poisson": 0.3, "restitution": 0.5, "friction": 0.5}
    assert through(5e-5, contact=hertz)
    assert not through(5e-5, contact={**hertz, "young": 1e10})


def test_a_container_that_leaves_the_box_as_it_turns_is_warned_of_and_said_to_be_driven_there():
    def beyond(angle: float) -> list[str]:
        turn = {"rotation": {"displacement": [[0, 0], [0.01, angle]]}, "pivot": [2e-3, 1e-3]}
        scene = framed(container=[{**FLOOR, **turn}], grains={"grain": [grain(6e-3, 6e-3)]})
        return warned(scene, "leaves the box")

    # 7 mm from the pivot to its far end, 1 mm above the floor of the box, which it meets at asin(1/7) = 0.143 rad.
    assert beyond(-0.14) == []
    (said,) = beyond(-0.16)
    assert said.startswith("floor leaves the box at t = 0.009")
    turns = {"rotation": {"velocity": -150.0}, "pivot": [2e-3, 1e-3]}
    simulation = build(framed(container=[{**FLOOR, **turns}], grains={"grain": [grain(6e-3, 6e-3)]}))
    simulation.advance(round(0.01 / simulation.step_seconds))
    with pytest.raises(Unstable, match="its motion is prescribed"):
        simulation.check()


def test_a_polygon_behind_a_wall_is_refused():
    slope = {"x": 0.006, "y": 0.0, "normal": [-1.0, 1.0]}
    found = refused(wall=[slope], polygon=[{**SQUARE, "at": [[9e-3, 2e-3]]}])
    assert found == ["polygon[0] = '(0.009, 0.002)': stands across or behind wall[0] by 0.000757 m; move one of them"]


def test_lines_and_polygons_come_back_from_the_file(tmp_path):
    from porescale.common.record.vtkhdf import Readers, frames_of, join, write_frame

    simulation = build(framed(polygon=[{**SQUARE, "at": [[4e-3, 2e-3]]}], container=[FLOOR]))
    made = simulation.snapshot().clouds["frames"]
    paths = [tmp_path / f"{k}.vtkhdf" for k in range(3)]
    for k, path in enumerate(paths[:2]):
        write_frame(path, "frames", made, k, float(k))
    join(paths[2], [frames_of(path)[0] for path in paths[:2]])
    for k in range(2):
        with Readers() as readers:
            back = readers.of("frames", paths[2]).frame(k)
        np.testing.assert_array_equal(back.position, made.position)
        np.testing.assert_array_equal(back.lines, made.lines)
        for own, told in zip(back.polygons, made.polygons, strict=True):
            np.testing.assert_array_equal(own, told)


def test_vtk_sees_the_polygon_and_the_floor(tmp_path):
    from vtkmodules.vtkIOHDF import vtkHDFReader

    from porescale.common.record.vtkhdf import frames_of, join, write_frame

    simulation = build(framed(polygon=[{**SQUARE, "at": [[4e-3, 2e-3]]}], container=[FLOOR]))
    paths = [tmp_path / f"{k}.vtkhdf" for k in range(3)]
    for k, path in enumerate(paths[:2]):
        write_frame(path, "frames", simulation.snapshot().clouds["frames"], k, float(k))
        simulation.grains.discs.position[:4] += 1e-3
    join(paths[2], [frames_of(path)[0] for path in paths[:2]])
    reader = vtkHDFReader()
    reader.SetFileName(str(paths[2]))
    for k in range(2):
        reader.SetStep(k)
        reader.Update()
        seen = reader.GetOutput()
        assert (seen.GetNumberOfPolys(), seen.GetNumberOfLines(), seen.GetNumberOfVerts()) == (1, 1, 0)
        cells = [seen.GetCell(c) for c in range(seen.GetNumberOfCells())]
        by_points = {cell.GetNumberOfPoints(): cell for cell in cells}
        assert by_points[4].GetBounds()[0] == pytest.approx(4e-3 + k * 1e-3, abs=1e-9)
        assert by_points[2].GetBounds()[:2] == pytest.approx((1e-3, 9e-3), abs=1e-9)


def test_breaks_are_written_by_time_with_place_and_bodies(tmp_path):
    from porescale.builders.parts.bonds import BondsPart
    from porescale.output.breaks import write_breaks

    pull = {"velocity": 1e-3}  # a tenth of the strength in a period of these springs: in rest all the while
    row = [grain(2e-3, 2e-3), grain(2.9995e-3, 2e-3), grain(3.9985e-3, 2e-3)]
    scene = framed(
        grains={"grain": row}, bonds={}, gravity=[0, 0], contact__friction=0.0,
        control=[{"grain": 0, "x": {"velocity": 0.0}}, {"grain": 2, "x": pull, "record": True}],
    )  # fmt: skip
    simulation = build(scene)
    assert simulation.part(BondsPart)
    assert simulation.series()["bonds ()"] == 2.0
    simulation.advance(round(1.5e-3 / simulation.step_seconds))
    assert simulation.series()["broken bonds ()"] == 1.0
    cloud = simulation.snapshot().clouds["bonds"]
    assert cloud.data["whole"].tolist() == [0, 0, 1, 1]  # the shallower one, of half the strength

    class Run:
        def __len__(self) -> int:
            return 1

        def snapshot(self, k: int, cells: Any = None) -> Any:
            return simulation.snapshot()

    (path,) = write_breaks(Run(), tmp_path)  # type: ignore[arg-type]
    with path.open(encoding="utf-8") as file:
        (said,) = list(csv.DictReader(file))
    assert (said["body ()"], said["other body ()"]) == ("grain 0", "grain 1")
    assert float(said["strength (N/m)"]) == pytest.approx(2e5 * 5e-7, rel=1e-9)
    assert float(said["x (m)"]) == pytest.approx(2.5e-3, abs=2e-6)
    # Both bonds give alike until 2 * 0.5 um: 1 ms, and a quarter of a period, 0.2 ms, at the most.
    assert float(said["time (s)"]) == pytest.approx(1e-3, abs=2e-4)


def test_a_region_sees_the_exact_area_of_polygons_and_whom_they_touch(resting):
    from porescale.builders.parts.frame_measures import clipped_area, solid_in
    from porescale.dem.measures.region import Region

    frames, grains = resting.frames, resting.grains
    x, y = grains.steering.clumps.position[0]
    quarter = Region((float(x), float(y)), (8e-3, 8e-3))
    assert solid_in(grains, frames, quarter) == pytest.approx(0.25e-6, rel=1e-6)  # a corner of it; it leans by 1e-7
    assert resting.series()["coordination number ()"] == 1.0  # square and disc each stand on the floor
    arrow = np.array([[-8.0, -6.0], [0.0, -2.0], [8.0, -6.0], [0.0, 9.0]])
    # Below y = -4 two tips are left of the arrow: from the sides, which rise 15 in 8, and from the notch, 4 in 8.
    feet = clipped_area(arrow, Region((-9.0, -9.0), (9.0, -4.0)))
    assert feet == pytest.approx(2 * 0.5 * 2.0 * (2.0 * 8 / 4 - 2.0 * 8 / 15), rel=1e-12)


def test_pictures_of_contacts_show_discs_and_polygons_alike(tmp_path):
    from porescale.common.pictures.look import Look
    from porescale.output.grain_pictures import all_points, branches, chains, numbers, write_chains

    scene = framed(
        polygon=[{**SQUARE, "at": [[4e-3, 1.1495e-3]]}], container=[FLOOR], output__contacts=True,
        grains={"grain": [grain(7e-3, 1.5995e-3)]},
    )  # fmt: skip
    simulation = build(scene)
    simulation.advance(1)
    snapshot = simulation.snapshot()
    contacts = snapshot.clouds["contacts"]
    assert snapshot.clouds["grains"].data["contact_number"].tolist() == [1]
    # Two corners of the square stand on the floor, a contact each; their body has both, the floor all three.
    assert snapshot.clouds["frames"].data["contact_number"].tolist() == [2, 2, 2, 2, 3, 3]
    write_chains(tmp_path / "chains.vtp", snapshot)
    assert 'NumberOfLines="3"' in (tmp_path / "chains.vtp").read_text(encoding="utf-8")
    look = Look(view=(0.0, 0.012, 0.0, 0.008))
    for figure in (chains(snapshot, look), numbers(snapshot, look)):
        kinds = {type(it).__name__ for it in figure.axes[0].collections}
        assert {"EllipseCollection", "PolyCollection", "LineCollection"} <= kinds

    ends = branches(all_points(snapshot), contacts)
    assert ends[:, 1, 1] == pytest.approx(1e-3, abs=1e-6)  # each ends on the line of the floor


def test_a_disc_falls_into_a_thin_bucket_at_the_step_that_is_chosen():
    # It meets the floor at r + thickness, so a wall of a tenth of its radius does not limit its way in a step: it may
    # go r/10.  The step follows from the contact; at 0.4 m/s it makes more than 0.1 thicknesses, which stopped the run.
    # At rest it lies m g/k = 8e-7 m deeper than touching; what is left of its bounces is below 2e-5 m.
    bucket = {"chain": [[1e-3, 7e-3], [1e-3, 1e-3], [9e-3, 1e-3], [9e-3, 7e-3]], "thickness": 1e-4}
    disc = {**grain(5e-3, 5e-3, 2e-3), "velocity": [0.0, -0.4]}
    scene = loose(disc, domain=BOX, container=[bucket], contact={"stiffness": 1e5, "restitution": 0.1})
    simulation = build(scene)
    assert derive(scene).contact_step * 0.4 > 0.1 * bucket["thickness"]
    simulation.run(until=0.1)
    simulation.grains.check()
    assert simulation.positions[0, 1] == pytest.approx(1e-3 + 1e-4 + 1e-3, abs=2e-5)
    simulation.grains.discs.velocity[-1] = [0.3 * bucket["thickness"] / simulation.grains.last_dt, 0.0]
    with pytest.raises(Unstable, match=r"0\.2 of the smallest thickness in a step"):
        simulation.grains.check()


def test_the_step_is_short_enough_for_thin_corners():
    rod = {"chain": [[2e-3, 6e-3], [6e-3, 6e-3]], "width": 2e-5, "thickness": 2e-5, "velocity": [0.0, -2.0]}
    made = derive(framed(segment=[rod], contact={"stiffness": 1e4, "restitution": 0.5}))
    assert made.contact_step * made.speed <= 0.2 * rod["thickness"]
