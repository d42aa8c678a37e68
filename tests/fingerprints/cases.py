"""Fingerprints of what lies under cases/: every scene, every script, decks by their scripts.

A scene.toml that is not named here is found by its place and taken with what most have.
"""

import tomllib

from tests.fingerprints.subjects import CASES, Scene, Script, Subject

GRAINS, CONTINUUM = "porescale", "continuum-sph"

SCENES: dict[str, tuple[str, int, str | None, tuple[str, ...]]] = {
    "bubble_in_water/scene.toml": (CONTINUUM, 150, "draft", ()),
    "clump/clump.toml": (GRAINS, 4000, None, ()),
    "collapsing_water_column/scene.toml": (CONTINUUM, 200, "draft", ()),
    "column_collapse/scene.toml": (
        GRAINS, 40, "draft", ("grains.packing.height=3 cm", "domain.height=4.8 cm", "gate.lift_speed=0.5"),
    ),
    "column_collapse_tank/scene.toml": (
        GRAINS, 60, "draft", ("domain.height=8 cm", "grains.packing.height=6 cm", "rectangle.0.starts_at=0"),
    ),
    "consolidation/scene.toml": (CONTINUUM, 100, None, ()),
    "cylinder_in_channel/scene.toml": (GRAINS, 200, "draft", ()),
    "dry_levee/scene.toml": (CONTINUUM, 100, "draft", ()),
    "dry_slope/scene.toml": (CONTINUUM, 200, "draft", ()),
    "geostatic_column/scene.toml": (CONTINUUM, 200, "draft", ()),
    "hydrostatic_column/scene.toml": (CONTINUUM, 200, "draft", ()),
    "infiltration/scene.toml": (CONTINUUM, 100, "draft", ()),
    "lid_driven_cavity/scene.toml": (GRAINS, 400, "draft", ()),
    "lifting_gate/scene.toml": (GRAINS, 200, "draft", ()),
    "loose_and_dense_collapse/scene.toml": (GRAINS, 60, "draft", ("gate.opens_at=0.001",)),
    "own_law/scene.toml": (GRAINS, 2000, None, ()),
    "permeameter/scene.toml": (GRAINS, 80, "draft", ()),
    "levee_by_suction/scene.toml": (CONTINUUM, 100, "draft", ()),
    "piston/scene.toml": (GRAINS, 200, "draft", ()),
    "rising_bubble/scene.toml": (CONTINUUM, 100, "draft", ()),
    "settling_disc/scene.toml": (GRAINS, 200, "draft", ()),
    "settling_square/scene.toml": (GRAINS, 200, "draft", ()),
    "soil_column_collapse/scene.toml": (CONTINUUM, 200, "draft", ()),
    "submerged_slope/scene.toml": (CONTINUUM, 150, "draft", ()),
    "taylor_couette/scene.toml": (GRAINS, 400, "draft", ()),
    "tipping_tray/scene.toml": (GRAINS, 2000, "draft", ()),
    "towed_cylinder/scene.toml": (GRAINS, 200, "draft", ()),
    "trapped_air/scene.toml": (CONTINUUM, 150, "draft", ()),
    "upward_flow/scene.toml": (CONTINUUM, 100, None, ()),
    "vortex_street/scene.toml": (GRAINS, 200, "draft", ()),
    "tumbling_plate/plate.toml": (GRAINS, 200, "draft", ()),
    "simple_shear/cell.toml": (GRAINS, 1000, None, ("grains.packing.height=10 cm", "domain.height=10 cm")),
    "biaxial_compression/specimen.toml": (
        GRAINS, 1000, None, ("grains.packing.height=20 cm", "domain.height=20 cm"),
    ),
    "micro_to_macro/bed.toml": (GRAINS, 60, "draft", ()),
    "micro_to_macro/column.toml": (GRAINS, 400, None, ()),
    "micro_to_macro/ground.toml": (CONTINUUM, 200, None, ()),
    "micro_to_macro/slope.toml": (GRAINS, 60, "draft", ()),
    "micro_to_macro/squeezed.toml": (GRAINS, 60, None, ()),
    "micro_to_macro/squeezed_ground.toml": (CONTINUUM, 200, None, ()),
    "rectangular_dam/scene.toml": (CONTINUUM, 150, None, ()),
    "saturated_levee/scene.toml": (CONTINUUM, 60, "draft", ()),
    "sheet_pile/scene.toml": (CONTINUUM, 100, None, ()),
    "sheet_pile_failure/scene.toml": (CONTINUUM, 60, "draft", ()),
}  # fmt: skip
"""Scene: package, steps, quality, settings that make it smaller."""

