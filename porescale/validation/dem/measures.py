"""Packings whose porosity, stress, fabric and coarse-grained fields are known exactly.  SI."""

import math

import numpy as np

from porescale.common.core.constants import GRAVITY
from porescale.common.core.types import Floats
from porescale.common.evidence.validations import Measured, Validations
from porescale.dem.contact.linear import Linear
from porescale.dem.discs import make_discs
from porescale.dem.forces.walls import Box
from porescale.dem.grains import Grains
from porescale.dem.measures.coarse_graining import CoarseGrained, Raster
from porescale.dem.measures.contacts import contacts
from porescale.dem.measures.fabric import Fabric, coordination, fabric
from porescale.dem.measures.porosity import porosity
from porescale.dem.measures.region import Region
from porescale.dem.measures.stress import contact_stress
from porescale.dem.prepare.settle import come_to_rest, weights_of
from porescale.validation.dem import setups as lab
from porescale.validation.dem.bodies import clumped_cell, lattice, random_cell

COLUMN = 12
"""Discs of the loaded column."""


def square_lattice_porosity(lower: tuple[float, float], upper: tuple[float, float]) -> float:
    """Porosity of touching discs of diameter 1 at half numbers, periodic over 8 x 6, in a rectangle (in diameters)."""
    at = np.stack(np.meshgrid(np.arange(8) + 0.5, np.arange(6) + 0.5), axis=-1).reshape(-1, 2)
    return porosity(Region(lower, upper), at, np.full(len(at), 0.5), (8.0, 6.0))


def cut_lattice_porosity(shift: float) -> float:
    """Porosity of the same discs in a rectangle 2 x 2 - ``shift`` (0 to 0.5) whose upper edge cuts the upper row:
    1 - (2 whole discs + 2 discs less their upper segment)/area.

    The segment above height h over the centre is r² acos(h/r) - h sqrt(r² - h²), h = r - shift.
    """
    r, h = 0.5, 0.5 - shift
    segment = r * r * math.acos(h / r) - h * math.sqrt(r * r - h * h)
    return 1.0 - (4.0 * math.pi * r * r - 2.0 * segment) / (2.0 * (2.0 - shift))


def loaded_column(load: float = 1000.0, settled: float = 60.0) -> tuple[Grains, float]:
    """A column of discs on a floor, ``load`` N/m on the top one: (grains, width of a strip that holds it, m).

    ``settled``: decay times of the slowest wave that it is given to come to rest.
    """
    diameter = 2.0 * lab.RADIUS
    y = lab.RADIUS * (2.0 * np.arange(COLUMN) + 1.0)
    box = Box((0.0, 0.0), (diameter, 2.0 * COLUMN * diameter), left="open", right="open", top="open")
    grains = Grains(make_discs(np.column_stack((np.full(COLUMN, lab.RADIUS), y)), lab.RADIUS, lab.DENSITY),
                    lab.law_at(0.3), box)  # fmt: skip
    pushes = lab.weights(COLUMN)
    pushes[-1, 1] -= load
    dt, slowest = grains.stable_step(), lab.slowest_wave(COLUMN)
    grains.step(dt, pushes, None, int(settled / (slowest * dt)), 2.0 * slowest)
    return grains, diameter


def column_stress(grains: Grains, width: float) -> tuple[Floats, Floats]:
    """Vertical Love-Weber stress (Pa) in regions from one centre of a column to the next, and the weight above with the
    load over the width (Pa), from the bottom; (COLUMN - 1,) each."""
    y, found = grains.discs.position[:, 1], contacts(grains)
    measured = [contact_stress(Region((0.0, y[k]), (width, y[k + 1])), found)[1, 1] for k in range(COLUMN - 1)]
    pushed = -grains.external_force[::-1, 1].cumsum()[::-1]
    return np.array(measured), pushed[1:] / width


STRAIN = 1e-3


def pressed_lattice(stretch: float = 0.0) -> Grains:
    """The `lattice` of frictionless discs, 6 x 6, compressed by STRAIN, its contacts listed."""
    grains = lattice(Linear(lab.STIFFNESS), 6, STRAIN, stretch, skin=0.05 * lab.RADIUS)
    grains.refresh()
    return grains


def lattice_stress(grains: Grains) -> tuple[Floats, float, Fabric]:
    """Love-Weber stress (2, 2) Pa of the whole cell, coordination number and fabric."""
    found, region = contacts(grains), Region(grains.box.lower, grains.box.upper)
    period = grains.box.period
    return (
        contact_stress(region, found, period),
        coordination(found, region, grains.discs.position, period),
        fabric(found, region, period),
    )


