"""The report of `check` on a scene before it runs."""

from continuum_sph.builders.reports.effect_report import warn_without_effect
from continuum_sph.builders.reports.seepage_report import seepage_report
from continuum_sph.builders.reports.soil_report import soil_report
from continuum_sph.builders.reports.suction_report import suction_report
from continuum_sph.builders.reports.water_report import water_report
from continuum_sph.scene.sections import Scene
from porescale.common.api.report import Report


def report(scene: Scene) -> Report:
    """Every derived number of a scene; raises InputError with all refusals."""
    if scene.soil is None:
        out = water_report(scene)
        warn_without_effect(scene, out)
        return out
    if scene.soil.suction is not None:
        out = suction_report(scene)
    else:
        out = soil_report(scene) if scene.dry else seepage_report(scene)
    warn_without_effect(scene, out)
    settle = 0.0 if scene.soil.held else scene.soil.numerics.settle
    if settle >= scene.time.end:
        out.warn(
            f"soil.numerics.settle = {settle:g} s: motion is braked to the end of the run, at {scene.time.end:g} s"
        )
    if settle == 0.0 and scene.soil.loads_from_none:
        out.warn(
            'soil.exponent from stress "none": diffusion of stress makes soil stiffer before its weight comes on, and '
            "it settles too little; give soil.numerics.settle a time until it rests, or soil.numerics.stress_diffusion"
        )
    return out
