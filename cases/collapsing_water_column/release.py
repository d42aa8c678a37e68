"""How the column is let go: leads of the front over three experiments for gates that rise at several speeds."""

import argparse

import numpy as np

from continuum_sph.builders import wall_layers, water_flow
from continuum_sph.validation.water import dam_break as verify
from continuum_sph.validation.water import setups as trials
from continuum_sph.water import Flow, Layer
from porescale import GRAVITY
from porescale.common.neighbors import PairList, square_lattice

SCALE = (2.0 * GRAVITY) ** 0.5  # 1/s, √(2g/a), a = 1 m
WIDTH, HEIGHT = 1.0, 2.0  # m


def gated(flow: Flow, spacing: float) -> tuple[Flow, slice]:
    """A ``flow`` at rest with a gate of wall particles before its right face, and their rows."""
    layer, pairs = flow.layer, flow.pairs
    depth = wall_layers(flow.law, spacing) * spacing
    gate = square_lattice((WIDTH, 0.0), (WIDTH + depth, HEIGHT + depth), spacing)
    held = Layer(
        layer.fluid,
        np.vstack((layer.x, gate)),
        np.vstack((layer.v, np.zeros_like(gate))),
        np.concatenate((layer.mass, np.full(len(gate), layer.mass[-1]))),
        layer.density,
    )
    made = Flow(held, flow.law, PairList(held.count, pairs.skin, pairs.lower, pairs.upper, full=True))
    made.lower[:], made.upper[:] = flow.lower, flow.upper
    made.start()
    return made, slice(layer.count, held.count)


def front(across: int, clears: float, pressure: str) -> np.ndarray:
    """(k, 2) of t √(2g/a) and front/a; a gate rises evenly and leaves the water at t √(2g/a) = ``clears``, 0: none."""
    spacing = WIDTH / across
    flow = water_flow(trials.column_scene(spacing, tank=(5.0, 3.0), column=(WIDTH, HEIGHT), pressure=pressure))
    gate, speed = slice(0, 0), 0.0
    if clears > 0.0:
        flow, gate = gated(flow, spacing)
        speed = HEIGHT * SCALE / clears
        flow.layer.v[gate, 1] = speed
    found = [(0.0, 1.0)]
    while flow.time * SCALE < verify.LATEST:
        flow.layer.x[gate, 1] += speed * flow.next_step
        flow.advance()
        at = float(flow.layer.x[: flow.layer.fluid, 0].max()) + 0.5 * spacing
        found.append((flow.time * SCALE, at))
    return np.array(found)


def main() -> int:
    """Print, for each way of release, how the front stands to the published ones."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--across", type=int, default=20, help="particles over the width (default: 20)")
    across = parser.parse_args().across
    if across < 4:
        parser.error(f"--across = {across}: is out of range (allowed: 4 or more)")
    for clears, pressure in ((0.0, "released"), (0.0, "hydrostatic"), *((t, "hydrostatic") for t in (0.5, 1.0, 2.0))):
        moved = front(across, clears, pressure)
        print(f"gate gone at t √(2g/a) = {clears:g}, {pressure} at the start:")
        for name, series in verify.published_fronts().items():
            speed, lead = verify.front_against(moved, series)
            place = verify.front_since(moved, series)
            print(f"  {name}: leads by {lead:.1%}, speed {speed:.2f}, place from 1.5 a on within {place:.1%}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