SCRIPTS: dict[str, Script] = {
    name: Script(f"{name}/{name}.py", steps)
    for name, steps in {
        "angle_of_repose": 15_000, "biaxial_compression": 15_000, "biaxial_element": 100,
        "block_pushed_by_soil": 15_000, "bouncing_disc": 2000, "chain_pulse": 1000, "clay_bar": 100,
        "clump": 3000, "demseg_chain": 2000, "demseg_clump": 2000, "demseg_control": 2000,
        "demseg_disc": 2000, "demseg_repose": 10_000, "demseg_segment": 2000, "demseg_triangle": 2000,
        "dry_column_collapse": 10_000, "grain_size": 10_000, "hanging_chain": 2000,
        "liquid_columns": 200, "micro_to_macro": 50, "oscillating_drop": 60, "rock": 15_000,
        "rolling_on_a_slope": 2000,
        "simple_shear": 15_000, "soil_stress_noise": 150, "sph_corrections": 100, "step_stability": 300,
        "tumbling_plate": 60, "turned_stressed_block": 150,
    }.items()
} | {
    "column_collapse_piv": Script("column_collapse_piv/column_collapse_piv.py", 4),
    "column_collapse_piv sweep": Script("column_collapse_piv/sweep.py", 4),
    "collapsing_water_column release": Script("collapsing_water_column/release.py", 150),
    "piv_cavity": Script("piv_cavity/piv_cavity.py", 150),
    "piv_synthetic": Script("piv_synthetic/piv_synthetic.py", pairs=6, arguments=("--seeds", "1")),
}  # fmt: skip

NO_SUBJECT = {
    "column_collapse_piv/filmed.py": "imported by the script beside it",
    "column_collapse_piv/variants.py": "imported by the script beside it",
    "column_collapse_table1/implied.py": "draws the numbers of a refusal",
    "column_collapse_table1/scene.toml": "is there to be refused",
    "collapsing_water_column/trade.toml": "of a study, not a scene",
    "column_collapse/lambda.py": "reads a sweep of the scene beside it",
    "column_collapse/levels.py": "reads sweeps of the scene beside it",
    "column_collapse/trade.toml": "of a study, not a scene",
    "consolidation/trade.toml": "of a study, not a scene",
    "dry_levee/safety.py": "reads a run of the scene beside it",
    "loose_and_dense_collapse/compare.py": "reads a sweep of the scene beside it",
    "micro_to_macro/compared.py": "imported by the script beside it",
    "micro_to_macro/consolidates.py": "imported by the script beside it",
    "micro_to_macro/falls.py": "imported by the script beside it",
    "micro_to_macro/flows.py": "imported by the script beside it",
    "micro_to_macro/layers.py": "imported by the script beside it",
    "micro_to_macro/material.toml": "read by ground.toml",
    "micro_to_macro/rates.toml": "read by slides.py",
    "micro_to_macro/slides.py": "imported by the script beside it",
    "micro_to_macro/trade.toml": "of a study, not a scene",
    "own_law/laws.py": "named by the scene beside it",
    "permeameter/trade.toml": "of a study, not a scene",
    "piv_synthetic/windows.py": "a study of the pairs of the script beside it",
    "rectangular_dam/trade.toml": "of a study, not a scene",
    "saturated_levee/trade.toml": "of a study, not a scene",
}
"""Files of cases that have no fingerprint of their own."""


def unnamed() -> dict[str, tuple[str, int, str | None, tuple[str, ...]]]:
    """Scenes of cases that SCENES does not name: of the continuum where they have a tank or soil."""
    files = sorted(it.relative_to(CASES).as_posix() for it in CASES.glob("*/scene.toml"))
    new = [it for it in files if it not in SCENES and it not in NO_SUBJECT]
    tables = {it: tomllib.loads((CASES / it).read_text(encoding="utf-8")) for it in new}
    return {
        it: (
            CONTINUUM if {"tank", "soil"} & set(tables[it]) else GRAINS, 100,
            "draft" if "draft" in tables[it].get("quality", {}) else None, (),
        ) for it in new
    }  # fmt: skip


def subjects() -> dict[str, Subject]:
    """All of cases by name."""
    found: dict[str, Subject] = {}
    for file, (package, steps, quality, settings) in (SCENES | unnamed()).items():
        found[f"scene/{file.removesuffix('.toml').removesuffix('/scene')}"] = Scene(
            package, steps, file, quality=quality, settings=settings
        )
    return found | {f"script/{name}": it for name, it in SCRIPTS.items()}
