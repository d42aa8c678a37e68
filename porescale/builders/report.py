"""The report of ``check`` on a scene: every derived number, the regime, the parts that will be built, and the cost."""

import math
from collections.abc import Sequence

import numpy as np

from porescale.analysis.homogenise import homogenise_doubts
from porescale.analysis.permeability import bed_of_spheres, gebart, kozeny_carman, ratio_for
from porescale.builders.checks.clear_packing import require_bonds, require_clear_packing
from porescale.builders.checks.device import device_of
from porescale.builders.cost import (
    memory,
    require_memory,
    seconds_on_gpu,
    snapshot_bytes,
    step_count,
    work,
)
from porescale.builders.derive import Derived, derive
from porescale.builders.initial.contact_laws import density_of_packing
from porescale.builders.initial.fluid_options import has_soft_rim, weight_of
from porescale.builders.initial.random_polygons import copies_of
from porescale.builders.kinds import SECTIONS
from porescale.common.api.report import Report, report_output, report_time
from porescale.common.duration.expected import STEPS, expected
from porescale.common.schema.own import own_laws
from porescale.coupling.solid.choose import SOLID_OPERATORS
from porescale.coupling.weighting.choose import WEIGHTINGS
from porescale.dem.contact.hertz import Hertz
from porescale.dem.contact.own import OwnContact
from porescale.lbm.collision.choose import OPERATORS
from porescale.scene.bodies.disc import Disc
from porescale.scene.bodies.segments import PolygonBody, SegmentBody
from porescale.scene.fluid import Fluid
from porescale.scene.grains import Grains
from porescale.scene.scene import Scene

WEEK = 7 * 86400.0
"""Seconds in a week."""
TIPS = 5
"""Cells for the tips at two corners of a polygon (``pointed``): those of 60 degrees take about 2, needles more."""
SPHERES = 0.4
"""Porosity of the bed of spheres that a bed of discs is compared with."""


def report(scene: Scene) -> Report:
    """All of the above; raises InputError with every refusal."""
    derived = derive(scene)
    require_memory(scene, derived)
    require_clear_packing(scene, derived)
    of_bonds = require_bonds(scene, derived)
    out = Report(scene.title or "scene")
    _parts(scene, out)
    if derived.scales:
        _lattice(derived, out)
    if scene.fluid:
        _operators(scene.fluid, bool(scene.grains or scene.disc or scene.rectangle or scene.ring), out)
    if scene.disc:
        _discs(scene.disc, derived, out)
    if scene.ring and derived.scales:
        out.heading("Ring")
        out.row("cells across", scene.ring.diameter / derived.scales.spacing, "", "each row of the box is partly solid")
        out.row("speed of its wall", 0.5 * abs(scene.ring.spin) * scene.ring.diameter, "m/s")
    if scene.grains:
        wanted = scene.permeability.wanted if scene.permeability else None
        _grains(scene.grains, derived.grain_count - len(scene.disc), derived, wanted, out)
        _contact(derived, density_of_packing(scene) / scene.grains.density, out)
    if next(own_laws(scene), None):
        _own_laws(scene, derived, out)
    if derived.corners:
        _frames(scene, derived, out)
    if scene.fluid and scene.grains:
        _regime(density_of_packing(scene), math.hypot(*scene.gravity), derived, out)
    _cost(scene, derived, out)
    for warning in (*derived.warnings, *of_bonds, *homogenise_doubts(scene)):
        out.warn(warning)
    return out


def _parts(scene: Scene, out: Report) -> None:
    out.heading("Parts")
    out.row("built", ", ".join(name for name in SECTIONS if getattr(scene, name)))
    out.row("absent, not built", ", ".join(name for name in SECTIONS if not getattr(scene, name)) or "none")
    out.row("sides", ", ".join(f"{name} {side.text()}" for name, side in scene.domain.sides.items()))


