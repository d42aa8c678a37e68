"""Small scenes of the continuum with everything that ground, water and air can have: what readers are tried on."""

from typing import Any

PILE = """\
title = "A sheet pile between two levels"
[tank]
width = 1.02
height = 0.9
lid = false
[water]
sound_speed = 30
[[water.column]]
width = 1.02
height = 0.6
[soil]
density = 1590
stiffness = 4e5
permeability = "1 cm/s"
friction_angle = "30 degree"
[[soil.body]]
outline = [[0, 0], [1.02, 0], [1.02, 0.45], [0, 0.45]]
[soil.numerics]
settle = 0.5
[pile]
x = 0.51
tip = 0.24
faces = "hold"
[[reservoir]]
name = "upstream"
left = 0
right = 0.48
bottom = 0.45
rise = [[0, 0.6], [0.5, 0.75]]
[[reservoir]]
name = "downstream"
left = 0.54
right = 1.02
bottom = 0.45
level = 0.6
[[probe]]
name = "tip"
x = 0.6
y = 0.2
[[level]]
name = "left"
x = 0.2
[time]
end = 0.6
[output]
snapshot_interval = 0.1
series_interval = 0.02
"""

AIR = """\
title = "Water on soil full of air"
[tank]
width = 0.3
height = 0.99
lid = false
[water]
sound_speed = 40
[[water.column]]
bottom = 0.6
width = 0.3
height = 0.21
[air]
density = 10
[soil]
permeability = "1 cm/s"
elastic = true
[[soil.body]]
outline = [[0, 0], [0.3, 0], [0.3, 0.6], [0, 0.6]]
[time]
end = 0.1
[output]
snapshot_interval = 0.05
series_interval = 0.01
"""

TWO_FLUIDS = """\
title = "A bubble"
[tank]
width = 0.4
height = 0.6
[[water.column]]
width = 0.4
height = 0.5
[inclusion]
density = 1.207
viscosity = 1.81e-5
law = "adiabatic"
surface_tension = 0.072
[[inclusion.disc]]
x = 0.2
y = 0.2
radius = 0.08
[numerics]
spacing = 0.02
[time]
end = 0.1
[output]
snapshot_interval = 0.05
series_interval = 0.01
"""

SEEPING = """\
[numerics]
spacing = 0.03
smoothing_ratio = 2
shifting = 0
tension = "cut"
artificial_viscosity = 0.1
"""

SCENES = {"pile": PILE + SEEPING, "air": AIR + SEEPING, "bubble": TWO_FLUIDS}


def put(table: dict[str, Any], key: str, value: object) -> None:
    """Set ``key`` (``soil.density``, ``reservoir.0.left``) of a scene's table: overwrites it."""
    *path, last = key.split(".")
    here: Any = table
    for part in path:
        here = here[int(part)] if isinstance(here, list) else here.setdefault(part, {})
    here[int(last) if isinstance(here, list) else last] = value
