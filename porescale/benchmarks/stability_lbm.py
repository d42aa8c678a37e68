"""Where each collision operator stays stable and where it is right: flows of the stability map, lattice units.

Every flow starts as hard as it can: shear layers thinner than a cell, a lid that moves at once at its full speed.
"""

import math
from collections.abc import Collection
from typing import Any

import numpy as np

from porescale.common.evidence.stability import Axis, Stability, Tried
from porescale.lbm.boundary.sides import Sides
from porescale.lbm.collision.choose import OPERATORS
from porescale.lbm.collision.smagorinsky import CONSTANT
from porescale.lbm.fluid import Fluid
from porescale.lbm.lattice import relaxation_time, viscosity
from porescale.lbm.sanity import SOUND, sane
from porescale.validation.lbm.channels import one_thread

STABILITY = Stability()

LOOK_EVERY = 50
"""Steps between two checks of the state."""

MAGICS = {"trt": {"trt 3/16": 3 / 16, "trt 1/4": 1 / 4}}
"""Operators whose magic parameter is varied."""

MACHS = Axis("Mach number", (0.02, 0.05, 0.1, 0.2, 0.3), (0.05, 0.3))
EXCESS = Axis(
    "relaxation time - 1/2",
    (4.5, 1.5, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0001),
    (4.5, 0.5, 0.01, 0.0001),
)
REYNOLDS = Axis("Reynolds number", (100, 400, 1000, 1500, 2000, 3000, 5000, 1e4, 1e5, 1e6, 1e7), (100, 1e4, 1e6))

VORTEX_CELLS = 48
LAYER_CELLS = 64
CAVITY_CELLS = 48
CAVITY_SWEEPS = {100: 24, 400: 48, 1000: 60}
"""Lid passages after which the cavity is steady to a per mille, by Reynolds number."""
IMPULSE_SWEEPS = 12
"""Lid passages that an impulsive start must be survived."""
CAVITY_LEAST = {100: -0.21090, 400: -0.32726, 1000: -0.38857}
"""Least velocity on the vertical centre line over the lid's: Ghia, Ghia & Shin 1982; Re 1000: Botella & Peyret 1998."""


def variants(quick: bool) -> dict[str, dict[str, Any]]:
    """Keyword arguments of ``Fluid`` by name: every operator, with eddies and without, and without in float32."""
    operators: Collection[str] = {"trt": "", "central": ""} if quick else OPERATORS
    plain: dict[str, dict[str, Any]] = {}
    for name in operators:
        for label, magic in MAGICS.get(name, {name: None}).items():
            plain[label] = {"operator": name} | ({} if magic is None else {"magic": magic})
            if quick:
                break
    if quick:
        return plain
    eddies = {f"{label} + eddies": {**law, "smagorinsky": CONSTANT} for label, law in plain.items()}
    single = {f"{label}, float32": {**law, "dtype": np.float32} for label, law in plain.items()}
    return plain | eddies | single


def laws(quick: bool) -> list[str]:
    """Names of the variants."""
    return list(variants(quick))


def lasts(fluid: Fluid, steps: int) -> bool:
    """Advance; whether the state stayed finite and in bounds, checked every 50 steps."""
    with np.errstate(over="ignore", invalid="ignore"), one_thread():
        for step in range(1, steps + 1):
            fluid.advance()
            if (step % LOOK_EVERY == 0 or step == steps) and not sane(fluid):
                return False
    return True


def made(law: str, cells: int, tau: float, sides: Sides) -> Fluid:
    """A square box of fluid under the law of that name."""
    return Fluid(cells, cells, tau, sides=sides, **variants(False)[law])


PERIODIC = Sides("periodic", "periodic", "periodic", "periodic")


