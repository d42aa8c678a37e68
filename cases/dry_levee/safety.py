"""Factors of safety of both slopes by Bishop's simplified method, under the pore pressures of a finished run.

    continuum-sph run cases/dry_levee --out runs/dry_levee
    python cases/dry_levee/safety.py runs/dry_levee

The least of circles that cut at least a tenth of the height deep, in the first outline; soil weighs what it and the
water in it do in the mean; dry pores have no pressure; φ' and c' of the scene.
"""

import argparse
from pathlib import Path
from typing import Any

import numpy as np

import porescale as ps
from continuum_sph.validation.unsaturated import slices

EVERY = 1.0  # s
REACH = 2.0  # spacings: pores without water so near are dry
MANY = 6  # particles of water whose pressures a mean is of: neighbours of one in a lattice of triangles
CENTRES = [(along, up) for along in np.linspace(0.2, 1.3, 12) for up in (0.6, 0.8, 1.0, 1.3, 1.7, 2.2, 3.0)]
"""Of circles: way down the slope over its run, height over the levee's."""


def slope(run: ps.Run, snapshot: Any) -> slices.Slope:
    """The levee at a snapshot as `slices` take it."""
    scene, water = run.card["scene"], snapshot.clouds["water"]
    soil, outer = scene["soil"], scene["reservoir"][0]
    outline, density = np.array(soil["body"][0]["outline"]), scene["water"]["density"]
    specific, spacing = density * scene["gravity"], scene["numerics"]["spacing"]
    foot, toe, edge, top = outline
    surface = np.array([[0.0, foot[1]], foot, top, edge, toe, [scene["tank"]["width"], toe[1]]])
    level = float(np.interp(snapshot.time, *np.array(outer["rise"]).T))
    x, pressure = water.position[:, :2], water.data["pressure"]
    wet = float((snapshot.clouds["soil"].data["saturation"] > 0.5).mean())

    def pore(px: ps.Floats, py: ps.Floats) -> ps.Floats:
        """Pressure (Pa) of the nearest water, each with the height to it, at (px, py) (k,) m."""
        away = (px[:, None] - x[:, 0]) ** 2 + (py[:, None] - x[:, 1]) ** 2
        nearest = away.argsort(axis=1)[:, :MANY]
        found = (pressure[nearest] + specific * (x[nearest, 1] - py[:, None])).mean(axis=1)
        near = away.min(axis=1) < (REACH * spacing) ** 2
        return np.where(near, np.maximum(found, 0.0), 0.0)

    def river(px: ps.Floats) -> ps.Floats:
        """Level (m) of the open water at ``px`` (k,) m."""
        return np.where(px < 0.5 * (top[0] + edge[0]), level, 0.0)

    weight = scene["gravity"] * (soil["density"] + soil["porosity"] * density * wet)
    friction = soil["friction_angle"]
    return slices.Slope(surface, weight, soil["cohesion"], friction, pore, river, specific)


def least(given: slices.Slope, right: bool) -> float:
    """The least factor of the land side, or of the river's."""
    foot, top, edge, toe = given.surface[1:5]
    height, (crest, end) = float(top[1]), (edge[0], toe[0]) if right else (top[0], foot[0])
    centres = [(crest + along * (end - crest), up * height) for along, up in CENTRES]
    depths = np.linspace(0.0, 0.5 * height, 11)
    return slices.least(given, centres, tuple(depths), right=right, shallow=0.1 * height)[0]


def main() -> int:
    """A line for each second."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="of the run")
    folder, due = parser.parse_args().folder, 0.0
    try:
        run = ps.open_run(folder)
    except ps.PorescaleError as error:
        parser.error(str(error))
    if not any(it["rise"] for it in run.card["scene"].get("reservoir", ())[:1]):
        parser.error(f"folder = {str(folder)!r}: is no run of dry_levee")
    print("| s | river side | land side |\n|---|---|---|")
    for snapshot in run.snapshots():
        if snapshot.time > due - 1e-3:
            due += EVERY
            given = slope(run, snapshot)
            river, land = (least(given, right) for right in (False, True))
            print(f"| {snapshot.time:.0f} | {river:.2f} | {land:.2f} |")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
