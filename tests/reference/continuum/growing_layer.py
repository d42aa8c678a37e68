"""A layer under its own weight that consolidates while its stiffness grows with the stress, by finite differences."""

import numpy as np


def half_times(power: float, rows: int, already: float = 0.1) -> tuple[float, float]:
    """T_v at which half of the excess pressure is left at the floor, and half of the settlement of the centre to come.

    M goes with the effective stress to ``power``; water bears all that the layer weighs beyond a share ``already``; T_v
    is that of the M which load H/3 over the settlement of the centre in the end shows.  Drained at the top; k stays.
    H, the weight of the layer and k over that of water are 1.  Explicit in time.
    """
    dy = 1.0 / rows
    height = (np.arange(rows) + 0.5) * dy
    weight, m = 1.0 - height, 1.0 - power
    strain = (weight**m - (already * weight) ** m) / m  # of a stress s from already * weight on: the integral of ds/M
    arm = height[::-1]  # of its strain on the centre
    modulus = (1.0 - already) / 3.0 / float((strain * arm).sum() * dy)
    now, flow, times, left, come = np.zeros(rows), np.zeros(rows + 1), [], [], []
    while not come or come[-1] < 0.6 or left[-1] > 0.4:
        excess = weight - (m * now + (already * weight) ** m) ** (1.0 / m)
        flow[1:rows] = (excess[:-1] - excess[1:]) / dy
        flow[rows] = 2.0 * excess[-1] / dy
        times.append(0.4 * dy**2 * len(times) * modulus)
        left.append((1.5 * excess[0] - 0.5 * excess[1]) / (1.0 - already))
        come.append(float((now * arm).sum() / (strain * arm).sum()))
        now += 0.4 * dy * np.diff(flow)
    return float(np.interp(-0.5, -np.array(left), times)), float(np.interp(0.5, come, times))
