"""Measuring displacements: synthetic pairs whose displacement is known exactly.

The rows of the accuracy table are means over ten seeds; a pair's own value scatters by a fifth.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.piv.estimate.interpolate import coefficients, sample
from porescale.piv.estimate.measure import Settings, Vectors, measure
from porescale.piv.fields.field import in_pixels
from porescale.piv.fields.vortices import vortices
from porescale.piv.images import flows
from porescale.piv.images.flows import Flow
from porescale.piv.images.spots import add_spots
from porescale.piv.images.synth import Camera, Pair, pair

VALIDATIONS = Validations()

SIZE = (512, 512)

CAMERA = Camera(SIZE)
"""0.05 tracers a pixel, diameter 2.8 px, noise 3 grey levels, 5 % lost pairs."""
CLEAN = Camera(SIZE, noise=0.0, lost=0.0)
SEEDS = range(10)

NEAR = 16.0
"""Distance from a solid, px, that a row for vectors near solids ends at."""

INVALID = 1.0
"""px: what an invalid vector counts as beside solids."""

TABLE: dict[str, tuple[Flow, Camera]] = {
    "clean": (flows.lamb_oseen(SIZE, 6.0, 64.0), CLEAN),
    "uniform": (flows.uniform(3.3, 2.4), CAMERA),
    "shear": (flows.shear(SIZE, 4.0), CAMERA),
    "stagnation": (flows.stagnation(SIZE, 4.0), CAMERA),
    "lamb_oseen": (flows.lamb_oseen(SIZE, 6.0, 64.0), CAMERA),
    "taylor_green_128": (flows.taylor_green(SIZE, 4.0, 128.0), CAMERA),
    "taylor_green_64": (flows.taylor_green(SIZE, 2.0, 64.0), CAMERA),
    "discs": (flows.past_discs(SIZE, 2.0, flows.scattered_discs(SIZE)), CAMERA),
}
"""The pairs of the accuracy table: flow and camera."""


@dataclass(frozen=True)
class Outcome:
    """Errors of a component, rms over all fluid vectors and seeds, px.

    rms : of all vectors;  far, near : of those beyond and within NEAR of a solid, invalid ones counted as INVALID;
    largest : of all;  inside : vectors within solids that claim to be none.
    """

    rms: float
    far: float
    near: float
    largest: float
    inside: int


def errors(made: Pair, found: Vectors) -> tuple[Floats, Floats]:
    """Both components' errors, (2, ny, nx) px, and the distance from the nearest solid, (ny, nx) px."""
    x, y = np.meshgrid(found.x, found.y)
    u, v = made.flow.displacement(x, y)
    return np.stack([found.u - u, found.v - v]), made.flow.discs.distance(x, y)


def trial(flow: Flow, camera: Camera, seeds: Iterable[int], settings: Settings | None = None) -> Outcome:
    """Measure a pair for every seed; rms values are means over the seeds."""
    rows = []
    for seed in seeds:
        made = pair(flow, camera, seed)
        found = measure(made.first, made.second, made.solid if made.solid.any() else None, settings)
        off, distance = errors(made, found)
        fluid = ~found.solid
        counted = np.where(found.valid, off, INVALID)
        far, near = fluid & (distance > NEAR), fluid & (distance <= NEAR)
        rows.append((
            _rms(off[:, fluid]), _rms(counted[:, far]), _rms(counted[:, near]), float(np.abs(off[:, fluid]).max()),
            int((fluid & (distance < -0.5)).sum()),
        ))  # fmt: skip
    table = np.array(rows)
    rms, far, near = table[:, :3].mean(0).tolist()
    return Outcome(rms, far, near, float(table[:, 3].max()), int(table[:, 4].sum()))


def row(name: str, seeds: Iterable[int] = SEEDS, settings: Settings | None = None) -> Outcome:
    """A row of the accuracy table."""
    flow, camera = TABLE[name]
    return trial(flow, camera, seeds, settings)


