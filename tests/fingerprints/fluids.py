"""Fingerprints of the lattice: every collision operator, side, solid operator, weight and kind of body in fluid."""

from tests.fingerprints.subjects import Scene, Subject

CAVITY = """
gravity = [0, 0]
[domain]
width = 0.04
height = 0.032
top = { kind = "wall", speed = 0.1 }
[time]
end = 10
[output]
snapshot_interval = 1
series_interval = 1
fields = ["vorticity", "stream_function"]
[fluid]
density = 1000
spacing = 1e-3
step = 1e-3
viscosity = 2e-5
body_force = [3.0, 1.0]
velocity = [0.01, 0.02]
"""
SIDES = {
    "periodic": {"left": '"periodic"', "right": '"periodic"'},
    "slip": {"top": '"slip"', "bottom": '"slip"'},
    "through": {
        "left": '{ kind = "velocity", velocity = [0.05, 0.01], profile = "parabola" }',
        "right": '{ kind = "pressure", pressure = 0.5 }',
    },
    "upwards": {
        "bottom": '{ kind = "velocity", velocity = [0.01, 0.04] }',
        "top": '{ kind = "velocity", velocity = [0.0, 0.04], profile = "parabola" }',
    },
    "pressures": {"bottom": '{ kind = "pressure", pressure = 3 }', "top": '"pressure"'},
}
DISCS = """
[domain]
width = "12 mm"
height = "14 mm"
right = "slip"
[time]
end = 0.4
[output]
snapshot_interval = 1
series_interval = 1
[fluid]
density = 1000
viscosity = 5e-6
spacing = "0.25 mm"
step = 1e-4
[grains]
density = 2500
hydraulic_radius_ratio = 0.9
[[grains.grain]]
x = "4 mm"
y = "9 mm"
diameter = "2.5 mm"
velocity = [0.01, 0]
spin = 3
[[grains.grain]]
x = "6.6 mm"
y = "8.4 mm"
diameter = "2.6 mm"
[[grains.grain]]
x = "5.2 mm"
y = "11.5 mm"
diameter = "2 mm"
velocity = [0, -0.04]
[contact]
stiffness = 1e4
tangential_stiffness = 2.5e3
restitution = 0.6
friction = 0.4
"""
HELD = """
[[disc]]
x = "9.5 mm"
y = "4 mm"
diameter = "2 mm"
velocity = ["4 mm/s", 0]
spin = 2
"""
GATE = """
[gate]
x = "8.5 mm"
opens_at = 0.002
lift_speed = 0.2
"""
SLAB = """
[[rectangle]]
lower = ["8.6 mm", 0]
upper = ["9.8 mm", "15 mm"]
velocity = [0, "0.1 m/s"]
starts_at = 0.002
friction = 0.1
"""
BODIES = """
[[clump]]
discs = [["-0.8 mm", 0, "0.9 mm"], ["0.8 mm", 0, "0.9 mm"]]
at = [["3 mm", "3 mm"]]
angle = [0.4]
[[polygon]]
sides = 5
diameter = "2.6 mm"
thickness = "0.05 mm"
at = [["9.6 mm", "5 mm"]]
velocity = [0, -0.02]
[[control]]
grain = 2
name = "led"
x = { velocity = "1 mm/s" }
y = { displacement = [[0, 0], ["0.1 s", "-1 mm"]] }
rotation = { force = { amplitude = 1e-4, frequency = 10 } }
record = true
"""
LOADS = """
[loads]
grains = [0]
[[probe]]
name = "p"
x = "2 mm"
y = "2 mm"
[[flux]]
name = "f"
start = ["3 mm", 0]
end = ["3 mm", "14 mm"]
[[line]]
name = "l"
start = [0, "6 mm"]
end = ["12 mm", "6 mm"]
points = 21
[lubrication]
gap = 1.5
"""
ALONE = {
    operator: (f"fluid.operator={operator}",) for operator in ("trt", "mrt", "central", "bgk")
} | {
    "magic": ("fluid.magic=0.25",),
    "magic, float32": ("fluid.magic=0.25", "fluid.precision=float32"),
}  # fmt: skip
SOLIDS = ("odd-SC1", "SC1", "SC2", "SC3")


def _fluid(*settings: str, text: str = CAVITY) -> Scene:
    return Scene("porescale", 200, text=text, settings=settings)


def _solid(*settings: str, more: str = "") -> Scene:
    return Scene("porescale", 120, text=DISCS + more, settings=settings)


def subjects() -> dict[str, Subject]:
    """All by name."""
    found: dict[str, Subject] = {}
    for name, settings in ALONE.items():
        found[f"fluid/{name}"] = _fluid(*settings)
    for operator in ("trt", "mrt", "central", "bgk"):
        found[f"fluid/{operator}, eddies"] = _fluid(f"fluid.operator={operator}", "fluid.smagorinsky=0.1")
        found[f"fluid/{operator}, float32"] = _fluid(f"fluid.operator={operator}", "fluid.precision=float32")
    for name, sides in SIDES.items():
        head = "".join(f"{side} = {kind}\n" for side, kind in sides.items())
        rest = CAVITY if "top" not in sides else CAVITY.replace('top = { kind = "wall", speed = 0.1 }\n', "")
        found[f"fluid/{name}"] = _fluid(text=rest.replace("height = 0.032\n", f"height = 0.032\n{head}"))
    found["solid/exact-wall"] = _solid(more=HELD)
    found["solid/exact-wall, soft"] = _solid("fluid.rim=soft", more=HELD)
    found["solid/narrow-wall"] = _fluid("fluid.solid_operator=narrow-wall", "time.end=0.5", text=CAVITY + HELD)
    found["solid/exact-wall, float32"] = _solid("fluid.precision=float32", more=HELD)
    for operator in SOLIDS:
        for weight in ("B1", "B2"):
            chosen = (f"fluid.solid_operator={operator}", f"fluid.weighting={weight}")
            found[f"solid/{operator}, {weight}"] = _solid(*chosen, more=HELD)
    for operator in ("mrt", "central", "bgk"):
        found[f"solid/exact-wall, {operator}"] = _solid(f"fluid.operator={operator}", more=HELD)
    found["solid/central, sharp"] = _solid("fluid.operator=central", "fluid.rim=sharp", more=HELD)
    found["solid/trt, eddies"] = _solid("fluid.smagorinsky=0.1", more=HELD)
    found["solid/gate"] = _solid(more=GATE)
    found["solid/rectangle"] = _solid(more=SLAB)
    found["solid/bodies"] = _solid(more=BODIES)
    found["solid/measured, lubrication"] = _solid(more=LOADS)
    hertz = DISCS.replace("tangential_stiffness = 2.5e3\n", "").replace("stiffness = 1e4", 'law = "hertz"\nyoung = 2e6')
    found["solid/hertz"] = Scene("porescale", 120, text=hertz)
    return found
