"""Discs with prescribed motion, or free, in fluid: oscillation, shear, streams, falls.  Lattice units.

Discs that fall on each other and on the bottom, SI.
"""

import math

import numpy as np
from scipy.special import kve

from porescale.common.core.types import Reals
from porescale.common.evidence.validations import Measured, Validations
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.lattice import viscosity
from porescale.lbm.scales import Scales
from porescale.validation.coupling.setups import DEFAULT, PERIODIC, TAU, Method, immersed
from porescale.validation.coupling.towed import RADIUS, faxen, jeffrey_onishi, steady, towed
from porescale.validation.lbm.channels import one_thread


def stokes_oscillation(frequency: float) -> complex:
    """G = 1 + 4 K1(z)/(z K0(z)), z = sqrt(i a² w/nu): force on an oscillating cylinder -rho pi a² G dU/dt (Stokes).

    Its real part is the added mass, less its imaginary part the damping over w, both in displaced masses.
    """
    z = np.sqrt(1j * frequency)
    return complex(1 + 4 * kve(1, z) / (z * kve(0, z)))


def dipole_in_a_box(images: int = 200) -> float:
    """Stream that its images in a square box of side 1 send to a dipole of strength 1 in the middle, against it.

    A wall across turns the dipole's image round, one along does not: sum of (-1)^m (m² - n²)/(m² + n²)² over all but
    the origin, rows first, since over n each row falls off exponentially.
    """
    n = np.arange(-images * 50, images * 50 + 1)
    total = 0.0
    for m in range(-images, images + 1):
        row = n[n != 0] if m == 0 else n
        total += (-1) ** m * float(np.sum((m * m - row**2) / (m * m + row**2) ** 2.0))
    return -total