def strained_stress(clumps: bool) -> tuple[Floats, Floats]:
    """Love-Weber stress (Pa) of a rectangle as large as a dense cell strained in all ways, somewhere across its sides,
    and the stress of contacts that the cell works with in its next step, (2, 2) each."""
    law = Linear(lab.STIFFNESS, 20.0, 0.5 * lab.STIFFNESS, 10.0, 0.5)
    grains = (clumped_cell if clumps else random_cell)(law, 3)
    dt = grains.stable_step()
    grains.steering.strain_cell(xx=-0.18 / (900 * dt), yy=-0.14 / (900 * dt), xy=0.35 / (900 * dt))
    grains.step(dt, count=900)
    width, height, _ = grains.period
    region = Region((0.013, -0.031), (0.013 + width, height - 0.031))
    found = contact_stress(region, contacts(grains), grains.period)
    grains.step(dt)
    return found, -grains.steering.load[:4].reshape(2, 2) / (width * height)


def pressed_lattice_stress() -> float:
    """Exact pressure (Pa) of that lattice: three contacts F = 2 r k STRAIN with branch l = 2 r (1 - STRAIN) per disc on
    l² sqrt(3)/2, sum of F l n n = 3/2 F l: p = sqrt(3) F/l = sqrt(3) k STRAIN/(1 - STRAIN)."""
    return math.sqrt(3.0) * lab.STIFFNESS * STRAIN / (1.0 - STRAIN)


