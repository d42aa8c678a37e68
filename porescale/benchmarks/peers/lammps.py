"""The contact loop beside LAMMPS (Thompson et al. 2022), pair style gran/hooke/history, on the same settled pile.

The same discs, springs, dashpots, friction, walls, gravity and step; both keep a half list with a skin and make it anew
when a disc has moved by half of it.  LAMMPS is a three-dimensional program held to a plane (fix enforce2d).
"""

from typing import Any

import numpy as np

from porescale.benchmarks.dem import DENSITY, LAW, SIZE, STEPS, float64_only, settled_pile
from porescale.common.core.constants import GRAVITY
from porescale.common.core.errors import Fault, InputError
from porescale.common.core.extras import extra
from porescale.common.evidence.benchmarks import Benchmarks, Dtype, Work
from porescale.dem.grains import Grains
from porescale.dem.prepare.settle import weights_of

PEERS = Benchmarks()
SKIN = 0.1
"""Of the neighbour list of LAMMPS, largest radii: with 0.05 and 0.2 it is slower on this pile."""


@PEERS.row("lammps")
def against_lammps(size: int | None, threads: int, dtype: Dtype) -> list[Work]:
    """Contact steps of a settled pile: ours, and those of LAMMPS, on one thread whatever ``threads``."""
    float64_only(dtype)
    grains = settled_pile(SIZE if size is None else size)
    weights, dt = weights_of(grains.discs, DENSITY), grains.stable_step()
    theirs = lammps_pile(grains, dt)

    def ours() -> None:
        """The steps, with a list of neighbours made anew when it is due."""
        grains.step(dt, weights, count=STEPS)

    count = grains.discs.count
    return [
        Work(ours, float(STEPS * count), "discs/s", count, variant="ours"),
        Work(lambda: theirs.command(f"run {STEPS} pre no post no"), float(STEPS * count), "discs/s", count,
             variant="peer", yardstick=True),
    ]  # fmt: skip


def lammps_pile(grains: Grains, dt: float) -> Any:
    """LAMMPS with the discs of ``grains`` where they are and a step of ``dt`` s.  InputError if it cannot be loaded."""
    discs, box = grains.discs, grains.box
    try:
        program = extra("lammps").lammps(cmdargs=["-screen", "none", "-log", "none"])
    except OSError as raised:
        repair = "install an MPI library, such as mpich"
        raise InputError(Fault("lammps", None, f"cannot be loaded ({raised})", repair=repair)) from None
    (left, bottom), (right, _) = box.lower, box.upper
    largest, top = float(discs.radius.max()), float(discs.position[:, 1].max() + 20 * discs.radius.max())
    half = float(discs.mass.mean()) / 2  # LAMMPS wants rates: coefficients over the reduced mass of a pair
    normal, tangential = LAW.damping / half, LAW.tangential_damping / half
    law = f"{LAW.stiffness} {LAW.tangential_stiffness} {normal} {tangential} {LAW.friction} 1"
    program.commands_list([
        "units si", "dimension 2", "boundary f f p", "atom_style sphere", "newton off", "comm_modify vel yes",
        f"region all block {left} {right} {bottom} {top} {-largest} {largest} units box", "create_box 1 all",
        f"neighbor {SKIN * largest} bin", "neigh_modify delay 0 every 1 check yes", f"timestep {dt}",
        f"pair_style gran/hooke/history {law}", "pair_coeff * *",
    ])  # fmt: skip
    count = discs.count
    at = np.column_stack((discs.position, np.zeros(count)))
    program.create_atoms(count, None, [1] * count, at.reshape(-1).tolist())
    order = program.numpy.extract_atom("id")[:count] - 1
    program.numpy.extract_atom("radius")[:count] = discs.radius[order]
    program.numpy.extract_atom("rmass")[:count] = discs.mass[order]
    program.commands_list([
        "fix plane all enforce2d", "fix motion all nve/sphere disc", f"fix weight all gravity {GRAVITY} vector 0 -1 0",
        f"fix sides all wall/gran hooke/history {law} xplane {left} {right}",
        f"fix floor all wall/gran hooke/history {law} yplane {bottom} NULL", "thermo 1000000", "run 0 post no",
    ])  # fmt: skip
    return program