def oscillation(
    frequency: float,
    *,
    radius: float = 10.0,
    width: float = 10.0,
    relaxation_time: float = TAU,
    inner: bool = True,
    method: Method = DEFAULT,
) -> complex:
    """G of a disc that oscillates in a closed box ``width`` radii wide, ``frequency`` a² w/nu.

    inner: whether the fluid inside is given back.  Its centre hardly moves.  The first half period is passed over, the
    next whole one fitted.
    """  # fmt: skip
    n, nu = round(width * radius), viscosity(relaxation_time)
    w = frequency * nu / radius**2
    period = round(2 * math.pi / w)
    coupled = towed((n, n), [(n / 2 + 0.3, n / 2 + 0.1)], radius, relaxation_time=relaxation_time, method=method)
    if not inner:
        coupled.inner_mass[:] = 0.0
    speed = 1e-3 * w * radius  # a thousandth of the radius to and fro
    force = np.zeros(period)
    with one_thread():
        for step in range(period // 2 + period):
            coupled.grains.discs.velocity[0, 0] = speed * math.sin(w * step)
            coupled.advance()
            if step >= period // 2:
                force[step - period // 2] = coupled.fluid_force[0, 0]
    # U is held over a step and loads are those within it: half a step later.
    phase = w * (np.arange(period) + period // 2)
    fitted = np.linalg.lstsq(np.stack([np.sin(phase), np.cos(phase), np.ones(period)], 1), force, rcond=None)[0]
    amplitude = complex(fitted[0], fitted[1])  # of exp(i w t) - i: force = Im(amplitude exp(i phase))
    return -amplitude / (1j * w * math.pi * radius**2 * speed)


def oscillation_in_a_box(frequency: float, width: float = 10.0) -> complex:
    """G with the images of its dipole, a² (1 + G)/2, whose stream u acts as G U - (1 + G) u: exact to (a/W)⁴."""
    g = stokes_oscillation(frequency)
    return g + (1 + g) ** 2 / 2 * dipole_in_a_box() / width**2


def shear_spin(
    blockage: float = 0.1, diameter: float = 10.0, *, reynolds: float = 0.01, place: tuple[float, float] = (0.3, 0.0)
) -> float:
    """Spin over the shear rate of a free disc midway between walls that move apart, diameter over their distance given.

    reynolds: shear rate * d²/nu.  The channel is periodic, three heights long.
    """  # fmt: skip
    height = round(diameter / blockage)
    nu = viscosity(TAU)
    rate = reynolds * nu / diameter**2
    wall = rate * height / 2
    sides = Sides("periodic", "periodic", "wall", "wall", top_speed=wall, bottom_speed=-wall)
    cells = 3 * height, height
    centre = cells[0] / 2 + place[0], height / 2 + place[1]
    coupled = towed(
        cells, [centre], diameter / 2, spin=-rate / 2, sides=sides, density=1.0,
    )  # fmt: skip
    y = np.arange(height)[:, None] + 0.5 - height / 2
    coupled.fluid.set_flow(rate * y * np.ones(cells[0]), 0.0)
    coupled.grains.hold(0, x=True, y=True, rotation=False)
    discs = coupled.grains.discs
    return -steady(coupled, lambda: float(discs.spin[0]), (height / (2 * math.pi)) ** 2 / nu) / rate


def stream_drag(frame: float, *, diameter: float = 10.0, speed: float = 0.02, steps: int = 2000) -> Reals:
    """Drag on a disc that enters fluid at ``speed`` in a periodic box of six diameters, (steps,).

    frame 0: the disc stands and the fluid streams;  1: the fluid stands and the disc goes;  others between and beyond.
    """  # fmt: skip
    cells = round(6 * diameter)
    coupled = towed(
        (cells, cells), [(cells / 2, cells / 2)], diameter / 2, (-frame * speed, 0.0), sides=PERIODIC,
    )  # fmt: skip
    coupled.fluid.set_flow((1 - frame) * speed, 0.0)
    coupled.inner_velocity[:] = coupled.grains.discs.velocity
    drag = np.zeros(steps)
    with one_thread():
        for step in range(steps):
            coupled.advance()
            drag[step] = coupled.fluid_force[0, 0]
    return drag


def settled_speed(
    ratio: float,
    blockage: float = 0.2,
    diameter: float = 10.0,
    *,
    relaxation_time: float = TAU,
    speed: float = 1e-4,
    gravity_in_fluid: bool = False,
) -> float:
    """Speed over the expected one of a free disc of density ``ratio`` that sinks or rises in a closed channel.

    Expected: (s - 1) g pi a²/(mu K), K by Faxen.  gravity_in_fluid: the fluid is pulled down too; what it then
    leaves of a disc's load at rest, of its pressure and the push of the force, is measured and put right.
    """  # fmt: skip
    width = round(diameter / blockage)
    nu, a = viscosity(relaxation_time), diameter / 2
    g = speed * nu * faxen(diameter / width) / ((ratio - 1) * math.pi * a**2)
    cells = width, 4 * width

    def made(held: bool, pulled: bool) -> float:
        """The speed a disc settles at, or the load on one that is held, in cells and steps."""
        coupled = immersed(
            cells, [(width / 2, cells[1] / 2 + 0.3)], a, ratio, relaxation_time=relaxation_time,
            acceleration=(0.0, 0.0 if held else -g), force=(0.0, -g if pulled else 0.0),
        )  # fmt: skip
        if pulled:  # start with the pressure of water at rest
            depth = cells[1] / 2 - 0.5 - np.arange(cells[1])
            coupled.fluid.set_flow(0.0, 0.0, 1 + 3 * g * depth[:, None])
        if held:
            coupled.grains.hold(0)
        elif pulled:
            coupled.weight[0, 1] = -coupled.grains.discs.mass[0] * g + math.pi * a**2 * g - left
        discs = coupled.grains.discs
        memory = max((width / (2 * math.pi)) ** 2 / nu, (ratio + 1) * math.pi * a**2 / (nu * 16))
        load, push = coupled.fluid_force, coupled.push
        value = (lambda: float(load[0, 1] + push[0, 1])) if held else lambda: float(discs.velocity[0, 1])
        return steady(coupled, value, memory, 1e-4)

    left = made(True, True) if gravity_in_fluid else 0.0
    return abs(made(False, gravity_in_fluid)) / speed


def kiss(
    cells_per_diameter: int = 20,
    *,
    relaxation_time: float = 0.512,
    density_ratio: float = 1.5,
) -> tuple[float, Reals]:
    """Time (s) at which two falling discs first touch, and their places then (2, 2) in diameters.

    Uhlmann 2005: channel 8 x 24 diameters, d 0.25 cm, s 1.5, nu 0.01 cm²/s, g 9.81 m/s², released at rest 4 and 6
    diameters below the top, d/250 to the right and to the left of the middle.  nan if they do not touch within 0.3 s.
    """  # fmt: skip
    diameter, nu = 0.0025, 1e-6
    spacing = diameter / cells_per_diameter
    step = (relaxation_time - 0.5) / 3 * spacing**2 / nu
    offset = diameter / 250
    place = [(4 * diameter + offset, 20 * diameter), (4 * diameter - offset, 18 * diameter)]
    coupled = immersed(
        (8 * cells_per_diameter, 24 * cells_per_diameter), place, diameter / 2, 1000 * density_ratio,
        acceleration=(0.0, -9.81), scales=Scales(spacing, step, relaxation_time),
    )  # fmt: skip
    at, time, gap = coupled.grains.discs.position, 0.0, diameter
    with one_thread():
        while time < 0.3:
            coupled.advance()
            before, gap = gap, float(np.hypot(*(at[0] - at[1]))) - diameter
            time = coupled.fluid.step * step
            if gap <= 0:
                return time - step * gap / (gap - before), at / diameter
    return float("nan"), at / diameter


def approach(
    gaps: tuple[float, ...] = (0.6, 0.4, 0.3),
    *,
    radius: float = 10.0,
    relaxation_time: float = 0.6,
    ratio: float = 2.0,
    method: Method = DEFAULT,
) -> list[float]:
    """Speed times mu over the weight per metre of a disc that sinks to the floor, at gaps in radii, descending.

    Box 12 by 6 radii, lattice units; released 1.2 radii up, so slowly that the flow follows.
    """  # fmt: skip
    nu = viscosity(relaxation_time)
    weight = 2e-3 * nu**2 * jeffrey_onishi(1.0)  # a Reynolds number of 0.002 or so
    g = weight / ((ratio - 1) * np.pi * radius**2)
    coupled = immersed(
        (round(12 * radius), round(6 * radius)), [(6 * radius + 0.3, 2.0 * radius)], radius, ratio,
        relaxation_time=relaxation_time, acceleration=(0.0, -g), method=method,
    )  # fmt: skip
    discs, found = coupled.grains.discs, []
    with one_thread():
        for gap in gaps:
            while discs.position[0, 1] > radius * (1 + gap):
                coupled.advance()
            found.append(-float(discs.velocity[0, 1]) * nu / weight)
    return found


VALIDATIONS = Validations()

OSCILLATIONS = ((5.0, 10.0, 0.6), (20.0, 10.0, 0.53), (100.0, 20.0, 0.515))
"""Frequency a² w/nu, radius in cells, tau."""
SHEAR = {0.25: 0.48208, 0.125: 0.49567}
"""Spin over shear rate of a free disc midway between walls in slow flow, by diameter over their distance: point forces
(tests/reference/coupling/stokes_box.py), five digits; 1/2 without walls."""
SINKING = (0.8, 2.5, 10.0)
KISS = 0.173


@VALIDATIONS.row(
    "coupling.oscillating_disc",
    source="Stokes 1851: force -rho pi a² G dU/dt, G 2.284 - 1.637 i, 1.635 - 0.7287 i, 1.283 - 0.3025 i; images of the"
    " dipole in the box (10 a wide) added",
    because="4 %, as for the release from rest: the rim is a cell thick where the viscous layer has 6, 3 and 3, and"
    " the box counts to the fourth power, (a/W)⁴ 3.4² = 0.1 %",
    tolerance=0.04,
    slow=True,
)
def oscillation_row() -> Measured:
    """Added mass and damping, real and less the imaginary part of G, at a² w/nu = 5, 20, 100; error |dG|/|G|."""
    exact = [oscillation_in_a_box(frequency) for frequency, _, _ in OSCILLATIONS]
    found = [oscillation(f, radius=a, relaxation_time=tau) for f, a, tau in OSCILLATIONS]
    error = float(max(abs(one - two) / abs(two) for one, two in zip(found, exact, strict=True)))
    return Measured(_parts(exact), _parts(found), error)


def _parts(values: list[complex]) -> list[float]:
    return [part for value in values for part in (value.real, -value.imag)]


@VALIDATIONS.row(
    "coupling.neutral_disc_in_shear",
    source="half the shear rate (Einstein 1906; Ding & Aidun 2000 for small Re and blockage), walls by point forces",
    because="0.1 %: walls take 4 k² of half the rate, up to 3.6 %, which goes as R²: 0.05 % for a radius 0.73 % off,"
    " and as much that the two places leave; at one of them a disc looks up to 0.6 % longer across than along, and the"
    " strain turns it by as much, at the other the same the other way",
    tolerance=1e-3,
    slow=True,
)
def shear() -> Measured:
    """Spin over shear rate, diameter over the distance of the walls 0.25 and 0.125, Re 0.01, 10 cells per diameter.

    Mean over two places in the cell that change places when along and across do.
    """
    found = [float(np.mean([shear_spin(k, place=place) for place in ((0.3, 0.0), (0.0, 0.3))])) for k in SHEAR]
    return Measured.relative(list(SHEAR.values()), found)


@VALIDATIONS.row(
    "coupling.galilean_invariance",
    source="the same drag whether the disc stands or the fluid",
    because="1e-3: the lattice's error of third order in speed, 3 u² = 1.2e-3 of the viscosity at 0.02",
    tolerance=1.2e-3,
)
def galilean() -> Measured:
    """Mean drag over 20 cells of way, seen from the disc, from halfway and from the fluid at rest."""
    means = [float(stream_drag(frame)[1000:].mean()) for frame in (0.0, 0.5, 1.0)]
    return Measured.relative(means[0], means)


@VALIDATIONS.row(
    "coupling.terminal_speed",
    source="(s - 1) g pi a²/(mu K), K by Faxen 1946 for a channel, k 0.2",
    because="0.73 % of the radius, as on arrays, the speed goes as its power 1.15: 0.84 %; for every density alike",
    tolerance=1.15 * RADIUS,
    slow=True,
)
def terminal() -> Measured:
    """Speed over the expected one of a free disc of density ratio 0.8, 2.5 and 10."""
    found = [settled_speed(ratio, relaxation_time=0.6) for ratio in SINKING]
    return Measured.absolute([1.0] * len(found), found)


@VALIDATIONS.row(
    "coupling.terminal_speed_of_a_heavy_disc",
    source="as for lighter ones",
    because="as for lighter ones",
    tolerance=1.15 * RADIUS,
    slow=True,
)
def heavy() -> Measured:
    """Speed over the expected one of a free disc of density ratio 100."""
    return Measured.absolute(1.0, settled_speed(100.0, relaxation_time=0.6))


@VALIDATIONS.row(
    "coupling.gravity_in_the_fluid",
    source="a disc sinks alike where the fluid has weight and where the pressure is the reduced one",
    because="0.3 %: forces act half a step apart from velocities, and half a step of gravity is 0.23 % of the speed;"
    " what cells bear of a disc at rest, put right, is the same everywhere",
    tolerance=3e-3,
    slow=True,
)
def gravity() -> Measured:
    """Terminal speed with gravity in the fluid, over that with the reduced pressure, density ratio 2.5."""
    pair = [settled_speed(2.5, relaxation_time=0.6, gravity_in_fluid=pulled) for pulled in (False, True)]
    return Measured.relative(pair[0], pair[1])


@VALIDATIONS.row(
    "coupling.approach_to_the_bottom",
    source="Jeffrey & Onishi 1981: speed W (alpha - tanh alpha)/(4 pi mu) of a disc that sinks to a floor, weight W",
    because="3.3 %: the other walls of the box add 1.1 to a drag of 47 at the largest gap, 2.4 % (point forces, as for"
    " the cylinder near a wall); a quarter of 0.73 % of the radius, 20 cells wide, in the gap of 3 cells to the power"
    " 3/2, 0.9 %",
    tolerance=0.033,
    slow=True,
)
def approach_row() -> Measured:
    """Speed over the law's at gaps of 0.6, 0.4 and 0.3 radii; radius 10 cells, density ratio 2, tau 0.6."""
    gaps = (0.6, 0.4, 0.3)
    found = [v * jeffrey_onishi(gap) for v, gap in zip(approach(gaps), gaps, strict=True)]
    return Measured.absolute([1.0] * len(found), found)


@VALIDATIONS.row(
    "coupling.drafting_and_kissing",
    source="Feng, Hu & Joseph 1994; Uhlmann 2005: two discs in a channel of 8 x 24 diameters touch after 0.173 s",
    because="2 %: three digits of the source, and at half the resolution the time differs by 3 %, so here by 1 % if"
    " the error falls at second order, 1.5 % at first",
    tolerance=0.02,
)
def kissing() -> Measured:
    """Time of the first touch, s, at 20 cells per diameter, tau 0.512."""
    return Measured.relative(KISS, kiss(20)[0])
