"""A packing that is pressed together fills the box."""

from porescale.builders.initial.contact_laws import law_class
from porescale.common.core.errors import Fault
from porescale.scene.packing import SAME
from porescale.scene.scene import Scene


def check_compressed(scene: Scene, faults: list[Fault]) -> None:
    """A compressed packing fills the box: nothing else would hold it together."""
    packing = scene.grains.packing if scene.grains else None
    if packing is None or not packing.compress or scene.rock:
        return
    if scene.contact and not law_class(scene.contact).compresses:
        problem = "packings are compressed under the linear law only"
        faults.append(Fault("contact.law", str(scene.contact.law), problem, repair='let it settle, or take "linear"'))
    domain = scene.domain
    for key, start, length, size in (
        ("width", packing.left, packing.width, domain.width), ("height", packing.bottom, packing.height, domain.height),
    ):  # fmt: skip
        if abs(start) > SAME * size or abs(length - size) > SAME * size:
            problem = "a compressed packing fills the box, whose sides hold it"
            repair = "make the packing as large as the box, or let it settle"
            faults.append(Fault(f"grains.packing.{key}", length, problem, "m", f"{size:g}", repair))
