"""What experiments with soil and water share: water among the soil of a periodic column.  SI."""

import math
from collections.abc import Mapping

import numpy as np

from continuum_sph.scene.numerics import NumericsSection
from continuum_sph.seepage import Frame, PoreFlow, PressureFace, Resistance, Seepage, Skeleton, skeleton_of
from continuum_sph.seepage.overlap import Overlap
from continuum_sph.seepage.pressure_face import in_columns
from continuum_sph.soil import SoilFlow
from continuum_sph.water.eos.liquid import Tait
from continuum_sph.water.fluids import Fluid
from continuum_sph.water.parameters import Law
from continuum_sph.water.pressure_walls import tank_walls
from continuum_sph.water.smoothing import RATIO, SUPPORT, Smoothing
from continuum_sph.water.state import Layer
from porescale.common.core.types import Floats
from porescale.common.neighbors import PairList

WATER = 1000.0  # kg/m³
GRAINS = 2650.0  # kg/m³
SKIN = 0.15  # of the smoothing length
ALPHA = float(NumericsSection.model_fields["artificial_viscosity"].default)  # as in every scene
COLUMNS = 8  # particles across a periodic column: two cutoffs of 2h + skin and a little


def sides(width: float, height: float, spacing: float, ratio: float = RATIO) -> Floats:
    """Wall particles under and over a periodic column, (n, 2) m, as deep as kernels of ``ratio`` spacings reach."""
    return tank_walls(width, height, spacing, math.ceil(SUPPORT * ratio - 0.5 - 1e-9), sides=False, lid=True)


def pore_flow(
    layer: Layer, rules: Law, skeleton: Skeleton, resistance: Resistance, lower: tuple[float, float],
    upper: tuple[float, float], periodic: tuple[bool, bool] = (False, False),
) -> PoreFlow:  # fmt: skip
    """The water of a ``layer`` in the pores of a ``skeleton``, in a box from ``lower`` to ``upper`` (m)."""
    length, box = rules.smoothing.length, (lower, upper, periodic)
    return PoreFlow(
        layer, rules, PairList(layer.count, SKIN * length, *box, full=True), skeleton=skeleton,
        overlap=Overlap(layer.fluid, skeleton.count, length, SKIN * length, *box), resistance=resistance,
    )  # fmt: skip


def water_in(
    ground: SoilFlow | Frame,
    x: Floats,
    pressure: Floats,
    size: tuple[float, float],
    spacing: float,
    sound_speed: float,
    resistance: Resistance,
    *,
    grains: float = GRAINS,
    permeability: float = 1e-3,
    gravity: float = 0.0,
    drained: Mapping[str, float] | None = None,
    modulus: float = 0.0,
    load: Floats | None = None,
    v: Floats | None = None,
    ratio: float = RATIO,
    **law: float | bool,
) -> Seepage:
    """Water at ``x`` (n, 2) m under ``pressure`` (n,) Pa in a periodic column (width, height) m, among the soil there.

    load (soil, 2) N/m: on the soil;  v (n, 2) m/s: of the water, none if absent;  drained : pressure (Pa) of faces that
    water passes, "floor" or "lid";  ratio : of the smoothing length to the spacing.  Each particle takes up a square of
    the spacing, grains and all.
    """
    width, height = size
    smoothing, state, n = Smoothing("wendland", ratio * spacing), Tait(WATER, sound_speed), len(x)
    walls = sides(width, height, spacing, ratio)
    options = {"diffusion": 0.0, "cut": False, "alpha": 0.0, "corrected": True} | law
    rules = Law(smoothing, spacing, (Fluid(state),), (0.0, -gravity), **options)  # type: ignore[arg-type]
    skeleton = ground.skeleton if isinstance(ground, Frame) else skeleton_of(ground, grains, permeability)
    deep = math.ceil(-float(walls[:, 1].min()) / spacing) * spacing
    box = (0.0, -deep), (width, height + deep), (True, False)
    rho = state.density_at(pressure)
    mass = np.concatenate((rho * spacing**2, np.full(len(walls), WATER * spacing**2)))
    layer = Layer(n, np.concatenate((x, walls)), np.zeros((n + len(walls), 2)), mass, rho)
    if v is not None:
        layer.v[:n] = v
    flow = pore_flow(layer, rules, skeleton, resistance, *box)
    for face, held in (drained or {}).items():
        below = face == "floor"
        rows = n + np.flatnonzero(walls[:, 1] < 0.0 if below else walls[:, 1] > height)
        normal = (0.0, 1.0 if below else -1.0)
        columns = in_columns(rows, layer.x, normal)
        flow.faces.append(PressureFace(columns, (0.0, 0.0 if below else height), normal, np.full(columns.shape, held)))
    whole = resistance.porosity * WATER + (1.0 - resistance.porosity) * grains
    both = Seepage(flow, ground, modulus, whole if modulus else np.inf, load=load)
    both.start()
    layer.mass[:n] = flow.porosity * rho * spacing**2
    both.start()
    return both
