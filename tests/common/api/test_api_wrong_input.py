"""Wrong input from Python: one line in the words of the field, no error of something inside."""

import pickle

import numpy as np
import pytest
from matplotlib.figure import Figure

import continuum_sph
import porescale
from porescale.common.core.errors import InputError
from tests.common.api.small import build, scene_of


def test_a_scene_of_another_kind_is_named():
    tank, dry = scene_of("tank"), scene_of("dry")
    for package, scene, said in [
        (porescale, tank, "continuum_sph.Scene"),
        (continuum_sph, dry, "porescale.Scene"),
        (porescale, "column_collapse", "str"),
    ]:
        for door in (package.build, package.check, package.run):
            with pytest.raises(InputError, match=f"^scene = '{said}': is no scene of"):
                door(scene)
    assert continuum_sph.check(tank)


@pytest.mark.parametrize("changes", [None, "time.end=1", ["time.end=1"]])
def test_changes_are_a_mapping(changes):
    with pytest.raises(InputError, match=r'write it as scene\.with_\({"time\.end": 0\.1}\)'):
        scene_of("dry").with_(changes)


@pytest.mark.parametrize("count", ["2", 1.5])
def test_a_number_of_threads_is_whole(count):
    with pytest.raises(InputError, match=r"^threads = .*out of range"):
        porescale.set_threads(count)


def test_times_and_steps_are_numbers():
    sim = continuum_sph.build(scene_of("tank"))
    for wrong in ({"until": "1 ms"}, {"seconds": [1.0]}, {"steps": "a"}, {"steps": float("inf")}):
        with pytest.raises(InputError, match=f"^{next(iter(wrong))} = "):
            sim.run(**wrong)
    for wrong in ({"seconds": "1 ms"}, {"steps": "a"}, {"steps": float("inf")}):
        with pytest.raises(InputError, match=rf"^every\.{next(iter(wrong))} = "):
            sim.every(**wrong)
    assert sim.run(steps=np.array(1)).step == 1
    assert sim.run(seconds=np.float32(1e-9)).time > 0.0


@pytest.mark.parametrize("row", [{"": 1.0}, {"a,b": 1.0}, {"a\nb": 1.0}, {"good": 1.0, 'a"b': 1.0}])
def test_a_column_has_a_name_that_a_table_can_have(row):
    sim = continuum_sph.build(scene_of("tank"))
    sim.every(steps=1)(measure_of(row))
    with pytest.raises(InputError, match="is no name of a column"):
        sim.run(steps=1)


def measure_of(row):
    """A measure that gives ``row``."""

    def measure(sim):
        return row

    return measure


def test_the_column_that_is_no_number_is_named():
    sim = continuum_sph.build(scene_of("tank"))
    sim.every(steps=1)(measure_of({"good": 1.0, "bad": "x"}))
    with pytest.raises(InputError, match="column 'bad' is no number"):
        sim.run(steps=1)


def test_a_measure_that_runs_the_simulation_is_refused():
    sim = continuum_sph.build(scene_of("tank"))

    @sim.every(steps=1)
    def running(sim):
        sim.run(steps=1)

    with pytest.raises(InputError, match="ran the simulation"):
        sim.run(steps=1)


def test_a_run_is_opened_by_its_package_and_goes_to_other_processes(tmp_path):
    run = porescale.run(scene_of("dry"), tmp_path, progress=False)
    other = continuum_sph.open_run(tmp_path)  # is read, but not painted
    assert np.array_equal(other[-1]["grains"].position, run[-1]["grains"].position)
    for paint in (other.picture, other.show, other.film, lambda: other[-1].picture()):
        with pytest.raises(InputError, match="holds a run of porescale, not of continuum-sph"):
            paint()
    assert other._repr_png_() is None
    assert run._repr_png_()
    run.picture()
    for copy in (pickle.loads(pickle.dumps(run)), pickle.loads(pickle.dumps(run[-1])).run):
        assert np.array_equal(copy[-1]["grains"].position, run[-1]["grains"].position)