def stated(name: str, seeds: Iterable[int] = SEEDS) -> tuple[float, float]:
    """Rms error of the valid vectors of a row over the rms of their uncertainties, and the share of errors below it."""
    flow, camera = TABLE[name]
    errors_, spreads = [], []
    for seed in seeds:
        made = pair(flow, camera, seed)
        found = measure(made.first, made.second, made.solid if made.solid.any() else None)
        off, _ = errors(made, found)
        errors_.append(off[:, found.valid])
        spreads.append(np.stack([found.uncertainty[found.valid]] * 2))
    off, spread = np.concatenate(errors_, 1), np.concatenate(spreads, 1)
    return _rms(off) / _rms(spread), float(np.mean(np.abs(off) < spread))


def bias(diameter: float, shifts: Iterable[float], size: int = 256, settings: Settings | None = None) -> Floats:
    """Mean error of u on clean pairs of a uniform displacement, px, for each of ``shifts``."""
    camera = Camera((size, size), diameter=diameter, noise=0.0, lost=0.0)
    found = []
    for seed, shift in enumerate(shifts):
        made = pair(flows.uniform(shift, 0.0), camera, seed)
        found.append(float(np.mean(measure(made.first, made.second, None, settings).u)) - shift)
    return np.array(found)


def still(size: int = 256) -> float:
    """Largest displacement between a noisy picture and itself, px."""
    made = pair(flows.uniform(0.0, 0.0), Camera((size, size)), 1)
    found = measure(made.first, made.first)
    return float(max(np.abs(found.u).max(), np.abs(found.v).max()))


def vortex(seed: int = 0) -> tuple[list[float], list[float]]:
    """A Lamb-Oseen vortex found in a measured field: x, y px and circulation of its core px^2, and what they are.

    The circulation is that of a disc of the core's own area around the centre.
    """
    peak, core = 6.0, 64.0
    flow = flows.lamb_oseen(SIZE, peak, core)
    made = pair(flow, CAMERA, seed)
    found = vortices(in_pixels(measure(made.first, made.second)))[0]
    middle = 0.5 * (SIZE[0] - 1)
    _, speed = flow.velocity(np.array([middle + found.radius]), np.array([middle]))
    exact = -2 * np.pi * found.radius * float(speed[0])  # y points down: positive turns with the clock
    return [found.x, found.y, found.circulation], [middle, middle, exact]


def quintic(size: int = 48) -> float:
    """Largest error of the interpolator on a polynomial of fifth degree over its largest value, away from the edges."""
    y, x = np.mgrid[:size, :size] / size

    def value(x: Floats, y: Floats) -> Floats:
        """The polynomial at x, y."""
        return np.asarray((x - 0.3) ** 5 - 2 * x * x * y**3 + y**5 - x * y + 0.5)

    shift = np.random.default_rng(0).uniform(-0.5, 0.5, (2, size, size)).astype(np.float32)
    found = np.empty((size, size), np.float32)
    sample(coefficients(value(x, y).astype(np.float32)), shift[0], shift[1], 0, found)
    exact = value(x + shift[0] / size, y + shift[1] / size)
    inner = slice(20, -20)
    return float(np.abs(found - exact)[inner, inner].max() / np.abs(exact).max())


def turned(angle: float, radius: float) -> tuple[float, float]:
    """Displacement in a rotation by ``angle`` rad at ``radius`` px: integrated, and the chord 2 r sin(angle/2)."""
    side = 2 * round(radius) + 1
    flow = flows.rotation((side, side), angle * radius)
    u, v = flow.displacement(np.array([2 * radius]), np.array([radius]))
    return float(np.hypot(u, v)[0]), 2 * radius * float(np.sin(angle / 2))


def light(sigma: float) -> float:
    """Light of a spot in the middle of a picture over that of the whole Gaussian, 2 pi sigma^2."""
    image = np.zeros((65, 65))
    add_spots(np.array([32.3]), np.array([31.8]), np.array([1.0]), sigma, image)
    return float(image.sum()) / (2 * np.pi * sigma**2)


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0


ROUND_OFF = float(np.finfo(np.float32).eps)
ROWS = "exact displacement; tracers 2.8 px, 0.05 a pixel, noise 3 grey levels, 5 % lost, window 16, every fluid vector"
PUBLISHED = "OpenPIV 0.26.1 (64, 32, 16 px, deformed) reaches {best} px on such pairs; half of the least is required"


