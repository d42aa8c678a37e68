"""A tank of water as `porescale.common.record` drives it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.build.bubble import bubble
from continuum_sph.build.build import flow_of, water_of
from continuum_sph.build.health import Leaps, refuse_beyond, refuse_no_numbers, refuse_one_place, refuse_step, stepped
from continuum_sph.build.health_fluids import bounds, swiftest_sound
from continuum_sph.build.instruments import Cloud, tables
from continuum_sph.scene.sections import Scene
from continuum_sph.water.energy_budget import book, held
from continuum_sph.water.parameters import RULES
from continuum_sph.water.step import Flow
from porescale.common.record.model import Cloud as Points
from porescale.common.record.model import Snapshot

REPAIR = "lower numerics.courant, or raise numerics.artificial_viscosity or water.sound_speed"


class Simulation:
    """Model of a scene; see `porescale.common.record.model.Model`."""

    variable_step = True

    def __init__(self, scene: Scene, flow: Flow | None = None) -> None:
        """flow : that of the scene's water where soil has it made."""
        self.scene = scene
        self.flow: Flow = flow or flow_of(scene)
        self.leaps = Leaps(scene.numerics.spacing)
        self.refresh()

    def refresh(self) -> None:
        """Steps done, time reached (s) and length of the next step (s), for whoever drives."""
        self.step: int = self.flow.step
        self.time: float = self.flow.time
        self.step_seconds: float = self.flow.next_step
        self.leaps.went(self.time, self.flow.swiftest)

    def advance(self, steps: int) -> None:
        """Do ``steps`` steps; Unstable when a position is no number any more."""
        for _ in range(steps):
            stepped(self.flow.advance, self.step, self.time, REPAIR)
            self.refresh()

    def inside(self) -> NDArray[np.bool_]:
        """Which water particles are in the tank, (fluid,)."""
        (width, height), x = self.scene.inner, self.flow.layer.x[: self.flow.layer.fluid]
        low = (x >= 0.0).all(axis=1)
        inside: NDArray[np.bool_] = low & (x[:, 0] <= width) & (x[:, 1] <= height)
        return inside

    def check(self) -> None:
        """Raise Unstable when a particle is nowhere, where none could have come to or where another is, when a fluid in
        the tank is faster than sound or of a density that means nothing, or the next step is longer than it may be.
        """
        flow, layer, law, now = self.flow, self.flow.layer, self.flow.law, (self.step, self.time, REPAIR)
        n = layer.fluid
        recorded = {
            "position": ("m", layer.x[:n]), "velocity": ("m/s", layer.v[:n]), "density": ("kg/m³", layer.density),
            "mass": ("kg/m", layer.mass[:n]), "pressure": ("Pa", layer.pressure[:n]), "energy": ("J/m", layer.energy),
            "acceleration": ("m/s²", layer.acceleration), "smoothing length": ("m", layer.length[:n]),
        }  # fmt: skip
        refuse_no_numbers(recorded, *now)
        self.leaps.check(layer.x[:n], layer.mass[:n], *now)
        refuse_beyond(layer.mass[:n], 0.0, np.inf, "mass", "kg/m", np.arange(n), layer.x, *now)
        inside = np.flatnonzero(self.inside())
        refuse_one_place(layer.x, inside, *now)
        speed = np.hypot(layer.v[inside, 0], layer.v[inside, 1])
        thin, dense, swift = (values[layer.material[inside]] for values in bounds(law.fluids))
        refuse_beyond(speed, 0.0, swift, "speed", "m/s", inside, layer.x, *now)
        refuse_beyond(layer.density[inside], thin, dense, "density", "kg/m³", inside, layer.x, *now)
        for rate in (layer.rate, layer.rate_before):  # a step on it is within bounds still
            most = (dense - thin) / flow.next_step if flow.next_step > 0.0 else np.inf
            refuse_beyond(np.abs(rate[inside]), 0.0, most, "density rate", "kg/(m³ s)", inside, layer.x, *now)
        hardest = float(np.hypot(*layer.acceleration.T).max(initial=0.0))
        sound = swiftest_sound(law.fluids, layer.material[:n], layer.density)
        limits = law.limits(hardest, float((sound / layer.length[:n]).max(initial=0.0)))
        refuse_step(flow.next_step, limits, RULES, layer.x, layer.acceleration, layer.density, *now)

    def series(self) -> dict[str, float]:
        """One row: where the water is, its energies, and how the step was chosen."""
        layer, tait = self.flow.layer, water_of(self.scene)
        n, half = layer.fluid, 0.5 * self.scene.numerics.spacing
        x, v, mass = layer.x[:n], layer.v[:n], layer.mass[:n]
        inside = self.inside()
        at = x[inside] if inside.any() else np.zeros((1, 2))
        speed2 = (v * v).sum(axis=1)
        energy = book(self.flow) if layer.booked else held(self.flow)
        return {
            "time (s)": self.time,
            "step (s)": self.flow.next_step,
            "front (m)": float(at[:, 0].max()) + half,
            "highest water (m)": float(at[:, 1].max()) + half,
            "mean height (m)": float((mass * x[:, 1]).sum()) / (float(mass.sum()) or 1.0),
            **{f"{name} (J/m)": value for name, value in energy.items()},
            "momentum x (kg/s)": float((mass * v[:, 0]).sum()),
            "fastest (m/s)": float(np.sqrt(speed2[inside].max())) if inside.any() else 0.0,
            "densest (kg/m3)": float(layer.density.max()) if n else tait.density,
            "mass (kg/m)": float(mass.sum()),
            "particles outside ()": float(int((mass > 0.0).sum()) - int(inside.sum())),
            "stops at walls ()": float(self.flow.stopped),
            **(bubble(self.flow) if self.scene.inclusion else {}),
            **{f"steps limited by {rule} ()": float(k) for rule, k in zip(RULES, self.flow.limited, strict=True)},
        }

    def tables(self) -> dict[str, dict[str, float]]:
        """A row of probes.csv and of levels.csv, where the scene asks for them."""
        scene, layer = self.scene, self.flow.layer
        if not (scene.probe or scene.level):
            return {}
        n = layer.fluid
        cloud = Cloud(
            layer.x[:n], layer.mass[:n] / layer.density, layer.pressure[:n], layer.v[:n],
            self.flow.law.smoothing.length, scene.numerics.spacing, scene.inner[0],
        )  # fmt: skip
        return tables(self.time, scene.probe, scene.level, cloud)

    def snapshot(self) -> Snapshot:
        """The water as a cloud: velocity, pressure, density."""
        layer = self.flow.layer
        n = layer.fluid
        velocity = np.zeros((n, 3))
        velocity[:, :2] = layer.v[:n]
        data: dict[str, NDArray[Any]] = {
            "velocity": velocity,
            "pressure": layer.pressure[:n].copy(),
            "density": layer.density.copy(),
        }
        if self.scene.inclusion:
            data["fluid"] = layer.material[:n].copy()
        units = {"velocity": "m/s", "pressure": "Pa", "density": "kg/m3"}
        cloud = Points(layer.x[:n].copy(), data, units)
        return Snapshot(self.time, self.step, clouds={"particles": cloud})

    def state(self) -> dict[str, Any]:
        """Everything that later steps depend on."""
        return {"flow": self.flow.state()}

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from a state of a model of the same scene."""
        self.flow.restore(state["flow"])
        self.leaps.forget()
        self.refresh()