def _lattice(derived: Derived, out: Report) -> None:
    s, cells = derived.scales, derived.cells
    assert s is not None
    assert cells is not None
    out.heading("Lattice")
    out.row("cells", f"{cells[0]} x {cells[1]}")
    out.row("spacing", s.spacing, "m")
    out.row("step", s.step, "s")
    out.row("relaxation time", s.relaxation_time, "", "0.52 to 1 is best")
    out.row("viscosity", s.viscosity, "m²/s")
    out.row("speed of sound", s.sound_speed, "m/s")
    out.row("largest speed to expect", derived.speed, "m/s", "an estimate from energy and drag")
    out.row("Mach number", derived.speed / s.sound_speed, "", "below 0.1")


def _operators(fluid: Fluid, solid: bool, out: Report) -> None:
    """The laws that were chosen, with a word on each; ``solid`` : whether anything solid is in the fluid."""
    out.heading("Operators")
    out.row("collision", fluid.operator, "", OPERATORS[fluid.operator].purpose)
    out.row("magic parameter", fluid.magic, "", "3/16: walls half-way between nodes; 1/24: narrow gaps")
    out.row("Smagorinsky constant", fluid.smagorinsky or "none")
    if solid:
        out.row("solid", fluid.solid_operator, "", SOLID_OPERATORS[fluid.solid_operator].purpose)
        out.row("rim", "soft" if has_soft_rim(fluid) else "sharp", "", "soft: for grains that the fluid passes fast")
        out.row("weight", weight_of(fluid), "", WEIGHTINGS[weight_of(fluid)].purpose)
    out.row("precision", fluid.precision)


def _discs(discs: Sequence[Disc], derived: Derived, out: Report) -> None:
    out.heading("Held discs")
    out.row("number", len(discs), "", f"{sum(it.fastest > 0 for it in discs)} of them towed or turned")
    out.row("fastest", max(it.fastest for it in discs), "m/s")
    if derived.scales:
        least = min(it.diameter for it in discs)
        out.row("cells per diameter", least / derived.scales.spacing, "", "of the smallest")
        speed = max([derived.speed, *(it.fastest for it in discs)])
        out.row("Reynolds number", speed * max(it.diameter for it in discs) / derived.scales.viscosity, "",
                "U d/nu of the largest at the largest speed to expect")  # fmt: skip


def _grains(grains: Grains, count: int, derived: Derived, wanted: float | None, out: Report) -> None:
    assert derived.diameters is not None
    out.heading("Grains")
    out.row("number", count)
    low, mean, high = derived.diameters
    out.row("diameter", f"{low:.4g} … {high:.4g}, mean {mean:.4g}", "m")
    if derived.scales:
        ratio = grains.hydraulic_radius_ratio or 1.0
        out.row("cells per diameter", mean / derived.scales.spacing)
        out.row("cells per diameter of the smallest", low / derived.scales.spacing, "", "in the fluid: times lambda")
        out.row("hydraulic radius ratio", ratio, "", "lambda; 1 seals a 2-D bed at rest")
        out.row("cells per hydraulic diameter", ratio * mean / derived.scales.spacing)
        if packing := grains.packing:
            _bed(packing.packing_fraction * ratio**2, (0.5 * ratio * mean) ** 2, out)
            _lambda(grains, packing.packing_fraction, wanted, out)


def _frames(scene: Scene, derived: Derived, out: Report) -> None:
    """Bodies of segments, and what thickness they have."""
    many: dict[str, Sequence[SegmentBody | PolygonBody]] = {"segments": scene.segment, "polygons": scene.polygon}
    out.heading("Bodies of segments")
    for name, sections in many.items():
        out.row(name, sum(len(copies_of(it)) for it in sections))
    out.row("containers", len(scene.container), "", "kept out of the cells")
    out.row("corners", derived.corners, "", "a side costs up to ten discs")
    thin = [it.thickness for it in (*scene.segment, *scene.polygon)] + [it.thickness for it in scene.container]
    if thin:
        out.row("thickness", f"{min(thin):.4g} … {max(thin):.4g}", "m", "half of what a segment measures across")
        law = derived.law
        if isinstance(law, Hertz) and derived.grain_count > len(scene.disc) and derived.diameters is not None:
            radius = 0.5 * derived.diameters[1]
            share = math.sqrt(min(thin) / (radius + min(thin)))
            out.row(
                "stiffness at a side over that at a wall", share, "", "of a mean grain: sides are round, see shapes"
            )
    if scene.rock:
        out.row("rock", scene.rock.kind, "", "bonded when the run begins")