@VALIDATIONS.row(
    "piv.paths_of_a_solid_rotation",
    source="chord of a circle, 2 r sin(angle/2)",
    because="Runge-Kutta of fourth order, 48 steps of 1/48 rad: (1/48)^5/120 each, 1.6e-9 in all, relative",
    tolerance=1.6e-9,
)
def paths() -> Measured:
    """Displacement in a turn of one radian, over the chord."""
    found, exact = turned(1.0, 100.0)
    return Measured.absolute(1.0, found / exact)


@VALIDATIONS.row(
    "piv.light_of_a_spot",
    source="integral of a Gaussian: 2 pi sigma^2",
    because="spots end 4.5 sigma from their centre or later: erfc(4.5/sqrt 2) = 6.8e-6 along each axis",
    tolerance=2 * 6.8e-6,
)
def spots() -> Measured:
    """Light of spots of 2, 2.8 and 6 px over that of the Gaussian: pixels integrate, they do not sample."""
    return Measured.absolute([1.0] * 3, [light(diameter / 4) for diameter in (2.0, 2.8, 6.0)])


@VALIDATIONS.row(
    "piv.interpolation_of_a_quintic",
    source="quintic splines reproduce polynomials of fifth degree (Unser, Aldroubi & Eden 1993)",
    because="float32: 36 products of weights and coefficients, and 41 + 41 of the inverse filter, whose taps add up to"
    " four times the value: half a unit of round-off each",
    tolerance=4 * (36 + 82) * ROUND_OFF / 2,
)
def quintic_row() -> Measured:
    """Largest error over the largest value, at random places up to half a pixel off."""
    return Measured.absolute(0.0, quintic())


@VALIDATIONS.row(
    "piv.still_pair",
    source="a picture against itself does not move",
    because="0.001 px required: a tenth and less of what noise and lost tracers make of other pairs",
    tolerance=1e-3,
)
def still_row() -> Measured:
    """Largest displacement measured between a picture and itself, px."""
    return Measured.absolute(0.0, still())


@VALIDATIONS.row(
    "piv.sub_pixel_bias",
    source="exact uniform displacements of 0 to 1 px in tenths; tracers 2.8 px, clean",
    because="0.005 px: under half the 0.012 px of cubic splines; aliasing of pixel-integrated spots is what is left",
    tolerance=0.005,
)
def bias_row() -> Measured:
    """Largest mean error over eleven displacements, px."""
    return Measured.absolute(0.0, float(np.abs(bias(2.8, np.linspace(0, 1, 11))).max()))


@VALIDATIONS.row(
    "piv.sub_pixel_bias_of_small_tracers",
    source="exact uniform displacements of 0 to 1 px in tenths; tracers 2.0 px, clean",
    because="0.010 px: under half the 0.022 px of cubic splines; spots of 2 px are aliased at a fifth of their light",
    tolerance=0.010,
)
def small_bias() -> Measured:
    """Largest mean error over eleven displacements, px."""
    return Measured.absolute(0.0, float(np.abs(bias(2.0, np.linspace(0, 1, 11))).max()))


@VALIDATIONS.row(
    "piv.vortex_in_a_measured_field",
    source="Lamb 1932, art. 334a; Gamma 1 and 2 of Graftieaux, Michard & Grosjean 2001",
    because="circulation: vorticity by differences over 16 px errs by (8/64)^2/6 of its bending, 0.3 %, and points"
    " count as in or out along a rim of some 50 of them, 4 px of 64 each, at random: 0.9 %; centre: a quarter of a"
    " step, 2 px of 64, 3 %, the largest of the three",
    tolerance=0.03,
)
def vortex_row() -> Measured:
    """Centre over the core's radius, and circulation relative."""
    found, exact = vortex()
    off = [abs(found[0] - exact[0]) / 64, abs(found[1] - exact[1]) / 64, abs(found[2] / exact[2] - 1)]
    return Measured(exact, found, max(off))


@VALIDATIONS.row(
    "piv.ten_per_cent_lost",
    source="exact uniform displacement; 10 % of the tracers in one picture only",
    because="no vector of a smooth flow may be off by a pixel; validation and replacement bear it",
    tolerance=1.0,
    slow=True,
)
def lost() -> Measured:
    """Largest error of any vector over three seeds, px."""
    flow, _ = TABLE["uniform"]
    return Measured.absolute(0.0, trial(flow, replace(CAMERA, lost=0.1), range(3)).largest)


