"""A layer whose water bears its weight at first, of grains or of soil: what is read of it as it consolidates."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from porescale import Floats

SLOWEST = 0.25 * math.pi**2  # lambda² of Terzaghi's slowest mode, cos(lambda z/H) exp(-lambda² T_v)


@dataclass(frozen=True)
class Layer:
    """A layer that consolidates.

    height m;  porosity;  load : Pa, what it weighs more at its floor;  times : (t,) s, since;  excess : (t, rows) Pa,
    of its water at ``heights`` (rows,) m, the floor first;  settled : (t,) m, of its centre;
    storage : 1/Pa, by what its water is compressed: n/K_w; more on a lattice, which has water inside of discs, too;
    sudden : the load was put on, so that what compresses water comes at once; else water bears all of it at first;
    mobility : m²/(Pa s), the K/(rho nu) that is said of it.
    """

    height: float
    porosity: float
    load: float
    times: Floats
    heights: Floats
    excess: Floats
    settled: Floats
    storage: float
    sudden: bool = False
    mobility: float = math.nan

    @property
    def settlement(self) -> float:
        """Settlement of the centre (m) in the end.  Where the look ends only the slowest mode is left, of which
        3/lambda² times the share of the load that the floor still has is to come."""
        still = self.excess[-10:, 0].mean() / self.load
        return float(self.settled[-10:].mean() / (1.0 - 3.0 / SLOWEST * still))

    @property
    def modulus(self) -> float:
        """M (Pa): the centre of a layer of the same M everywhere settles by load H/(3 M) under its own weight."""
        return self.load * self.height / (3.0 * self.settlement)

    @property
    def borne(self) -> float:
        """Share of the load that water bears at first."""
        return 1.0 / (1.0 + self.storage * self.modulus) if self.sudden else 1.0

    @property
    def left(self) -> Floats:
        """Excess pressure at the floor over that at first, (t,)."""
        return self.excess[:, 0] / (self.borne * self.load)

    @property
    def to_come(self) -> Floats:
        """Share of the settlement still to come, (t,), of what does not come at once."""
        return (1.0 - self.settled / self.settlement) / self.borne

    @property
    def seen(self) -> float:
        """K/(rho nu), m²/(Pa s), of the layer itself, while 0.7 to 0.25 are left at its floor: where the grains go down
        as much water goes up, which takes all the pressure that there is at the floor.  To this water that expands adds
        1/lambda² of its volume, as in the slowest mode."""
        first, last = (int(np.flatnonzero(self.left > it)[-1]) for it in (0.7, 0.25))
        floor = self.excess[first : last + 1, 0]
        out = self.settled[last] - self.settled[first]
        out += self.storage * self.height * (floor[0] - floor[-1]) / SLOWEST
        return float(self.height * out / np.trapezoid(floor, self.times[first : last + 1]))

    def factor(self, time: float | Floats) -> Any:
        """T_v = c_v t/H² of a ``time`` (s), c_v = K/(rho nu (1/M + n/K_w))."""
        return self.mobility / (1.0 / self.modulus + self.storage) * time / self.height**2

    @property
    def half_left(self) -> float:
        """T_v at which half of the excess pressure is left at the floor."""
        return float(self.factor(half_way(self.times, self.left)))

    @property
    def half_settled(self) -> float:
        """T_v at which half of the settlement has come."""
        return float(self.factor(half_way(self.times, self.to_come)))


def half_way(times: Floats, left: Floats) -> float:
    """Time at which half is ``left`` (t,) of what decays: on a parabola through the times (t,) of all between 0.35 and
    0.65 over the logarithm, so that swings even out; nan where there are too few."""
    near = (left > 0.35) & (left < 0.65)
    if near.sum() < 4:
        return math.nan
    return float(np.polyfit(np.log(2.0 * left[near]), times[near], 2)[-1])


def terzaghi(factor: Floats, z: Floats) -> tuple[Floats, Floats]:
    """Of a layer whose water bears its weight at first: excess pressure over the load at z/H (rows,), and share of the
    settlement of its centre that is to come, at T_v (t,): (t, rows), (t,)."""
    mode = (np.arange(200) + 0.5) * np.pi
    decay = np.exp(-np.outer(factor, mode**2))
    return decay @ (2.0 / mode[:, None] ** 2 * np.cos(np.outer(mode, z))), decay @ (6.0 / mode**4)
