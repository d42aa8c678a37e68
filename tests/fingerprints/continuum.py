"""Fingerprints of the continuum: every choice of water, walls, second fluid, soil, seepage and air."""

from tests.fingerprints.subjects import Scene, Subject

DAM = """
[tank]
width = 0.8
height = 0.5
[water]
viscosity = 1.002e-3
[[water.column]]
width = 0.3
height = 0.4
[[probe]]
name = "toe"
x = 0.2
y = 0.1
[[level]]
name = "left"
x = 0.1
[numerics]
spacing = 0.02
{numerics}
[time]
end = 1
[output]
snapshot_interval = 1
series_interval = 1
energy = true
"""
BUBBLE = """
[tank]
width = 0.4
height = 0.5
walls = "floor and lid stick"
[water]
sound_speed = 30
[[water.column]]
width = 0.4
height = 0.4
[inclusion]
density = {density}
law = "{law}"
surface_tension = {tension}
{more}
[[inclusion.disc]]
x = 0.2
y = 0.16
radius = 0.08
[numerics]
spacing = 0.02
gradient = "{gradient}"
shifting = 1.0
[time]
end = 1
[output]
snapshot_interval = 1
series_interval = 1
"""
SOIL = """
gravity = 9.8
[tank]
width = 1.0
height = 0.5
lid = false
[soil]
stiffness = 1e6
{soil}
[[soil.body]]
outline = [[0, 0], [0.4, 0], [0.4, 0.3], [0, 0.3]]
[soil.numerics]
{numerics}
[numerics]
spacing = 0.02
[time]
end = 1
[output]
snapshot_interval = 1
series_interval = 1
"""
WET = """
gravity = 9.8
[tank]
width = 0.8
height = 0.5
lid = false
[water]
sound_speed = 30
[[water.column]]
left = {left}
bottom = {bottom}
width = {width}
height = {height}
[soil]
stiffness = 4e5
permeability = "2 cm/s"
{soil}
[[soil.body]]
outline = [[0.3, 0], [0.56, 0], [0.56, 0.3], [0.3, 0.3]]
{sections}
[numerics]
spacing = 0.02
artificial_viscosity = 0.1
{numerics}
[time]
end = 1
[output]
snapshot_interval = 1
series_interval = 1
"""
RESERVOIRS = """
[[reservoir]]
name = "upstream"
left = 0
right = 0.2
level = 0.26
[[reservoir]]
name = "downstream"
left = 0.66
right = 0.8
level = 0
"""
RISING = RESERVOIRS.replace("level = 0.26", "rise = [[0, 0.2], [0.02, 0.3]]")
PILE = """
[pile]
x = 0.43
tip = 0.12
faces = "{faces}"
"""
AIR = """
[air]
density = 20
pressure = 5000
law = "{law}"
"""
WATER = {
    "plain": "",
    "corrected, shifted": 'gradient = "corrected"\nshifting = 2.0',
    "corrected": 'gradient = "corrected"',
    "cubic": 'kernel = "cubic"\nsmoothing_ratio = 1.0',
    "cubic, corrected": 'kernel = "cubic"\ngradient = "corrected"\nshifting = 1.0',
    "xsph": "xsph = 0.5",
    "density filter": "density_filter = 20\ndensity_diffusion = 0",
    "evolved length": 'smoothing_length = "evolved"',
    "diffusion of linear": 'diffusion_of = "linear"',
    "diffusion of everything": 'diffusion_of = "plain"',
    "no noise floor": "noise_floor = 0",
    "no diffusion": "density_diffusion = 0",
    "cut tension": 'tension = "cut"',
    "both viscosities": "artificial_viscosity = 0.1\nartificial_viscosity_2 = 0.2",
    "as published": 'kernel = "cubic"\nsmoothing_ratio = 1\nsmoothing_length = "evolved"\ndensity_filter = 20\n'
    "xsph = 0.5\ndensity_diffusion = 0",
}
TANKS = {
    "walls that stick": ("tank.walls=stick",),
    "floor and lid stick": ("tank.walls=floor and lid stick",),
    "images": ("tank.wall_particles=images",),
    "images that stick": ("tank.wall_particles=images", "tank.walls=stick"),
    "released": ("water.pressure=released",),
    "no pressure, pushed": ("water.pressure=none", "water.push=face"),
    "exponent 1.5": ("water.exponent=1.5",),
    "exponent 3, viscous": ("water.exponent=3", "water.viscosity=5"),
}
GROUND = {
    "drained": ("", ""),
    "dilatant, cohesive": ('dilatancy_angle = "5 degree"\ncohesion = 200\ntension = 100', ""),
    "elastic, stiffening": ("elastic = true\nexponent = 0.5", ""),
    "printed modulus": ('modulus = "printed"\nstress = "none"', ""),
    "clay": ('friction_angle = 0\ncohesion = 1000\ntension = 300\nsides = "hold"', "repulsion = 20"),
    "floor slips": ('floor = "slip"\nrest = 0.6', "settle = 0.05"),
    "as published": (
        "",
        'gradient = "plain"\ndamping_of = "approach"\ndamping = 0.001\nstress_diffusion = 0\nparting = 0',
    ),
    "by viscosity": ("", "damping_viscosity = 0.08\nrestless_diffusion = 0.1"),
    "bounded": ("", 'damping_of = "bounded"'),
    "side walls": ('side_walls = {distance = "30 cm", friction_angle = "15 degree"}', ""),
    "fast, softening": (
        'rate = {friction_angle = "35 degree", inertial_number = 0.3, grain_diameter = 1e-3}\n'
        'softening = {friction_angle = "20 degree", shear_strain = 0.01, band_width = 0.1}',
        "",
    ),
}
BESIDE = {"left": "0", "bottom": "0", "width": "0.3", "height": "0.26"}
OVER = {"left": "0", "bottom": "0", "width": "0.8", "height": "0.4"}
CARMAN = 'permeability_law = "kozeny-carman"'
STILL = 'smoothing_ratio = 2\ntension = "cut"'
SEEPAGE = {
    "beside": (BESIDE, "", "", STILL),
    "beside, elastic": (BESIDE, "elastic = true", RESERVOIRS, STILL),
    "rising level": (BESIDE, "", RISING, STILL),
    "over": (OVER, "saturated = true", "", ""),
    "over, bounded": (OVER, 'saturated = true\nnumerics = {damping_of = "bounded"}', "", ""),
    "over, kozeny-carman": (OVER, CARMAN, "", 'gradient = "corrected"\nshifting = 1.0'),
    "pile": (OVER, "saturated = true", PILE.format(faces="slip"), STILL),
    "pile that holds": (OVER, "", PILE.format(faces="hold"), ""),
    "air": (BESIDE, "", AIR.format(law="adiabatic"), 'gradient = "corrected"\nshifting = 1.0\ntension = "cut"'),
    "air, printed": (BESIDE, "", AIR.format(law="printed"), 'tension = "cut"'),
}


