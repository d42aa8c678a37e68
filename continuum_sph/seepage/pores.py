"""Pore water: a `Flow` coupled to the soil's particles; derivation: `continuum_sph.seepage`."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from continuum_sph.seepage.exchange import apply_drag, apply_reaction, relative_to_soil
from continuum_sph.seepage.mixture import (
    LINES,
    POROSITY,
    PULL_X,
    ROOM,
    SLIP_X,
    SLIP_Y,
    find_enclosed,
    gather_soil,
    keep_place_density,
    load_soil,
    mix_fluxes,
    open_gradients,
    share_forces,
)
from continuum_sph.seepage.overlap import Overlap, Reach
from continuum_sph.seepage.pressure_face import PressureFace, continue_behind, follow, prescribe_pressure
from continuum_sph.seepage.resistance import Resistance
from continuum_sph.seepage.sheet_pile import CutPairList
from continuum_sph.seepage.skeleton import Skeleton
from continuum_sph.seepage.swelling import add_swelling, gather_motion
from continuum_sph.seepage.volume_excess import PACE, Edges, excess_about_water, fill_about_soil, room_before, take_up
from continuum_sph.water.step import Flow
from porescale.common.compiled.simd import LANES
from porescale.common.core.types import Floats


@dataclass
class PoreFlow(Flow):
    """Water of a law among the grains of a skeleton.

    resistance : law of drag;  specific_weight (fluid,) N/m³, of several fluids, see `gather_soil`, or empty;  faces :
    faces of given pressure;  enclosing : (l,) numbers of the wall particles that continue the pressure of the water
    before them below zero, too, as no surface of it is near;  pores (15, fluid + LANES) what water particles have about
    them, see `mixture`;  excess (fluid,) of volume when pairs were listed last, see `volume_excess`;  borne (soil, 2)
    N/m, drag on the soil of the last half step;  heat (fluid + soil,) J/m, work that drag took from both layers.
    """

    skeleton: Skeleton = field(kw_only=True)
    overlap: Overlap = field(kw_only=True)
    resistance: Resistance = field(kw_only=True)
    specific_weight: Floats = field(default_factory=lambda: np.zeros(0), kw_only=True)
    faces: list[PressureFace] = field(default_factory=list, kw_only=True)
    enclosing: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64), kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        fluid = self.layer.fluid
        self.pores = np.zeros((LINES, fluid + LANES))
        self.pores[[POROSITY, ROOM]] = 1.0
        self.enclosed = np.zeros(fluid, np.bool_)
        self.home = self.layer.x.copy()  # of walls: where they stood at the start, grains reach no further
        self.thrust, self.push, self.parts = np.zeros((fluid, 4)), np.zeros((fluid, 2)), np.zeros((4, fluid + LANES))
        self.motion = np.zeros((0 if self.skeleton.swelling is None else fluid, 4))
        self.full, self.excess, self.corrected = np.zeros(self.skeleton.count), np.zeros(fluid), False
        self.borne = np.zeros((self.skeleton.count, 2))
        self.heat = np.zeros(fluid + self.skeleton.count)

    def start(self) -> None:
        """Rates of the initial state, and how open faces push the water there."""
        super().start()
        near = self.near(self.law.smoothing.kind)
        for face in self.faces:
            face.arrange(near, self.layer, self.gradients.matrix, self.law.spacing)

    def begin(self, step: float) -> float:
        """Begin a step as a flow of water alone does; particles behind open faces go along with it."""
        ratio = super().begin(step)
        layer, near, matrix = self.layer, self.near(self.law.smoothing.kind), self.gradients.matrix
        for face in self.faces:
            follow(face.columns, face.whole, face.slope, near, layer.x, layer.record, matrix, *face.normal)
        return ratio

    def evaluate(self, step: float, ratio: float) -> None:
        """Evaluate rates and forces of the mixture, as `Flow.evaluate` does; forces of the water on the soil beside."""
        layer, soil = self.layer, self.skeleton
        x, length = layer.x[: layer.fluid], self.law.smoothing.length
        new = self.overlap.update(x, soil.x)
        super().evaluate(step, ratio)
        self.thrust[:, :2] = x
        share_forces(
            layer.fluid, layer.mass, layer.acceleration, *self.law.gravity, self.pores, layer.rate, self.budget[0],
            self.thrust,
        )  # fmt: skip
        if soil.swelling is not None:
            self.swell(soil.swelling)
        if self.corrected:
            take_up(
                layer.fluid, layer.mass, layer.record, self.pores, self.excess, PACE / length, layer.rate,
                self.budget[0],
            )  # fmt: skip
        load_soil(
            layer.fluid, *self.overlap.rows, soil.x, soil.grains, self.thrust, soil.force, length, *self.pairs.period
        )  # fmt: skip
        if new:
            self.find_excess()

    def swell(self, swelling: Floats) -> None:
        """Let pores swell as the stress of soil that yields takes it to, see `swelling`."""
        layer, soil = self.layer, self.skeleton
        gather_motion(layer.fluid, *self.overlap.rows, soil.burden, swelling, self.pores, self.motion)
        add_swelling(
            layer.fluid, layer.record, self.near(self.law.smoothing.kind), self.gradients.matrix, layer.mass,
            self.pores, self.motion, layer.v, float(soil.x[:, 1].max()), layer.rate, self.budget[0],
        )  # fmt: skip

    def find_excess(self) -> None:
        """Overwrite ``excess`` with that of now."""
        layer, soil, law, rows = self.layer, self.skeleton, self.law, self.overlap.rows
        pile = (self.pairs.at, self.pairs.bottom, self.pairs.half) if isinstance(self.pairs, CutPairList) else None
        room = room_before(Edges(*self.edges_at(soil.x), pile), soil.x, law.spacing, law.smoothing.length)
        fill_about_soil(layer.fluid, *rows, layer.record, layer.material, room, self.full)
        excess_about_water(layer.fluid, *rows, soil.burden, layer.material, self.enclosed, self.full, self.excess)
        self.corrected = bool(self.excess.any())

    def edges_at(self, x: Floats) -> tuple[Floats, Floats]:
        """Lower and upper edges of the room of the water beside places ``x`` (s, 2), m: of the tank, (2,); (2, s) where
        it has faces, which go along with the water."""
        if not self.faces:
            return self.lower, self.upper
        lower, upper = (np.repeat(edge[:, None], len(x), axis=1) for edge in (self.lower, self.upper))
        for face in self.faces:
            way = face.passed(x, self.layer.x, self.home).T
            if max(face.normal) > 0.0:
                lower += way
            else:
                upper += way
        return lower, upper

    def sum_pairs(self, half: float) -> None:
        """Sum over pairs as `Flow.sum_pairs` does, for the mixture: gradients are corrected among grains alone."""
        if self.law.corrected:
            law, layer = self.law, self.layer
            open_gradients(
                layer.fluid, self.pores, layer.record, layer.matrix, self.gradients.density, law.lattice, *law.gravity
            )  # fmt: skip
        super().sum_pairs(half)
        if self.law.shifting > 0.0:
            keep_place_density(self.layer.fluid, self.pores, self.density_gradient, self.layer.drift, self.layer.rate)

    def update_walls(self, step: float, ratio: float) -> None:
        """Update walls, grains and open faces in the water's equations, a ``step`` (s) on."""
        super().update_walls(step, ratio)
        layer, pairs, smoothing = self.layer, self.pairs, self.law.smoothing
        how = (smoothing.length, *pairs.period)
        self.skeleton.show()
        gather_soil(
            layer.fluid, *self.overlap.rows, layer.record, layer.mass, self.skeleton.burden, self.resistance.gravity,
            self.specific_weight, self.pores, Reach(*how),
        )  # fmt: skip
        mix_fluxes(layer.fluid, pairs.start, self.split, pairs.partner, layer.record, self.home, self.pores, *how)
        find_enclosed(layer.fluid, self.pores, self.enclosed)
        for face in self.faces:
            prescribe_pressure(
                face.columns, face.pressure, self.home, self.near(smoothing.kind), layer.x, layer.record,
                layer.pressure, *face.point, *face.normal,
            )  # fmt: skip
        if len(self.enclosing):
            continue_behind(
                self.enclosing, self.near(smoothing.kind), layer.x, layer.v, layer.record, layer.pressure,
                *self.law.gravity,
            )  # fmt: skip

    def update_pull(self) -> None:
        """Take up the accelerations that both layers have now, without drag, for the drag that follows."""
        layer, soil = self.layer, self.skeleton
        shown = soil.weigh(soil.acceleration)
        relative_to_soil(layer.fluid, *self.overlap.rows, shown, layer.acceleration, self.pores, PULL_X)

    def update_slip(self) -> None:
        """Take up the velocities that both layers have now; `evaluate` does so too."""
        layer, soil = self.layer, self.skeleton
        soil.resist()  # as at the end of the last step; of a run that goes on from a state
        relative_to_soil(layer.fluid, *self.overlap.rows, soil.weigh(soil.v), layer.v, self.pores, SLIP_X)

    def drag(self, seconds: float) -> None:
        """Drag of ``seconds`` between water and soil, with the velocities and accelerations taken up last."""
        layer, soil, law = self.layer, self.skeleton, self.resistance
        apply_drag(
            layer.fluid, self.pores, layer.v, law.number, law.factor, law.share, seconds, self.parts, self.push,
            self.heat,
        )  # fmt: skip
        apply_reaction(
            layer.fluid, *self.overlap.rows, self.push, soil.resisting, soil.mass, soil.v, seconds, self.borne,
            self.heat,
        )  # fmt: skip

    @property
    def slip(self) -> Floats:
        """Velocity of water over soil before the last drag, (fluid, 2) m/s: 0 in the open."""
        return self.pores[SLIP_X : SLIP_Y + 1, : self.layer.fluid].T

    @property
    def porosity(self) -> Floats:
        """n at water particles, (fluid,): 1 in the open."""
        return self.pores[POROSITY, : self.layer.fluid]

    @property
    def room(self) -> Floats:
        """Volume share Ω at the water particles, (fluid,)."""
        return self.pores[ROOM, : self.layer.fluid]

    def saturation(self) -> Floats:
        """Share of the volume about each soil particle that water and its grains take up, (soil,): 1 where pores are
        full, less near walls and the surface of the water."""
        return np.minimum(1.0, self._about(np.ones(self.layer.fluid)))

    def pore_pressure(self) -> Floats:
        """Mean pressure of the water about each soil particle, (soil,) Pa; no number where there is none."""
        n = self.layer.fluid
        with np.errstate(invalid="ignore"):
            found: Floats = self._about(self.layer.pressure[:n]) / self._about(np.ones(n))
        return found

    def _about(self, values: Floats) -> Floats:
        """Sums of ``values`` (fluid,) over the water about each soil particle by V W, (soil,); V is the whole volume,
        grains included, m²."""
        start, partner, weight = self.overlap.rows
        n, count = self.layer.fluid, self.skeleton.count
        volume = self.layer.mass[:n] / (self.porosity * self.layer.density * self.room)
        volume[self.layer.material[:n] != 0] = 0.0  # air
        volume *= values
        first, last = int(start[n]), int(start[n + count])
        row = np.repeat(np.arange(count), np.diff(start[n : n + count + 1]))
        return np.bincount(row, weight[first:last] * volume[partner[first:last]], count).astype(np.float64)

    def state(self) -> dict[str, Any]:
        """Everything that later steps depend on."""
        return super().state() | {
            "pores": self.pores.copy(),
            "excess": self.excess.copy(),
            "heat": self.heat.copy(),
            "borne": self.borne.copy(),
            "record": self.layer.record.copy(),
            "home": self.home.copy(),
            "overlap": self.overlap.pairs.state(),
            **({"matrix": self.layer.matrix.copy()} if self.faces else {}),
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Go on bit for bit from the ``state`` of a flow of the same start."""
        super().restore(state)
        self.pores[:], self.heat[:], self.borne[:] = state["pores"], state["heat"], state["borne"]
        self.layer.record[:], self.home[:] = state["record"], state["home"]
        self.excess[:] = state.get("excess", 0.0)
        self.corrected = bool(self.excess.any())
        if "matrix" in state:
            self.layer.matrix[:] = state["matrix"]
        self.overlap.restore(state["overlap"], self.layer.x[: self.layer.fluid], self.skeleton.x)