def heap(seed: int = 2) -> Grains:
    """Some sixty discs of different sizes at rest under gravity between two walls, walls and floor rough."""
    rng = np.random.default_rng(seed)
    radius = lab.RADIUS * rng.uniform(0.7, 1.0, 60)
    at = np.array([(0.012 + 0.0215 * (k % 9), 0.012 + 0.0215 * (k // 9)) for k in range(60)])
    at[:, 0] += 0.002 * rng.uniform(-1.0, 1.0, 60)
    law = lab.law_at(0.3, tangential_stiffness=0.25 * lab.STIFFNESS, friction=0.3)
    grains = Grains(make_discs(at, radius, lab.DENSITY), law, Box((0.0, 0.0), (0.2, 0.4), top="open"))
    come_to_rest(grains, weights_of(grains.discs, lab.DENSITY), GRAVITY, energy=1e-16, balance=1e-7)
    return grains


def heap_fields(grains: Grains, cells: float, width: float = 0.03) -> CoarseGrained:
    """Fields of a heap at ``cells`` cells a ``width`` (m), on a raster that reaches a width beyond all of it."""
    raster = Raster.over((-width, -width), (0.2 + width, 0.3), width / cells, width)
    return CoarseGrained(raster, grains.discs, contacts(grains), conserve=False)


def totals(grains: Grains, *, conserve: bool = True) -> Floats:
    """Sums of density, solid fraction and contact stress xx over a grid between the walls of a heap, over mass, area of
    discs and sum of F_x l_x, (3,)."""
    raster = Raster.over((0.0, 0.0), (0.2, 0.2), 0.004, 0.03)
    found, d = contacts(grains), grains.discs
    fields = CoarseGrained(raster, d, found, conserve=conserve)
    sums = [fields.density.sum(), fields.solid_fraction.sum(), fields.contact_stress[..., 0, 0].sum()]
    whole = [d.mass.sum(), d.area.sum(), np.sum(found.force[:, 0] * found.branch[:, 0])]
    return np.asarray(np.array(sums) * raster.cell / np.array(whole))


def imbalance(fields: CoarseGrained, gravity: float = GRAVITY, *, walls: bool = True) -> float:
    """Largest |div sigma - rho g - t| over the largest rho g, by central differences; ``walls`` False leaves t out."""
    dx, dy = fields.raster.spacing
    stress = fields.contact_stress
    left = np.zeros((*stress.shape[:2], 2))
    left[1:-1, 1:-1] = (stress[1:-1, 2:, :, 0] - stress[1:-1, :-2, :, 0]) / (2.0 * dx)
    left[1:-1, 1:-1] += (stress[2:, 1:-1, :, 1] - stress[:-2, 1:-1, :, 1]) / (2.0 * dy)
    left[..., 1] += fields.density * gravity
    if walls:
        left -= fields.wall_force
    return float(np.abs(left[1:-1, 1:-1]).max() / (fields.density.max() * gravity))


def turned(grains: Grains, rate: float = 3.0) -> Grains:
    """The same discs moving as one rigid body, with 2 m/s and a rotation of ``rate`` rad/s."""
    d = grains.discs
    d.velocity[:] = np.column_stack((2.0 - rate * d.position[:, 1], rate * d.position[:, 0]))
    d.spin[:] = rate
    return grains


VALIDATIONS = Validations()

COMMENSURATE = (((0.0, 0.0), (8.0, 6.0)), ((1.0, 2.0), (3.0, 5.0)), ((0.5, 0.5), (3.5, 2.5)), ((0.3, 0.2), (2.3, 3.2)))
"""Corners, in diameters, of regions whole numbers of diameters wide and high: any such region holds whole discs."""
CUTS = (0.1, 0.25, 0.4)
GOLDHIRSCH = "Goldhirsch 2010, Granular Matter 12, 239; at walls Weinhart et al. 2012, Granular Matter 14, 289"


@VALIDATIONS.row(
    "dem.porosity_of_a_square_lattice",
    source="n = 1 - pi/4 for touching discs on a square lattice; circular segments where an edge cuts them",
    because="round-off: sums of some 40 disc areas of order one, each from a dozen terms, over areas of 4 or more",
    tolerance=1e-14,
)
def square_lattice() -> Measured:
    """Porosity from regions that hold whole discs wherever they lie, and from regions whose edge cuts a row."""
    whole = [square_lattice_porosity(*corners) for corners in COMMENSURATE]
    cut = [square_lattice_porosity((0.0, 0.0), (2.0, 2.0 - shift)) for shift in CUTS]
    exact = [1.0 - math.pi / 4.0] * len(whole) + [cut_lattice_porosity(shift) for shift in CUTS]
    return Measured.absolute(exact, whole + cut)


@VALIDATIONS.row(
    "dem.stress_of_a_loaded_column",
    source="balance of forces: stress times width = load + weight above (Love 1927, Weber 1966)",
    because="overlaps of 1e-4 m are read off positions known to 3e-17 m, 3e-13; ten times that where a step's round-off"
    " keeps it moving",
    tolerance=3e-12,
)
def column() -> Measured:
    """Vertical stress between neighbouring centres of twelve discs under 1 kN/m."""
    found, exact = column_stress(*loaded_column())
    return Measured.relative(exact, found)


@VALIDATIONS.row(
    "dem.hexagonal_packing_under_pressure",
    source="sigma = sqrt(3) k strain/(1 - strain) times unity, coordination 6, fabric one half of unity",
    because="overlaps of 2e-5 m are read off positions of 0.1 m known to 1.4e-17 m, 7e-13",
    tolerance=2e-12,
)
def hexagonal() -> Measured:
    """Stress over its exact value (xx, yy, xy), coordination number and fabric (xx, yy, xy), periodic, strain 1e-3."""
    stress, neighbours, fabric = lattice_stress(pressed_lattice())
    scaled = stress / pressed_lattice_stress()
    ways = ((0, 0), (1, 1), (0, 1))
    found = [*(scaled[k] for k in ways), neighbours, *(fabric.tensor[k] for k in ways)]
    return Measured.absolute((1.0, 1.0, 0.0, 6.0, 0.5, 0.5, 0.0), found)


@VALIDATIONS.row(
    "dem.stress_of_a_strained_cell",
    source="Love 1927, Weber 1966 with images of the sheared cell; virial of Evans & Morriss 1990, section 6.3",
    because="overlaps of some 1e-4 m are read off places of 0.1 m, images of images, known to 1e-16 m: 1e-12, and"
    " members of clumps share forces as large",
    tolerance=1e-11,
)
def strained() -> Measured:
    """Stress of a rectangle across the sides of a cell, over its largest part, of discs and of clumps (xx, xy, yx,
    yy)."""
    pairs = [strained_stress(clumps) for clumps in (False, True)]
    found, exact = (np.array([pair[k] / np.abs(pair[1]).max() for pair in pairs]).ravel() for k in (0, 1))
    return Measured.absolute(exact, found)


@VALIDATIONS.row(
    "dem.coarse_grained_mass",
    source=GOLDHIRSCH + "; weights scaled to one on the grid",
    because="round-off of sums over 60 discs and some thousand cells, growing like its root",
    tolerance=1e-13,
)
def mass() -> Measured:
    """Integral of density, of solid fraction and of contact stress over mass, area, and force times branch, in a heap
    whose walls cut the kernels off."""
    return Measured.absolute((1.0, 1.0, 1.0), totals(heap()))


@VALIDATIONS.row(
    "dem.coarse_grained_momentum",
    source=GOLDHIRSCH + ": div sigma = rho g + wall force at rest",
    because="central differences err by h²/6 s''': Lucy's third derivative is at most 48/c³, the stress at most that of"
    " five widths of height, so (48/6) 5 (h/c)² = 1e-2 at 64 cells a width",
    tolerance=1e-2,
)
def momentum() -> Measured:
    """Largest imbalance over the largest weight of a heap at rest, everywhere, walls included."""
    return Measured.absolute(0.0, imbalance(heap_fields(heap(), 64)))


@VALIDATIONS.row(
    "dem.rigid_rotation_has_no_strain_rate",
    source="affine motion fitted by least squares, Itasca PFC measurement regions",
    because="round-off: eps times the speed of 2.6 m/s over (0.01)² of the worst second moment admitted and the width,"
    " 2e-10 1/s",
    tolerance=2e-10,
)
def rigid() -> Measured:
    """Largest strain rate (1/s) on a grid over a heap that moves as one body at 2 m/s and 3 rad/s, and its rotation."""
    fields = heap_fields(turned(heap()), 8)
    strain = float(np.nanmax(np.abs(fields.strain_rate)))
    gradient = fields.velocity_gradient
    spin = float(np.nanmax(np.abs(0.5 * (gradient[..., 1, 0] - gradient[..., 0, 1]) - 3.0)))
    return Measured.absolute((0.0, 0.0), (strain, spin))
