"""Fingerprints of dry grains: every contact law, kind of friction and of bond, of bodies and of what drives them."""

from tests.fingerprints.subjects import Commands, Scene, Subject

HEAD = """
gravity = [1.0, -9.81]
[domain]
width = "8 cm"
height = "6 cm"
[time]
end = 1
[output]
snapshot_interval = 1
series_interval = 1
contacts = true
forces = true
[grains]
density = 2500
"""
PACKING = """
[grains.packing]
settle = false
left = 0
width = "5 cm"
height = "5 cm"
diameter = "6 mm"
size_spread = 0.2
packing_fraction = 0.7
seed = 3
"""
RAISED = PACKING.replace("left = 0", 'left = 0\nbottom = "5 mm"')
SETTLED = PACKING.replace("settle = false", "settle = true")
LINEAR = """
[contact]
stiffness = 1e5
tangential_stiffness = 4e4
restitution = 0.7
friction = 0.5
"""
SMOOTH = """
[contact]
stiffness = 1e5
restitution = 0.7
"""
HERTZ = """
[contact]
law = "hertz"
young = 1e7
poisson = 0.25
damping_ratio = 0.1
friction = 0.5
"""
STRAIGHT = ("gravity=[0,-9.81]", "domain.width=5 cm")
"""Room in which a packing settles."""
GATE = """
[gate]
x = "5 cm"
opens_at = 0.01
friction = 0.1
"""
STEEL = """
[[material]]
name = "sand"
[[material]]
name = "steel"
density = 7800
"""
TWO = """
[[grains.grain]]
x = "6 cm"
y = "2 cm"
diameter = "9 mm"
material = "steel"
[[grains.grain]]
x = "6.2 cm"
y = "3 cm"
diameter = "8 mm"
material = "steel"
velocity = [-0.5, 0]
"""
PAIR = """
[[contact.pair]]
materials = ["sand", "steel"]
friction = 0.2
"""
BODIES = """
[[clump]]
discs = [["-2.5 mm", 0, "3.5 mm"], ["2.5 mm", 0, "3.5 mm"]]
at = [["5.7 cm", "1.2 cm"], ["7.2 cm", "1.2 cm"]]
angle = [0.3, -0.2]
[[polygon]]
sides = 5
diameter = "12 mm"
thickness = "1 mm"
at = [["5.8 cm", "2.8 cm"], ["7.2 cm", "3.2 cm"]]
[[segment]]
chain = [["-6 mm", "6 mm"], ["-6 mm", "-4 mm"], ["6 mm", "-4 mm"]]
thickness = "1 mm"
at = [["6.5 cm", "5 cm"]]
"""
CONTAINER = """
[[container]]
name = "drum"
chain = [["5.2 cm", "5 cm"], ["5.2 cm", "3 mm"], ["7.6 cm", "3 mm"]]
thickness = "1 mm"
pivot = ["6 cm", "2 cm"]
rotation = { displacement = [[0, 0], [0.2, -0.5]] }
record = true
"""
CONTROL = """
[[control]]
grain = 0
name = "led"
x = { velocity = "2 cm/s" }
y = { displacement = [[0, 0], ["1 s", "5 mm"]] }
rotation = { force = { amplitude = 1e-3, frequency = 10 } }
record = true
[[wall]]
x = "4 cm"
y = "-1 cm"
normal = [0.3, 1]
friction = 0.3
velocity_y = "1 cm/s"
"""
GRAIN = """
[[grains.grain]]
x = "6.5 cm"
y = "4 cm"
diameter = "8 mm"
spin = 5
"""
REGIONS = """
[[region]]
name = "foot"
lower = ["1 cm", 0]
upper = ["4 cm", "2 cm"]
[coarse_graining]
spacing = "5 mm"
fields = ["solid_fraction", "velocity", "stress", "density", "strain_rate", "kinetic_stress"]
"""
CELL = """
gravity = [0, 0]
[domain]
width = "6 cm"
height = "6 cm"
left = "periodic"
right = "periodic"
bottom = "periodic"
top = "periodic"
[cell]
{cell}
[time]
end = 1
[output]
snapshot_interval = 1
series_interval = 1
[grains]
density = 2500
[grains.packing]
left = 0
width = "6 cm"
height = "6 cm"
diameter = "6 mm"
{sizes}
seed = 2
"""
ROCK = """
gravity = [0, 0]
[domain]
width = "6 cm"
height = "6 cm"
[time]
end = 1
[output]
snapshot_interval = 1
series_interval = 1
[grains]
density = 2500
[grains.packing]
left = "1 cm"
bottom = "1 cm"
width = "3 cm"
height = "3 cm"
diameter = "4 mm"
pressure = "10 kPa"
seed = 2
[rock]
kind = "{kind}"
{more}
strain = [[0, 0], ["1 s", -0.5]]
"""
CROWD = """
[grains.packing]
settle = false
left = 0
width = "95 cm"
height = "95 cm"
diameter = "6 mm"
size_spread = 0.2
packing_fraction = 0.7
seed = 3
"""
HEAVY = ("gravity=[30,-300]", "domain.width=95 cm", "domain.height=96 cm", "output.contacts=false")
"""Gaps close within some steps."""
ROLLING = ("contact.rolling_friction=0.2", "contact.rolling_stiffness=3e4", "contact.rolling_damping=1")
ROLLING_HERTZ = ("contact.rolling_friction=0.2", "contact.rolling_stiffness_ratio=0.7")


