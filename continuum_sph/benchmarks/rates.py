"""Rate of weakly compressible water: a column on its way down, pair list rebuilds included."""

from dataclasses import replace
from typing import Any

from continuum_sph.builders.parts.soil import geostatic
from continuum_sph.builders.parts.water import water_flow
from continuum_sph.soil import Material
from continuum_sph.validation.seepage.saturated_box import saturated_box
from continuum_sph.validation.soil.setups import in_tank
from continuum_sph.validation.water.setups import column_scene
from porescale.common.core.errors import Fault, InputError
from porescale.common.evidence.benchmarks import Benchmarks, Dtype, Work
from porescale.common.neighbors import square_lattice

BENCHMARKS = Benchmarks()

SIZE = 20_000  # water particles
STEPS = 50
FALLEN = 200  # steps before timing: water in motion, list rebuilt at its usual rate


def collapsing(size: int | None, dtype: Dtype, **numerics: Any) -> Work:
    """Steps of a column of ``size`` particles on its way down, with choices of [numerics]; InputError for float32."""
    if dtype != "float64":
        raise InputError(Fault("--dtype", dtype, "smoothed particles have", allowed="float64"))
    count = size or SIZE
    across = max(8, round((count / 2) ** 0.5))
    flow = water_flow(column_scene(1.0 / across, tank=(4.0, 3.0), column=(1.0, 2.0), pressure="released", **numerics))

    def steps() -> None:
        """The steps that are timed."""
        for _ in range(STEPS):
            flow.advance()

    for _ in range(FALLEN // STEPS):
        steps()
    fluid = flow.layer.fluid
    return Work(steps, float(fluid * STEPS), "particles/s", fluid)


@BENCHMARKS.row("water")
def bench_water(size: int | None, threads: int, dtype: Dtype) -> Work:
    """Particle-steps of collapsing water, wall particles computed but not counted; InputError for float32."""
    return collapsing(size, dtype)


@BENCHMARKS.row("corrected")
def bench_corrected(size: int | None, threads: int, dtype: Dtype) -> list[Work]:
    """The same with corrected gradients, and with shifting beside them."""
    shifted = collapsing(size, dtype, gradient="corrected", shifting=2.0)
    return [collapsing(size, dtype, gradient="corrected"), replace(shifted, variant="shifted")]


@BENCHMARKS.row("seepage")
def bench_seepage(size: int | None, threads: int, dtype: Dtype) -> Work:
    """Particle-steps of both layers of a stirred, saturated box of elastic soil; InputError for float32."""
    if dtype != "float64":
        raise InputError(Fault("--dtype", dtype, "smoothed particles have", allowed="float64"))
    both = saturated_box(max(8, round(((size or SIZE) / 2) ** 0.5)), 1, speed=0.1, permeability=1e-3)
    count = both.water.layer.fluid + both.water.skeleton.count

    def steps() -> None:
        """The steps that are timed."""
        for _ in range(STEPS):
            both.advance()

    steps()
    return Work(steps, float(count * STEPS), "particles/s", count)


@BENCHMARKS.row("soil")
def bench_soil(size: int | None, threads: int, dtype: Dtype) -> Work:
    """Particle-steps of a collapsing column of soil, walls computed but not counted; InputError for float32."""
    if dtype != "float64":
        raise InputError(Fault("--dtype", dtype, "smoothed particles have", allowed="float64"))
    across = max(8, round((2 * (size or SIZE)) ** 0.5))
    spacing = 0.2 / across
    high = across // 2 * spacing
    material = Material(1e6, 2040.0, sin_friction=0.37)
    x = square_lattice((0.0, 0.0), (0.2, high), spacing)
    flow = in_tank(x, geostatic(high - x[:, 1], material), (0.6, 0.15), spacing, material)

    def steps() -> None:
        """The steps that are timed."""
        for _ in range(STEPS):
            flow.advance()

    for _ in range(FALLEN // STEPS):
        steps()
    return Work(steps, float(len(x) * STEPS), "particles/s", len(x))