def subjects() -> dict[str, Subject]:
    """All by name."""
    found: dict[str, Subject] = {}
    for name, numerics in WATER.items():
        found[f"water/{name}"] = _model(DAM.format(numerics=numerics), 150)
    for name, settings in TANKS.items():
        found[f"water/{name}"] = _model(DAM.format(numerics=""), 150, *settings)
    crowd = DAM.replace("spacing = 0.02", "spacing = 0.0025").format(numerics=WATER["corrected, shifted"])
    found["water/crowd"] = _model(crowd, 15)
    for law, density in (("liquid", 500), ("adiabatic", 1.207), ("printed", 1.207)):
        for gradient, tension in (("plain", 0.0), ("corrected", 5.0)):
            text = BUBBLE.format(law=law, density=density, gradient=gradient, tension=tension, more="")
            found[f"inclusion/{law}, {gradient}"] = _model(text, 100)
    text = BUBBLE.format(law="adiabatic", density=1.207, gradient="plain", tension=0.0, more="cohesion = 5e-4")
    found["inclusion/cohesion"] = _model(text, 100)
    for name, (soil, numerics) in GROUND.items():
        found[f"soil/{name}"] = _model(SOIL.format(soil=soil, numerics=numerics), 150)
    for name, (where, soil, sections, numerics) in SEEPAGE.items():
        found[f"seepage/{name}"] = _model(WET.format(**where, soil=soil, sections=sections, numerics=numerics), 100)
    return found


def _model(text: str, steps: int, *settings: str) -> Scene:
    return Scene("continuum-sph", steps, text=text, settings=settings)