def _grains(text: str, *settings: str, steps: int = 1500) -> Scene:
    return Scene("porescale", steps, text=HEAD + text, settings=settings)


def _contacts() -> dict[str, Subject]:
    """Laws, frictions and materials."""
    linear, hertz = PACKING + LINEAR, PACKING + HERTZ
    steel = TWO + STEEL.replace("density", "stiffness = 4e5\nfriction = 0.3\ndensity")
    young = TWO + STEEL.replace("density", "young = 5e7\nfriction = 0.3\ndensity")
    return {
        "linear": _grains(linear),
        "linear, smooth": _grains(PACKING + SMOOTH),
        "linear, released at overlap": _grains(linear, "contact.release=overlap"),
        "linear, tangential damping": _grains(linear, "contact.tangential_damping=2"),
        "linear, damping": _grains(linear.replace("restitution = 0.7", "damping = 3")),
        "linear, wall friction": _grains(linear, "contact.wall_friction=0.1"),
        "linear, no friction at walls": _grains(linear, "contact.wall_friction=0"),
        "linear, rolling": _grains(linear, *ROLLING),
        "linear, smooth and rolling": _grains(PACKING + SMOOTH, *ROLLING),
        "linear, materials": _grains(PACKING + steel + LINEAR + PAIR),
        "linear, materials, rolling": _grains(PACKING + steel + LINEAR + PAIR, *ROLLING),
        "linear, energy": _grains(linear, "output.energy=true"),
        "hertz": _grains(hertz),
        "hertz, smooth": _grains(hertz, "contact.friction=0"),
        "hertz, restitution": _grains(hertz.replace("damping_ratio = 0.1", "restitution = 0.6")),
        "hertz, released at overlap": _grains(hertz, "contact.release=overlap"),
        "hertz, rolling": _grains(hertz, *ROLLING_HERTZ),
        "hertz, materials": _grains(PACKING + young + HERTZ + PAIR),
        "hertz, energy": _grains(hertz, "output.energy=true"),
    }  # fmt: skip


def _crowds() -> dict[str, Subject]:
    """As many discs as are worth threads: 20 000 or more."""
    linear, hertz = CROWD + LINEAR, CROWD + HERTZ
    beside = CROWD.replace('left = 0\nwidth = "95 cm"', 'left = "8 cm"\nwidth = "87 cm"')
    return {
        "linear": _grains(linear, *HEAVY, steps=60),
        "linear, smooth": _grains(CROWD + SMOOTH, *HEAVY, steps=60),
        "linear, rolling": _grains(linear, *HEAVY, *ROLLING, steps=60),
        "linear, energy": _grains(linear, *HEAVY, "output.energy=true", steps=60),
        "linear, materials": _grains(CROWD + STEEL + LINEAR + PAIR, *HEAVY, steps=60),
        "hertz": _grains(hertz, *HEAVY, steps=60),
        "hertz, rolling": _grains(hertz, *HEAVY, *ROLLING_HERTZ, steps=60),
        "bodies": _grains(beside + BODIES + LINEAR, *HEAVY, steps=60),
        "bonds": _grains(linear + "[bonds]\nat = 0.006\n", *HEAVY, steps=60),
    }  # fmt: skip


