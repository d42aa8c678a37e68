"""The report of `check` on soil with suction before it runs."""

import math

from continuum_sph.builders.parts.soil import porous_section, soil_law, soil_particles
from continuum_sph.builders.parts.stiffness import largest_modulus
from continuum_sph.builders.parts.suction import longest_step, require_filled, retention_of, suction_section
from continuum_sph.builders.reports.seepage_report import report_stiffness
from continuum_sph.builders.reports.soil_report import soil_report
from continuum_sph.scene.bounds import WHOLE
from continuum_sph.scene.sections import Scene
from continuum_sph.unsaturated.richards import MOST_STAGES, SAFE, lattice_rate, stages_in
from porescale.common.api.report import Report
from porescale.common.core.constants import GRAVITY

FROM_EARTHS = 0.01  # of gravity: less is in no permeability that is measured
HALF = 0.5


def suction_report(scene: Scene) -> Report:
    """The soil's report, and how its water rises, sinks and limits steps; InputError for water that is too soft
    for its retention or too stiff for a step, or of which suction at the start leaves nothing."""
    section, suction, law = porous_section(scene), suction_section(scene), retention_of(scene)
    require_filled(scene, soil_particles(scene)[0][:, 1])
    porosity, (least, most) = section.porosity, section.permeabilities
    modulus, smoothing, spacing = largest_modulus(scene), soil_law(scene).smoothing, scene.numerics.spacing
    h = smoothing.length
    step = longest_step(scene)
    diffusivity = most * law.stiffness / (porosity * law.weight)
    longest = SAFE * spacing**2 / (diffusivity * lattice_rate(smoothing.kind, h / spacing))
    stages = stages_in(step / longest)
    out = soil_report(scene, step, stages)
    out.heading("suction")
    fringe = float(law.suction(HALF))
    out.row("capillary height", fringe, "m", "where S_e is a half, at rest over water")
    out.row("suction there", fringe * law.weight, "Pa")
    out.row("spacings in it", fringe / spacing)
    out.row("time to rise as high", porosity * fringe / least, "s", "about: n h/k")
    out.row("time to sink through the soil", porosity * section.height / least, "s", "n H/k")
    out.row("cohesion of half full pores at most", HALF * fringe * law.weight * math.tan(section.friction_angle), "Pa",
            "S_e psi tan phi")  # fmt: skip
    report_stiffness(out, law.stiffness, porosity * modulus, scene.water.density)
    out.row("longest step for sound in soil that cannot drain", step, "s")
    out.row("stages of flow in a step", stages, "", f"of full pores; more than {2 * MOST_STAGES} are several steps")
    if fringe < 2.0 * spacing:
        out.warn(f"the capillary height is {fringe / spacing:.2g} spacings: lower numerics.spacing")
    if abs(scene.gravity / GRAVITY - 1.0) > FROM_EARTHS:
        out.warn(
            f"with suction soil.permeability and alpha are those under the scene's gravity, {scene.gravity:g} m/s2, "
            f"not under {GRAVITY:g} m/s2 as in soil without: in a centrifuge of N g give N times k, and N times alpha"
        )
    for warning in scene.meeting_strips():
        out.warn(warning)
    crest = section.height
    if any(it.highest > crest for it in scene.reservoir):
        out.warn("a level stands over the soil: open water is at rest, so it then stands on both sides of the soil")
    table = suction.water_table
    if table is not None and table > crest * (1.0 + WHOLE) and not any(it.highest >= table for it in scene.reservoir):
        out.warn(
            f"soil.suction.water_table = {table:g} m lies over the soil, {crest:g} m high, and no reservoir keeps "
            "water there: pores lose at once what stands over them"
        )
    if suction.saturation is not None and suction.saturation < 0.9 and any(it.highest > 0.0 for it in scene.reservoir):
        out.row("suction at the start", float(law.suction((suction.saturation - suction.residual)
                / (1.0 - suction.residual))), "m")  # fmt: skip
    return out
