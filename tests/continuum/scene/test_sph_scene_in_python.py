"""Scenes of continuum_sph from Python: the same as of porescale."""

import pytest

import continuum_sph as cs
import porescale as ps


def test_a_case_by_name_changed_and_made_again() -> None:
    scene = cs.load("collapsing_water_column", quality="draft")
    wider = scene.with_({"numerics.spacing": "1 cm", "water.viscosity": 2e-3})
    assert (wider.numerics.spacing, wider.water.viscosity) == (0.01, 2e-3)
    assert wider != scene
    assert wider == cs.load("collapsing_water_column", quality="draft", settings=wider.source.settings)
    assert cs.Scene(**scene.to_dict()) == scene
    assert cs.Scene(**{name: getattr(scene, name) for name in scene.model_fields_set}) == scene
    assert hash(scene) == hash(cs.load("collapsing_water_column", quality="draft"))


def test_faults_of_python_are_those_of_files() -> None:
    with pytest.raises(cs.InputError, match=r"tank\.widht = 1: unknown key; did you mean 'width'") as caught:
        cs.Scene(tank={"widht": 1}, numerics={"spacing": "1 s"})
    assert len(caught.value.faults) == 6  # width, height, time and output are missing, too
    with pytest.raises(cs.InputError, match="did you mean the case 'collapsing_water_column'"):
        cs.load("collapsing_water_colum")
    assert cs.InputError is ps.InputError
    assert cs.PorescaleWarning is ps.PorescaleWarning
