"""An endless slope under water let go, of grains and of the soil that they make; what slows it, read alike of both.

On STEEP both slide.  What the layer gains in momentum, grains and water together, is its buoyant weight along the slope
less what the floor takes; the floor bears the buoyant weight across: their ratio is the friction.  On FLAT, below the
limit tan β = sin φ of soil that shears without dilatancy, 14.6°, both rest.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from compared import Compared, half, half_of
from matplotlib.axes import Axes

import continuum_sph as cs
import porescale as ps
from continuum_sph.builders import material_of
from continuum_sph.validation.seepage import wet_slopes
from porescale import GRAVITY

HERE = Path(__file__).resolve().parent
STEEP, FLAT = 19.0, 13.0  # degrees
FROM, TO = 0.2, 0.6
"""s between which the acceleration is taken, when grains have found the porosity at which they slide; and when the
speed is."""
RESTING = 3  # packings on FLAT: none of them may move
DEPTH = 0.04  # m
ROWS = (10, 20, 40)  # of soil over the depth
FEW = 10  # rows of soil whose numbers are varied
RATED = "soil.material=rates.toml", "soil.rate={}"
"""Settings of ground.toml with friction that grows with the rate of shear."""
SOUND = 10.0
"""Speed of sound of the water in the soil's pores, of √(g H)."""
NAME = "friction of a slope under water"
INTERVALS = {
    "soil.friction_angle": "critical_friction_angle", "soil.rate.friction_angle": "fastest_shear_friction_angle",
    "soil.rate.inertial_number": "inertial_number_of_half_the_growth",
}  # fmt: skip
"""Numbers of the material whose intervals leave friction open: key of a scene, name in the file."""


@dataclass(frozen=True)
class Slide:
    """A layer that was let go.  friction : τ/σ' by its acceleration between FROM and TO;  speed : of the grains, or the
    soil, at TO, m/s."""

    friction: float
    speed: float


def grains_slide(seed: int, degrees: float, settings: Sequence[str] = ()) -> Slide:
    """The layer of slope.toml with another packing, on a slope of ``degrees``, with ``settings``."""
    tilt = math.radians(degrees)
    turned = f"gravity=[{GRAVITY * math.sin(tilt)!r}, {-GRAVITY * math.cos(tilt)!r}]"
    given = [turned, f"grains.packing.seed={seed}", f"time.end={TO!r}", *settings]
    simulation = ps.build(ps.load(HERE / "slope.toml", quality="draft", settings=given))
    scene, marks = simulation.scene, []
    assert scene.grains
    assert scene.fluid
    assert simulation.coupled
    for time in (FROM, TO):
        simulation.advance(round((time - simulation.time) / simulation.step_seconds))
        marks.append((simulation.time, float(simulation.coupled.momentum()[0])))
    (t0, before), (t1, after) = marks
    free = slice(len(simulation.masses) - len(scene.disc))
    mass, speed = simulation.masses[free], simulation.motion()[1][free, 0]
    weight = GRAVITY * float(mass.sum()) * (1.0 - scene.fluid.density / scene.grains.density)
    held = (weight * math.sin(tilt) - (after - before) / (t1 - t0)) / (weight * math.cos(tilt))
    return Slide(held, float(np.average(speed, weights=mass)))


def layer(rows: int, degrees: float, settings: Sequence[str] = ()) -> wet_slopes.WetSlope:
    """The same layer of the soil of material.toml, with its own stiffness and ``settings`` of ground.toml."""
    fluid, soil = ps.load(HERE / "slope.toml").fluid, cs.load(HERE / "ground.toml", settings=settings).soil
    assert fluid
    assert fluid.viscosity
    assert soil
    assert soil.origin
    known, it = soil.origin.measured, material_of(soil)
    return wet_slopes.WetSlope(
        degrees, False, rows, it.sin_friction, it.porosity, known["permeability"][0] * GRAVITY / fluid.viscosity,
        known["stiffness"][0], SOUND * math.sqrt(GRAVITY * DEPTH), DEPTH, it.density / (1.0 - it.porosity), it.poisson,
        it.rate,
    )  # fmt: skip


def soil_slides(given: wet_slopes.WetSlope) -> Slide:
    """A layer of soil."""
    gained, speed = given.slides(FROM, TO)
    return Slide(given.shown(gained), speed)