def _bodies() -> dict[str, Subject]:
    """Bodies, bonds, what drives them and what is measured on them."""
    bonds = (
        '[[bonds]]\nat = 0.02\nbodies = ["grain"]\n[[bonds]]\nat = 0.04\ntension = 20\nwithin = [0, 0, 0.03, 0.03]\n'
    )
    linear, hertz = PACKING + LINEAR, PACKING + HERTZ
    grown, pressed = "compress = true\npacking_fraction = 0.8", 'pressure = "5 kPa"'
    sheared = LINEAR.replace("1e5", "1e6").replace("4e4", "5e5")
    return {
        "settled": _grains(SETTLED + LINEAR, *STRAIGHT, steps=300),
        "settled, hertz": _grains(SETTLED + HERTZ, *STRAIGHT, steps=300),
        "asleep": _grains(SETTLED + LINEAR + "[sleep]\nafter = 0.002\n", *STRAIGHT, steps=1500),
        "gate": _grains(SETTLED + LINEAR + GATE, "gravity=[0,-9.81]", steps=1000),
        "bonds": _grains(linear + bonds),
        "bonds, hertz": _grains(hertz + bonds),
        "bodies": _grains(PACKING + BODIES + LINEAR),
        "bodies, hertz": _grains(PACKING + BODIES + HERTZ),
        "bodies, rolling": _grains(PACKING + BODIES + LINEAR, *ROLLING),
        "bodies, energy": _grains(PACKING + BODIES + LINEAR, "output.energy=true"),
        "bodies, bonds": _grains(PACKING + BODIES + LINEAR + "[bonds]\nat = 0.03\n"),
        "container": _grains(PACKING + CONTAINER + LINEAR),
        "control and wall": _grains(RAISED + GRAIN + CONTROL + LINEAR),
        "measured": _grains(linear + REGIONS),
        "rectangle": _grains(linear + '[[rectangle]]\nlower = ["5.2 cm", 0]\nupper = ["5.6 cm", "7 cm"]\n'
                             'velocity = [0, "0.2 m/s"]\nfriction = 0.1\n'),
        "held disc": _grains(linear + '[[disc]]\nx = "6 cm"\ny = "1 cm"\ndiameter = "8 mm"\nvelocity = ["-5 cm/s", 0]\n'
                             "spin = 3\n"),
        "cell, grown": _cell("rate_xy = 2", grown, sheared),
        "cell, pressed": _cell('rate_xy = 2\nstress_yy = "5 kPa"\nfastest = 1', pressed, sheared),
        "cell, stresses": _cell('stress_xx = "5 kPa"\nrate_yy = -1\nfastest = 1', pressed, sheared),
        "rock, cells": _rock("cells", 'gap = "0.05 mm"\npressed = "2 um"'),
        "rock, triangles": _rock("triangles", 'gap = "0.05 mm"\npressed = "2 um"\nplates = "y"'),
        "rock, discs": _rock("discs", ""),
    }  # fmt: skip


def _cell(cell: str, sizes: str, law: str) -> Scene:
    return Scene("porescale", 1000, text=CELL.format(cell=cell, sizes=sizes) + law)


def _rock(kind: str, more: str) -> Scene:
    return Scene("porescale", 800, text=ROCK.format(kind=kind, more=more) + LINEAR.replace("1e5", "1e6"))


def _commands() -> dict[str, Subject]:
    """What commands leave in files."""
    few = "--set grains.packing.height=12mm --set domain.height=15mm --set time.end=0.012"
    run = f"porescale run {{cases}}/lifting_gate --out run --quiet --threads {{threads}} {few}"
    film = "porescale piv render run --out film --scale 0.1mm --interval 1ms --start 0.004s"
    cavity = "--quality draft --set time.end=2 --set output.snapshot_interval=0.2"
    return {
        "run": Commands((run,), ("run/*.csv", "run/**/*.vtkhdf")),
        "piv": Commands(
            (f"porescale run {{cases}}/lid_driven_cavity --out run --quiet --threads {{threads}} {cavity}",
             "porescale piv render run --out film --scale 5mm --interval 20ms --start 1.5s --end 1.6s",
             "porescale piv measure film/frames --out fields --csv field.csv --scale 5mm --interval 20ms"
             " --threads {threads}"),
            ("*.csv", "fields/*.csv"),
        ),
        "piv synth": Commands(
            ("porescale piv synth rankine --out made --size 256",
             "porescale piv measure made/a.png made/b.png --csv field.csv --threads {threads}",
             "porescale piv synth discs --out held --size 256",
             "porescale piv measure held/a.png held/b.png --mask held/mask.png --no-slip --csv masked.csv"
             " --threads {threads}"),
            ("*.csv", "made/*.csv"),
        ),
        "demseg run": Commands(
            ("porescale demseg run {cases}/demseg_repose --out run --quiet --threads {threads}",),
            ("run/*.dat", "run/*.csv"),
        ),
        "demseg convert": Commands(("porescale demseg convert {cases}/demseg_triangle --out made.toml",), ("*.toml",)),
        "film of run": Commands((run, film), ("film/*/*.png",)),
    }  # fmt: skip


def subjects() -> dict[str, Subject]:
    """All by name."""
    found = {f"contact/{name}": it for name, it in _contacts().items()}
    found |= {f"crowd/{name}": it for name, it in _crowds().items()}
    found |= {f"grains/{name}": it for name, it in _bodies().items()}
    return found | {f"command/{name}": it for name, it in _commands().items()}