def _bed(solid_fraction: float, square: float, out: Report) -> None:
    """What regular arrays of that solid fraction let through; square : hydraulic radius squared, m²."""
    out.row("hydraulic solid fraction", solid_fraction, "", "lambda² times the packing fraction")
    out.row("permeability, hexagonal array", gebart(solid_fraction, hexagonal=True) * square, "m²", "Gebart 1992")
    out.row("permeability, Kozeny-Carman", kozeny_carman(solid_fraction) * square, "m²",
            "measured by [permeability]")  # fmt: skip


def _lambda(grains: Grains, packing_fraction: float, wanted: float | None, out: Report) -> None:
    """K over the grains' diameter², and which lambda gives that of spheres, and what is ``wanted``."""
    ratio = grains.hydraulic_radius_ratio or 1.0
    relative = 0.25 * ratio**2 * gebart(packing_fraction * ratio**2, hexagonal=True)
    out.row("K/d² by Gebart", relative, "", "d of the grains, not lambda d")
    targets = [("spheres", bed_of_spheres(SPHERES), f"of spheres at porosity {SPHERES:g}, Kozeny-Carman")]
    if wanted is not None:
        targets.append(("permeability.wanted", wanted, "wanted"))
    for what, target, whose in targets:
        found = ratio_for(target, packing_fraction)
        text = "none" if found is None else f"{found:.3f}"
        out.row(
            f"lambda for {what}",
            text,
            "",
            f"K/d² = {target:.3g} {whose}; by Gebart, K within a tenth at 0.8, a third at 0.9",
        )


def _contact(derived: Derived, heavier: float, out: Report) -> None:
    """Of mean grains, ``heavier`` than at the density of [grains]."""
    law, wall = derived.law, derived.wall_law
    assert law is not None
    assert wall is not None
    assert derived.diameters is not None
    assert derived.contact_limit is not None
    assert derived.contact_step is not None
    out.heading("Contact")
    mass = heavier * derived.mean_mass / 2
    radius = derived.diameters[1] / 4  # reduced, of two mean grains
    lasts, remark = law.contact_report(mass, radius)
    out.row("damping ratio of a pair", law.ratio_of_damping(mass, radius))
    out.row("contact time of a pair", lasts, "s", remark)
    out.row("restitution of a pair", law.restitution(mass, radius))
    out.row("restitution at a wall", wall.restitution(2 * mass, 2 * radius), "", "of a mean grain")
    out.row("stability limit in a packing", derived.contact_limit, "s")
    out.row("contact step", derived.contact_step, "s")
    out.row("contact steps per model step", derived.contact_steps or 1)


def _own_laws(scene: Scene, derived: Derived, out: Report) -> None:
    """The laws of a user's files, with their numbers; and what follows from a contact law for the smallest grains."""
    out.heading("Own laws")
    for key, it in own_laws(scene):
        out.row(key, it.reference, "", f"hash {it.hash}, of {', '.join(it.sources)}")
    law, contact = derived.law, scene.contact
    if not (isinstance(law, OwnContact) and contact and derived.diameters):
        return
    for (key, unit), number in zip(law.units.items(), law.numbers, strict=True):
        out.row(f"contact.{key}", number, unit)
    radius = derived.diameters[0] / 2
    mass = math.pi * radius**2 * (density_of_packing(scene) if scene.grains else 0.0)
    out.row("stiffest tangent", law.stiffest(mass, radius).stiffness[0], "N/m", f"up to {law.deepest:g} of a radius")
    fastest = law.fastest_impact(mass, radius)
    for speed in (0.01 * fastest, 0.1 * fastest, fastest):
        found = law.collision(mass / 2, radius / 2, speed)
        note = f"two smallest grains at {speed:.3g} m/s, restitution {found.restitution:.6g}"
        out.row("contact time", found.seconds, "s", note)


