"""[homogenise]: the specimen of a scene's packing that stands for the soil it makes, without walls and weight.

The grains of [grains.packing] (sizes, density, contact law, friction while they are packed) are pressed together in a
periodic cell until their mean stress is the pressure, then compressed along y at a constant rate under that stress
across: a biaxial test.  The rate follows from the inertial number I = rate √(m/p), m the mass of a mean grain (da Cruz
et al. 2005, Phys. Rev. E 72, 021309): quasi-static to I = 1e-3.
"""

import math
from typing import Any

from porescale.builders.initial.contact_laws import MaterialPlan, law_class
from porescale.builders.initial.packing import radii_of
from porescale.builders.scene import Scene
from porescale.common.core.errors import Fault, InputError
from porescale.common.schema.sections import scene_as_dict, validate
from porescale.dem.contact.linear import Linear
from porescale.dem.prepare.compaction import DEEPEST
from porescale.scene.measures.homogenise import Homogenise
from porescale.scene.packing import Packing

ROWS = 3000
"""Of the series of a test: some twenty before half of the strength is there."""
SNAPSHOTS = 24
FASTEST = 10.0
"""Largest rate under the stress across, over that along the test."""
SOLID = 0.83
"""Fraction by which a number of grains is turned into a size of the cell: that of a dense packing."""
WAVES = 10.0
"""Times that a wave crosses the cell while it is strained by the pressure over the contact stiffness."""
HARD = 300.0
"""Contact stiffness over pressure below which angles and porosity begin to follow it."""


def pressure_of(scene: Scene) -> float:
    """The stress (Pa) at which a scene's soil is measured: as given, as its packing is pressed, else as the weight of
    half the packing's height has it, buoyant where there is fluid."""
    section, packing = section_of(scene), packing_of(scene)
    if section.pressure is not None:
        return section.pressure
    if packing.pressure is not None:
        return packing.pressure
    lighter = scene.fluid.density if scene.fluid else 0.0
    weight = (MaterialPlan.of(scene).density(packing.material) - lighter) * abs(scene.gravity[1])
    return 0.5 * packing.packing_fraction * weight * packing.height


def section_of(scene: Scene) -> Homogenise:
    """[homogenise] of a scene, or its defaults."""
    return scene.homogenise or Homogenise.model_validate({})


def packing_of(scene: Scene) -> Packing:
    """The packing of a scene that has one."""
    assert scene.grains
    assert scene.grains.packing
    return scene.grains.packing


def mean_mass(scene: Scene) -> float:
    """Mass (kg/m) of a grain of the packing's mean diameter."""
    packing = packing_of(scene)
    return math.pi / 4.0 * packing.diameter**2 * MaterialPlan.of(scene).density(packing.material)


def require_measurable(scene: Scene) -> None:
    """InputError with what keeps a scene's grains from being homogenised."""
    faults = []
    if scene.grains is None or scene.grains.packing is None:
        repair = "add [grains.packing]: sizes, density and the way they are packed"
        raise InputError(Fault("grains.packing", None, "is missing: there is no packing to measure", repair=repair))
    if scene.contact and not law_class(scene.contact).compresses:
        problem = "packings are compressed under the linear law only"
        faults.append(Fault("contact.law", str(scene.contact.law), problem, repair='take "linear"'))
    for name in ("clump", "polygon", "segment", "rock", "bonds"):
        if getattr(scene, name):
            faults.append(Fault(name, None, "is not measured: specimens are of single discs", repair="leave it out"))
    if not faults and not pressure_of(scene) > 0.0:
        problem, repair = "is needed where weight presses nothing", "give the stress at which the soil is tested"
        faults.append(Fault("homogenise.pressure", None, problem, "Pa", "> 0", repair))
    if not faults and stiffness_over_pressure(scene) < 1.0 / DEEPEST:
        problem = f"would press grains into each other by {1.0 / stiffness_over_pressure(scene):.2g} of a diameter"
        repair = "raise contact.stiffness or lower it"
        most = f"<= {DEEPEST * stiffness_over_pressure(scene) * pressure_of(scene):.3g}"
        faults.append(Fault("homogenise.pressure", pressure_of(scene), problem, "Pa", most, repair))
    if faults:
        raise InputError(faults)


def homogenise_doubts(scene: Scene) -> list[str]:
    """Why `porescale homogenise` would refuse a scene with [homogenise], which runs without it; one line each."""
    if not scene.homogenise:
        return []
    try:
        specimen(scene)
    except InputError as error:
        return [f"porescale homogenise would refuse the scene: {fault.line()}" for fault in error.faults]
    return []


def stiffness_over_pressure(scene: Scene) -> float:
    """Contact stiffness k (N/m a metre) over the pressure: E follows it, angles do not where it is large."""
    return law_of(scene).stiffness / pressure_of(scene)


