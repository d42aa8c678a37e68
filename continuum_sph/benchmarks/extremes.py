"""What `continuum-sph study extremes` tries: each number from mild to absurd, in a flow that shows what it does."""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from continuum_sph.builders.parts.water import WaterPart
from continuum_sph.builders.report import report
from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from continuum_sph.validation.water import flows, setups
from continuum_sph.water.energy_budget import budget
from porescale.common.core.constants import GRAVITY
from porescale.common.evidence.extremes import Extreme, Extremes, Verdict
from porescale.common.schema.sections import validate

WATER = 1.002e-3  # Pa s
TANK, COLUMN = (1.5, 1.2), (0.5, 1.0)  # m, wide and high
FALL = (2.0 * GRAVITY * COLUMN[1]) ** 0.5  # m/s, from the top of the columns
CHECKED = 20  # steps between two checks of the state
JUDGED = 0.25  # s: the front of the columns has come half a metre, and has as far to go to the wall
SPACING = 0.05  # m
NEAR = 0.5 * SPACING  # m: particles of this size resolve a front no better
CLOSED = 0.01  # of the energy at the start: tolerance of the energy budget


def driven(model: Simulation, end: float, judged: bool = False) -> str | Verdict:
    """Take ``model`` to ``end`` (s) and state the outcome; Unstable where its state is out of bounds.

    judged : by how far water has run at JUDGED and by its energy budget."""
    model.flow.layer.keep_budget()
    start = budget(model.flow)["energy balance"]
    fastest, way = 0.0, None
    while model.time < end:
        model.advance(CHECKED)
        model.check()
        fastest = max(fastest, model.flow.max_speed)
        if way is None and model.time >= JUDGED:
            way = front(model)
    energy = budget(model.flow)["energy balance"] / start if start else 1.0
    n = model.flow.layer.fluid
    pressure = model.flow.layer.pressure[:n]
    outside = n - int(model.part(WaterPart).inside().sum())
    text = f"{model.step} steps to {model.time:.3g} s; fastest {fastest:.3g} m/s = {fastest / _sound(model):.2g} c0"
    text += f"; pressure {pressure.min():.3g} to {pressure.max():.3g} Pa; energy balance {energy:.3f} of the start"
    text += f"; {outside} particles outside" if outside else ""
    if not judged or way is None:
        return text
    off = way - mild_front()
    return Verdict(
        f"{text}; front at {JUDGED:g} s {100.0 * off:+.1f} cm from that at Mach 0.05 with everything else as it comes",
        abs(off) < NEAR and abs(energy - 1.0) < CLOSED,
    )


def front(model: Simulation) -> float:
    """How far the water has run, m, where it is to be at JUDGED: brought there at the speed of its first particle."""
    layer = model.flow.layer
    x = layer.x[: layer.fluid, 0]
    first = int(np.argmax(x))
    spacing: float = model.scene.numerics.spacing
    return float(x[first] + layer.v[first, 0] * (JUDGED - model.time)) + 0.5 * spacing


@cache
def mild_front() -> float:
    """The same of the mildest that is tried: sound twice as fast as it comes."""
    scene = setups.column_scene(SPACING, tank=TANK, column=COLUMN, pressure="released")
    water = scene.water.model_copy(update={"sound_speed": FALL / 0.05})
    model = Simulation(scene.model_copy(update={"water": water}))
    while model.time < JUDGED:
        model.advance(1)
    return front(model)


def _sound(model: Simulation) -> float:
    return float(model.flow.law.state.sound_speed)


def collapse(end: float = 0.8, lid: bool = True, judged: bool = True, **changes: Any) -> Callable[[], str | Verdict]:
    """COLUMN let go in TANK; changes of [water], [tank] (by name) and [numerics].  judged : as in `driven`."""
    tank = {"width": TANK[0], "height": TANK[1], "lid": lid}
    water = {
        "pressure": "released",
        "viscosity": changes.pop("viscosity", WATER),
        "column": [{"width": COLUMN[0], "height": COLUMN[1]}],
        "sound_speed": changes.pop("sound_speed", None),
    }
    numerics = {"spacing": SPACING, **changes}
    return lambda: _run(tank, water, None, numerics, end, judged)


def bubble(ratio: float, end: float = 0.1) -> Callable[[], str | Verdict]:
    """A disc of liquid ``ratio`` times lighter than the water around it, equally stiff, in a tank of 0.4 m."""
    tank = {"width": 0.4, "height": 0.6}
    water = {"column": [{"width": 0.4, "height": 0.4}]}
    light = {"density": 1000.0 / ratio, "viscosity": 1e-4, "law": "liquid"}
    light |= {"disc": [{"x": 0.2, "y": 0.16, "radius": 0.08}]}
    return lambda: _run(tank, water, light, {"spacing": 0.02, "shifting": 1.0}, end)


