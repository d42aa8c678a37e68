"""Soil in a tank as `porescale.common.record` drives it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.build.health import Leaps, refuse_beyond, refuse_no_numbers, refuse_one_place, refuse_step, stepped
from continuum_sph.build.soil_build import soil_flow
from continuum_sph.scene.sections import Scene
from continuum_sph.soil import SoilFlow, porosity
from continuum_sph.soil.parameters import RULES
from continuum_sph.soil.state import XX, XY, YY, ZZ
from porescale.common.record.model import Cloud, Snapshot

REPAIR = "raise soil.stiffness or soil.numerics.damping, or lower numerics.courant"
LEAST = float(np.finfo(np.float64).tiny)  # of what is above zero
DEEPEST = 0.5  # of a porosity at the start, left when soil is pressed together beyond sense


class SoilSimulation:
    """Model of a scene of soil; see `porescale.common.record.model.Model`."""

    variable_step = True

    def __init__(self, scene: Scene, flow: SoilFlow | None = None) -> None:
        """flow : that of the scene's soil where water has it made."""
        self.scene = scene
        self.flow: SoilFlow = flow or soil_flow(scene)
        self.first = self.flow.soil.x[: self.flow.soil.soil].copy()  # (soil, 2) m, where displacements count from
        self.counted = scene.soil is not None and scene.soil.numerics.settle == 0.0
        self.leaps = Leaps(self.flow.law.spacing)
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
            self.count()
            self.refresh()

    def count(self) -> None:
        """Displacements count from now if the soil has just settled."""
        if not self.counted and self.flow.time >= self.flow.law.settle:
            self.first[:] = self.flow.soil.x[: len(self.first)]
            self.counted = True

    def check(self) -> None:
        """Raise Unstable when soil is nowhere or where none could have come to, where another is, faster than its
        own sound, denser than its grains, under a stress that no blow makes, or when the next step is longer than it
        may be.
        """
        flow, soil, n, now = self.flow, self.flow.soil, self.flow.soil.soil, (self.step, self.time, REPAIR)
        recorded = {
            "position": ("m", soil.x[:n]), "velocity": ("m/s", soil.v[:n]), "density": ("kg/m³", soil.density),
            "mass": ("kg/m", soil.mass[:n]), "stress": ("Pa", soil.stress[:n]), "plastic strain": ("", soil.plastic),
            "opening": ("", soil.opening), "acceleration": ("m/s²", soil.acceleration),
        }  # fmt: skip
        refuse_no_numbers(recorded, *now, "soil particle")
        self.leaps.check(soil.x[:n], soil.mass[:n], *now)
        refuse_one_place(soil.x, np.arange(n), *now)
        sound = flow.pace * flow.law.smoothing.length
        for values, least, most, name, unit in (
            (soil.mass[:n], LEAST, np.inf, "mass", "kg/m"),
            (soil.density, LEAST, np.inf, "density", "kg/m³"),
            (porosity(soil.density, soil.material[:n], flow.table), -DEEPEST, 1.0, "porosity", ""),
            (np.hypot(soil.v[:n, 0], soil.v[:n, 1]), 0.0, sound, "speed", "m/s"),
            # A blow at the speed of sound is one of ρ c², the stress of a strain of one.
            (np.abs(soil.stress[:n]).max(axis=1), 0.0, soil.density * sound * sound, "stress", "Pa"),
            (soil.plastic, 0.0, np.inf, "plastic strain", ""),
            (soil.opening, 0.0, np.inf, "opening", ""),
        ):
            refuse_beyond(values, least, most, name, unit, np.arange(n), soil.x, *now)
        limits = flow.law.limits(float(np.hypot(*soil.acceleration.T).max(initial=0.0)), flow.pace, flow.limit)
        refuse_step(flow.next_step, limits, RULES, soil.x, soil.acceleration, soil.density, *now)

    def displacement(self) -> NDArray[np.float64]:
        """How far each particle has come since the start, or since it settled, (soil,) m."""
        moved: NDArray[np.float64] = np.hypot(*(self.flow.soil.x[: len(self.first)] - self.first).T)
        return moved

    def series(self) -> dict[str, float]:
        """One row: where the soil is, how it moves, how it bears its weight, and how the step was chosen."""
        flow, soil, n = self.flow, self.flow.soil, self.flow.soil.soil
        half, gravity = 0.5 * flow.law.spacing, -flow.law.gravity[1]
        x, v, mass, stress = soil.x[:n], soil.v[:n], soil.mass[:n], soil.stress[:n]
        volume, moved = mass / soil.density, self.displacement()
        weight = gravity * float((mass * x[:, 1]).sum())
        upright, across = float((volume * stress[:, YY]).sum()), float((volume * stress[:, XX]).sum())
        return {
            "time (s)": self.time,
            "step (s)": flow.next_step,
            "front (m)": float(x[:, 0].max()) + half,
            "highest soil (m)": float(x[:, 1].max()) + half,
            "largest displacement (m)": float(moved.max()),
            "mean displacement (m)": float(moved.mean()),
            "displacement of 95 % (m)": float(np.quantile(moved, 0.95)),
            "fastest (m/s)": float(np.hypot(v[:, 0], v[:, 1]).max()),
            "kinetic energy (J/m)": 0.5 * float((mass * (v * v).sum(axis=1)).sum()),
            "potential energy (J/m)": weight,
            "momentum x (kg/s)": float((mass * v[:, 0]).sum()),
            "stress upright over weight ()": upright / weight if weight > 0.0 else 0.0,
            "stress across over upright ()": across / upright if upright > 0.0 else 0.0,
            "plastic strain ()": float(soil.plastic.mean()),
            "volume (m2)": float(volume.sum()),
            "share come apart ()": float((soil.opening * volume / (1.0 + soil.opening)).sum() / volume.sum()),
            "mass (kg/m)": float(mass.sum()),
            "stops at walls ()": float(flow.stopped),
            **{f"steps limited by {rule} ()": float(k) for rule, k in zip(RULES, flow.limited, strict=True)},
        }

    def snapshot(self) -> Snapshot:
        """The soil as a cloud: velocity, displacement, stress, what yielded and what came apart."""
        soil, n = self.flow.soil, self.flow.soil.soil
        velocity = np.zeros((n, 3))
        velocity[:, :2] = soil.v[:n]
        stress = soil.stress[:n]
        data: dict[str, NDArray[Any]] = {
            "velocity": velocity,
            "displacement": self.displacement(),
            "mean_stress": 0.5 * (stress[:, XX] + stress[:, YY]),
            "stress_xx": stress[:, XX].copy(),
            "stress_yy": stress[:, YY].copy(),
            "stress_xy": stress[:, XY].copy(),
            "stress_zz": stress[:, ZZ].copy(),
            "plastic_strain": soil.plastic.copy(),
            "opening": soil.opening.copy(),
            "porosity": porosity(soil.density, soil.material[:n], self.flow.table),
        }
        units = {name: "Pa" for name in data if "stress" in name}
        units |= {"velocity": "m/s", "displacement": "m"}
        return Snapshot(self.time, self.step, clouds={"particles": Cloud(soil.x[:n].copy(), data, units)})

    def state(self) -> dict[str, Any]:
        """Everything that later steps depend on."""
        return {"flow": self.flow.state(), "first": self.first.copy(), "counted": self.counted}

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from a state of a model of the same scene."""
        self.flow.restore(state["flow"])
        self.first[:], self.counted = state["first"], bool(state["counted"])
        self.leaps.forget()
        self.refresh()