def _regime(density: float, gravity: float, derived: Derived, out: Report) -> None:
    """Of grains of a density (kg/m³) under a gravity (m/s²)."""
    s = derived.scales
    assert s is not None
    assert derived.diameters is not None
    d, ratio = derived.diameters[1], density / s.density
    reynolds = derived.speed * d / s.viscosity
    out.heading("Regime")
    out.row("density ratio", ratio, "", "grains over fluid")
    out.row("Archimedes number", abs(ratio - 1) * gravity * d**3 / s.viscosity**2, "", "(s - 1) g d³/nu²")
    out.row("Reynolds number", reynolds, "", "U d/nu at the largest speed to expect")
    out.row("Stokes number", ratio * reynolds / 18, "", "s Re/18: viscous below 1, inertial above 10")
    if derived.density_variation:
        out.row("density variation by pore pressure", derived.density_variation, "",
                "3 (rho_s - rho) g phi H/(rho c²), below 0.05")  # fmt: skip


def bytes_on_gpu(scene: Scene, derived: Derived) -> int:
    """Device memory that a run of the scene takes: of the fluid, and of bodies in it, grains as wide as the widest."""
    from porescale.coupling.coverage.polygon import SPARE
    from porescale.coupling.device import bodies
    from porescale.lbm.device.fluid import bytes_needed

    assert scene.fluid
    assert derived.cells
    assert derived.scales
    need, spacing = bytes_needed(*derived.cells, derived.precision), derived.scales.spacing
    grains, (polygons, longest) = derived.grain_count - len(scene.disc), derived.polygons
    widest = [derived.diameters[2]] * grains if derived.diameters else []
    rows = [math.ceil(it / spacing) + 2 for it in (*widest, *(it.diameter for it in scene.disc))]
    rows += [math.ceil(longest / spacing) + TIPS + SPARE] * polygons
    if rows:
        soft = has_soft_rim(scene.fluid)
        need += bodies.bytes_needed(*derived.cells, derived.precision, np.array(rows), polygons, soft=soft)
    return need


def _device(scene: Scene, derived: Derived, steps: int, on_cpu: float, out: Report) -> float:
    """What the GPU needs, what there is, and what it would gain; returns seconds on it, those on the CPU if unknown."""
    from porescale.common.compiled.cuda import describe, makers_bandwidth

    name, memory_bytes = describe()
    need = bytes_on_gpu(scene, derived)
    out.row("memory of the GPU", need / 2**20, "MiB", name)
    if memory_bytes and need > memory_bytes:
        out.warn(f"the GPU has {memory_bytes / 2**30:.1f} GiB: the run will not start there")
    told = expected(work(scene, derived, name))
    seconds, known = told.seconds[STEPS], "by the last runs of such scenes on it"
    if not told.measured:
        bandwidth = makers_bandwidth()
        if bandwidth is None:
            out.row("time on the GPU", "unknown", "", "nothing says how fast its memory is")
            return on_cpu
        seconds = seconds_on_gpu(derived, steps, bandwidth)
        known = f"at least: an estimate from the maker's figures, {bandwidth / 1e9:.4g} GB/s of memory; not measured"
    out.row("time on the GPU", seconds, "s", known)
    out.row(
        "gain of the GPU", on_cpu / seconds, "", "time on the CPU over that" + ("" if told.measured else ", at most")
    )
    return seconds


def _cost(scene: Scene, derived: Derived, out: Report) -> None:
    steps, told = step_count(scene, derived), expected(work(scene, derived))
    seconds = told.total
    out.heading("Cost")
    out.row("steps", steps, "", f"of {derived.model_step:.3g} s")
    out.row("memory", memory(scene, derived) / 2**20, "MiB")
    if device_of(scene) == "gpu" and derived.cells is not None:
        out.row("time on the CPU", told.seconds[STEPS], "s", told.known)
        seconds = _device(scene, derived, steps, told.seconds[STEPS], out)
    else:
        report_time(out, work(scene, derived))
    if seconds > WEEK:
        out.warn(
            f"the run is expected to take {seconds / 86400:.3g} days, more than a week; a coarser spacing, "
            "longer steps, softer contacts or an earlier end shorten it"
        )
    report_output(out, scene.time.end, scene.output, steps, snapshot_bytes(scene, derived))