def _run(tank: Any, water: Any, inclusion: Any, numerics: Any, end: float, judged: bool = False) -> str | Verdict:
    """Check a scene of these sections as `run` does, and run it."""
    scene = validate(
        Scene,
        {
            "tank": tank,
            "water": water,
            **({"inclusion": inclusion} if inclusion else {}),
            "numerics": numerics,
            "time": {"end": end},
            "output": {"snapshot_interval": end, "series_interval": end},
        },
    )
    report(scene)
    return driven(Simulation(scene), end, judged)


def spun(tension: str, shifting: float) -> Callable[[], str]:
    """A square of water that spins in open space: its middle is in tension, `trials.spinning_square`."""

    def run() -> str:
        """A quarter turn: least pressure, how far it reaches, energies."""
        flow = flows.spinning_square(24, cut=tension == "cut", shifting=shifting)
        flow.layer.keep_budget()
        layer, start, pull = flow.layer, budget(flow)["energy balance"], 0.0
        while flow.time < 0.5 * np.pi:  # a quarter turn
            flow.advance()
            pull = min(pull, float(layer.pressure[: layer.fluid].min()))
        energy = budget(flow)["energy balance"] / start
        apart = float(np.abs(layer.x[: layer.fluid]).max())
        return f"a quarter turn; least pressure {pull:.3g} Pa; reaches {apart:.3g} m; energy balance {energy:.3f}"

    return run


def thrown(speed: float) -> Callable[[], str | Verdict]:
    """The collapse in a tank without a lid, its uppermost row thrown up (or down) at ``speed`` times sound."""

    def run() -> str | Verdict:
        """How it ends after half a second."""
        model = Simulation(setups.column_scene(SPACING, tank=TANK, column=COLUMN, pressure="released"))
        scene = model.scene.model_copy(update={"tank": model.scene.tank.model_copy(update={"lid": False})})
        model = Simulation(scene)
        layer = model.flow.layer
        top = layer.x[: layer.fluid, 1] > 0.95
        layer.v[: layer.fluid][top, 1] = speed * _sound(model)
        return driven(model, 0.5)

    return run


def broken() -> str | Verdict:
    """The collapse with a particle whose velocity is no number after 10 steps."""
    model = Simulation(setups.column_scene(SPACING, tank=TANK, column=COLUMN, pressure="released"))
    model.advance(10)
    model.flow.layer.v[7] = np.nan
    return driven(model, 0.5)


EXTREMES = Extremes(
    [
        *(Extreme("density ratio", f"{ratio:g} : 1", bubble(ratio)) for ratio in (1.0, 10.0, 100.0, 1000.0)),
        Extreme("density ratio", "10000 : 1", bubble(1e4, end=0.02)),  # steps go as its root
        *(
            Extreme("Mach number", f"{mach:g}", collapse(sound_speed=FALL / mach))
            for mach in (0.05, 0.1, 0.2, 0.3, 0.4)
        ),
        *(
            # boundary layers of √(νt) = 0.4 mm, 14 mm and 0.16 m: with the last it is another flow
            Extreme("viscosity / water", f"{times:g}", collapse(viscosity=times * WATER, judged=times < 1e5))
            for times in (0.0, 1.0, 1000.0, 1e5)
        ),
        Extreme("viscosity / water", "0, none artificial", collapse(viscosity=0.0, artificial_viscosity=0.0)),
        *(
            Extreme(f"neighbours, {kernel}", f"{np.pi * (2.0 * ratio) ** 2 - 1.0:.0f}",
                    collapse(kernel=kernel, smoothing_ratio=ratio))
            for kernel in ("wendland", "cubic")
            for ratio in (0.89, 1.0, 1.3, 1.6, 1.8)
        ),
        *(
            Extreme("negative pressure", f"{tension}, shifting {shifting:g}", spun(tension, shifting))
            for tension in ("kept", "cut")
            for shifting in (0.0, 2.0)
        ),
        Extreme("leaving the domain", "no lid", collapse(lid=False)),
        *(Extreme("leaving the domain", f"thrown up at {speed:g} c0", thrown(speed)) for speed in (0.3, 0.9)),
        *(Extreme("leaving the domain", f"thrown down at {speed:g} c0", thrown(-speed)) for speed in (0.3, 3.0)),
        Extreme("leaving the domain", "position lost", broken),
    ]
)  # fmt: skip