def _table(name: str, tolerance: float, best: str) -> None:
    """Register a row of the accuracy table."""

    @VALIDATIONS.row(
        f"piv.{name}", source=ROWS, because=PUBLISHED.format(best=best), tolerance=tolerance, slow=name != "uniform"
    )
    def measure() -> Measured:
        """Rms error of a component over ten seeds (one where quick), px."""
        return Measured.absolute(0.0, row(name, SEEDS if name != "uniform" else range(1)).rms)


for flow, bound, others in (
    ("clean", 0.0095, "0.019 to 0.034"),
    ("uniform", 0.019, "0.038 to 0.043"),
    ("shear", 0.019, "0.038 to 0.043"),
    ("stagnation", 0.019, "0.038 to 0.043"),
    ("lamb_oseen", 0.023, "0.046"),
    ("taylor_green_128", 0.067, "0.135 to 0.198"),
    ("taylor_green_64", 0.112, "0.224 to 0.246"),
):
    _table(flow, bound, others)


@VALIDATIONS.row(
    "piv.taylor_green_128_in_wide_windows",
    source=ROWS.replace("window 16", "window 32"),
    because="OpenPIV 0.26.1 reaches 0.23 to 0.48 px at that window; 0.13 px is aimed at",
    tolerance=0.13,
    slow=True,
)
def wide() -> Measured:
    """Rms error of a component over ten seeds, px."""
    return Measured.absolute(0.0, row("taylor_green_128", settings=Settings(window=32)).rms)


@VALIDATIONS.row(
    "piv.past_discs",
    source=ROWS + "; no-slip flow past five discs, invalid vectors count 1 px",
    because="in shares of what is aimed at: 0.042 px beyond 16 px from a solid, a fifth less than OpenPIV 0.26.1 on"
    " such pairs (0.053), and 0.10 px nearer (OpenPIV 0.24); no vector in a solid",
    tolerance=1.0,
    slow=True,
)
def discs() -> Measured:
    """Rms beyond and within 16 px of a solid, px; the error is the larger share, infinite with a vector in a solid."""
    found = row("discs")
    share = max(found.far / 0.042, found.near / 0.10)
    return Measured([0.0, 0.0], [found.far, found.near], share if not found.inside else float("inf"))


@VALIDATIONS.row(
    "piv.past_discs_without_slip",
    source=ROWS + "; no-slip flow past five discs, invalid vectors count 1 px; rims told to stand still",
    because="a quarter of OpenPIV 0.26.1's 0.24 px: rims that are known leave nothing to be carried on beyond tracers",
    tolerance=0.06,
    slow=True,
)
def no_slip() -> Measured:
    """Rms within 16 px of a solid, over four seeds, px."""
    return Measured.absolute(0.0, row("discs", range(4), Settings(no_slip=True)).near)


ROWS_STATED = ("uniform", "shear", "stagnation", "lamb_oseen", "taylor_green_128", "taylor_green_64", "discs", "clean")

WITHIN = 0.683
"""Share of normal errors within one standard deviation."""


@VALIDATIONS.row(
    "piv.uncertainty",
    source="errors of the table's rows, known exactly, over the uncertainties stated with the vectors",
    because="in shares of a factor of 1.5 between rms error and rms uncertainty, and of 0.2 between the share of errors"
    " within one deviation and 0.683: fields that are smooth all over have a handful of degrees of freedom, four seeds"
    " of them scatter by 1/sqrt(2 4 4) = 0.18, and bias is known to its size only",
    tolerance=1.0,
    slow=True,
)
def uncertainty() -> Measured:
    """Ratio and share, row by row, over four seeds."""
    found = [stated(name, range(4)) for name in ROWS_STATED]
    off = [max(abs(math.log(ratio)) / math.log(1.5), abs(share - WITHIN) / 0.2) for ratio, share in found]
    numbers = [it for pair in found for it in pair]
    return Measured([1.0, WITHIN] * len(found), numbers, max(off))
