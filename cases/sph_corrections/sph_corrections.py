"""What each correction to the printed method buys: vortices, flow between plates, water at rest, method by method."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from continuum_sph import Scene
from continuum_sph.builders import water_flow
from continuum_sph.validation.water import channels, flows, setups
from continuum_sph.water import Flow, Layer, Smoothing, Tait
from porescale import GRAVITY
from porescale.common.neighbors import PairList
from porescale.output import conclude, options, stage

HERE = Path(__file__).resolve().parent
PLAIN = "Wendland's kernel, wider"
METHODS: dict[str, dict[str, float | str | int]] = {
    "as printed": {
        "kernel": "cubic", "smoothing_ratio": 1.0, "smoothing_length": "evolved", "density_filter": 30,
        "density_diffusion": 0.0, "artificial_viscosity": 0.001,
    },
    "density diffusion": {"kernel": "cubic", "smoothing_ratio": 1.0, "artificial_viscosity": 0.001},
    PLAIN: {"artificial_viscosity": 0.001},
    "corrected gradients": {"artificial_viscosity": 0.001, "gradient": "corrected"},
    "shifting": {"artificial_viscosity": 0.001, "shifting": 2.0},
    "both": {"artificial_viscosity": 0.001, "gradient": "corrected", "shifting": 2.0},
}  # fmt: skip
"""Settings of [numerics]; walls of the paper in the first, in a tank."""


def chosen(flow: Flow, name: str, alpha: float = 0.0) -> Flow:
    """``flow`` with the choices of a method, ready for its first step; walls and viscosity are those it has."""
    scene = setups.column_scene(0.05, tank=(1.0, 1.0), column=(0.5, 0.5), **METHODS[name])  # type: ignore[arg-type]
    law, layer, pairs = water_flow(scene).law, flow.layer, flow.pairs
    law = replace(
        law, spacing=flow.law.spacing,
        smoothing=Smoothing(law.smoothing.name, scene.numerics.smoothing_ratio * flow.law.spacing),
        fluids=flow.law.fluids, gravity=flow.law.gravity, alpha=alpha, sticky=flow.law.sticky, cut=False,
    )  # fmt: skip
    fresh = Layer(layer.fluid, layer.x, layer.v, layer.mass, layer.density, layer.material)
    listed = PairList(layer.count, pairs.skin, pairs.lower, pairs.upper, pairs.periodic, full=True)
    made = Flow(fresh, law, listed)
    made.start()
    return made


def vortices(name: str, across: int, end: float) -> float:
    """Relative error of the speed of Taylor's and Green's vortices at ``end`` (s), Reynolds number 100."""
    flow = chosen(flows.taylor_green(across, 100.0), name)
    start = setups.kinetic_energy(flow)
    setups.run_until(flow, end)
    return abs(float((setups.kinetic_energy(flow) / start) ** 0.5 / np.exp(-0.08 * np.pi**2 * flow.time)) - 1.0)


def plates(name: str, across: int) -> float:
    """Largest error of a flow between plates after a second, over its speed."""
    flow = setups.run_until(chosen(channels.channel(1e-3, across, 1e-6, 1e-3, force=1e-4), name), 1.0)
    y, u = channels.speed_profile(flow)
    return float(np.abs(u - channels.poiseuille(y, flow.time, 1e-3, 1e-4, 1e-6)).max()) / 1.25e-5


def rest(name: str, rows: int, seconds: float) -> tuple[float, float]:
    """(error of pressure over that at the floor, root mean square; fastest particle over the speed of sound) of a
    column of water at rest after ``seconds``."""
    scene = setups.column_scene(1.0 / rows, tank=(0.5, 1.2), column=(0.5, 1.0), **METHODS[name])  # type: ignore[arg-type]
    table = scene.model_dump()
    if name == "as printed":
        table["tank"]["wall_particles"] = "images"
    flow = setups.run_until(water_flow(Scene(**table)), seconds)
    layer, state = flow.layer, flow.law.state
    assert isinstance(state, Tait)
    n = layer.fluid
    exact = state.pressure(state.settled_density(1.0 - layer.x[:n, 1], GRAVITY))
    wrong = np.sqrt(np.mean((state.pressure(layer.density) - exact) ** 2)) / (state.density * GRAVITY)
    return float(wrong), float(np.hypot(layer.v[:n, 0], layer.v[:n, 1]).max()) / state.sound_speed


def measure(across: int = 30) -> dict[str, list[float]]:
    """For each method: errors of vortices and plates, error of pressure and speed at rest."""
    return {
        name: [vortices(name, across, 0.25), plates(name, 20), *rest(name, 20, 2.0)] for name in METHODS
    }  # fmt: skip


def main() -> int:
    """Measure, say, draw; 1 if a row of expected.toml is missed."""
    given = options(__doc__ or "", HERE, across=(int, 30, "particles in a period of the vortices", 7))
    found = measure(given.across)
    figure, axes = stage(4, 10.0, 3.2)
    titles = ("vortices", "flow between plates", "pressure at rest", "speed at rest / c0")
    for k, (axis, title) in enumerate(zip(axes, titles, strict=True)):
        axis.barh(list(found)[::-1], [max(numbers[k], 1e-5) for numbers in found.values()][::-1], color="#5b8fd0")
        axis.set(xscale="log", xlim=(5e-4, 1.0), title=title)
        if k:
            axis.set_yticklabels([])
    print(f"{'':22}" + "".join(f"{title:>22}" for title in titles))
    for name, numbers in found.items():
        print(f"{name:22}" + "".join(f"{number:22.4f}" for number in numbers))
    measured = {
        "vortices, both": found["both"][0],
        "vortices, plain gradients without shifting": found[PLAIN][0],
        "plates, plain gradients": found[PLAIN][1],
    }
    return conclude(HERE, measured, figure, given.out)


if __name__ == "__main__":
    raise SystemExit(main())
