"""Water that is stirred over held ground and comes to rest: it keeps its volume, and lies level.  SI."""

from continuum_sph.builders.simulation import Simulation
from continuum_sph.scene.sections import Scene
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.schema.sections import validate

VALIDATIONS = Validations()

WIDTH, BED, STANDS = 1.0, 0.2, 0.25  # m: of the tank; surface of the ground; depth of the water once it lies level
SECONDS = 10.0


def stirred(spacing: float, seconds: float = SECONDS) -> tuple[float, float]:
    """(by how much the water is too deep, twice its mean height over the ground less ``STANDS``, in spacings;
    difference of level between two quarters of the tank, m).

    A column twice as deep as it will stand falls from the left half of the tank and sloshes for so many ``seconds``
    over ground that is held and full of water.
    """
    outline = [[0.0, 0.0], [WIDTH, 0.0], [WIDTH, BED], [0.0, BED]]
    scene = validate(
        Scene,
        {
            "tank": {"width": WIDTH, "height": 1.4, "lid": False},
            "numerics": {"spacing": spacing},
            "time": {"end": seconds},
            "output": {"snapshot_interval": seconds, "series_interval": seconds},
            "soil": {
                "stiffness": 2e6, "friction_angle": "30 degree", "held": True, "permeability": 1e-3,
                "body": [{"outline": outline}],
            },
            "water": {
                "column": [
                    {"width": WIDTH, "height": BED},
                    {"width": 0.5 * WIDTH, "height": 2.0 * STANDS, "bottom": BED},
                ],
            },
            "level": [{"x": 0.25 * WIDTH}, {"x": 0.75 * WIDTH}],
        },
    )  # fmt: skip
    model = Simulation(scene)
    while model.time < seconds:
        model.advance(50)
    layer = model.state()["water"]["flow"]["layer"]
    height = layer["x"][: len(layer["density"]), 1]
    depth = 2.0 * (float(height[height > BED].mean()) - BED)
    levels = [row["level 0 (m)"] - row["level 1 (m)"] for row in model.tables().values() if "level 0 (m)" in row]
    return (depth - STANDS) / spacing, levels[0]


@VALIDATIONS.row(
    "continuum.stirred_water_over_ground",
    source="exact: water keeps its volume: a column 0.5 m deep over half of a tank lies 0.25 m deep",
    because="half a spacing, in spacings, at 5 and 10 rows of water: it covers the ground with whole particles, so its"
    " lower edge is known to half of one",
    tolerance=0.5,
    slow=True,
)
def stirred_water() -> Measured:
    """Depth of water over ground 10 s after it was let go, less that which it has, in spacings, 5 and 10 rows."""
    return Measured.absolute([0.0, 0.0], [stirred(spacing)[0] for spacing in (0.05, 0.025)])
