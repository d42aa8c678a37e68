"""Scenes of both programs, run in this process from their command lines: what holds of one must hold of the other."""

import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

from continuum_sph.cli import PACKAGE as CONTINUUM
from porescale.cli.main import PACKAGE as PORESCALE
from porescale.common.cli.application import application, main
from porescale.common.compiled import jit
from tests.reference.faults.killing import SCENES
from tests.reference.scenes import write

PACKAGES = {"porescale": PORESCALE, "continuum_sph": CONTINUUM}
SOIL: dict[str, Any] = {
    "tank": {"width": 0.3, "height": 0.2},
    "soil": {"stiffness": 1e6, "body": [{"outline": [[0, 0], [0.1, 0], [0.1, 0.1], [0, 0.1]]}]},
    "numerics": {"spacing": 0.01}, "time": {"end": 0.02},
    "output": {"snapshot_interval": 0.005, "series_interval": 0.001},
}  # fmt: skip
BUBBLE: dict[str, Any] = {
    "tank": {"width": 0.4, "height": 0.5},
    "water": {"viscosity": 1e-3, "sound_speed": 26.5, "column": [{"width": 0.4, "height": 0.4}]},
    "inclusion": {"density": 1.2, "viscosity": 1.8e-5, "surface_tension": 6.0,
                  "disc": [{"x": 0.2, "y": 0.16, "radius": 0.08}]},
    "numerics": {"spacing": 0.02, "artificial_viscosity": 0.05, "gradient": "plain", "shifting": 1.0},
    "time": {"end": 0.02}, "output": {"snapshot_interval": 0.005, "series_interval": 0.001, "energy": True},
}  # fmt: skip
AIR: dict[str, Any] = {
    "tank": {"width": 0.16, "height": 0.44, "lid": False},
    "water": {"sound_speed": 42.0, "pressure": "hydrostatic",
              "column": [{"bottom": 0.2, "width": 0.16, "height": 0.2}]},
    "air": {"density": 20.0, "pressure": 5000.0},
    "soil": {"density": 1590.0, "porosity": 0.4, "stiffness": 3e5, "permeability": 0.05, "stress": "geostatic",
             "body": [{"outline": [[0, 0], [0.16, 0], [0.16, 0.2], [0, 0.2]]}]},
    "numerics": {"spacing": 0.02, "artificial_viscosity": 0.1, "shifting": 1.0, "gradient": "corrected",
                 "tension": "cut"},
    "time": {"end": 0.02}, "output": {"snapshot_interval": 0.005, "series_interval": 0.001},
}  # fmt: skip
FRAMED: dict[str, Any] = {
    "domain": {"width": 0.012, "height": 0.008}, "time": {"end": 0.008},
    "output": {"snapshot_interval": 0.002, "series_interval": 0.0004, "checkpoint_seconds": 0.05, "energy": True},
    "grains": {"density": 2500, "grain": [{"x": x, "y": 0.0017, "diameter": 0.001} for x in (0.0085, 0.00951)]},
    "contact": {"stiffness": 2e5, "tangential_stiffness": 5e4, "restitution": 0.5, "friction": 0.5},
    "disc": [{"x": 0.011, "y": 0.006, "diameter": 0.001}],
    "polygon": [{"corners": [[0, 0], [1e-3, 0], [1e-3, 1e-3], [0, 1e-3]], "thickness": 5e-5,
                 "at": [[2e-3, 2e-3], [3.0992e-3, 2e-3], [4.1984e-3, 2e-3]]}],
    "container": [{"chain": [[7e-3, 1e-3], [10e-3, 1e-3]], "thickness": 1e-4}],
    "bonds": [{}], "control": [{"polygon": 0, **{axis: {"velocity": 0.0} for axis in ("x", "y", "rotation")}}],
}  # fmt: skip
"""Squares 0.8 µm into each other, which bonds hold to a first one that is held; two grains fall on a chain."""
KINDS = {
    **SCENES, "framed": ("porescale", FRAMED), "soil": ("continuum_sph", SOIL), "bubble": ("continuum_sph", BUBBLE),
    "air": ("continuum_sph", AIR),
}  # fmt: skip
"""Package and scene: grains behind a gate in water, awake and asleep; bodies of lines, bonded; water, ground, and
ground with water in it; gas in water, and in ground."""


@dataclass(frozen=True)
class Program:
    """What runs a scene of KINDS, which lies in ``place``."""

    name: str
    place: Path

    @property
    def scene(self) -> Path:
        """Its file."""
        return self.place / "scene.toml"

    @property
    def values(self) -> dict[str, Any]:
        """What the file says."""
        return KINDS[self.name][1]

    def run(
        self, folder: Path, *words: object, happens: Callable[[], object] | None = None, at: float = 0.5,
        fault: Callable[[Any], object] = lambda model: None, builds: bool = True,
    ) -> int:  # fmt: skip
        """Exit code of a run into ``folder``, without pictures.

        happens : is called once, after the first step later than a share ``at`` of the whole time, and then ``fault``
        with the model;  builds : False where it must end before a model is built.
        """
        package, before = PACKAGES[KINDS[self.name][0]], jit.threads()
        late = at * float(self.values["time"]["end"])

        def build(scene: Any) -> Any:
            """A model that does so."""
            assert builds, "a model is built"
            model = package.build(scene)
            advance, waiting = model.advance, [happens]

            def steps(count: int) -> None:
                """Its own steps."""
                advance(count)
                if waiting and model.time > late:
                    waiting.pop()()
                    fault(model)

            if happens is not None:
                model.advance = steps
            return model

        given = ["run", self.scene, "--out", folder, "--quiet", *words]
        given += [] if "--threads" in words else ["--threads", 1]
        try:
            with patch.object(sys.modules[package.show.__module__], "show", lambda folder: []):
                return main(application(replace(package, build=build)), [str(word) for word in given])
        finally:
            jit.set_threads(before)


def program(name: str, place: Path) -> Program:
    """Writes the scene's file into ``place``."""
    write(place / "scene.toml", KINDS[name][1])
    return Program(name, place)