def decay_error(law: str, tau: float, mach: float) -> float | None:
    """|nu/nu_wanted - 1| from the decay of Taylor-Green vortices carried along at half their speed; None: unstable.

    48² cells; ``mach``: of the vortices' top speed and the carrying speed together.  The decay is that of the wave's
    Fourier amplitudes (where it has been carried to does not count), from when the start is forgotten until it has
    decayed by exp(-1/2), or for 1000 steps.
    """
    n, k = VORTEX_CELLS, 2 * math.pi / VORTEX_CELLS
    rate = 2 * viscosity(tau) * k**2
    top = mach * SOUND / 1.5
    fluid = made(law, n, tau, PERIODIC)
    y, x = np.mgrid[:n, :n] * k
    ux, uy = -top * np.cos(x) * np.sin(y), top * np.sin(x) * np.cos(y)
    rho = 1 - 0.75 * top**2 * (np.cos(2 * x) + np.cos(2 * y))
    fluid.set_flow(ux + top / 2, uy + top / 4, rho)
    steps = int(min(max(0.5 / rate, 20), 1000))
    forgotten = min(4 * int(tau) + 2, steps // 2)
    if not lasts(fluid, forgotten):
        return None
    before = _amplitude(fluid)
    if not lasts(fluid, steps - forgotten):
        return None
    return abs(math.log(before / _amplitude(fluid)) / ((steps - forgotten) * rate) - 1)


def _amplitude(fluid: Fluid) -> float:
    """Size of the four waves (±1, ±1) of the velocity."""
    _, ux, uy = fluid.fields()
    waves = [np.fft.fft2(u.astype(float))[np.ix_([1, -1], [1, -1])] for u in (ux, uy)]
    return float(np.sqrt(np.sum(np.abs(waves) ** 2)))


def shear_layer(law: str, tau: float, mach: float) -> bool:
    """Whether two shear layers, thinner than a cell and disturbed, outlast one and a half crossings of the box.

    64² cells, u = tanh(80 (y - 1/4)), tanh(80 (3/4 - y)), v = 0.05 sin(2 pi (x + 1/4)) (Minion & Brown 1997, the
    thin layer).
    """
    n = LAYER_CELLS
    speed = mach * SOUND
    fluid = made(law, n, tau, PERIODIC)
    y, x = (np.mgrid[:n, :n] + 0.5) / n
    ux = np.where(y <= 0.5, np.tanh(80 * (y - 0.25)), np.tanh(80 * (0.75 - y)))
    fluid.set_flow(speed * ux, 0.05 * speed * np.sin(2 * math.pi * (x + 0.25)))
    return lasts(fluid, math.ceil(1.5 * n / speed))


@STABILITY.flow(
    "lbm.shear",
    title="Thin double shear layer (stable?) and carried Taylor-Green vortices (right?)",
    x=EXCESS,
    y=MACHS,
    laws=laws,
    right=0.05,
    because="viscosity within 5 % of the wanted one, at 48 cells a wave; compressibility costs 3 Mach²/4, 7 % at 0.3",
    limit="cell Reynolds number",
)
def shear(law: str, x: float, y: float) -> Tried:
    """tau - 1/2 against the Mach number."""
    holds = shear_layer(law, 0.5 + x, y)
    error = decay_error(law, 0.5 + x, y)
    numbers = {"cell Reynolds number": y * SOUND / viscosity(0.5 + x), "viscosity error": math.nan}
    if error is not None:
        numbers["viscosity error"] = error
    return Tried(holds and error is not None, error, numbers)


@STABILITY.flow(
    "lbm.cavity",
    title="Lid-driven cavity on 48² cells, the lid started at once",
    x=REYNOLDS,
    y=Axis("Mach number", (0.1, 0.3), (0.3,)),
    laws=laws,
    right=0.1,
    because="least velocity on the centre line within 10 % of Ghia, Ghia & Shin 1982 (Re 1000: Botella & Peyret 1998);"
    " there a cell is two thirds of the layer at the wall, 1/sqrt(Re); beyond, nothing is judged",
    judged=1000,
    monotone=True,
    limit="cell Reynolds number",
)
def cavity(law: str, x: float, y: float) -> Tried:
    """Reynolds number of lid and box, as far as it goes."""
    n, lid = CAVITY_CELLS, y * SOUND
    tau = relaxation_time(lid * n / x)
    fluid = made(law, n, tau, Sides(top_speed=lid))
    holds = lasts(fluid, math.ceil(CAVITY_SWEEPS.get(int(x), IMPULSE_SWEEPS) * n / lid))
    numbers = {"relaxation time": tau, "cell Reynolds number": x / n}
    if not holds or int(x) not in CAVITY_LEAST:
        return Tried(holds, None, numbers)
    least = float(fluid.fields()[1][:, n // 2 - 1 : n // 2 + 1].mean(axis=1).min()) / lid
    return Tried(True, abs(least / CAVITY_LEAST[int(x)] - 1), numbers)
