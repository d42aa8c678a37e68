"""What steps a scene, and what a GPU does not have: refused, one line each, and never run on the CPU instead."""

from porescale.common.compiled.own import OwnLaw
from porescale.common.core.errors import Fault
from porescale.scene.scene import Scene

REPAIR = 'take "cpu"'


def check_device(scene: Scene) -> list[Fault]:
    """Faults of [run] device = "gpu"."""
    if device_of(scene) == "cpu":
        return []
    if scene.fluid is None:
        return [Fault("run.device", "gpu", "steps fluid only, and there is none", repair=REPAIR)]
    solids = {"rectangle": scene.rectangle, "ring": scene.ring}
    lacking = [f"[{name}] in fluid" for name, section in solids.items() if section]
    if isinstance(scene.fluid.body_force, OwnLaw):
        lacking.append("a body_force of your own")
    return [Fault("run.device", "gpu", f"does not have {name}", repair=REPAIR) for name in lacking]


def device_of(scene: Scene) -> str:
    """What steps the fluid of a scene, "cpu" or "gpu"."""
    return scene.run.device if scene.run else "cpu"


def require_device_of(scene: Scene) -> None:
    """InputError where the scene's fluid is stepped on a GPU and none can be used."""
    if device_of(scene) != "cpu":
        from porescale.common.compiled.cuda import require_device

        require_device()


def gpu_of(scene: Scene) -> tuple[str, str]:
    """Name of the GPU that steps the fluid of a scene and the version of its driver; both "" where none does."""
    if device_of(scene) == "cpu":
        return "", ""
    from porescale.common.compiled.cuda import describe, driver

    return describe()[0], driver()
