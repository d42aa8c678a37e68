"""A package for the workbench that simulates nothing: what its commands do is up to the scene."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from porescale.common.api.report import Report
from porescale.common.cli.package import Package
from porescale.common.core.errors import Fault, InputError, PorescaleError, Unstable
from porescale.common.evidence.benchmarks import Benchmarks, Work
from porescale.common.evidence.validations import Measured, Validations
from porescale.common.pictures.look import Look
from porescale.common.record.series import Series
from porescale.common.schema.scene import SceneBase
from porescale.common.schema.sections import Section, quantity


class Decay(Section):
    rate: float = quantity("1/s", gt=0, help="rate of decay")
    start: float = quantity("m", 1.0)


class Noise(Section):
    seed: int = 1
    size: float = quantity("", 0.1, ge=0, help="deviation of the rate")


class ToyScene(SceneBase):
    decay: Decay
    noise: Noise | None = None
    duration: float = quantity("s", 1.0, gt=0)
    trouble: str = ""

    @property
    def drawn_at_once(self) -> bool:
        return False  # there is nothing to draw


TEMPLATE = '# How fast it goes.\nduration = "2 s"\n[decay]\nrate = 3\n[quality.fine.decay]\nstart = 2\n'


@dataclass
class Ended:
    outcome: str
    step: int
    time: float
    seconds: float
    snapshots: int
    steps_per_second: float


class ToyModel:
    def __init__(self, scene: ToyScene) -> None:
        self.scene = scene


def drive(
    model: ToyModel, folder: Path, scene: ToyScene, *, card: dict, resume: bool, quiet: bool, overwrite: bool = False
) -> Ended:
    troubles = {
        "unstable": lambda: Unstable("cell (1, 2)", "speed", 9.0, "m/s", 7, 0.5, "a smaller step helps"),
        "failed": lambda: PorescaleError("the film\ncould not be made"),
        "stopped": KeyboardInterrupt,
        "bug": lambda: ZeroDivisionError("ours"),
        "memory": lambda: MemoryError("12 GiB"),
        "disk": lambda: OSError(28, "No space left on device", "fields.vtkhdf"),
        "lost": lambda: FileNotFoundError(2, "No such file", "fields.vtkhdf"),
        "nameless": lambda: OSError(22, "Invalid argument"),
    }
    if scene.trouble:
        raise troubles[scene.trouble]()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "card.json").write_text(json.dumps({**card, "resumed": resume, "overwrite": overwrite}))
    write_series(folder, card["scene"])
    return Ended("finished", 10, scene.duration, 0.5, 3, 20.0)


def report(scene: ToyScene) -> Report:
    if scene.decay.rate > 100:
        raise InputError(Fault("decay.rate", scene.decay.rate, "is beyond the stable limit", "1/s", "<= 100"))
    made = Report("toy")
    made.heading("time")
    made.row("steps", 10, "", "of 0.1 s")
    return made


def picture(folder: Path) -> list[Path]:
    return [folder / "end.png"]


def write_series(folder: Path, scene: dict) -> None:
    """series.csv of what decayed in a scene."""
    decay, noise = scene["decay"], scene.get("noise")
    rate = decay["rate"] * (1.0 + noise["size"] * np.random.default_rng(noise["seed"]).normal() if noise else 1.0)
    time = np.linspace(0.0, 1.0, 11)
    series = Series(folder / "series.csv")
    for row in zip(time, decay["start"] * np.exp(-rate * time), strict=True):
        series.append(dict(zip(("time (s)", "left (m)"), row, strict=True)))
    series.close()


def seeds(scene: ToyScene) -> dict[str, int]:
    return {"noise.seed": scene.noise.seed} if scene.noise else {}


def validations() -> Validations:
    made = Validations()

    @made.row("toy.good", source="exact", because="exact", tolerance=0.0)
    def _() -> Measured:
        return Measured(1.0, 1.0, 0.0)

    @made.row("toy.bad", source="exact", because="exact", tolerance=0.0, slow=True)
    def _() -> Measured:
        return Measured(1.0, 2.0, 1.0)

    return made


def benchmarks() -> Benchmarks:
    made = Benchmarks()

    @made.row("toy")
    def _(size: int | None, threads: int, dtype: str) -> Work:
        return Work(lambda: sum(range(1000)), 1.0, "toys/s", size or 1)

    return made


TOY = Package(
    name="toy",
    module="tests.reference.toy_package",
    summary="A toy.",
    scene=lambda: ToyScene,
    template=lambda: TEMPLATE,
    build=ToyModel,
    drive=drive,
    report=report,
    show=picture,
    look=lambda run: Look(),
    seeds=seeds,
    validations=validations,
    benchmarks=benchmarks,
)