@pytest.mark.parametrize("wrong", [None, 3, 3.5])
def test_what_is_no_path_is_refused_where_a_path_is_meant(wrong):
    for package in (porescale, continuum_sph):
        with pytest.raises(InputError, match=f"^scene = '{wrong}': is no path"):
            package.load(wrong)
        with pytest.raises(InputError, match=f"^folder = '{wrong}': is no path"):
            package.open_run(wrong)
    if wrong is not None:
        with pytest.raises(InputError, match=f"^out = '{wrong}': is no path"):
            porescale.run(scene_of("dry"), wrong)
        with pytest.raises(InputError, match=r"^settings = .*are no settings"):
            porescale.load("column_collapse", settings=wrong)


def test_a_file_to_write_is_a_path_and_a_snapshot_has_a_number(tmp_path):
    run = porescale.run(scene_of("dry"), tmp_path, progress=False)
    for write in (scene_of("dry").save, run.picture().save, run.film, run.figure):
        with pytest.raises(InputError, match=r"^path = '5': is no path \(int\); name a file$"):
            write(5)
    with pytest.raises(InputError, match=r"^out = '5': is no path \(int\); name a folder$"):
        run.measure(probe={"x": 0.1, "y": 0.02}, out=5)
    for wrong in ("0", 1.5, None):
        for read in (run.__getitem__, run.snapshot, run.picture):
            with pytest.raises(InputError, match=rf"^snapshot = '{wrong}': is no number of a snapshot"):
                read(wrong)
    with pytest.raises(InputError, match=r"^snapshot = 'a': is no number of a snapshot"):
        run["a":]
    assert run[np.int64(-1)].step == run[len(run) - 1].step
    assert len(run[:-1:1]) == len(run) - 1


@pytest.mark.parametrize("kind", ["dry", "tank"])
@pytest.mark.parametrize("steps", [3.0, -3, "3", None])
def test_steps_to_advance_are_a_whole_number_from_0_on(kind, steps):
    sim = build(scene_of(kind))
    with pytest.raises(InputError, match=f"^steps = '{steps}': is no number of steps .allowed: >= 0, whole"):
        sim.advance(steps)
    assert sim.step == 0
    sim.advance(np.int64(1))
    assert sim.step == 1


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        (3, "= '3': must be two numbers"),
        ((1.0, 2.0, 3.0), "must be two numbers"),
        ("ab", "= 'ab': must be two numbers"),
        ((0.3, 0.0), "must be low and high; exchange them"),
        ((float("nan"), 1.0), "is not finite"),
    ],
)
def test_limits_of_colours_are_a_low_and_a_high_number(limits, said):
    sim = build(scene_of("tank"))
    axes = Figure().add_subplot()
    with pytest.raises(InputError, match=f"^limits.*{said}"):
        sim.plot(axes, field="speed", limits=limits)
    with pytest.raises(InputError, match=f"^limits.*{said}"):
        sim.plot(axes, limits=limits)
    assert sim.plot(axes, field="speed", limits=(0.0, 0.3)) is axes


def test_completion_offers_sections_and_what_a_scene_can_do():
    scene = scene_of("dry")
    offered = set(dir(scene))
    assert {"time", "grains", "with_", "save", "to_dict", "source"} <= offered
    assert not {"model_fields", "dict", "construct", "parse_obj"} & offered
    assert all(hasattr(scene, name) for name in offered)


def test_a_contact_law_without_its_keys_says_what_to_write():
    with pytest.raises(InputError, match=r"contact_law = 'sticky': has no keys; write @contact_law\(keys="):

        @porescale.contact_law
        def sticky(overlap, closing, radius, mass, p):
            return overlap


def test_an_interrupted_run_can_be_caught_by_name():
    assert issubclass(porescale.Interrupted, porescale.PorescaleError)
    assert continuum_sph.Interrupted is porescale.Interrupted


def test_an_entry_of_a_list_that_is_not_there_is_named():
    scene = scene_of("tank")
    with pytest.raises(InputError, match="probe: is not in the scene; give the whole list"):
        scene.with_({"probe[0].x": 0.1})
    with pytest.raises(InputError, match=r"time\.end: is no list; give the whole list"):
        scene.with_({"time.end[0]": 1})
