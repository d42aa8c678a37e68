"""Cases of the continuum that are scripts: each measures what its expected.toml says, and would say so if it did not.

Scripts run as they are, some with fewer of their methods: those that the rows speak of, and those that are twins.
"""

from collections.abc import Callable
from typing import Any

import pytest

from continuum_sph.validation.water import fluids as trials_fluids
from continuum_sph.water.parameters import Law
from porescale.output import case as cases
from porescale.output.case import expected, missed
from tests.reference.folders import CASES, script

pytestmark = pytest.mark.slow


@pytest.fixture
def concluded(tmp_path, monkeypatch) -> Callable[..., dict[str, float]]:
    """Runs the script of a case with ``words``, changed by ``change``; what it measured.  It has drawn a picture."""

    def run(name: str, *words: object, change: Callable[[Any], object] = lambda module: None) -> dict[str, float]:
        made, module = {}, script(name)
        change(module)

        def conclude(folder, numbers, figure, out):
            made.update(numbers)
            cases.draw(figure, out / "picture.png")
            return 0

        monkeypatch.setattr(module, "conclude", conclude)
        monkeypatch.setattr("sys.argv", [name, "--out", str(tmp_path), *map(str, words)])
        assert module.main() == 0
        assert (tmp_path / "picture.png").stat().st_size > 5_000
        return made

    return run


def only(**chosen: Any) -> Callable[[Any], None]:
    """Sets names of a script's module; of a table, only the entries in a list are left."""

    def change(module: Any) -> None:
        for name, value in chosen.items():
            own = getattr(module, name)
            setattr(module, name, {key: own[key] for key in value} if isinstance(own, dict) else value)

    return change


def test_a_bar_of_clay_bears_its_own_turning_with_repulsion_and_not_without(concluded):
    case = "clay_bar"
    numbers = concluded(case, change=only(PULLS=(0.0045,)))
    assert missed(CASES / case, numbers) == []
    # The twin that must fail: without repulsion the bar flies to pieces.
    (name,) = (row["name"] for row in expected(CASES / case))
    without = numbers[name.replace("with repulsion", "without")]
    assert missed(CASES / case, {name: without}) == [name]
    assert without > 10.0


def test_both_corrections_buy_what_their_case_says(concluded):
    case = "sph_corrections"
    numbers = concluded(case, change=only(METHODS=["Wendland's kernel, wider", "both"]))
    assert missed(CASES / case, numbers) == []


def test_sums_as_printed_miss_plates_and_corrections_that_are_none_miss_vortices(concluded, monkeypatch):
    # The twin that must fail: no number for the lattice; no correction in place of both, and both in place of none.
    def change(module: Any) -> None:
        vortices = module.vortices
        module.vortices = lambda name, *rest: vortices({"both": module.PLAIN}.get(name, "both"), *rest)
        module.METHODS = {name: module.METHODS[name] for name in (module.PLAIN, "both")}
        module.rest = lambda *_: (0.0, 0.0)  # no row speaks of it

    monkeypatch.setattr(Law, "lattice", 1.0)

    case = "sph_corrections"
    assert missed(CASES / case, concluded(case, change=change)) == [row["name"] for row in expected(CASES / case)]


def test_shear_keeps_stress_smooth_and_ground_at_rest_and_parting_keeps_particles_apart(concluded):
    case = "soil_stress_noise"
    none, sound, shear, parting = "corrected gradients", "diffusion by sound", "diffusion by shear", "and parting"
    numbers = concluded(case, change=only(METHODS=[none, sound, shear, parting]))
    assert missed(CASES / case, numbers) == []
    # The twins that must fail: without diffusion there is more noise than friction can bear; diffusion at the pace of
    # sound makes ground creep; without parting particles come nearer than kernels see.
    off = {
        "noise, and parting": numbers[f"noise, {none}"], "noise, diffusion by shear": numbers[f"noise, {none}"],
        "creep, and parting": numbers[f"creep, {sound}"], "nearest, and parting": numbers[f"nearest, {shear}"],
    }  # fmt: skip
    assert missed(CASES / case, off) == [row["name"] for row in expected(CASES / case)]


def test_a_drop_swings_in_the_time_that_its_viscosity_leaves_it(concluded):
    case = "oscillating_drop"
    numbers = concluded(case)
    assert missed(CASES / case, numbers) == []
    # The twins that must fail: the period without viscosity, and the jump of a sphere, 2σ/R.
    exact = trials_fluids.exact_period
    lamb = numbers["period"] * exact(0.2) / exact(0.2, viscous=False)
    assert missed(CASES / case, {"period": lamb, "pressure jump": 2.0}) == ["period", "pressure jump"]


def test_a_thick_column_is_slower_than_one_of_water_which_ends_level(concluded):
    case = "liquid_columns"
    assert missed(CASES / case, concluded(case)) == []


def test_two_columns_of_water_do_not_differ_and_are_not_level_at_once(concluded):  # the twin that must fail
    def change(module: Any) -> None:
        module.VISCOSITIES = dict.fromkeys(module.VISCOSITIES, 1.002e-3)
        module.SETTLED = 0.2

    numbers = concluded("liquid_columns", change=change)
    assert missed(CASES / "liquid_columns", numbers) == [row["name"] for row in expected(CASES / "liquid_columns")]
