"""Cases of soil and water that are scenes: another parameter misses the rows that speak of it, and only those."""

import pytest

from continuum_sph.cli import PACKAGE
from porescale import open_run
from porescale.common.cli.application import application, main
from tests.end_to_end.cases.test_cases import expected, missed
from tests.reference.folders import CASES

FLOW = {"flow at half of the critical gradient", "flow at nine tenths of the critical gradient"}
STRESS = {f"stress in the soil {name.removeprefix('flow ')}" for name in FLOW}
SUNK = {row["name"] for row in expected(CASES / "infiltration")}
LATER = {row["name"] for row in expected(CASES / "consolidation")} - {"the water bears all of the weight at the start"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("case", "setting", "names"),
    [
        ("upward_flow", "soil.permeability=5.2e-3", FLOW),  # 4 % of the flow; none of the stress
        ("upward_flow", "soil.density=1650", STRESS),  # grains 4 % heavier; none of the flow
        ("infiltration", "soil.permeability=0.035", SUNK),
        ("consolidation", "soil.permeability=1.2e-3", LATER),  # a fifth sooner
        ("consolidation", "soil.stress=geostatic", {row["name"] for row in expected(CASES / "consolidation")}),
    ],
)  # fmt: skip
def test_other_soil_misses_the_rows_that_speak_of_it(case, setting, names, tmp_path):
    out = tmp_path / "out"
    words = ["run", str(CASES / case), "--out", str(out), "--quiet", "--set", setting, "--set", "output.report=false"]
    assert main(application(PACKAGE), words) == 0
    found = missed(open_run(out).series, expected(CASES / case), open_run(out).table)
    assert {it.partition(":")[0] for it in found} == names