@dataclass(frozen=True)
class Slopes:
    """Layers on STEEP: of grains, one for each packing, of soil, one for each of ROWS, and of soil whose friction grows
    with the rate;  given : half of the interval that the material's own leaves to each of the latter;  resting : the
    largest speed on FLAT over the mean on STEEP, of grains and of soil."""

    grains: list[Slide]
    soil: list[Slide]
    rated: list[Slide]
    given: tuple[float, float]
    resting: tuple[float, float]

    def compared(self) -> list[Compared]:
        """Friction at both scales, with that of the material file, and growing with the rate."""
        grains = np.array([it.friction for it in self.grains])
        plain = Compared(NAME, "", grains, ROWS, np.array([it.friction for it in self.soil]), self.given[0])
        rated = np.array([it.friction for it in self.rated])
        return [plain, replace(plain, name=f"{NAME}, growing with the rate", soil=rated, given=self.given[1])]


def slopes(count: int) -> Slopes:
    """``count`` layers of grains and those of soil, on both slopes."""
    seeds = range(1, count + 1)
    steep = [grains_slide(seed, STEEP) for seed in seeds]
    flat = max(abs(grains_slide(seed, FLAT).speed) for seed in seeds[:RESTING])
    soil, rated = ([soil_slides(layer(rows, STEEP, it)) for rows in ROWS] for it in ((), RATED))
    lying = abs(soil_slides(layer(ROWS[-1], FLAT)).speed)
    resting = flat / float(np.mean([it.speed for it in steep])), lying / soil[-1].speed
    return Slopes(steep, soil, rated, (left_open(()), left_open(RATED)), resting)


def ends_of(settings: Sequence[str]) -> list[tuple[str, str]]:
    """A setting of ground.toml for either end of the interval of each number of friction that it has with
    ``settings``."""
    soil, ends = cs.load(HERE / "ground.toml", settings=settings).soil, []
    assert soil
    assert soil.origin
    for key, name in INTERVALS.items():
        if name in soil.origin.measured:
            mean, error = soil.origin.measured[name]
            off = half_of(error, len(soil.origin.made["seeds"]))
            ends.append((f"{key}={mean - off!r}", f"{key}={mean + off!r}"))
    return ends


def left_open(settings: Sequence[str]) -> float:
    """Half of the interval of the soil's friction on STEEP that those of its numbers leave, squared and added."""
    total = 0.0
    for ends in ends_of(settings):
        low, high = (soil_slides(layer(FEW, STEEP, (*settings, it))).friction for it in ends)
        total = math.hypot(total, 0.5 * (high - low))
    return total


def numbers_of_slopes(slid: Slopes | None) -> dict[str, float | None]:
    """The rows of expected.toml; None where no layer was asked for."""
    names = (
        "friction of a slope of grains under water", "friction of a slope of soil under water",
        "friction of soil that grows with the rate over that of grains",
        "speed of grains below the limit over that beyond it", "speed of soil below the limit over that beyond it",
    )  # fmt: skip
    if slid is None:
        return dict.fromkeys(names)
    plain, rated = slid.compared()
    mean = float(plain.grains.mean())
    return dict(zip(names, [mean, float(plain.soil[-1]), float(rated.soil[-1]) / mean, *slid.resting], strict=True))


def draw_slopes(panel: Axes, slid: Slopes | None, colours: Sequence[str]) -> None:
    """Friction over the spacing, in ``colours`` of grains, soil, and soil whose friction grows with the rate; an empty
    panel where no layer was asked for."""
    if slid is None:
        panel.axis("off")
        return
    plain, rated = slid.compared()
    mean, error = float(plain.grains.mean()), half(plain.grains)
    panel.axhspan(mean - error, mean + error, color=colours[0], alpha=0.3, lw=0, label="grains, mean, 95 %")
    panel.plot(np.zeros(len(plain.grains)), plain.grains, ".", color=colours[0], ms=4)
    for it, style, colour, label in (
        (plain, "s-", colours[1], "continuum"), (rated, "d--", colours[2], "growing with the rate")
    ):  # fmt: skip
        spacing = 1000.0 * DEPTH / np.array(it.rows)
        panel.errorbar(spacing, it.soil, it.given, fmt=style, color=colour, ms=4, capsize=3, label=label)
    panel.set(xlim=(-0.3, None), xlabel="spacing, mm", title="friction of a slope under water")
    panel.title.set_fontsize(9)
    panel.tick_params(labelsize=7)
    panel.legend(fontsize=6, frameon=False)