def law_of(scene: Scene) -> Linear:
    """The contact law of the packing's grains with each other."""
    law = MaterialPlan.of(scene).law_and_others(packing_of(scene).material, mean_mass(scene))[0]
    assert isinstance(law, Linear)  # as `require_measurable` holds
    return law


def lambda_error(scene: Scene) -> float:
    """By how much the hydraulic radius ratio of a scene may be off, relative; 0 where none is stated."""
    ratio = scene.grains.hydraulic_radius_ratio if scene.grains else None
    return section_of(scene).ratio_error / ratio if ratio else 0.0


def ramp_of(section: Homogenise, packing: Packing) -> float:
    """Rate times the time in which a test comes to it: slowly enough for stress to be even while contacts are loaded.

    A wave takes L √(ρ/k) through a cell of height L; a rate that grows evenly over T has strained it by p/k after
    √(2 T p/(rate k)), which WAVES of them make  rate T = WAVES² I² ρ L²/2m,  whatever k and p are.
    """
    grains = cell_of(section, packing)[1] ** 2 / (math.pi / 4.0 * packing.diameter**2)
    return 0.5 * WAVES**2 * section.inertial_number**2 * grains


def cell_of(section: Homogenise, packing: Packing) -> tuple[float, float]:
    """(width m, height m) of the cell that holds the chosen number of grains."""
    if packing.sizes:
        side = math.sqrt(sum(math.pi / 4.0 * d**2 * count for d, count in sizes_of(section, packing)) / SOLID)
    else:
        discs = section.grains * math.pi / 4.0 * (1.0 + packing.size_spread**2 / 3.0)
        side = packing.diameter * math.sqrt(discs / SOLID)
    if packing.grading or packing.log_spread is not None:  # by how many are drawn up for that side
        drawn = radii_of(packing.model_copy(update={"width": side, "height": side, "packing_fraction": SOLID}))
        assert drawn is not None
        side *= math.sqrt(section.grains / len(drawn))
    slender = math.sqrt(section.aspect_ratio)
    return side / slender, side * slender


def sizes_of(section: Homogenise, packing: Packing) -> list[list[float]]:
    """The given sizes of a packing, [diameter m, number], as many in all as are chosen, one or more of each."""
    every = sum(count for _, count in packing.sizes)
    return [[d, float(max(1, round(count / every * section.grains)))] for d, count in packing.sizes]


def specimen(scene: Scene) -> dict[str, Any]:
    """The tables of a scene that is one biaxial test of the grains of ``scene``; the seed is that of its packing.

    Raises InputError for what cannot be tested.
    """
    require_measurable(scene)
    section, packing = section_of(scene), packing_of(scene)
    pressure = pressure_of(scene)
    width, height = cell_of(section, packing)
    rate = section.inertial_number * math.sqrt(pressure / mean_mass(scene))
    ramp = ramp_of(section, packing) / rate
    end = section.strain / rate + 0.5 * ramp
    grains = {
        "diameter": packing.diameter, "size_spread": packing.size_spread, "seed": packing.seed,
        "settling_friction": packing.settling_friction if packing.gives("settling_friction") else None,
        "settling_rolling_friction": packing.settling_rolling_friction, "material": packing.material,
        "log_spread": packing.log_spread,
        "grading": [list(pair) for pair in packing.grading], "packing_fraction": SOLID,
        "sizes": sizes_of(section, packing),
    }  # fmt: skip
    for key in ("diameter", "packing_fraction") if packing.sizes else ("diameter",) if packing.grading else ():
        del grains[key]
    whole = scene_as_dict(scene)
    table = {
        "title": f"Biaxial test: {scene.title}".rstrip(": "),
        "gravity": [0.0, 0.0],
        "domain": {"width": width, "height": height, **dict.fromkeys(("left", "right", "bottom", "top"), "periodic")},
        "cell": {"rate_yy": [[0.0, 0.0], [ramp, -rate]], "stress_xx": pressure, "fastest": FASTEST * rate},
        "time": {"end": end},
        "output": {"snapshot_interval": end / SNAPSHOTS, "series_interval": end / ROWS},
        "grains": {
            "density": whole["grains"]["density"],
            "packing": {
                "left": 0.0, "width": width, "height": height, "pressure": pressure,
                **{key: value for key, value in grains.items() if value not in (None, [], "")},
            },
        },
        "contact": _given({**whole["contact"], "step": None}),
        "material": [_given(one) for one in whole["material"]],
    }  # fmt: skip
    table = {name: part for name, part in table.items() if part != []}
    try:
        validate(Scene, table)
    except InputError as error:
        raise error.in_file("the specimen that the scene describes") from None
    return table


def _given(table: Any) -> Any:
    """``table`` without what is None, empty or no list entry: what TOML can hold."""
    if isinstance(table, dict):
        return {key: _given(it) for key, it in table.items() if it is not None and it != [] and it != ""}
    return [_given(it) for it in table] if isinstance(table, list) else table
