"""What is varied in search of the second vortex: a name, the case that is run, and its settings.

A setting is what `porescale run CASE --set SETTING` takes.
"""

from dataclasses import dataclass

TANK, BOX = "column_collapse_tank", "column_collapse"
COARSE = ("fluid.spacing=1e-3", "fluid.step=8.33333333333333e-5")
"""6 cells per bead: an eighth of the draft's work."""
FIVE = ("fluid.spacing=3e-4", "fluid.step=3.6e-5")
"""5 cells per grain of the box, where its draft has 4."""
SPARSE = ("output.snapshot_interval=0.05",)
"""Runs that are not filmed."""


@dataclass(frozen=True)
class Variant:
    """A run.  case : its folder in cases/;  settings : what differs from it;  cells : per bead."""

    name: str
    case: str
    settings: tuple[str, ...]
    cells: int


def _gate(speed: float | None) -> tuple[str, ...]:
    """A gate without thickness instead of the slab; None: it vanishes at once."""
    lift = "" if speed is None else f", lift_speed = {speed:g}"
    return ("rectangle=[]", f"gate={{x = 0.15, opens_at = 0.05, friction = 0.05{lift}}}")


def _slab(speed: float) -> tuple[str, ...]:
    return (f"rectangle[0].velocity=[0, {speed:g}]",)


FACTORS: dict[str, tuple[str, ...]] = {
    "as it is": (),
    "gate vanishes": _gate(None),
    "gate thin, 0.5 m/s": _gate(0.5),
    "gate 0.25 m/s": _slab(0.25),
    "gate 1 m/s": _slab(1.0),
    "viscosity 1e-5": ("fluid.viscosity=1e-5",),
    "viscosity 1e-4": ("fluid.viscosity=1e-4",),
    "viscosity 8e-4": ("fluid.viscosity=8e-4",),
    "viscosity 8e-4, gate vanishes": ("fluid.viscosity=8e-4", *_gate(None)),
    "lid, gate 0.25 m/s": ('domain.top="wall"', *_slab(0.25)),
    "lid, gate 1 m/s": ('domain.top="wall"', *_slab(1.0)),
    "lid": ('domain.top="wall"',),
    "lid, gate vanishes": ('domain.top="wall"', *_gate(None)),
    "viscosity 1e-5, gate vanishes": ("fluid.viscosity=1e-5", *_gate(None)),
    "viscosity 1e-4, gate vanishes": ("fluid.viscosity=1e-4", *_gate(None)),
    "no eddy viscosity": ("fluid.smagorinsky=1e-6",),
    "one bead for a column": (
        "grains={density = 2500, hydraulic_radius_ratio = 0.8, grain = [{x = 0.19, y = 0.003, diameter = 0.006}]}",
    ),
    "lambda 0.7": ("grains.hydraulic_radius_ratio=0.7",),
    "lambda 0.9": ("grains.hydraulic_radius_ratio=0.9",),
    "water 14 cm deep": ("domain.height=0.14",),
}
"""What is changed in the tank, one thing at a time but for the gate."""
FINER = ("as it is", "lid", "gate vanishes", "viscosity 1e-4")
"""Those that are run with 12 cells per bead, too."""


def _variants() -> list[Variant]:
    found = []
    for seed in (1, 2, 3):
        for name, settings in FACTORS.items():
            if any(setting.startswith("grains={") for setting in settings):  # no packing: one run, without a seed
                if seed == 1:
                    found.append(Variant(f"{name}, 6 cells", TANK, (*settings, *SPARSE, *COARSE), 6))
                continue
            made = (*settings, f"grains.packing.seed={seed}", *SPARSE)
            found.append(Variant(f"{name}, seed {seed}, 6 cells", TANK, (*made, *COARSE), 6))
    for seed in (1, 2, 3):
        for name in FINER:
            made = (*FACTORS[name], f"grains.packing.seed={seed}", *SPARSE)
            found.append(Variant(f"{name}, seed {seed}, 12 cells", TANK, made, 12))
    for name, settings in BOX_FACTORS.items():
        found.append(Variant(f"box, {name}, 5 cells", BOX, (*settings, *SPARSE, *FIVE), 5))
    return found


WATER = ("fluid.viscosity=1e-6", 'fluid.operator="central"', "fluid.smagorinsky=0.1")
BOX_FACTORS: dict[str, tuple[str, ...]] = {
    "as it is": (),
    "gate 0.5 m/s": ("gate.lift_speed=0.5",),
    "gate 0.5 m/s, seed 2": ("gate.lift_speed=0.5", "grains.packing.seed=2"),
    "gate 0.5 m/s, lid": ("gate.lift_speed=0.5", 'domain.top="wall"'),
    "water": WATER,
    "water, gate 0.5 m/s": (*WATER, "gate.lift_speed=0.5"),
}
"""What is changed in the box of the paper's simulation."""

VARIANTS: dict[str, Variant] = {it.name: it for it in _variants()}
